"""Bearing given as one text: a designation of the catalogue, or a geometry such as ``n_balls=8,pitch_diameter_mm=33.5,...``."""

import difflib
from typing import Any

from pydantic import ValidationError

from gen.importers.mapping_values import Geometry, bearing_of
from gen.physics.bearing import Bearing, Orders, orders
from gen.physics.catalogue import CATALOGUE, known_designation
from gen.support.errors import CorpusError
from gen.support.sentences import sentences


def bearing_orders(text: str) -> Orders:
    """Nominal fault orders of a bearing, given as for `bearing_from_text`.

    >>> [round(order, 4) for order in bearing_orders("6205")]
    [0.3983, 3.5848, 5.4152, 2.3567]
    """
    return orders(bearing_from_text(text))


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
    example = "n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=7.938"
    if "=" not in text:
        near = difflib.get_close_matches(text, CATALOGUE, 1)
        guess = f"did you mean {near[0]}?" if near else f"the catalogue has {', '.join(CATALOGUE)}."
        raise CorpusError(f"bearing {text!r} is not in the catalogue; give its geometry, such as {example}, or {guess}")
    values: dict[str, Any] = {}
    for part in text.split(","):
        key, _, value = (piece.strip() for piece in part.partition("="))
        if key in values:
            raise CorpusError(f"bearing: {key} is given twice; write it like {example}.")
        try:
            values[key] = value if key == "designation" else float(value)
        except ValueError:
            raise CorpusError(
                f"bearing: {part.strip()!r} is not of the form key=number; write it like {example}."
            ) from None
    try:
        return bearing_of(Geometry.model_validate(values))
    except ValidationError as error:
        raise CorpusError(f"bearing: {' '.join(sentences(error, Geometry))} Write it like {example}.") from None
