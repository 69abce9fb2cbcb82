"""Distributions a recipe may name: each checks itself and turns a number between 0 and 1 into a value.

Drawing by inverse distribution functions serves random and low-discrepancy points alike, and keeps the number of draws the same
whatever a recipe asks for, so that one value never moves another.
"""

import math
import reprlib
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator
from scipy.special import ndtr, ndtri

Number = Annotated[float, Field(strict=True)]


class _Distribution(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    def draw(self, u: float) -> float:
        """Value at the quantile ``u`` in [0, 1)."""
        raise NotImplementedError

    def support(self) -> tuple[float, float]:
        """Smallest and largest value it can give."""
        raise NotImplementedError


class Constant(_Distribution):
    """Always the same value; a bare number means this."""

    kind: Literal["constant"] = "constant"
    value: Number

    def draw(self, u: float) -> float:  # noqa: ARG002 - the same for every quantile
        """Return the value."""
        return self.value

    def support(self) -> tuple[float, float]:
        """Return the value, twice."""
        return self.value, self.value


class _Interval(_Distribution):
    low: Number
    high: Number

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.low > self.high:
            raise ValueError(f"low {self.low} is above high {self.high}; swap them.")
        return self

    def support(self) -> tuple[float, float]:
        """Return the ends of the interval."""
        return self.low, self.high


class Uniform(_Interval):
    """Anything from low to high, all alike."""

    kind: Literal["uniform"]

    def draw(self, u: float) -> float:
        """Value at the quantile ``u``.

        >>> Uniform(kind="uniform", low=2, high=4).draw(0.5)
        3.0
        """
        return self.low + u * (self.high - self.low)


class LogUniform(_Interval):
    """Anything from low to high, every decade alike."""

    kind: Literal["loguniform"]

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
    """A normal distribution cut off at low and high."""

    kind: Literal["normal"]
    mean: Number
    sd: Annotated[Number, Field(gt=0)]

    def draw(self, u: float) -> float:
        """Value at the quantile ``u`` of the truncated distribution."""
        low, high = ndtr((self.low - self.mean) / self.sd), ndtr((self.high - self.mean) / self.sd)
        value = self.mean + self.sd * float(ndtri(low + u * (high - low)))
        return min(max(value, self.low), self.high)


class Choice(_Distribution):
    """One of a few values, with weights if they are not all alike."""

    kind: Literal["choice"]
    values: Annotated[tuple[Number, ...], Field(min_length=1)]
    weights: tuple[Annotated[Number, Field(ge=0)], ...] | None = None

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
    """Its values in turn: with other grids of the same level, every combination before the first comes again."""

    kind: Literal["grid"]
    values: Annotated[tuple[Number, ...], Field(min_length=1)]

    def draw(self, u: float) -> float:
        """Value at the quantile ``u``, for whoever knows no turn."""
        return self.values[weighted_index((1.0,) * len(self.values), u)]

    def support(self) -> tuple[float, float]:
        """Return the smallest and the largest value."""
        return min(self.values), max(self.values)


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
    text = f"in {'(' if open_low else '['}{low:g}, {high:g}]"
    given: dict[str, Any] = {} if default is None else {"default": default}
    return Field(**given, description=text, json_schema_extra=bounds)


def check_bounds(distribution: Any, bounds: dict[str, Any]) -> Any:
    """Return ``distribution`` if all its values lie within the ``bounds`` of its field, else raise ValueError."""
    low, high, open_low = bounds["low"], bounds["high"], bounds["open_low"]
    for end in distribution.support():
        if not low <= end <= high or (open_low and end == low):
            raise ValueError(f"{end:g} is not in {'(' if open_low else '['}{low:g}, {high:g}].")
    return distribution
