"""Scenarios in, accelerations at the bodies out.

Records that need the same kernel and step share a batch; what a record gives does not depend on the others in its batch. The step is
chosen before the run from what the machine should do, and held against what its contacts did after it.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gen.errors import SimulationError
from gen.physics.kernel.batch import Record, lay_out, record_shape
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.equations import Shape
from gen.physics.kernel.integrate import Integral, integrate
from gen.physics.rotor import fastest_decay, fastest_swing, likely_stiffness
from gen.recipe import MAX_OVERSAMPLING, Recipe
from gen.scenarios import Scenario, first_specimens
from gen.simulation.machine import physical_record

FloatArray = NDArray[np.float64]

# omega * dt of the stiffest mode: 0.30 keeps the acceleration to about 1e-3, 1.0 still rings as it should, 2.8 is unstable
FINE_STEP, COARSEST_STEP = 0.30, 1.0
LEAD_S = 0.05  # given ahead of the record, for the measurement's filters to start in
_FACTORS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, MAX_OVERSAMPLING)
LARGEST_TURN = 0.7  # rad of the shaft from sample to sample, between which it turns evenly
CHECKED_PARTS, CHECKED_SHARE = 32, 0.01  # in one part of so many the share of all their records has its steps checked


@dataclass(frozen=True)
class Response:
    """What the channels' bodies do, from ``LEAD_S`` before the record on."""

    acceleration: NDArray[np.float32]
    """Shape (record, channel, time), NaN where a record diverged [m s-2]."""
    oversampling: NDArray[np.int64]
    """Steps per sample, shape (record,)."""
    step_phase: FloatArray
    """Fastest angular frequency that a record's contacts, as stiff as they became, allow, times the step, shape (record,) [rad]."""
    failures: dict[int, str]
    """A sentence for each record that cannot be or diverged, by its place in the batch."""
    records: list[Record | None]
    """What the kernel was given, None for a record that cannot be."""


def simulate(scenarios: list[Scenario], recipe: Recipe, *, report: Callable[[int], None] = lambda _: None) -> Response:
    """Integrate scenarios.

    Parameters
    ----------
    scenarios : list of Scenario
        Records to simulate.
    recipe : Recipe
        Gives sample rate, duration and settling time.
    report : callable, optional
        Called after each batch with the number of records integrated so far.

    Returns
    -------
    Response
        One row per scenario.

    Raises
    ------
    SimulationError
        Before anything runs, if a step would be too coarse for the stiffest mode of a scenario, or for its shaft.
    """
    failures: dict[int, str] = {}
    records: list[Record | None] = []
    for place, scenario in enumerate(scenarios):
        try:
            records.append(kernel_record(scenario, recipe))
        except SimulationError as error:
            records.append(None)
            failures[place] = str(error)
    possible = {place: record for place, record in enumerate(records) if record is not None}
    factors = {place: steps_per_sample(record, scenarios[place], recipe) for place, record in possible.items()}
    made, phases = _integrated(list(possible.values()), list(factors.values()), recipe, report)
    for row, (place, factor) in enumerate(factors.items()):
        number = scenarios[place].record.number
        if made.diverged[row] >= 0:
            failures[place] = (
                f"record {number} diverged at t = {made.diverged[row] / recipe.recording.sample_rate_hz:.4g} s with "
                f"{factor} steps per sample; raise recording.oversampling or soften the machine."
            )
        elif phases[row] > COARSEST_STEP:
            need = math.ceil(factor * phases[row] / FINE_STEP)
            failures[place] = (
                f"record {number}: its contacts became stiffer than {factor} steps per sample can follow; "
                f"set recording.oversampling to {need}."
            )
    acceleration = np.full((len(scenarios), *made.response.shape[1:]), np.nan, np.float32)
    acceleration[list(possible)] = made.response
    acceleration[list(failures)] = np.nan
    step_phase = np.full(len(scenarios), np.nan)
    step_phase[list(possible)] = phases
    oversampling = np.array([factors.get(place, 0) for place in range(len(scenarios))])
    return Response(acceleration, oversampling, step_phase, failures, records)


