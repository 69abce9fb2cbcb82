"""Bearing given as one text: a designation of the catalogue, its dimensions, or the fault orders that its maker prints."""

import difflib
import math
from collections.abc import Mapping
from typing import Annotated, Any, Self

from pydantic import AliasChoices, Field, ValidationError, model_validator

from gen.physics.bearing import Bearing, FaultOrders, orders
from gen.physics.catalogue import CATALOGUE, known_designation
from gen.support.errors import CorpusError
from gen.support.key_types import Keys, Millimetres, Name
from gen.support.sentences import sentences
from gen.support.units import from_si, to_si

_EXAMPLE = "n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=7.938"
_ORDERS = "bpfo=3.585,bpfi=5.415,bsf=2.357,ftf=0.398"
_ROUNDING = 0.02  # of orders that are printed with two decimals, and their share of a geometry's orders


class Geometry(Keys):
    """A bearing that is not in the catalogue."""

    designation: Name = "own"
    n_balls: Annotated[int, Field(ge=3, le=1000, validation_alias=AliasChoices("n_balls", "n_rollers"))]
    pitch_diameter_mm: Annotated[Millimetres, Field(ge=1)]
    ball_diameter_mm: Annotated[
        Millimetres, Field(ge=0.01, validation_alias=AliasChoices("ball_diameter_mm", "roller_diameter_mm"))
    ]
    contact_angle_deg: Annotated[float, Field(ge=0, lt=90)] = 0.0
    roller_length_mm: Millimetres | None = None

    @model_validator(mode="after")
    def _balls_fit(self) -> Self:
        if self.ball_diameter_mm >= self.pitch_diameter_mm * math.sin(math.pi / self.n_balls):
            raise ValueError(f"{self.n_balls} balls of {self.ball_diameter_mm:g} mm do not fit on the pitch circle.")
        return self


class PrintedOrders(Keys):
    """Fault orders of a bearing, as its maker prints them."""

    designation: Name = "own"
    bpfo: Annotated[float, Field(gt=0, le=1000)]
    bpfi: Annotated[float, Field(gt=0, le=1000)]
    bsf: Annotated[float, Field(gt=0, le=1000)]
    ftf: Annotated[float, Field(gt=0, lt=0.5)]

    @model_validator(mode="after")
    def _agree(self) -> Self:
        """With a fixed outer ring, BPFO + BPFI is the number of balls, BPFO is FTF times it, and BSF follows from a cosine below 1."""
        n_balls = round(self.bpfo + self.bpfi)
        if n_balls < 3 or abs(self.bpfo + self.bpfi - n_balls) > _ROUNDING:
            raise ValueError(f"bpfo and bpfi add up to {self.bpfo + self.bpfi:g}, which is no number of balls.")
        if abs(self.ftf * n_balls - self.bpfo) > _ROUNDING * self.bpfo:
            raise ValueError(
                f"ftf is not bpfo over {n_balls} balls, {self.bpfo / n_balls:.4g}; the outer ring is fixed."
            )
        gamma = 1 - 2 * self.bpfo / n_balls
        if (1 - gamma**2) / (2 * self.bsf) < gamma * (1 - _ROUNDING):
            raise ValueError(f"bsf is too high; if it is the line of a ball fault, 2 BSF, give {self.bsf / 2:g}.")
        return self


def bearing_orders(bearing: str | Mapping[str, Any]) -> FaultOrders:
    """Nominal fault orders of a bearing: its designation, or its dimensions or orders as a text or a dict.

    Raises
    ------
    CorpusError
        If the designation is not in the catalogue, or a dimension or order is missing or wrong.

    >>> [round(order, 4) for order in bearing_orders("6205")]
    [0.3983, 3.5848, 5.4152, 2.3567]
    >>> round(bearing_orders({"n_balls": 8, "pitch_diameter_mm": 33.5, "ball_diameter_mm": 7.938}).bpfo, 4)
    3.0522
    """
    return orders(bearing_from_text(bearing) if isinstance(bearing, str) else _of_values(bearing))


