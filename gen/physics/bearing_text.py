"""Bearing given as one text: a designation of the catalogue, or a geometry such as ``n_balls=8,pitch_diameter_mm=33.5,...``."""

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
from gen.support.units import to_si

_EXAMPLE = "n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=7.938"


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


def bearing_orders(bearing: str | Mapping[str, Any]) -> FaultOrders:
    """Nominal fault orders of a bearing, given as for `bearing_from_text` or by a dict of its dimensions.

    >>> [round(order, 4) for order in bearing_orders("6205")]
    [0.3983, 3.5848, 5.4152, 2.3567]
    >>> round(bearing_orders({"n_balls": 8, "pitch_diameter_mm": 33.5, "ball_diameter_mm": 7.938}).bpfo, 4)
    3.0522
    """
    return orders(bearing_from_text(bearing) if isinstance(bearing, str) else _of_geometry(bearing))


def bearing_from_text(text: str) -> Bearing:
    """Bearing with a designation of the catalogue, or with the keys of a geometry, separated by commas.

    The length of rollers is taken, because records need it; the orders do not depend on it.

    >>> bearing_from_text("n_rollers=8,pitch_diameter_mm=33.5,roller_diameter_mm=7.938,roller_length_mm=9").n_balls
    8

    Raises
    ------
    CorpusError
        If the text is neither.
    """
    known = known_designation(text)
    if known is not None:
        return CATALOGUE[known]
    if "=" not in text:
        near = difflib.get_close_matches(text, CATALOGUE, 1)
        guess = f"did you mean {near[0]}?" if near else f"the catalogue has {', '.join(CATALOGUE)}."
        raise CorpusError(
            f"bearing {text!r} is not in the catalogue; give its geometry, such as {_EXAMPLE}, or {guess}"
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
    return _of_geometry(values)


def bearing_of_label(given: Any) -> Bearing:
    """Bearing of a text or a dict of dimensions; ValueError if it is neither."""
    try:
        return _of_geometry(given) if isinstance(given, Mapping) else bearing_from_text(str(given))
    except CorpusError as error:
        raise ValueError(str(error)) from None


def _of_geometry(values: Mapping[str, Any]) -> Bearing:
    try:
        given = Geometry.model_validate(values)
    except ValidationError as error:
        raise CorpusError(f"bearing: {' '.join(sentences(error, Geometry))} Write it like {_EXAMPLE}.") from None
    return Bearing(
        given.designation,
        given.n_balls,
        to_si(given.pitch_diameter_mm, "mm"),
        to_si(given.ball_diameter_mm, "mm"),
        to_si(given.contact_angle_deg, "deg"),
        rolling_element="roller" if any("roller" in key for key in values) else "ball",
    )
