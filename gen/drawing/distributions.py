"""Distributions that a recipe can name: each checks its numbers and turns a number between 0 and 1 into a value.

Values are drawn with the inverse distribution function. So random and quasi-random points are treated alike, and every distribution takes
one number: to change the distribution of one key does not move the values of the others. ``uniform(0.4, 1) * load_n`` is a share of
another quantity: :mod:`gen.recipe.shares` says which quantities can be named, and :mod:`gen.drawing.draws` multiplies when all are drawn.
"""

import functools
import math
from bisect import bisect_right
from typing import Annotated, Any, ClassVar, Literal, Self, cast, get_args

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StringConstraints,
    model_serializer,
    model_validator,
)

from gen.drawing.expressions import expression_of, read_expression

_FARTHEST = 6  # standard deviations from the mean, beyond which quantiles of a normal distribution are too coarse
Number = Annotated[float, Field(strict=True)]
Support = tuple[float, float]
"""Smallest and largest value."""


class _Distribution(BaseModel):
    arguments: ClassVar[tuple[str, ...]]
    """Fields that are written without their names, in this order."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, use_attribute_docstrings=True)

    share_of: Annotated[str, StringConstraints(min_length=1, max_length=60)] | None = None
    """Quantity behind the `*`: the drawn number is then a share of the value of that quantity, and 1 is all of it."""
    per: Literal["rig", "specimen", "record"] | None = None
    """What has one value in common; in `operation` alone, where each record has its own if this is left out."""
    scatter_percent: Annotated[Number, Field(ge=0, lt=100)] = 0.0
    """Largest deviation of a record from the value of its rig or specimen, to both sides and uniformly distributed."""

    @model_validator(mode="after")
    def _scattered_about_something(self) -> Self:
        if self.scatter_percent > 0 and self.per not in ("rig", "specimen"):
            raise ValueError("scatter_percent needs a value to scatter about; give per=rig or per=specimen.")
        return self

    def __mul__(self, quantity: str) -> Self:
        """The distribution as a share of a quantity, by its key."""
        return self.model_copy(update={"share_of": quantity})

    @property
    def written(self) -> str | float:
        """The distribution as a recipe has it: a number if it is one value, else text."""
        return expression_of(self)

    @model_serializer(mode="plain")
    def _as_written(self) -> str | float | list[float]:
        return self.written

    def __str__(self) -> str:
        return str(self.written)

    __repr__ = __str__

    def draw(self, u: float) -> float:
        """Value at the quantile ``u`` in [0, 1)."""
        raise NotImplementedError

    def support(self) -> Support:
        """Smallest and largest number of the distribution, with its scatter: of a share, the share."""
        low, high = self._ends()
        away = self.scatter_percent / 100
        return low - away * abs(low), high + away * abs(high)

    def _ends(self) -> Support:
        raise NotImplementedError

    def about(self, value: float) -> "Constant | Uniform":
        """What is left to draw for a record whose rig or specimen has a ``value``."""
        away = abs(value) * self.scatter_percent / 100
        if away == 0:
            return Constant.model_construct(value=value, share_of=self.share_of)
        return Uniform.model_construct(kind="uniform", low=value - away, high=value + away, share_of=self.share_of)


class Constant(_Distribution):
    """One value; a plain number is short for this."""

    arguments: ClassVar[tuple[str, ...]] = ("value",)
    kind: Literal["constant"] = "constant"
    """Gives the same value to every item."""
    value: Number
    """Number that every item gets."""

    @property
    def written(self) -> str | float:
        """The value, if nothing else is given."""
        return self.value if self.model_fields_set <= {"kind", "value"} else expression_of(self)

    def draw(self, u: float) -> float:
        """Return the value."""
        return self.value

    def _ends(self) -> Support:
        """Return the value, twice."""
        return self.value, self.value


class _Interval(_Distribution):
    arguments: ClassVar[tuple[str, ...]] = ("low", "high")
    low: Number
    """Smallest value that can be drawn."""
    high: Number
    """Largest value that can be drawn."""

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.low > self.high:
            raise ValueError(f"low {self.low} is above high {self.high}; swap them.")
        return self

    def _ends(self) -> Support:
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

    arguments: ClassVar[tuple[str, ...]] = ("mean", "sd", "low", "high")
    kind: Literal["normal"]
    """Draws from a normal distribution without its tails."""
    mean: Number
    """Mean before the distribution is truncated."""
    sd: Annotated[Number, Field(gt=0)]
    """Standard deviation before the distribution is truncated."""

    @model_validator(mode="after")
    def _holds_some(self) -> Self:
        reach = _FARTHEST * self.sd
        if self.low > self.mean + reach or self.high < self.mean - reach:
            raise ValueError(
                f"mean {self.mean} lies {_FARTHEST} sd or more outside low {self.low} and high {self.high}; move it, or raise sd."
            )
        return self

    def draw(self, u: float) -> float:
        """Value at the quantile ``u`` of the truncated distribution."""
        from scipy.special import ndtri  # SciPy loads for 0.2 s, and reading a recipe does not need it

        low, high = (_quantile((end - self.mean) / self.sd) for end in (self.low, self.high))
        value = self.mean + self.sd * float(ndtri(low + u * (high - low)))
        return min(max(value, self.low), self.high)


class _Values(_Distribution):
    arguments: ClassVar[tuple[str, ...]] = ("values",)
    values: Annotated[tuple[Number, ...], Field(min_length=1)]
    """Numbers of which one is taken."""

    def draw(self, u: float) -> float:
        """Value at the quantile ``u``; that of a grid is used when no item number is known."""
        return self.values[weighted_index(getattr(self, "weights", None) or (1.0,) * len(self.values), u)]

    def _ends(self) -> Support:
        """Return the smallest and the largest value."""
        return min(self.values), max(self.values)


class Choice(_Values):
    """One of a few values, with weights if they are not equally likely.

    >>> Choice(kind="choice", values=(1, 2), weights=(1, 3)).draw(0.3)
    2.0
    """

    kind: Literal["choice"]
    """Draws one number of a list."""
    weights: tuple[Annotated[Number, Field(ge=0)], ...] | None = None
    """Relative probability of each value; equal if left out."""

    @model_validator(mode="after")
    def _weighted(self) -> Self:
        if self.weights is not None and (len(self.weights) != len(self.values) or sum(self.weights) <= 0):
            raise ValueError(f"{len(self.weights)} weights for {len(self.values)} values; give one each, not all 0.")
        return self


class Grid(_Values):
    """Values in turn, by item number; several grids of the same level enumerate all combinations."""

    kind: Literal["grid"]
    """Cycles through a list by the number of the rig, specimen or record."""


class Listed(_Distribution):
    """Values that are given one by one, for a key that is drawn for each of several items; a list is short for this."""

    arguments: ClassVar[tuple[str, ...]] = ("values",)
    kind: Literal["listed"]
    """Takes the numbers of a list."""
    values: Annotated[tuple[Number, ...], Field(max_length=1000)]
    """One number for each item."""

    @property
    def written(self) -> Any:
        """The list."""
        return list(self.values)

    def _ends(self) -> Support:
        """Return the smallest and the largest value."""
        return min(self.values, default=math.nan), max(self.values, default=math.nan)


DISTRIBUTIONS = (Constant, Uniform, LogUniform, Normal, Choice, Grid)
_TYPES = {*DISTRIBUTIONS, Listed}


def weighted_index(weights: tuple[float, ...], u: float) -> int:
    """Index drawn with ``weights`` at the quantile ``u``.

    >>> [weighted_index((1, 2, 1), u) for u in (0.0, 0.25, 0.74, 0.75)]
    [0, 1, 1, 2]
    """
    return min(bisect_right(_edges(weights), u), len(weights) - 1)


@functools.lru_cache(maxsize=256)
def _quantile(value: float) -> float:
    """Share of a standard normal distribution below a value."""
    from scipy.special import ndtr

    return ndtr(value)


@functools.lru_cache(maxsize=256)
def _edges(weights: tuple[float, ...]) -> list[float]:
    """Upper end of the quantiles of each index."""
    return (np.cumsum(weights) / np.sum(weights)).tolist()


KINDS = {kind: model for model in DISTRIBUTIONS for kind in get_args(model.model_fields["kind"].annotation)}
_TEXT = rf"^\s*(({'|'.join(KINDS)})\s*\(.*\)|[-+.0-9eE_]+)\s*(\*\s*[A-Za-z0-9_]+\s*)?$"


def _read(value: Any) -> Any:
    if is_distribution(value):
        return value
    if isinstance(value, int | float) and not isinstance(value, bool):
        return {"kind": "constant", "value": value}
    if isinstance(value, list | tuple):
        return {"kind": "listed", "values": cast("Any", value)}
    return read_expression(value, KINDS)


Distribution = Annotated[
    Annotated[Constant | Uniform | LogUniform | Normal | Choice | Grid | Listed, Field(discriminator="kind")],
    BeforeValidator(
        _read, json_schema_input_type=float | Annotated[str, StringConstraints(pattern=_TEXT)] | list[float]
    ),
]


def is_distribution(value: Any) -> bool:
    """Whether a value is a distribution of one of the ``KINDS``."""
    return type(value) in _TYPES


def within(
    low: float,
    high: float,
    *,
    open_low: bool = False,
    default: float | str | None = None,
    each: bool = False,
    whole: bool = False,
    **per: str,
) -> Any:
    """Field of a distribution whose values all lie between ``low`` and ``high``; required if it has no default.

    ``each`` is for a key that is drawn for each of the items that its section counts, ``whole`` for a count whose fixed numbers are whole,
    and ``per`` for a key that is drawn at another level than its section.
    """
    kinds = {name: True for name, chosen in (("each", each), ("whole", whole)) if chosen}
    bounds: dict[str, Any] = {"low": low, "high": high, "open_low": open_low} | kinds | per
    options: dict[str, Any] = {} if default is None else {"default": default}
    return Field(**options, json_schema_extra=bounds)


def interval(bounds: dict[str, Any]) -> str:
    """Bounds of a field in the notation of intervals.

    >>> interval({"low": 0, "high": 60, "open_low": True})
    '(0, 60]'
    """
    return f"{'(' if bounds['open_low'] else '['}{bounds['low']:g}, {bounds['high']:g}]"


def check_bounds(distribution: Any, bounds: dict[str, Any]) -> Any:
    """Return ``distribution`` if all its values lie within the ``bounds`` of its field, else raise ValueError.

    The values of a share are checked when the whole recipe is read.
    """
    if isinstance(distribution, Listed) and not bounds.get("each"):
        raise ValueError(f"is a list; give one number, or a distribution such as {_instead_of(distribution.values)}.")
    if distribution is None or distribution.share_of is not None or getattr(distribution, "values", True) == ():
        return distribution
    for end in distribution.support():
        if not is_within(end, bounds):
            raise ValueError(f"{end:g} is not in {interval(bounds)}.")
        if isinstance(distribution, Constant) and bounds.get("whole") and end % 1:
            raise ValueError(f"{end:g} is no whole number; give {math.floor(end)} or {math.ceil(end)}.")
    return distribution


def _instead_of(values: tuple[float, ...]) -> "Uniform | Choice":
    """Distribution that the writer of a list may have meant: a range if it has two ascending numbers, else a choice."""
    if len(values) == 2 and values[0] < values[1]:
        return Uniform(kind="uniform", low=values[0], high=values[1])
    return Choice(kind="choice", values=values if 0 < len(values) <= 6 else (1.0, 2.0))


def is_within(value: float, bounds: dict[str, Any], rounding: float = 0.0) -> bool:
    """True if a value lies within the bounds of a field, up to a relative error from ``rounding``."""
    low, high = bounds["low"], bounds["high"]
    if low <= value <= high and not (bounds["open_low"] and value == low):
        return True
    return rounding > 0 and any(is_within(value * factor, bounds) for factor in (1 - rounding, 1 + rounding))
