"""What a recipe would make, without making it: counts, bytes, steps and a rough time.

Records are drawn and checked as :func:`gen.generate` would, so that what it refuses is refused here; nothing is simulated or written.
"""

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gen.corpus import FAULTS, SPLITS
from gen.errors import SimulationError
from gen.recipe import Recipe, read_recipe
from gen.scenarios import Scenario, draw_scenarios
from gen.simulation.batches import Group, filled_lanes, group_of
from gen.simulation.outline import outlined_input
from gen.simulation.steps import steps_per_sample
from gen.simulation.timeline import timeline

MOST_DRAWN = 5000  # records, about 2 s; of a larger corpus as many parts, spread over it
MOST_DRAWN_DEAR = 1500  # the same with an axial load or a load that wanders, which take another 0.5 ms a record each

# Rough, so that a plan costs nothing: what raceway bench gave on one core of a shared machine with AVX-512
LANE_STEPS_PER_SECOND = 18e6  # integration, lanes that pad a batch included
SECONDS_PER_SAMPLE = 1e-7  # path, background, converter, compression, per channel
COMPILE_SECONDS = 9.0  # per kernel

STORED_BYTES = {"adc": 2.0, "float32": 4.0}  # per sample
COMPRESSED = {"zlib": 0.67, "zstd": 0.75, "none": 1.0}  # of vibration that uses a part of the converter's range
BYTES_PER_RECORD, BYTES_PER_FILE = 700, 80_000  # labels and drawn values; what a part or the index takes for itself


@dataclass(frozen=True)
class Plan:
    """What a recipe would make.

    ``classes``, ``splits`` and ``steps_per_sample`` count records; the last leaves out the ``left_out`` records, which cannot be simulated.
    If the ``drawn`` records are not all, these and the estimates are scaled up from them. ``estimated_seconds`` is for one worker;
    ``compile_seconds`` come on top the first time on a machine.
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
    bytes: int
    estimated_seconds: float
    compile_seconds: float
    drawn: int
    left_out: int
    first_left_out: str | None
    """Why the first of them cannot be simulated."""


def plan(recipe: Path | str, *, seed: int | None = None, records: int | None = None) -> Plan:
    """Draw and check what a recipe would make.

    Parameters
    ----------
    recipe : path or str
        Recipe file, or name of a recipe that ships with Raceway.
    seed, records : int, optional
        Take the place of the recipe's own.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe asks for what cannot be, or none of its records can be simulated.
    """
    checked = read_recipe(recipe, seed=seed, records=records)
    parts = [draw_scenarios(checked, first, stop) for first, stop in some_ranges(checked)]
    failures: list[str] = []
    groups = [_groups(part, checked, failures) for part in parts]
    drawn = [scenario.specimen for part in parts for scenario in part]
    if len(failures) == len(drawn):
        raise SimulationError(failures[0])
    scale = checked.n_records / len(drawn)

    def scaled(counts: Counter[Any], order: Iterable[Any]) -> dict[Any, int]:
        return {key: round(counts[key] * scale) for key in order if counts[key]}

    factors: Counter[int] = Counter()
    for group, count in (item for part in groups for item in part.items()):
        factors[group.steps] += count
    lanes = sum(group.steps * filled_lanes(count) for part in groups for group, count in part.items())
    kernels = {group.shape for part in groups for group in part}
    recording = checked.recording
    samples = checked.n_records * checked.n_samples * len(recording.channels)
    specimens = math.ceil(checked.n_records / checked.corpus.records_per_specimen)
    return Plan(
        recipe=checked.name,
        title=checked.title,
        seed=checked.seed,
        rigs=math.ceil(specimens / checked.corpus.specimens_per_rig),
        specimens=specimens,
        records=checked.n_records,
        parts=checked.n_parts,
        sample_rate=recording.sample_rate_hz,
        duration=recording.duration_s,
        channels=tuple(channel.name for channel in recording.channels),
        classes=scaled(Counter(specimen.fault for specimen in drawn), FAULTS),
        splits=scaled(Counter(specimen.split for specimen in drawn), SPLITS),
        steps_per_sample=scaled(factors, sorted(factors)),
        kernels=len(kernels),
        bytes=round(samples * _bytes_per_sample(checked) + checked.n_records * BYTES_PER_RECORD)
        + (checked.n_parts + 1) * BYTES_PER_FILE,
        estimated_seconds=lanes * scale * timeline(checked).integrated / LANE_STEPS_PER_SECOND
        + samples * SECONDS_PER_SAMPLE,
        compile_seconds=len(kernels) * COMPILE_SECONDS,
        drawn=len(drawn),
        left_out=round(len(failures) * scale),
        first_left_out=failures[0] if failures else None,
    )


def some_ranges(recipe: Recipe) -> list[tuple[int, int]]:
    """First and last but one record of every part, or of as many parts as ``most_drawn`` records make, spread over the corpus."""
    size, most = recipe.corpus.records_per_part, most_drawn(recipe)
    parts = min(recipe.n_parts, max(1, most // size))
    firsts = [place * recipe.n_parts // parts * size for place in range(parts)]
    return [(first, min(first + min(size, most), recipe.n_records)) for first in firsts]


def most_drawn(recipe: Recipe) -> int:
    """Number of records that a plan draws at most."""
    operation = recipe.operation
    dear = operation.axial_load_n.support()[1] > 0 or operation.load_wander_percent.support()[1] > 0
    return MOST_DRAWN_DEAR if dear else MOST_DRAWN


def _groups(scenarios: list[Scenario], recipe: Recipe, failures: list[str]) -> Counter[Group]:
    """Number of records of a part in each group; ``failures`` receives a sentence for each record that is left out."""
    groups: Counter[Group] = Counter()
    for scenario in scenarios:
        try:
            given = outlined_input(scenario, timeline(recipe))
        except SimulationError as error:
            failures.append(str(error))
            continue
        groups[group_of(given, steps_per_sample(given, scenario.record.number, recipe))] += 1
    return groups


def _bytes_per_sample(recipe: Recipe) -> float:
    return STORED_BYTES[recipe.recording.converter.kind] * COMPRESSED[recipe.corpus.codec]
