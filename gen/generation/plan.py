"""Plan of a corpus: counts, size, steps and time, without generating it.

Records are drawn as :func:`gen.generate` draws them, some of them checked as it checks them, and a few made.
"""

import zlib
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gen.corpus import FAULTS, SPLITS
from gen.corpus.fault_classes import HEALTHY
from gen.generation.trial import try_some
from gen.recipe import Recipe, read_recipe
from gen.scenarios import Scenario, draw_scenarios, fault_of_each_specimen, scenario_texts, split_of
from gen.simulation.compiled_kernel import is_compiled
from gen.simulation.inputs import kernel_inputs
from gen.simulation.motion import draw_motion
from gen.simulation.steps import steps_per_sample
from gen.simulation.truth import width_share
from gen.support.errors import SimulationError

MOST_DRAWN = 2000  # records, about 0.6 s; from a larger corpus whole parts are drawn, spread evenly over it
MOST_OF_LIVES = 30_000  # records, about 6 s; a few lives tell neither classes nor splits of all
MOST_CHECKED = 64  # of the drawn records; one of some seconds with a changing speed takes 10 ms
AT_ONCE = 8  # records: a schedule of a minute takes 10 MB

STORED_BYTES = {"adc": 2.0, "float32": 4.0}  # per sample
BYTES_PER_RECORD = 760  # labels, in a part and in the index
SCENARIOS = 256  # whose stored text is compressed to estimate its size
BYTES_PER_FILE = 115_000  # overhead of a part or of the index


