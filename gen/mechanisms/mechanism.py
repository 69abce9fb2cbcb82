"""What a mechanism of a recipe is: a section that some rigs or records have, with its key, its effect and its labels."""

from collections.abc import Container, Iterable, Iterator
from typing import Any, ClassVar, TypeVar, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from gen.corpus.schema import Variable
from gen.drawing import Level, Probability, Section, composed, sections_with_places
from gen.support.errors import RacewayError
from gen.support.plugins import plugin, plugins, unusable

FloatArray = NDArray[np.floating]
Base = TypeVar("Base")


class Mechanism(Section):
    """Keys of a mechanism; it is left out of a recipe, or occurs with a probability."""

    place: ClassVar[str]
    """Its key in a recipe."""
    labels: ClassVar[tuple[Variable, ...]] = ()
    """What the corpus says of it, 0 in a record without it."""

    probability: Probability

    @staticmethod
    def compile() -> None:
        """Compile what the mechanism needs, or fetch it from numba's cache on disk."""


def with_plugins(
    base: type[Base], built_in: tuple[type[Base], ...], others: Container[str] = ()
) -> tuple[type[Base], ...]:
    """Classes that are built in, and those of plug-ins with the same base, each with a key of its own, which is none of the ``others``.

    Raises
    ------
    RacewayError
        If the key of a plug-in is taken, or its draws are of no level.
    """
    classes = [*built_in]
    for name in plugins("mechanisms"):
        mechanism = plugin("mechanisms", name, type)
        if not issubclass(mechanism, base):
            continue
        if (key := _key(mechanism)) in others or key in map(_key, classes):
            raise unusable("mechanisms", name, f"{key} is taken")
        if (level := getattr(mechanism, "drawn_per", None)) not in (None, *get_args(Level)):
            raise unusable("mechanisms", name, f"drawn_per is {level!r} and not {', '.join(get_args(Level)[1:])}")
        classes.append(mechanism)
    return tuple(classes)


def _key(mechanism: type) -> str:
    """Key of a mechanism in a recipe: its place, or the kind of a fault."""
    fields = getattr(mechanism, "model_fields", {})
    return getattr(mechanism, "place", None) or "".join(get_args(fields["kind"].annotation) if "kind" in fields else ())


def plugins_of(*recipes: Section) -> list[str]:
    """Names of the plug-ins whose mechanisms some recipes have."""
    added = {name: plugin("mechanisms", name, type) for name in plugins("mechanisms")}
    sections = [section for recipe in recipes if added for _, section in sections_with_places(recipe)]
    return [name for name, mechanism in added.items() if any(isinstance(section, mechanism) for section in sections)]


def unusable_result(mechanism: Mechanism, method: str, wanted: str) -> RacewayError:
    """Error that names the plug-in of a mechanism whose method does not return what it must."""
    reason = f"{method}() of {mechanism.place} must return {wanted}"
    of_plugin = (unusable("mechanisms", name, reason) for name in plugins_of(mechanism))
    return next(of_plugin, RacewayError(f"{reason}."))


def section_with(name: str, module: str, base: type[Section], mechanisms: Iterable[type[Mechanism]]) -> Any:
    """Section of a recipe with the keys of ``base``, and one for each mechanism."""
    keys: dict[str, Any] = {
        kind.place: (
            kind | None,
            Field(default=None, description=f"{str(kind.__doc__).rstrip('.')}; none if left out."),
        )
        for kind in mechanisms
    }
    return composed(name, module, (base,), base.__doc__, **keys)


def mechanisms_of(section: Section) -> Iterator[Any]:
    """Mechanisms that a section of a recipe has."""
    return (value for _, value in section if isinstance(value, Mechanism))