def _integrated(
    records: list[Record], factors: list[int], recipe: Recipe, report: Callable[[int], None] = lambda _: None
) -> tuple[Integral, FloatArray]:
    """What :class:`Integral` describes, record by record in place of lane by lane, and the step phases."""
    fs, lead = recipe.recording.sample_rate_hz, lead_samples(recipe)
    n_settle, n_out = max(round(recipe.recording.settle_s * fs) - lead, 0), lead + recipe.n_samples
    batches: dict[tuple[Shape, int], list[int]] = defaultdict(list)
    for place, record in enumerate(records):
        batches[record_shape(record), factors[place]].append(place)
    response = np.empty((len(records), len(recipe.recording.channels), n_out), np.float32)
    diverged, steepest = np.empty(len(records), np.int64), np.empty(len(records))
    done = 0
    for (shape, factor), places in batches.items():
        for first in range(0, len(places), LANES):
            some = places[first : first + LANES]
            lanes = lay_out([records[place] for place in some], shape, 1 / fs)
            made = integrate(shape, lanes, 1 / (fs * factor), factor, decimation(factor), n_settle, n_out)
            response[some] = made.response.T[: len(some)]
            diverged[some], steepest[some] = made.diverged[: len(some)], made.steepest[: len(some)]
            done += len(some)
            report(done)
    phases = [
        float(fastest_swing(record.machine, stiffness)) / (fs * factor)
        for record, stiffness, factor in zip(records, steepest, factors, strict=True)
    ]
    return Integral(response, diverged, steepest), np.array(phases)


def step_errors(scenarios: list[Scenario], recipe: Recipe, response: Response) -> FloatArray:
    """Relative rms change of some records when their step is halved, NaN for those not tried, shape (record,).

    ``scenarios`` are those of a part; :func:`checked_places` says which of them.
    """
    errors = np.full(len(scenarios), np.nan)
    fine = {place: record for place, record in enumerate(response.records) if record and place not in response.failures}
    groups = {place: (record_shape(record), int(response.oversampling[place])) for place, record in fine.items()}
    tried = checked_places(scenarios, recipe, groups)
    if not tried:
        return errors
    finer, _ = _integrated([fine[place] for place in tried], [2 * groups[place][1] for place in tried], recipe)
    lead = lead_samples(recipe)
    coarse, halved = response.acceleration[tried][..., lead:], finer.response[..., lead:]
    change, whole = (np.sum(some**2, axis=(1, 2), dtype=np.float64) for some in (coarse - halved, halved))
    errors[tried] = np.sqrt(change / whole)
    return errors


def checked_places(scenarios: list[Scenario], recipe: Recipe, groups: Mapping[int, Hashable]) -> list[int]:
    """Places in a part of the records whose step is to be checked; records of one group, in ``groups`` by place, share batches.

    The first record of a class in the part where its first specimen of the corpus begins; in one part of ``CHECKED_PARTS``
    more, up to ``CHECKED_SHARE`` of the records that they hold together; and what fills their batches at no more cost.
    """
    corpus, begun = recipe.corpus, {scenario.record.number for scenario in scenarios}
    new = {fault for fault, number in first_specimens(recipe).items() if number * corpus.records_per_specimen in begun}
    first: dict[str, int] = {}
    for place in groups:
        if scenarios[place].specimen.fault in new:
            first.setdefault(scenarios[place].specimen.fault, place)
    start, span = scenarios[0].record.number, CHECKED_PARTS * corpus.records_per_part
    wanted = CHECKED_SHARE * min(span, recipe.n_records - start) if start % span == 0 else 0
    chosen = _with_full_batches(list(first.values()), groups)
    for place in groups:
        if len(chosen) >= wanted:
            break
        if place not in chosen:
            chosen = _with_full_batches([*chosen, place], groups)
    return chosen


