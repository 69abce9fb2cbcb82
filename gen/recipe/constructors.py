"""Faults and distributions of a recipe by calls, for recipes written in Python.

Each call takes the keys of the section of the same ``kind`` and gives the same errors as a recipe file; ``raceway recipes --keys faults``
lists the keys with their units, ranges and defaults.
"""

from collections.abc import Callable, Sequence
from typing import Any

from pydantic import ValidationError

from gen.drawing import Choice, Grid, LogUniform, Normal, Section, Uniform, plain
from gen.drawing.expressions import called
from gen.recipe.faults import OF_KIND, Fault
from gen.support.errors import RecipeError
from gen.support.sentences import sentences


def _call_of(kind: str) -> Callable[..., Fault]:
    model = OF_KIND[kind]

    def call(*parts: Section, **keys: Any) -> Fault:
        if parts and "parts" not in model.model_fields:
            raise RecipeError(
                f"{kind} fault: {parts[0]!r:.60} has no name; give keys by name, which raceway recipes --keys faults lists."
            )
        try:
            return model.model_validate({**plain({"parts": parts, **keys} if parts else keys), "kind": kind})
        except ValidationError as error:
            raise RecipeError("\n".join(f"{kind} fault: {sentence}" for sentence in sentences(error, model))) from None

    # help(gen.outer) then has the keys of its section
    call.__name__ = call.__qualname__ = kind
    call.__doc__ = f"""{model.__doc__}

    Raises
    ------
    RecipeError
        If there are wrong keys or values; one sentence for each of them.
    """
    return call


healthy, inner, outer, ball, cage, distributed, compound = map(
    _call_of, ("healthy", "inner", "outer", "ball", "cage", "distributed", "compound")
)


def uniform(low: float, high: float, **keys: Any) -> Uniform:
    """Any value from low to high, all equally likely.

    All distributions also take ``per`` and ``scatter_percent``, and are multiplied with the name of the quantity that they are a share of.

    >>> uniform(1000, 3000, per="rig"), uniform(0.1, 0.3) * "static_rating_n"
    (uniform(1000, 3000, per=rig), uniform(0.1, 0.3) * static_rating_n)
    """
    return _called(Uniform, (low, high), keys)


def loguniform(low: float, high: float, **keys: Any) -> LogUniform:
    """Any value from low to high, all decades equally likely; low must be above 0."""
    return _called(LogUniform, (low, high), keys)


def normal(mean: float, sd: float, low: float, high: float, **keys: Any) -> Normal:
    """A normal distribution truncated at low and high."""
    return _called(Normal, (mean, sd, low, high), keys)


def choice(*values: float, weights: Sequence[float] | None = None, **keys: Any) -> Choice:
    """One of a few values, with weights if they are not equally likely."""
    return _called(Choice, values, keys if weights is None else {"weights": tuple(weights), **keys})


def grid(*values: float, **keys: Any) -> Grid:
    """Values in turn, by the number of the rig, specimen or record."""
    return _called(Grid, values, keys)


def _called(model: Any, values: Sequence[float], keys: dict[str, Any]) -> Any:
    try:
        return called(model, plain(values), plain(keys))
    except ValueError as error:
        raise RecipeError(str(error)) from None
