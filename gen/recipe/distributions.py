"""Distributions that a recipe can name: each checks its keys and turns a number between 0 and 1 into a value.

Values are drawn with the inverse distribution function. So random and quasi-random points are treated alike, and every distribution takes
one number: to change the distribution of one key does not move the values of the others.
"""

import math
import reprlib
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

Number = Annotated[float, Field(strict=True)]


class _Distribution(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, use_attribute_docstrings=True)

    def draw(self, u: float) -> float:
        """Value at the quantile ``u`` in [0, 1)."""
        raise NotImplementedError

    def support(self) -> tuple[float, float]:
        """Smallest and largest value that can be drawn."""
        raise NotImplementedError


class Constant(_Distribution):
    """One value; a plain number is short for this."""

    kind: Literal["constant"] = "constant"
    """Gives the same value to every item."""
    value: Number
    """Number that every item gets."""

    def draw(self, u: float) -> float:  # noqa: ARG002 - the same for every quantile
        """Return the value."""
        return self.value

    def support(self) -> tuple[float, float]:
        """Return the value, twice."""
        return self.value, self.value


class _Interval(_Distribution):
    low: Number
    """Smallest value that can be drawn."""
    high: Number
    """Largest value that can be drawn."""

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.low > self.high:
            raise ValueError(f"low {self.low} is above high {self.high}; swap them.")
        return self

    def support(self) -> tuple[float, float]:
        """Return the ends of the interval."""
        return self.low, self.high


class Uniform(_Interval):
    """Any value from low to high, all equally likely."""

    kind: Literal["uniform"]
    """Makes all values of the interval equally likely."""

    def draw(self, u: float) -> float:
        """Value at the quantile ``u``.

        >>> Uniform(kind="uniform", low=2, high=4).draw(0.5)
        3.0
        """
        return self.low + u * (self.high - self.low)


class LogUniform(_Interval):
    """Any value from low to high, with a logarithm that is uniformly distributed; low must be above 0."""

    kind: Literal["loguniform"]
    """Makes all decades of the interval equally likely."""

    @model_validator(mode="after")
    def _positive(self) -> Self:
        if self.low <= 0:
            raise ValueError(f"low {self.low} is not above 0; a loguniform distribution has positive values only.")
        return self

    def draw(self, u: float) -> float:
        """Value at the quantile ``u``.

        >>> round(LogUniform(kind="loguniform", low=1, high=100).draw(0.5), 9)
        10.0
        """
        return self.low * math.exp(u * math.log(self.high / self.low))


class Normal(_Interval):
    """A normal distribution truncated at low and high."""

    kind: Literal["normal"]
    """Draws from a normal distribution without its tails."""
    mean: Number
    """Mean before the distribution is truncated."""
    sd: Annotated[Number, Field(gt=0)]
    """Standard deviation before the distribution is truncated."""

    def draw(self, u: float) -> float:
        """Value at the quantile ``u`` of the truncated distribution."""
        from scipy.special import ndtr, ndtri  # SciPy loads for 0.2 s, and reading a recipe does not need it

        low, high = ndtr((self.low - self.mean) / self.sd), ndtr((self.high - self.mean) / self.sd)
        value = self.mean + self.sd * float(ndtri(low + u * (high - low)))
        return min(max(value, self.low), self.high)


class Choice(_Distribution):
    """One of a few values, with weights if they are not equally likely."""

    kind: Literal["choice"]
    """Draws one number of a list."""
    values: Annotated[tuple[Number, ...], Field(min_length=1)]
    """Numbers of which one is taken."""
    weights: tuple[Annotated[Number, Field(ge=0)], ...] | None = None
    """Relative probability of each value; equal if left out."""

    @model_validator(mode="after")
    def _weighted(self) -> Self:
        if self.weights is not None and (len(self.weights) != len(self.values) or sum(self.weights) <= 0):
            raise ValueError(f"{len(self.weights)} weights for {len(self.values)} values; give one each, not all 0.")
        return self

    def draw(self, u: float) -> float:
        """Value at the quantile ``u``.

        >>> Choice(kind="choice", values=(1, 2), weights=(1, 3)).draw(0.3)
        2.0
        """
        return self.values[weighted_index(self.weights or (1.0,) * len(self.values), u)]

    def support(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return min(self.values), max(self.values)


class Grid(_Distribution):
    """Values in turn, by item number; several grids of the same level enumerate all combinations."""

    kind: Literal["grid"]
    """Cycles through a list by the number of the rig, specimen or record."""
    values: Annotated[tuple[Number, ...], Field(min_length=1)]
    """Numbers of which one is taken."""

    def draw(self, u: float) -> float:
        """Value at the quantile ``u``; used when no item number is known."""
        return self.values[weighted_index((1.0,) * len(self.values), u)]

    def support(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return min(self.values), max(self.values)


DISTRIBUTIONS = (Constant, Uniform, LogUniform, Normal, Choice, Grid)


def weighted_index(weights: tuple[float, ...], u: float) -> int:
    """Index drawn with ``weights`` at the quantile ``u``.

    >>> [weighted_index((1, 2, 1), u) for u in (0.0, 0.25, 0.74, 0.75)]
    [0, 1, 1, 2]
    """
    edges = np.cumsum(weights) / np.sum(weights)
    return min(int(np.searchsorted(edges, u, side="right")), len(weights) - 1)


def _from_number(value: Any) -> Any:
    if value is None or isinstance(value, bool | str | list):
        shown = reprlib.repr(value)  # pyright: ignore[reportUnknownArgumentType]
        raise ValueError(
            f"{shown} is neither a number nor a distribution; write 1.5 or {{kind: uniform, low: 1, high: 2}}."
        )
    return {"kind": "constant", "value": value} if isinstance(value, int | float) else value


Distribution = Annotated[
    Annotated[Constant | Uniform | LogUniform | Normal | Choice | Grid, Field(discriminator="kind")],
    BeforeValidator(
        _from_number, json_schema_input_type=float | Constant | Uniform | LogUniform | Normal | Choice | Grid
    ),
]


def within(low: float, high: float, *, open_low: bool = False, default: float | None = None) -> Any:
    """Field of a distribution whose values all lie between ``low`` and ``high``; required if it has no default."""
    bounds: dict[str, Any] = {"low": low, "high": high, "open_low": open_low}
    given: dict[str, Any] = {} if default is None else {"default": default}
    return Field(**given, json_schema_extra=bounds)


def interval(bounds: dict[str, Any]) -> str:
    """Bounds of a field in the notation of intervals.

    >>> interval({"low": 0, "high": 60, "open_low": True})
    '(0, 60]'
    """
    return f"{'(' if bounds['open_low'] else '['}{bounds['low']:g}, {bounds['high']:g}]"


def check_bounds(distribution: Any, bounds: dict[str, Any]) -> Any:
    """Return ``distribution`` if all its values lie within the ``bounds`` of its field, else raise ValueError."""
    for end in distribution.support():
        if not bounds["low"] <= end <= bounds["high"] or (bounds["open_low"] and end == bounds["low"]):
            raise ValueError(f"{end:g} is not in {interval(bounds)}.")
    return distribution
