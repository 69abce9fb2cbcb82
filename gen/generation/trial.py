"""Some records of a recipe, made to tell time and size of all of them, and whether their faults can be seen."""

import time
from collections import Counter
from typing import NamedTuple

import numpy as np

from gen.corpus import FAULTS
from gen.corpus.codecs import stored_size
from gen.corpus.unusable import clipping_complaint
from gen.generation.undetected import Made, made_from, make_records
from gen.measurement.measure import Measured
from gen.recipe import Recipe
from gen.scenarios import draw_scenarios
from gen.simulation.compiled_kernel import is_compiled
from gen.support.errors import SimulationError

RANGES, AT_ONCE = 4, 16  # ranges of records, and records of each: fewer do not fill the lanes of the kernel
LONGEST = 2.0  # s, of a record


class Trial(NamedTuple):
    """What some records tell of all of them."""

    seconds: float
    """CPU time of a record on this machine [s]."""
    bytes: float
    """Stored size of the signals of a record [B]."""
    seen: dict[str, tuple[int, int]]
    """Number of records whose fault can be seen, and of all that were judged, by class; not of lives, whose first records are made."""
    failure: str | None
    """The sentence about the first record that is left out."""
    clipping: str | None
    """A sentence with the number of records with a clipped sample."""


def try_some(recipe: Recipe) -> Trial | None:
    """Make records spread evenly over a corpus, because machines and speeds take different times and sizes.

    None if the kernel is not compiled yet, or if so many records would take long.

    Raises
    ------
    SimulationError
        If none of the records can be made.
    """
    if not is_compiled() or recipe.recording.duration_s > LONGEST:
        return None
    of_a_specimen = recipe.corpus.records_of_a_specimen
    # records that are made together are tried together, and the first ones of a life are there in any case
    together = of_a_specimen if recipe.truth.undetected == "redraw" else recipe.corpus.n_rungs
    count = -(-AT_ONCE // together) * together
    step = count if recipe.life is None else of_a_specimen
    firsts = {round(part * max(recipe.n_records // step - 1, 0)) * step for part in np.linspace(0, 1, RANGES)}
    _make(recipe, 0, 1)  # loads the kernel
    began = time.process_time()
    outcomes = [record for first in sorted(firsts) for record in _make(recipe, first, count)]
    seconds = (time.process_time() - began) / len(outcomes)
    records = [record for record in outcomes if isinstance(record, Measured)]
    failure = next((record for record in outcomes if isinstance(record, str)), None)
    if not records:
        raise SimulationError(failure)
    judged = Counter((record.scenario.fault, record.detectable) for record in records if recipe.life is None)
    seen = {fault: (judged[fault, 1], judged[fault, 1] + judged[fault, 0]) for fault in FAULTS if fault != "healthy"}
    clipping = clipping_complaint(sum(record.clipped > 0 for record in records), len(records))
    size = stored_size(np.stack([record.signal for record in records]), recipe.storage.codec)
    return Trial(seconds, size / len(records), {fault: of for fault, of in seen.items() if of[1]}, failure, clipping)


def _make(recipe: Recipe, first: int, count: int) -> list[Made]:
    """Some records, of a life without the rest of it."""
    if recipe.life is None and recipe.origin is None:
        return make_records(recipe, range(first, min(first + count, recipe.n_records)))
    return made_from(draw_scenarios(recipe, first, first + count))
