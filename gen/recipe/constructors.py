"""Faults and distributions of a recipe by calls, for recipes written in Python.

Each call takes the keys of the section of the same ``kind`` and gives the same errors as a recipe file; ``raceway recipes --keys faults``
lists the keys with their units, ranges and defaults.
"""

from collections.abc import Sequence
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from gen.drawing import Choice, Grid, LogUniform, Normal, Section, Uniform, plain
from gen.drawing.expressions import called
from gen.recipe.faults import BallFault, CageFault, CompoundFault, DistributedFault, Healthy, RaceFault
from gen.support.errors import RecipeError
from gen.support.sentences import sentences

_Of = TypeVar("_Of", bound=BaseModel)


def healthy(**keys: Any) -> Healthy:
    """A bearing without a fault."""
    return _checked(Healthy, "healthy", keys)


def inner(**keys: Any) -> RaceFault:
    """Spalls on the inner race; ``width_mm`` is required.

    Raises
    ------
    RecipeError
        If there are wrong keys or values; one sentence for each of them. All calls of this module raise it.

    >>> inner(width_mm=0.8).kind
    'inner'
    """
    return _checked(RaceFault, "inner", keys)


def outer(**keys: Any) -> RaceFault:
    """Spalls on the outer race; ``width_mm`` is required, ``depth_um``, ``angle_deg`` and ``n_spalls`` are further keys."""
    return _checked(RaceFault, "outer", keys)


def ball(**keys: Any) -> BallFault:
    """Spalls on one ball; ``width_mm`` is required."""
    return _checked(BallFault, "ball", keys)


def cage(**keys: Any) -> CageFault:
    """A broken cage, with ``pitch_error_deg`` and ``knock_n``."""
    return _checked(CageFault, "cage", keys)


def distributed(**keys: Any) -> DistributedFault:
    """A race worn over its whole circumference; ``site="inner"`` or ``site="outer"`` is required."""
    return _checked(DistributedFault, "distributed", keys)


def compound(*parts: Section, **keys: Any) -> CompoundFault:
    """Several faults in one bearing.

    >>> [part.kind for part in compound(inner(width_mm=0.4), cage()).parts]
    ['inner', 'cage']
    """
    return _checked(CompoundFault, "compound", {"parts": parts, **keys})


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


def _called(model: type[_Of], values: Sequence[float], keys: dict[str, Any]) -> _Of:
    try:
        return called(model, plain(values), plain(keys))
    except ValueError as error:
        raise RecipeError(str(error)) from None


def _checked(model: type[_Of], kind: str, keys: dict[str, Any]) -> _Of:
    try:
        return model.model_validate({**plain(keys), "kind": kind})
    except ValidationError as error:
        raise RecipeError("\n".join(f"{kind} fault: {sentence}" for sentence in sentences(error, model))) from None
