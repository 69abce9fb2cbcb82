"""Public names of a package that are imported when they are first used (PEP 562), and cheaper loading of what makes many objects."""

import gc
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from typing import Any

_THRESHOLD = gc.get_threshold()


def lazy_names(
    package: str, modules: Mapping[str, tuple[str, ...]]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """``__getattr__`` and ``__dir__`` for ``package``, whose public names are given by the module that defines them."""
    home = {name: module for module, names in modules.items() for name in names}

    def get(name: str) -> Any:
        if name not in home:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        with garbage_kept():
            return getattr(import_module(home[name]), name)

    def listed() -> list[str]:
        return sorted({*vars(sys.modules[package]), *home})

    return get, listed


@contextmanager
def garbage_kept() -> Iterator[None]:
    """Look for unused objects more seldom while modules load or kernels compile.

    They make hundreds of thousands of objects that stay in use. To look through these again and again takes a tenth of the time of a first
    record, and a fifth of that of a kernel.
    """
    gc.set_threshold(50_000, 20, 20)
    try:
        yield
    finally:
        gc.set_threshold(*_THRESHOLD)
