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
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.corpus.simulated import UNJUDGED
from gen.measurement.background import with_background
from gen.measurement.judging import Judge, compile_judging, judges_of
from gen.measurement.levels import Gains, bearing_over_background, fault_over_rest, gains_of
from gen.measurement.mixing import Parts
from gen.measurement.path import Vibration, through_paths, with_twin
from gen.measurement.rig import RigFilters, rig_filters
from gen.mechanisms.chain.measuring_chain import disturb
from gen.recipe.sensing import PhysicalLevel
from gen.scenarios import Scenario, same_recording
from gen.simulation.motion import Motion, draw_motion
from gen.simulation.shaft import angles_of
from gen.simulation.simulate import Twin
from gen.simulation.timeline import Timeline, timeline

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]
LARGEST_COUNT = 32767
_ROWS = 8  # records times channels per pass: transforms run side by side, and their arrays fit the second-level cache


@dataclass(frozen=True)
class Measured:
    """Records as they are stored."""

    signal: NDArray[np.int16] | NDArray[np.float32]
    """Shape (record, channel, time): converter counts, or m s-2."""
    counts_per_unit: float | None
    """Counts per m s-2, None without a converter."""
    clipped: NDArray[np.int32]
    """Samples at the limits of the converter, shape (record,)."""
    snr: FloatArray
    """Rms of the bearing over that of the background, or over the rounding noise of the converter if that is larger, shape (record,) [dB].
    NaN for a record without a bearing signal, without a background, or with no sample but zeros."""
    fault_snr: FloatArray
    """Rms of what the fault adds over that of all else: the bearing without the fault, and the background, shape (record,) [dB]. Minus
    infinity if the fault adds nothing, NaN for a healthy record or if the record without the fault is not known."""
    fault_share: FloatArray
    """Power of what the fault adds over its sum with the power of all else, shape (record,) [1]; 0 for a healthy record, NaN if unknown."""
    detectable: NDArray[np.int8]
    """1 if the fault can be seen in the record, 0 if not or if there is none, ``UNJUDGED`` if it was not judged, shape (record,)."""
    scenarios: list[Scenario]
    """The scenarios as measured: with the level that was taken if several were tried, and with the gains of records in groups."""
    chain_labels: list[dict[str, float]]
    """Of the faults of the measuring chain that are in each record, by name."""


def measure(
    acceleration: Float32Array,
    scenarios: list[Scenario],
    twins: Sequence[Twin] = (),
    *,
    motions: Sequence[Motion] | None = None,
    ratios: Mapping[int, Sequence[float]] = {},
) -> Measured:
    """Turn accelerations of the bodies into records.

    Parameters
    ----------
    acceleration : array, shape (record, channel, time)
        Acceleration that each channel measures, from the lead ahead of the record on [m s-2].
    scenarios : list of Scenario
        The scenarios that were simulated, in the same order; those of a group in any order.
    twins : sequence of Twin, optional
        The same records without their faults, which tell what the faults add.
    motions : sequence of Motion, optional
        Courses of their shafts; by default drawn again.
    ratios : mapping, optional
        Further signal-to-noise ratios of records by their place [dB]; the first one at which the fault can be seen is taken.
    """
    recording = same_recording(scenarios).recording
    fs, counts_per_unit = recording.sample_rate_hz, _counts_per_unit(recording.full_scale)
    # rms of an error that is uniform within half a count
    rounding = 0.0 if counts_per_unit is None else 1 / (counts_per_unit * math.sqrt(12))
    shape = len(scenarios), len(recording.channels), scenarios[0].recipe.n_samples
    signal: Any = np.empty(shape, np.float32 if counts_per_unit is None else np.int16)
    rows: dict[int, Any] = {}
    for group in _groups(acceleration, scenarios, twins, motions or [*map(draw_motion, scenarios)]):
        level, gains = _level(group, scenarios, ratios)
        for place, (parts, judge) in group.items():
            scenario = _with_level(scenarios[place], *level)
            analogue, chain_labels = _through_chain(_at_level(parts, gains), scenario, fs)
            clipped = 0 if counts_per_unit is None else _to_counts(analogue, counts_per_unit)
            signal[place] = analogue
            snr = bearing_over_background(parts.products, gains, rounding) if signal[place].any() else math.nan
            visibility = _visibility(parts, judge, scenario.fault, gains, rounding)
            rows[place] = clipped, snr, *visibility, scenario, chain_labels
    *numbers, taken, labels = zip(*(rows[place] for place in range(len(scenarios))), strict=True)
    clipped, snr, fault_snr, fault_share, detectable = map(np.array, numbers)
    return Measured(signal, counts_per_unit, clipped, snr, fault_snr, fault_share, detectable, [*taken], [*labels])


def compile_measuring(scenario: Scenario) -> None:
    """Compile the mixing and the judging of records, or fetch them from numba's cache on disk."""
    compile_judging()
    channels = len(scenario.recipe.recording.channels)
    measure(np.zeros((1, channels, timeline(scenario.recipe).returned), np.float32), [scenario])


