"""From the motion of the bodies to the samples that a data-acquisition card stores.

response -> transfer path -> modulation by the shaft -> machine background -> level -> sensor faults -> converter. Healthy and faulty
records are measured alike: path and background belong to the rig, and their random streams do not depend on the fault. Where the same
record without its fault is known, the two are filtered and modulated side by side, so what the fault adds is known at every stage. All of
it is in single precision. Its error is 1e-7 of the largest value of a record: a three-hundredth of a count of the converter at full scale.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft

from gen.corpus.simulated import UNJUDGED
from gen.measurement.background import NO_SIGNAL, impulses_of, lines_of, noise_of
from gen.measurement.judging import Judge, Parts, compile_judging, judges_of
from gen.measurement.levels import (
    bearing_over_background,
    fault_over_rest,
    gains_of,
    mean_square,
)
from gen.measurement.mixing import Products, mix
from gen.measurement.rig import RigFilters, rig_filters
from gen.mechanisms.background.section import locked_of
from gen.mechanisms.chain.measuring_chain import disturb
from gen.scenarios import Gains, Purpose, Scenario, common_settings
from gen.simulation.motion import Motion, draw_motion
from gen.simulation.shaft import angles_of
from gen.simulation.simulate import Twin
from gen.simulation.timeline import Timeline, timeline

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]
LARGEST_COUNT = 32767
SIGNIFICANT_RISE = 1.25  # of the rms by a fault without lines: ISO 20816-1:2016, criterion II
_Part = tuple[Parts, Products]
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
    other_levels: Callable[[Scenario], Iterable[Scenario]] = lambda _: (),
) -> Measured:
    """Turn accelerations of the bodies into records.

    Parameters
    ----------
    acceleration : array, shape (record, channel, time)
        Acceleration that each channel measures, from the lead ahead of the record on [m s-2].
    scenarios : list of Scenario
        The scenarios that were simulated, in the same order; of each group, the last one has the largest severity.
    twins : sequence of Twin, optional
        The same records without their faults, which tell what the faults add.
    motions : sequence of Motion, optional
        Courses of their shafts; by default drawn again.
    other_levels : callable
        Gives the same record with other levels, one after the other, until its fault can be seen.
    """
    settings = common_settings(scenarios)
    axis, motions = timeline(settings), motions or [*map(draw_motion, scenarios)]
    shape = len(scenarios), len(settings.channels), axis.record
    rigs = {scenario.rig.number: scenario.rig for scenario in scenarios}
    of_rig = {number: rig_filters(rig, axis.returned, axis.fs, settings.seed) for number, rig in rigs.items()}
    # of the stored scale factor, which is in single precision
    counts_per_unit = (
        None if settings.full_scale is None else 1 / float(np.float32(settings.full_scale / LARGEST_COUNT))
    )
    signal: Any = np.empty(shape, np.float32 if counts_per_unit is None else np.int16)
    clipped, taken, labels = np.zeros(shape[0], np.int32), list(scenarios), [dict[str, float]()] * shape[0]
    snr, fault_snr, fault_share = np.full((3, shape[0]), np.nan)
    detectable = np.empty(shape[0], np.int8)
    # rms of an error that is uniform within half a count
    rounding = 0.0 if counts_per_unit is None else 1 / (counts_per_unit * math.sqrt(12))
    several = max(1, _ROWS // shape[1])
    twin_of = {twin.place: twin for twin in twins}
    # Backwards: the last record of a group has the largest severity and sets the level of the group. One that diverged sets none.
    levels: dict[int, Levelled] = {}
    for first in reversed(range(0, shape[0], several)):
        some = slice(first, first + several)
        filters = [of_rig[scenario.rig.number] for scenario in scenarios[some]]
        angles = [angles_of(motion, axis) for motion in motions[some]]
        some_twins = [twin_of.get(row) for row in range(shape[0])[some]]
        parts = _parts(acceleration[some], scenarios[some], filters, angles, axis, some_twins)
        judged = zip(parts, _judges(parts), strict=True)
        for row, ((part, products), judge) in reversed(list(enumerate(judged, first))):
            scenario = scenarios[row]
            pair = scenario.record.pair
            if pair in levels:
                scenario = _with_level_of(levels[pair], scenario)
            level = _choose_level(part, products, judge, scenario, rounding, other_levels)
            if pair >= 0 and scenario.record.snr is not None and _is_finite(products):
                level = level._replace(scenario=_with_level_of(level, level.scenario))
                levels.setdefault(pair, level)
            mixed, labels[row] = _through_chain(_mix(part, level.gains), level.scenario, axis.fs)
            mixed += np.float32(scenario.rig.offset)
            if counts_per_unit is not None:
                clipped[row] = _to_counts(mixed, counts_per_unit)
            signal[row] = mixed
            taken[row], detectable[row] = level.scenario, level.detectable
            fault_snr[row], fault_share[row] = level.fault_snr, level.fault_share
            if signal[row].any():
                snr[row] = bearing_over_background(products, level.gains, rounding)
    return Measured(signal, counts_per_unit, clipped, snr, fault_snr, fault_share, detectable, taken, labels)


def _is_finite(products: Products) -> bool:
    """False if the record diverged."""
    return math.isfinite(sum(products))


class Levelled(NamedTuple):
    """Level of one record, and what can be seen of its fault; see :class:`Measured`."""

    scenario: Scenario
    gains: Gains
    fault_snr: float
    fault_share: float
    detectable: int


def compile_measuring(scenario: Scenario) -> None:
    """Compile the mixing and the judging of records, or fetch them from numba's cache on disk."""
    settings = scenario.settings
    compile_judging()
    measure(np.zeros((1, len(settings.channels), timeline(settings).returned), np.float32), [scenario])


