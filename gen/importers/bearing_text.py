"""Bearing given as one text: a designation of the catalogue, or a geometry such as ``n_balls=8,pitch_diameter_mm=33.5,...``."""

import difflib
from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from gen.importers.mapping_values import Geometry, bearing_of
from gen.physics.bearing import Bearing, FaultOrders, orders
from gen.physics.catalogue import CATALOGUE, known_designation
from gen.support.errors import CorpusError
from gen.support.sentences import sentences

_EXAMPLE = "n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=7.938"


def bearing_orders(bearing: str | Mapping[str, Any]) -> FaultOrders:
    """Nominal fault orders of a bearing, given as for `bearing_from_text` or by a dict of its dimensions.

    >>> [round(order, 4) for order in bearing_orders("6205")]
    [0.3983, 3.5848, 5.4152, 2.3567]
    >>> round(bearing_orders({"n_balls": 8, "pitch_diameter_mm": 33.5, "ball_diameter_mm": 7.938}).bpfo, 4)
    3.0522
    """
    return orders(bearing_from_text(bearing) if isinstance(bearing, str) else _of_geometry(bearing))


def bearing_from_text(text: str) -> Bearing:
    """Bearing with a designation of the catalogue, or with the keys of a mapping file, separated by commas.

    >>> bearing_from_text("n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=7.938").n_balls
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


def _of_geometry(values: Mapping[str, Any]) -> Bearing:
    try:
        return bearing_of(Geometry.model_validate(values))
    except ValidationError as error:
        raise CorpusError(f"bearing: {' '.join(sentences(error, Geometry))} Write it like {_EXAMPLE}.") from None