def _groups(
    acceleration: Float32Array, scenarios: Sequence[Scenario], twins: Sequence[Twin], motions: Sequence[Motion]
) -> Iterator[dict[int, tuple[Parts, Judge]]]:
    """Parts of the records of each group with their judges, by place: signal, path and background, and nothing of the level."""
    axis = timeline(same_recording(scenarios))
    filters = _filters(scenarios, axis)
    twin_of = {twin.place: twin for twin in twins}
    for groups in _passes(scenarios, max(1, _ROWS // acceleration.shape[1])):
        places = [place for group in groups for place in group]
        vibrations = [
            Vibration(
                scenarios[place],
                filters[place],
                angles_of(motions[place], axis),
                *with_twin(acceleration[place], twin_of.get(place)),
            )
            for place in places
        ]
        parts = with_background(through_paths(vibrations), axis)
        judged = dict(zip(places, zip(parts, judges_of(parts), strict=True), strict=True))
        yield from ({place: judged[place] for place in group} for group in groups)


def _filters(scenarios: Sequence[Scenario], axis: Timeline) -> list[RigFilters]:
    """Filters of the rig of each record; rigs of one number differ where scenarios were changed by hand."""
    known = defaultdict[int, list[tuple[Any, RigFilters]]](list)
    filters = []
    for scenario in scenarios:
        number, recipe = scenario.origin.rig, scenario.recipe
        parts = recipe.recording, recipe.path, recipe.background
        of_rig = next((made for others, made in known[number] if others == parts), None)
        if of_rig is None:
            of_rig = rig_filters(recipe, axis.returned, axis.fs, number)
            known[number].append((parts, of_rig))
        filters.append(of_rig)
    return filters


def _passes(scenarios: Sequence[Scenario], size: int) -> Iterator[list[list[int]]]:
    """Places of records by their groups, whole groups in passes of about ``size`` records; most groups have one record."""
    groups = defaultdict[int, list[int]](list)
    for place, scenario in enumerate(scenarios):
        pair = scenario.origin.pair
        groups[pair if pair >= 0 else -1 - place].append(place)
    together: list[list[int]] = []
    for group in groups.values():
        if sum(map(len, [*together, group])) > size and together:
            yield together
            together = []
        together.append(group)
    yield together


def _level(
    group: Mapping[int, tuple[Parts, Judge]], scenarios: Sequence[Scenario], ratios: Mapping[int, Sequence[float]]
) -> tuple[tuple[Any, int], Gains]:
    """Level of the records of a group with the number of its try, and its gains.

    It is the level of the largest severity that did not diverge: the drawn one, or if its fault cannot be seen, the first of some further
    ratios at which it can. In a group it becomes a physical level, so that all that differs between its records is the fault.
    """
    finite = [place for place, (parts, _) in group.items() if math.isfinite(sum(parts.products))]
    place = max(finite or group, key=lambda place: scenarios[place].origin.rung)
    (parts, sees), scenario = group[place], scenarios[place]
    level, drawn = scenario.recipe.level, scenario.recipe.level.si()
    if level.kind == "physical":
        return (level, 0), Gains(drawn["gain"], drawn["gain"] * drawn["background"])
    key = "healthy" if scenario.fault == "healthy" else "faulty"
    tried = [drawn[key], *ratios.get(place, ())]
    gains = [gains_of(parts.products, ratio, drawn["rms"]) for ratio in tried]
    chosen = next((n for n, some in enumerate(gains) if len(tried) == 1 or sees(some)), 0)
    if scenario.origin.pair < 0 or not finite:
        return (level.model_copy(update={f"{key}_db": tried[chosen]}), chosen), gains[chosen]
    bearing, background = gains[chosen]
    level = PhysicalLevel.model_construct(kind="physical", gain=bearing, background_m_s2=background / bearing)
    return (level, chosen), Gains(bearing, bearing * level.si()["background"])


def _with_level(scenario: Scenario, level: Any, level_try: int) -> Scenario:
    """A scenario with the level that it is measured at."""
    if level_try:
        scenario = scenario.edited(origin=scenario.origin.model_copy(update={"level_try": level_try}))
    return scenario.edited(level=level)


def _at_level(parts: Parts, gains: Gains) -> Float32Array:
    """Bearing plus background, shape (channel, time) [m s-2]."""
    mixed = np.float32(gains.bearing) * parts.signals[1:].sum(axis=0)
    mixed += np.float32(gains.background) * parts.signals[0]
    return mixed


def _through_chain(signal: Any, scenario: Scenario, fs: float) -> tuple[Any, dict[str, float]]:
    """Signal with the faults of the measuring chain of a scenario and the offset of its sensors, and the values of the labels."""
    signal, labels = disturb(signal, scenario.recipe.sensor_faults, fs, scenario.stream)
    signal += np.float32(scenario.recipe.recording.si()["offset"])
    return signal, labels


def _counts_per_unit(full_scale: float | None) -> float | None:
    """Counts of the converter per m s-2, of the stored scale factor, which is in single precision; None without a converter."""
    return None if full_scale is None else 1 / float(np.float32(full_scale / LARGEST_COUNT))


def _to_counts(signal: Float32Array, counts_per_unit: float) -> int:
    """Round a signal to counts of the converter, in place; return the number of samples beyond its limits.

    A record that diverged has no counts. It is left out of the corpus; here it becomes zeros.
    """
    if not np.isfinite(signal).all():
        signal[:] = 0.0
    np.rint(np.multiply(signal, np.float32(counts_per_unit), out=signal), out=signal)
    clipped = np.count_nonzero(np.abs(signal) > LARGEST_COUNT)
    np.clip(signal, -LARGEST_COUNT, LARGEST_COUNT, out=signal)
    return int(clipped)


def _visibility(parts: Parts, sees: Judge, fault: str, gains: Gains, rounding: float) -> tuple[float, float, int]:
    """Level of a fault over the rest [dB], its share of the power [1], and 1 if it can be seen, 0 if not, ``UNJUDGED`` if not known."""
    if len(parts.signals) == 2:
        return (math.nan, 0.0, 0) if fault == "healthy" else (math.nan, math.nan, UNJUDGED)
    return *fault_over_rest(parts.products, gains, rounding), int(sees(gains))
