"""Plan of a corpus: counts, bytes, steps and time, without generating it.

Records are drawn and checked as :func:`gen.generate` draws and checks them, so that both refuse the same recipes. The time is measured
on a sample of the records, once per machine (:mod:`gen.generation.pace`).
"""

import time
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from gen.corpus import CODECS, FAULTS, SPLITS
from gen.generation.pace import measured_pace
from gen.generation.step_checks import checked_places
from gen.physics.kernel.compiling import LANES
from gen.recipe import Recipe, operations, read_recipe
from gen.scenarios import Scenario, draw_scenarios, settings_of
from gen.simulation.batches import Group, filled_lanes, group_of
from gen.simulation.outline import outlined_inputs
from gen.simulation.simulate import integrations
from gen.simulation.steps import steps_per_sample
from gen.simulation.timeline import timeline
from gen.support.errors import SimulationError

MOST_DRAWN = 5000  # records, about 2 s; from a larger corpus whole parts are drawn, spread evenly over it
MOST_DRAWN_DEAR = 1500  # with an axial load or a load that wanders: each takes 0.5 ms more per record

STORED_BYTES = {"adc": 2.0, "float32": 4.0}  # per sample
BYTES_PER_RECORD = 700  # labels and drawn values
START_S = 2.0  # CPU time: start of the process, libraries, kernels from the cache, index and data card
BYTES_PER_FILE = 80_000  # overhead of a part or of the index

Groups = dict[Group, list[int]]
"""Places in a part of the records of each group."""


@dataclass(frozen=True)
class Plan:
    """Counts, size and time of a corpus.

    ``classes``, ``splits`` and ``steps_per_sample`` count records; the last does not count the ``left_out`` records, which cannot be
    simulated. If fewer records were ``drawn`` than the corpus has, these counts are scaled up. ``estimated_seconds`` is for one process,
    from its start to the finished corpus, with compiled kernels; None if a kernel is not compiled on this machine, or if one batch of
    records takes too long for a sample.
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
    estimated_seconds: float | None
    drawn: int
    left_out: int
    first_left_out: str | None
    """The sentence about the first record that cannot be simulated."""


def plan(recipe: Path | str, *, seed: int | None = None, records: int | None = None) -> Plan:
    """Draw and check the records of a recipe, and time a sample of them.

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
    checked = read_recipe(recipe, seed=seed, records=records)
    start = time.perf_counter()
    parts = [draw_scenarios(checked, first, stop) for first, stop in some_ranges(checked)]
    n_drawn = sum(map(len, parts))
    drawing = (time.perf_counter() - start) / n_drawn
    failures: list[str] = []
    groups = [_groups(part, checked, failures) for part in parts]
    if len(failures) == n_drawn:
        raise SimulationError(failures[0])
    recording = checked.recording
    seconds = _seconds_per_record(list(zip(parts, groups, strict=True)), checked)
    return Plan(
        recipe=checked.name,
        title=checked.title,
        seed=checked.seed,
        rigs=checked.n_rigs,
        specimens=checked.n_specimens,
        records=checked.n_records,
        parts=checked.n_parts,
        sample_rate=recording.sample_rate_hz,
        duration=recording.duration_s,
        channels=tuple(channel.name for channel in recording.channels),
        kernels=len({group.shape for part in groups for group in part}),
        bytes=_bytes(checked),
        estimated_seconds=None if seconds is None else START_S + (seconds + drawing) * checked.n_records,
        drawn=n_drawn,
        left_out=round(len(failures) * checked.n_records / n_drawn),
        first_left_out=failures[0] if failures else None,
        **_counts(parts, groups, checked.n_records / n_drawn),
    )