def _with_full_batches(chosen: list[int], groups: Mapping[int, Hashable]) -> list[int]:
    """Chosen places and, of their groups, those that fill the last batch of each."""
    filled = list(chosen)
    for group, count in Counter(groups[place] for place in chosen).items():
        others = [place for place, found in groups.items() if found == group and place not in chosen]
        filled += others[: -count % LANES]
    return filled


def kernel_record(scenario: Scenario, recipe: Recipe) -> Record:
    """What the kernel needs of a scenario.

    Raises
    ------
    SimulationError
        If no such machine can stand, with the number of the record.
    """
    with failures_named(scenario):
        return physical_record(scenario, recipe)


@contextmanager
def failures_named(scenario: Scenario) -> Iterator[None]:
    """Turn the ValueError of a machine that cannot stand into a SimulationError with the number of the record."""
    try:
        yield
    except ValueError as error:
        raise SimulationError(f"record {scenario.record.number}: {error}") from None


def lead_samples(recipe: Recipe) -> int:
    """Samples that a response has ahead of the record."""
    return round(LEAD_S * recipe.recording.sample_rate_hz)


def largest_pull(record: Record) -> float:
    """What may pull at the shaft beside its steady load: unbalance, a bent shaft, misalignment, the profile of the load [N]."""
    turning = record.motion
    speeds, loads = record.schedule.T if record.schedule.size else (np.ones(1), np.ones(1))
    unbalance = turning.unbalance * (2 * math.pi * turning.shaft_rate * float(speeds.max())) ** 2
    steady = math.hypot(record.machine.load_x, record.machine.load_y)
    further = steady * (float(loads.max()) - 1)
    return max(unbalance + turning.bow + math.hypot(turning.twice_x, turning.twice_y) + further, 0.0)


def compile_kernel(record: Record) -> None:
    """Compile the kernel that a record needs, or fetch it from numba's cache on disk."""
    shape = record_shape(record)
    lanes = lay_out([record], shape, 1e-4)
    integrate(shape, lanes, 1e-5, 1, decimation(1), 0, 1)


def steps_per_sample(record: Record, scenario: Scenario, recipe: Recipe) -> int:
    """Steps per sample that the stiffest mode of a record needs.

    Raises
    ------
    SimulationError
        If the recipe asks for fewer than the mode can bear, or the mode for more than are allowed.
    """
    fs = recipe.recording.sample_rate_hz
    machine = record.machine
    fastest = record.motion.shaft_rate * (float(record.schedule[:, 0].max()) if record.schedule.size else 1.0)
    if 2 * math.pi * fastest / fs > LARGEST_TURN:
        raise SimulationError(
            f"record {scenario.record.number}: its shaft turns {360 * fastest / fs:.3g} degrees per sample; raise "
            f"recording.sample_rate_hz to {math.ceil(2 * math.pi * fastest / LARGEST_TURN)}."
        )
    stiffness = likely_stiffness(machine, record.bearing.n_balls, largest_pull(record))
    rate = max(float(fastest_swing(machine, stiffness)), fastest_decay(machine, record.bearing.n_balls) / 2.5)
    asked = recipe.recording.oversampling
    if asked is not None:
        if rate / (asked * fs) > COARSEST_STEP:
            need = math.ceil(rate / (fs * FINE_STEP))
            raise SimulationError(
                f"record {scenario.record.number}: its stiffest mode of {rate / 2 / math.pi:.0f} Hz is too fast for a step of "
                f"{1e6 / (asked * fs):.3g} us; raise recording.oversampling to {need} or leave it out."
            )
        return asked
    for factor in _FACTORS:
        if rate / (factor * fs) <= FINE_STEP:
            return factor
    raise SimulationError(
        f"record {scenario.record.number}: its stiffest mode of {rate / 2 / math.pi:.0f} Hz needs more than {_FACTORS[-1]} steps per "
        f"sample at {fs:g} Hz; soften the machine or raise recording.sample_rate_hz."
    )
