"""One test for many cases: it tries all of them, and names those that fail."""

from collections.abc import Callable, Iterable
from typing import Any


def for_each(cases: Iterable[Any], name: Callable[[Any], str] = str) -> Callable[[Callable[[Any], None]], Any]:
    """Call a test, which takes no fixtures, with each case."""

    def decorate(test: Callable[[Any], None]) -> Callable[[], None]:
        def all_cases() -> None:
            failures = {}
            for case in cases:
                try:
                    test(case)
                except Exception as error:  # noqa: BLE001 - the others are tried too
                    failures[name(case)] = error
            if failures:
                listed = "\n".join(f"{case}: {error!r}" for case, error in failures.items())
                raise AssertionError(listed) from next(iter(failures.values()))

        all_cases.__name__, all_cases.__doc__, all_cases.__module__ = test.__name__, test.__doc__, test.__module__
        return all_cases

    return decorate