def _parts(
    acceleration: Float32Array,
    scenarios: Sequence[Scenario],
    filters: Sequence[RigFilters],
    angles: Sequence[NDArray[np.float64]],
    axis: Timeline,
    twins: Sequence[Twin | None],
) -> list[_Part]:
    """The parts of some records and of the same ones without their faults, None without a fault or if that is not known."""
    healthy = [whole if twin is None else twin.acceleration for whole, twin in zip(acceleration, twins, strict=True)]
    faulty = [row for row, twin in enumerate(twins) if twin is not None]
    both = np.stack([*healthy, *(acceleration[row] - healthy[row] for row in faulty)])
    _through_paths(both, [*filters, *(filters[row] for row in faulty)])
    faults = iter(both[len(twins) :])
    rngs = [scenario.rng(Purpose.NOISE) for scenario in scenarios]
    lines = [lines_of(*given, axis) for given in zip(filters, scenarios, rngs, strict=True)]
    background = noise_of(filters, acceleration.shape[1], rngs)
    impulses = impulses_of(filters, angles, rngs)
    for row, scenario in enumerate(scenarios):
        for source, drawn in locked_of(scenario.rig.background):
            for vibration in source.vibrations(drawn, angles[row], axis.fs, scenario.rng(source.of_record)):
                behind = filters[row].source_in_channels(vibration)
                # impulses have the length of the Fourier transform
                impulses[row] = impulses[row][:, : behind.shape[1]] + behind if impulses[row].size else behind
    parts = []
    for row, twin in enumerate(twins):
        one = NO_SIGNAL if twin is None else next(faults), both[row], background[row]
        products = Products(*mix(*one, impulses[row], angles[row], lines[row], axis.kept.start, axis.kept.stop))
        added, bearing, noise = (some[..., axis.kept] if some.size else some for some in one)
        steady, orders = scenarios[row].record.speed_profile is None, () if twin is None else twin.orders
        known = filters[row].impulse_lines, orders, angles[row][axis.kept], steady
        parts.append((Parts(added, bearing, noise, *known), products))
    return parts


def _mix(part: Parts, gains: Gains) -> Float32Array:
    """Bearing plus background, shape (channel, time) [m s-2]."""
    whole = part.healthy + part.fault if part.fault.size else part.healthy
    mixed = np.float32(gains.bearing) * whole
    mixed += np.float32(gains.background) * part.background
    return mixed