def _counts(parts: list[list[Scenario]], groups: list[Groups], scale: float) -> dict[str, dict[Any, int]]:
    """Number of records by class, by split and by steps per sample, scaled up from those drawn."""
    specimens = [scenario.specimen for part in parts for scenario in part]
    steps: Counter[int] = Counter()
    for part in groups:
        for group, places in part.items():
            steps[group.steps] += len(places)

    def scaled(counts: Counter[Any], order: Iterable[Any]) -> dict[Any, int]:
        return {key: round(counts[key] * scale) for key in order if counts[key]}

    return {
        "classes": scaled(Counter(specimen.fault for specimen in specimens), FAULTS),
        "splits": scaled(Counter(specimen.split for specimen in specimens), SPLITS),
        "steps_per_sample": scaled(steps, sorted(steps)),
    }


def _seconds_per_record(parts: list[tuple[list[Scenario], Groups]], recipe: Recipe) -> float | None:
    """Time to simulate, measure and write a record, by a sample of the group with the most steps [s]; None if not measured."""
    candidates = (
        (group.steps * len(places), group, scenarios, places)
        for scenarios, groups in parts
        for group, places in groups.items()
    )
    _, group, scenarios, places = max(candidates, key=lambda candidate: candidate[0])
    pace = measured_pace([scenarios[place] for place in places[:LANES]], group, recipe.storage.codec)
    if pace is None:
        return None
    lane_steps = timeline(settings_of(recipe)).integrated * _lane_steps(parts, recipe)
    return lane_steps * pace.lane_step / sum(len(scenarios) for scenarios, _ in parts) + pace.record


def _lane_steps(parts: list[tuple[list[Scenario], Groups]], recipe: Recipe) -> int:
    """Integration steps per sample of all lanes, with the records whose step is checked at half the step; parts fill batches together."""
    needed: Counter[Group] = Counter()
    for scenarios, groups in parts:
        for group, places in groups.items():
            needed[group] += integrations([replace(scenarios[place], other=None) for place in places])
        of_place = {place: group for group, places in groups.items() for place in places}
        in_order = {place: of_place[place] for place in sorted(of_place)}
        for place in checked_places(scenarios, recipe, in_order):
            needed[in_order[place]._replace(steps=2 * in_order[place].steps)] += 1
        of_others = [of_other for scenario in scenarios if (of_other := scenario.of_other) is not None]
        for group, places in _groups(of_others, recipe, []).items():
            needed[group] += integrations([of_others[place] for place in places])
    return sum(group.steps * filled_lanes(count) for group, count in needed.items())


def some_ranges(recipe: Recipe) -> list[tuple[int, int]]:
    """Start and stop of the records that are drawn: all parts, or parts of ``most_drawn`` records together, spread over the corpus."""
    size, most = recipe.storage.records_per_part, most_drawn(recipe)
    parts = min(recipe.n_parts, max(1, most // size))
    firsts = [place * recipe.n_parts // parts * size for place in range(parts)]
    return [(first, min(first + min(size, most), recipe.n_records)) for first in firsts]


def most_drawn(recipe: Recipe) -> int:
    """Largest number of records that a plan draws."""
    dear = any(
        operation.axial_load_n.support()[1] > 0 or operation.load_wander_percent.support()[1] > 0
        for operation in operations(recipe).values()
    )
    return MOST_DRAWN_DEAR if dear else MOST_DRAWN


def _groups(scenarios: list[Scenario], recipe: Recipe, failures: list[str]) -> Groups:
    """Records of a part by group; the sentence of each record that cannot be simulated goes to ``failures``."""
    groups: Groups = defaultdict(list)
    inputs, impossible = outlined_inputs(scenarios, timeline(settings_of(recipe)))
    failures += impossible.values()
    for place, (given, scenario) in enumerate(zip(inputs, scenarios, strict=True)):
        if given is not None:
            groups[group_of(given, steps_per_sample(given, scenario.record, scenario.settings))].append(place)
    return groups


def _bytes(recipe: Recipe) -> int:
    """Estimated size of the corpus [B]."""
    samples = recipe.n_records * recipe.n_samples * len(recipe.recording.channels)
    of_signals = samples * STORED_BYTES[recipe.recording.converter.kind] * CODECS[recipe.storage.codec].share
    return round(of_signals + recipe.n_records * BYTES_PER_RECORD) + (recipe.n_parts + 1) * BYTES_PER_FILE
