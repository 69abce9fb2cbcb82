"""From the motion of the bodies to the samples that a data-acquisition card stores.

signal -> transfer path -> background of the machine -> level -> faults of the measuring chain -> converter; then the fault is judged.
Healthy and faulty records are measured alike: path and background belong to the rig, and their random streams do not depend on the fault.
Where the same record without its fault is known, its twin, the two pass path and modulation side by side, so what the fault adds is known
at every stage. All of it is in single precision. Its error is 1e-7 of the largest value of a record: a three-hundredth of a count of the
converter at full scale.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.corpus.simulated import UNJUDGED
from gen.measurement.components import parts_of
from gen.measurement.gains import Gains, bearing_over_background, fault_over_rest, gains_of
from gen.measurement.judging import Judge, compile_judging, judges_of
from gen.measurement.mixing import Parts
from gen.measurement.rig import RigFilters, rig_filters
from gen.mechanisms.chain.measuring_chain import disturb
from gen.recipe import Recipe
from gen.recipe.sensing import PhysicalLevel
from gen.scenarios import Scenario
from gen.simulation.batches import Integration
from gen.simulation.motion import draw_motion
from gen.simulation.simulate import Run
from gen.simulation.timeline import timeline

LARGEST_COUNT = 32767
_ROWS = 8  # records times channels per pass: transforms run side by side, and their arrays fit the second-level cache


class Measured(NamedTuple):
    """A record as it is stored."""

    run: Run
    scenario: Scenario
    """As measured: with the level that was taken if several were tried, and with the gains of a record in a group."""
    signal: NDArray[np.int16] | NDArray[np.float32]
    """Shape (channel, time): converter counts, or m s-2."""
    chain_labels: dict[str, float]
    """Values of the labels of the faults of the measuring chain that are in it, by name."""
    clipped: int
    """Samples at the limits of the converter."""
    snr: float
    """Rms of the bearing over that of the background, or over the rounding noise of the converter if that is larger [dB]. NaN for a record
    without a bearing signal, without a background, or with no sample but zeros."""
    fault_snr: float = math.nan
    """Rms of what the fault adds over that of all else: the bearing without the fault, and the background [dB]. Minus infinity if the fault
    adds nothing, NaN for a healthy record or if the record without the fault is not known."""
    fault_share: float = math.nan
    """Power of what the fault adds over its sum with the power of all else [1]; 0 for a healthy record, NaN if unknown."""
    detectable: int = UNJUDGED
    """1 if the fault can be seen in the record, 0 if not or if there is none, ``UNJUDGED`` if it was not judged."""


def measure(runs: Sequence[Run], ratios: Mapping[int, Sequence[float]] = {}) -> list[Measured]:
    """Turn the accelerations of simulated bodies into records.

    Parameters
    ----------
    runs : sequence of Run
        Integrated records of one recording without failures; those of a group in any order.
    ratios : mapping, optional
        Further signal-to-noise ratios of records by their number [dB]; the first one at which the fault can be seen is taken.
    """
    filters, measured = _filters(runs), dict[Run, Measured]()
    for groups in _passes(runs):
        some = [run for group in groups for run in group]
        # signal, path and background, and nothing of the level
        parts = dict(zip(some, parts_of(some, [filters[run] for run in some]), strict=True))
        judges = dict(zip(some, judges_of([*parts.values()]), strict=True))
        for group in groups:
            # the largest severity sets the level
            largest = max(group, key=lambda run: run.scenario.origin.rung)
            tried = ratios.get(largest.scenario.origin.record, ())
            level = _level(largest.scenario, parts[largest], judges[largest], tried)
            measured |= {run: _measured(run, parts[run], judges[run], *level) for run in group}
    return [measured[run] for run in runs]


def compile_measuring(scenario: Scenario) -> None:
    """Compile the mixing and the judging of records, or fetch them from numba's cache on disk."""
    compile_judging()
    silence = np.zeros((len(scenario.recipe.recording.channels), timeline(scenario.recipe).returned), np.float32)
    any_input: Any = None
    measure([Run(scenario, draw_motion(scenario), Integration(any_input, 1, silence))])


def _filters(runs: Sequence[Run]) -> dict[Run, RigFilters]:
    """Filters of the rig of each record; rigs of one number differ where scenarios were changed by hand."""
    by_number, filters = defaultdict[int, list[tuple[Any, RigFilters]]](list), dict[Run, RigFilters]()
    for run in runs:
        recipe, of_number = run.scenario.recipe, by_number[run.scenario.origin.rig]
        sections = recipe.recording, recipe.path, recipe.background
        of_rig = next((rig for others, rig in of_number if others == sections), None)
        if of_rig is None:
            of_rig = rig_filters(run.scenario)
            of_number.append((sections, of_rig))
        filters[run] = of_rig
    return filters