@dataclass(frozen=True)
class Plan:
    """Counts and size of a corpus.

    ``classes``, ``splits`` and ``steps_per_sample`` count records; the last does not count the ``left_out`` records, which cannot be
    simulated. If fewer records were ``drawn`` than the corpus has, wide spalls and the classes of lives are scaled up; if fewer were
    ``checked``, steps and records left out are. A record whose fault cannot be seen may be left out too, which only :func:`gen.generate`
    counts.
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
    compiled: bool
    """Whether this machine has the kernel already."""
    drawn: int
    checked: int
    left_out: int
    left_out_example: str | None
    """The sentence about one record that is left out."""
    wide_spalls: int
    """Number of records with a spall that is wider than from ball to ball."""
    first_wide_spall: str | None
    """A sentence about the first of them."""
    bytes: int
    """Size by a few records; if none were made, because they are long or the kernel is not compiled, without compression."""
    seconds: float | None
    """CPU time of all records on this machine, by the same records [s]."""
    seen: dict[str, tuple[int, int]]
    """Number of these records whose fault can be seen, and of all that were judged, by class."""
    clipping: str | None
    """A sentence with the number of these records that have a clipped sample."""


def plan(recipe: Path | str | Recipe, *, seed: int | None = None, records: int | None = None) -> Plan:
    """Draw records of a recipe, and check some of them.

    Parameters
    ----------
    recipe : path, str or Recipe
        Recipe file, or name of a recipe that ships with Raceway.
    seed, records : int, optional
        Replace the seed and the number of records of the recipe.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe cannot be simulated, or none of its records can.
    """
    whole = read_recipe(recipe, seed=seed, records=records)
    if whole.background.recording is not None:
        whole.background.recording.cut(whole)
    # parts of the corpus stand for the whole of a large one
    ranges = some_ranges(whole)
    drawn = [scenario for first, stop in ranges for scenario in draw_scenarios(whole, first, stop)]
    present = len(drawn) / sum(stop - first for first, stop in ranges)  # lives that have ended have no more records
    count = round(whole.n_records * present)
    # by chance, since evenly spaced records might meet the same cell of every grid
    places = sorted(np.random.default_rng(0).permutation(len(drawn))[:MOST_CHECKED].tolist())
    outcomes = list(steps_of([drawn[place] for place in places]))
    # a record that cannot be simulated has a sentence in place of its steps
    steps = [outcome for outcome in outcomes if isinstance(outcome, int)]
    failures = [outcome for outcome in outcomes if isinstance(outcome, str)]
    if not steps:
        raise SimulationError(failures[0])
    recording, trial = whole.recording, try_some(whole)
    wide = [sentence for sentence in map(_wide_spall, drawn) if sentence]
    # counts of what was drawn become counts of the corpus
    of_drawn, of_checked = count / len(drawn), count / len(places)
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
        compiled=is_compiled(),
        bytes=_bytes(whole, count, drawn[:SCENARIOS], trial and trial.bytes),
        seconds=trial and trial.seconds * count,
        seen=trial.seen if trial else {},
        clipping=trial and trial.clipping,
        drawn=len(drawn),
        checked=len(places),
        left_out=round(len(failures) * of_checked),
        left_out_example=next(iter(failures), trial and trial.failure),
        wide_spalls=round(len(wide) * of_drawn),
        first_wide_spall=next(iter(wide), None),
        classes=_classes(whole, drawn, count),
        splits=_splits(whole, drawn, count),
        steps_per_sample=_scaled(steps, sorted(set(steps)), of_checked),
    )


def steps_of(scenarios: Sequence[Scenario]) -> Iterator[int | str]:
    """Steps per sample of each record, or a sentence where no machine is possible.

    Raises
    ------
    SimulationError
        If a record needs more steps than the recipe has.
    """
    for first in range(0, len(scenarios), AT_ONCE):
        some = scenarios[first : first + AT_ONCE]
        inputs = kernel_inputs([draw_motion(scenario) for scenario in some])
        for kernel_input, scenario in zip(inputs, some, strict=True):
            yield (
                str(kernel_input)
                if isinstance(kernel_input, SimulationError)
                else steps_per_sample(kernel_input, scenario)
            )


def _classes(recipe: Recipe, drawn: Sequence[Scenario], count: int) -> dict[str, int]:
    """Number of records of each class; the specimens of a large corpus are counted, since its parts may hold few of them."""
    if len(drawn) == count or recipe.life is not None:
        return _scaled((scenario.fault for scenario in drawn), FAULTS, count / len(drawn))
    corpus = recipe.corpus
    faults = [fault for rig in range(corpus.rigs) for fault in fault_of_each_specimen(recipe, rig)][
        : recipe.n_specimens
    ]
    rungs = corpus.rungs or (1.0,)
    records = (fault if rung else HEALTHY for fault in faults for rung in rungs)
    return _scaled(records, FAULTS, count / (len(faults) * len(rungs)))


def _splits(recipe: Recipe, drawn: Sequence[Scenario], count: int) -> dict[str, int]:
    """Number of records of each split; the specimens of a large corpus are counted, since a few rigs may all be in one split."""
    if len(drawn) == count:
        return _scaled((scenario.origin.split for scenario in drawn), SPLITS, 1.0)
    specimens = range(recipe.n_specimens)
    return _scaled((split_of(recipe, specimen) for specimen in specimens), SPLITS, count / len(specimens))


def _scaled(values: Iterable[Any], order: Iterable[Any], scale: float) -> dict[Any, int]:
    """Number of records of each value in the whole corpus."""
    counts = Counter(values)
    return {value: round(counts[value] * scale) for value in order if counts[value]}


def some_ranges(recipe: Recipe) -> list[tuple[int, int]]:
    """Start and stop of the records that are drawn: all parts, or parts of so many records together, spread over the corpus."""
    most, size = MOST_DRAWN if recipe.life is None else MOST_OF_LIVES, recipe.storage.records_per_part
    parts = min(recipe.n_parts, max(1, most // size))
    firsts = [place * recipe.n_parts // parts * size for place in range(parts)]
    return [(first, min(first + min(size, most), recipe.n_records)) for first in firsts]


def _wide_spall(scenario: Scenario) -> str | None:
    """Sentence about a spall under two balls at once."""
    for spall in scenario.spalls:
        if (share := width_share(scenario, spall)) > 1:
            return (
                f"record {scenario.origin.record}: {1e3 * spall.width:.3g} mm on the {spall.site} race, where neighbouring balls are "
                f"{1e3 * spall.width / share:.3g} mm apart."
            )
    return None


def _bytes(recipe: Recipe, records: int, some: Sequence[Scenario], of_signals: float | None) -> int:
    """Estimated size of the corpus [B]; the text of each scenario is in its part and in the index."""
    of_text = 2 * len(zlib.compress("".join(scenario_texts(some)).encode(), 1)) / len(some)
    if of_signals is None:
        of_signals = recipe.n_samples * len(recipe.recording.channels) * STORED_BYTES[recipe.recording.converter.kind]
    return round(records * (of_signals + BYTES_PER_RECORD + of_text)) + (recipe.n_parts + 1) * BYTES_PER_FILE
