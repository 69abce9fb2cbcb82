"""Compare drawn scenarios: key by key, whatever the corpus that they come from."""

from collections.abc import Mapping
from typing import Any

from gen.drawing import plain
from gen.scenarios import Scenario


def anywhere(scenario: Scenario) -> Scenario:
    """The scenario without the identity of its corpus, which tells recipes apart."""
    return scenario.edited(origin=scenario.origin.model_copy(update={"corpus": "0"}))


def with_key_of(scenario: Scenario, other: Scenario, section: str, key: str) -> Scenario:
    """The scenario with a key of another one, and from anywhere."""
    value = getattr(getattr(other.recipe, section), key)
    return anywhere(scenario.edited(**{section: getattr(scenario.recipe, section).model_copy(update={key: value})}))


def numbers_of(scenario: Scenario) -> dict[str, Any]:
    """Every value of a scenario by its path, such as ``path.modes.frequency_hz[1]``."""
    return dict(_leaves(plain(anywhere(scenario).recipe), ""))


def _leaves(value: Any, path: str) -> Any:
    inner = {}
    if isinstance(value, Mapping):
        inner = {f"{path}.{key}".lstrip("."): one for key, one in value.items()}
    elif isinstance(value, list):
        inner = {f"{path}[{place}]": one for place, one in enumerate(value)}
    else:
        yield path, value
    for below, one in inner.items():
        yield from _leaves(one, below)