def _passes(runs: Sequence[Run]) -> Iterator[list[list[Run]]]:
    """Records by their groups, whole groups in passes of about ``_ROWS`` rows; most groups have one record."""
    groups = defaultdict[Any, list[Run]](list)
    for run in runs:
        pair = run.scenario.origin.pair
        # records of a group share their gains, so they are measured together
        groups[pair if pair >= 0 else run].append(run)
    together: list[list[Run]] = []
    for group in groups.values():
        if sum(map(len, [*together, group])) > max(1, _ROWS // len(group[0].acceleration)) and together:
            yield together
            together = []
        together.append(group)
    if together:
        yield together


def _level(scenario: Scenario, parts: Parts, sees: Judge, further: Sequence[float]) -> tuple[Any, int, Gains]:
    """Level of a record and of its group, the number of its try, and its gains.

    It is the drawn level, or if the fault cannot be seen, the first of some ``further`` ratios at which it can. In a group it becomes a
    physical level, so that all that differs between its records is the fault.
    """
    level, drawn = scenario.recipe.level, scenario.recipe.level.si()
    if level.kind == "physical":
        return level, 0, (drawn["gain"], drawn["gain"] * drawn["background"])
    key = "healthy" if scenario.fault == "healthy" else "faulty"
    tried = [drawn[key], *further]
    gains = [gains_of(parts.products, ratio, drawn["rms"]) for ratio in tried]
    # the first level at which the fault can be seen
    chosen = next((n for n, some in enumerate(gains) if len(tried) == 1 or sees(some)), 0)
    if scenario.origin.pair < 0:
        return level.model_copy(update={f"{key}_db": tried[chosen]}), chosen, gains[chosen]
    bearing, background = gains[chosen]
    # the other records of the group get these gains, whatever their own ratio
    level = PhysicalLevel.model_construct(kind="physical", gain=bearing, background_m_s2=background / bearing)
    return level, chosen, (bearing, bearing * level.si()["background"])


def _measured(run: Run, parts: Parts, sees: Judge, level: Any, level_try: int, gains: Gains) -> Measured:
    """A record at its level, behind measuring chain and converter, and whether its fault can be seen."""
    (bearing, background), per_unit = gains, counts_per_unit(run.scenario.recipe)
    changes = {"origin": run.scenario.origin.model_copy(update={"level_try": level_try})} if level_try else {}
    scenario = run.scenario.edited(level=level, **changes)
    recording = scenario.recipe.recording
    # bearing over background, at the gains that the level asks for
    signal: Any = np.float32(bearing) * parts.signals[1:].sum(axis=0)
    signal += np.float32(background) * parts.signals[0]
    # faults of the measuring chain come ahead of the converter, whose range they use up
    signal, labels = disturb(signal, scenario.recipe.sensor_faults, recording.sample_rate_hz, scenario.stream)
    signal += np.float32(recording.si()["offset"])
    clipped, rounding = 0, 0.0
    if per_unit is not None:
        # rms of an error that is uniform within half a count
        rounding = 1 / (per_unit * math.sqrt(12))
        signal, clipped = _to_counts(signal, per_unit)
    snr = bearing_over_background(parts.products, gains, rounding) if signal.any() else math.nan
    judged: tuple[Any, ...]
    if run.twin is not None:
        judged = *fault_over_rest(parts.products, gains, rounding), int(sees(gains))
    else:
        judged = (math.nan, 0.0, 0) if scenario.fault == "healthy" else ()
    return Measured(run, scenario, signal, labels, clipped, snr, *judged)


def counts_per_unit(recipe: Recipe) -> float | None:
    """Counts of the converter per m s-2, of the stored scale factor, which is in single precision; None without a converter."""
    full_scale = recipe.recording.full_scale
    return None if full_scale is None else 1 / float(np.float32(full_scale / LARGEST_COUNT))


def _to_counts(signal: NDArray[np.float32], per_unit: float) -> tuple[NDArray[np.int16], int]:
    """Counts of the converter for a signal, which is overwritten, and the number of samples beyond its limits."""
    np.rint(np.multiply(signal, np.float32(per_unit), out=signal), out=signal)
    clipped = np.count_nonzero(np.abs(signal) > LARGEST_COUNT)
    return np.clip(signal, -LARGEST_COUNT, LARGEST_COUNT, out=signal).astype(np.int16), int(clipped)