def bearing_from_text(text: str) -> Bearing:
    """Bearing with a designation of the catalogue, or with the keys of a geometry or of fault orders, separated by commas.

    The length of rollers is taken, because records need it; the orders do not depend on it.

    >>> bearing_from_text("n_rollers=8,pitch_diameter_mm=33.5,roller_diameter_mm=7.938,roller_length_mm=9").n_balls
    8
    >>> bearing_from_text("bpfo=3.585,bpfi=5.415,bsf=2.357,ftf=0.398").n_balls
    9

    Raises
    ------
    CorpusError
        If the text is none of them.
    """
    designation = known_designation(text)
    if designation is not None:
        return CATALOGUE[designation]
    if "=" not in text:
        near = difflib.get_close_matches(text, CATALOGUE, 1)
        guess = f"did you mean {near[0]}?" if near else f"the catalogue has {', '.join(CATALOGUE)}."
        raise CorpusError(
            f"bearing {text!r} is not in the catalogue; give its geometry, such as {_EXAMPLE}, or, if nothing is simulated or drawn, the "
            f"orders that its maker prints, such as {_ORDERS}; or {guess}"
        )
    values: dict[str, Any] = {}
    for part in text.split(","):
        key, _, value = (piece.strip() for piece in part.partition("="))
        if key in values:
            raise CorpusError(f"bearing: {key} is given twice; write it like {_EXAMPLE}.")
        try:
            values[key] = value if key == "designation" else float(value)
        except ValueError:
            raise CorpusError(
                f"bearing: {part.strip()!r} is not of the form key=number; write it like {_EXAMPLE}."
            ) from None
    return _of_values(values)


def bearing_of_label(label: Any) -> Bearing:
    """Bearing of a text, or of a dict of dimensions or orders; ValueError if it is none of them."""
    try:
        return _of_values(label) if isinstance(label, Mapping) else bearing_from_text(str(label))
    except CorpusError as error:
        raise ValueError(str(error)) from None


def geometry_text(bearing: Bearing) -> str:
    """Dimensions of a bearing, or its orders, for people.

    >>> geometry_text(bearing_from_text("6205"))
    '9 balls of 7.94 mm on 39.04 mm'
    """
    if bearing.printed_orders is not None:
        return f"{bearing.n_balls} balls or rollers, BPFO {bearing.printed_orders.bpfo:g} as printed"
    ball, pitch = (from_si(length, "mm") for length in (bearing.ball_diameter, bearing.pitch_diameter))
    angle = f" at {from_si(bearing.contact_angle, 'deg'):g} deg" if bearing.contact_angle else ""
    return f"{bearing.n_balls} {bearing.rolling_element}s of {ball:.4g} mm on {pitch:.4g} mm{angle}"


def _of_values(values: Mapping[str, Any]) -> Bearing:
    """Bearing of dimensions, or of orders if there is one among the keys."""
    model, example = (PrintedOrders, _ORDERS) if {*FaultOrders._fields} & {*values} else (Geometry, _EXAMPLE)
    try:
        checked = model.model_validate(values)
    except ValidationError as error:
        raise CorpusError(f"bearing: {' '.join(sentences(error, model))} Write it like {example}.") from None
    if isinstance(checked, PrintedOrders):
        printed = FaultOrders(checked.ftf, checked.bpfo, checked.bpfi, checked.bsf)
        n_balls = round(checked.bpfo + checked.bpfi)
        return Bearing(checked.designation, n_balls, math.nan, math.nan, printed_orders=printed)
    return Bearing(
        checked.designation,
        checked.n_balls,
        to_si(checked.pitch_diameter_mm, "mm"),
        to_si(checked.ball_diameter_mm, "mm"),
        to_si(checked.contact_angle_deg, "deg"),
        rolling_element="roller" if any("roller" in key for key in values) else "ball",
    )
