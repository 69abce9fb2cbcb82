"""Plan of a corpus: counts, bytes, steps and time, without generating it.

Records are drawn as :func:`gen.generate` draws them, and some of them checked as it checks them. The time is a forecast
(:mod:`gen.generation.forecast`).
"""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gen.corpus import CODECS, FAULTS, SPLITS
from gen.generation.compilation import needed_shapes
from gen.generation.forecast import START_S, groups_of, seconds_of, some_of, work_of
from gen.recipe import Recipe, read_recipe
from gen.scenarios import draw_scenarios
from gen.simulation.batches import Group
from gen.simulation.kernels import is_compiled
from gen.support.errors import SimulationError

MOST_DRAWN = 5000  # records, about 2 s; from a larger corpus whole parts are drawn, spread evenly over it
MOST_CHECKED = 240  # of the drawn records; one of some seconds with a changing speed takes 10 ms

STORED_BYTES = {"adc": 2.0, "float32": 4.0}  # per sample
BYTES_PER_RECORD = 700  # labels and drawn values
BYTES_PER_FILE = 80_000  # overhead of a part or of the index


@dataclass(frozen=True)
class Plan:
    """Counts, size and time of a corpus.

    ``classes``, ``splits`` and ``steps_per_sample`` count records; the last does not count the ``left_out`` records, which cannot be
    simulated. If fewer records were ``drawn`` than the corpus has, classes and splits are scaled up; if fewer were ``checked``, steps and
    records left out are. ``estimated_seconds`` is for one process, from its start to the finished corpus, with compiled kernels.
    """

    recipe: str
    title: str
    seed: int
    rigs: int
    specimens: int
    records: int
    parts: int
    sample_rate: float
    duration: float
    channels: tuple[str, ...]
    classes: dict[str, int]
    splits: dict[str, int]
    steps_per_sample: dict[int, int]
    kernels: int
    uncompiled: int
    """Kernels that are not compiled on this machine."""
    bytes: int
    estimated_seconds: float
    drawn: int
    checked: int
    left_out: int
    first_left_out: str | None
    """The sentence about the first record that cannot be simulated."""


def plan(recipe: Path | str, *, seed: int | None = None, records: int | None = None) -> Plan:
    """Draw records of a recipe, and check some of them.

    Parameters
    ----------
    recipe : path or str
        Recipe file, or name of a recipe that ships with Raceway.
    seed, records : int, optional
        Replace the seed and the number of records of the recipe.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe cannot be simulated, or none of its records can.
    """
    whole = read_recipe(recipe, seed=seed, records=records)
    ranges = some_ranges(whole)
    drawn = [scenario for first, stop in ranges for scenario in draw_scenarios(whole, first, stop)]
    present = len(drawn) / sum(stop - first for first, stop in ranges)  # lives that have ended have no more records
    count = round(whole.n_records * present)
    checked = [drawn[place] for place in some_of(len(drawn), MOST_CHECKED)]
    groups, failures = list[Group](), list[str]()
    for found in groups_of(checked, whole):
        failures.append(found) if isinstance(found, str) else groups.append(found)
    if not groups:
        raise SimulationError(failures[0])
    recording, needed = whole.recording, needed_shapes(whole)
    of_drawn, of_checked = count / len(drawn), count / len(checked)
    steps = [group.steps for group in groups]
    return Plan(
        recipe=whole.name,
        title=whole.title,
        seed=whole.seed,
        rigs=whole.n_rigs,
        specimens=whole.n_specimens,
        records=count,
        parts=whole.n_parts,
        sample_rate=recording.sample_rate_hz,
        duration=recording.duration_s,
        channels=tuple(channel.name for channel in recording.channels),
        kernels=len(needed),
        uncompiled=sum(not is_compiled(shape) for shape in needed),
        bytes=_bytes(whole, count),
        estimated_seconds=START_S + seconds_of(present * work_of(whole, groups)),
        drawn=len(drawn),
        checked=len(checked),
        left_out=round(len(failures) * of_checked),
        first_left_out=failures[0] if failures else None,
        classes=_scaled((one.specimen.fault for one in drawn), FAULTS, of_drawn),
        splits=_scaled((one.specimen.split for one in drawn), SPLITS, of_drawn),
        steps_per_sample=_scaled(steps, sorted(set(steps)), of_checked),
    )


def _scaled(values: Iterable[Any], order: Iterable[Any], scale: float) -> dict[Any, int]:
    """Number of records of each value in the whole corpus."""
    counts = Counter(values)
    return {value: round(counts[value] * scale) for value in order if counts[value]}


def some_ranges(recipe: Recipe) -> list[tuple[int, int]]:
    """Start and stop of the records that are drawn: all parts, or parts of ``MOST_DRAWN`` records together, spread over the corpus."""
    size = recipe.storage.records_per_part
    parts = min(recipe.n_parts, max(1, MOST_DRAWN // size))
    firsts = [place * recipe.n_parts // parts * size for place in range(parts)]
    return [(first, min(first + min(size, MOST_DRAWN), recipe.n_records)) for first in firsts]


def _bytes(recipe: Recipe, records: int) -> int:
    """Estimated size of the corpus [B]."""
    samples = records * recipe.n_samples * len(recipe.recording.channels)
    of_signals = samples * STORED_BYTES[recipe.recording.converter.kind] * CODECS[recipe.storage.codec].share
    return round(of_signals + records * BYTES_PER_RECORD) + (recipe.n_parts + 1) * BYTES_PER_FILE