def _through_chain(signal: Any, scenario: Scenario, fs: float) -> tuple[Any, dict[str, float]]:
    """Signal with the faults of the measuring chain of a scenario, and the values of their labels."""
    of_rig, of_record = scenario.rig.sensor_faults, scenario.record.sensor_faults
    if not (of_rig or of_record):
        return signal, {}
    return disturb(signal, of_rig, of_record, fs, scenario.rng(Purpose.SENSOR_NOISE))


def _to_counts(signal: Float32Array, counts_per_unit: float) -> int:
    """Round a signal to counts of the converter, in place; return the number of samples beyond its limits.

    A record that diverged has no counts. It is left out of the corpus; here it becomes zeros.
    """
    lowest, highest = float(signal.min()), float(signal.max())
    if not (math.isfinite(lowest) and math.isfinite(highest)):
        signal[:] = 0.0
        return 0
    np.rint(np.multiply(signal, np.float32(counts_per_unit), out=signal), out=signal)
    if max(-lowest, highest) * counts_per_unit < LARGEST_COUNT:
        return 0
    clipped = np.count_nonzero(np.abs(signal) > LARGEST_COUNT)
    np.clip(signal, -LARGEST_COUNT, LARGEST_COUNT, out=signal)
    return int(clipped)


def _judges(parts: Sequence[_Part]) -> list[Judge | None]:
    """Judges of those records whose fault has a line."""
    wanted = [bool(part.orders) and part.fault.size > 0 and _is_finite(products) for part, products in parts]
    judges = iter(judges_of([part for (part, _), is_wanted in zip(parts, wanted, strict=True) if is_wanted]))
    return [next(judges) if is_wanted else None for is_wanted in wanted]


def _with_level_of(levelled: Levelled, scenario: Scenario) -> Scenario:
    """A scenario with the level of another record of its group, so that all that differs is the fault."""
    of = levelled.scenario.record
    record = replace(scenario.record, snr=of.snr, rms=of.rms, level_try=of.level_try, gains=levelled.gains)
    return replace(scenario, record=record)


def _choose_level(
    part: Parts,
    products: Products,
    judge: Judge | None,
    scenario: Scenario,
    rounding: float,
    other_levels: Callable[[Scenario], Iterable[Scenario]],
) -> Levelled:
    """Level of a record: the drawn one, or if its fault cannot be seen the first of some others at which it can."""
    if not part.fault.size:
        unseen = (0.0, 0) if scenario.specimen.fault == "healthy" else (math.nan, UNJUDGED)
        return Levelled(scenario, gains_of(scenario, products), math.nan, *unseen)
    levels = []
    for tried in chain([scenario], () if scenario.record.gains is not None else other_levels(scenario)):
        gains = gains_of(tried, products)
        levels.append(Levelled(tried, gains, *_visibility(products, judge, gains, rounding)))
        if levels[-1].detectable:
            return levels[-1]
    return levels[0]


def _visibility(products: Products, judge: Judge | None, gains: Gains, rounding: float) -> tuple[float, float, int]:
    """Level of a fault over the rest [dB], its share of the power [1], and 1 if it can be seen, else 0."""
    level, share = fault_over_rest(products, gains, rounding)
    if judge is not None:
        return level, share, int(judge.sees(gains))
    rise = mean_square(products, gains) >= SIGNIFICANT_RISE**2 * mean_square(products, gains, fault=False)
    return level, share, int(rise)


def _through_paths(acceleration: Float32Array, filters: Sequence[RigFilters]) -> None:
    """Filter accelerations by the transfer paths, in place, shape (record, channel, time) [m s-2].

    The convolution is circular; its wrap-around falls into the lead, which is dropped.
    """
    resonant = [row for row, of_row in enumerate(filters) if of_row.direct is None]
    for row, of_row in enumerate(filters):
        if of_row.direct is not None:
            acceleration[row] *= of_row.direct
    if resonant:
        spectra = rfft(acceleration[resonant], filters[0].n)
        for spectrum, row in zip(spectra, resonant, strict=True):
            spectrum *= filters[row].bearing_paths
        acceleration[resonant] = irfft(spectra, filters[0].n)[..., : acceleration.shape[2]]
