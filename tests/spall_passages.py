"""Entry and exit of a spall, and the drop at which it unloads a ball, on the reference machine with a sensor resonance of 10 kHz.

A ball that enters a spall is unloaded, which gives a step response of low frequency; at the exit it strikes the trailing edge, which gives
an impulse response of all frequencies [1]_. Both events are found on the housing as the sharpest kinks of its acceleration, and levels are
those of the sensor. Times are shares of the time W / v in which the contact travels the width W. A ball that rests on both edges strikes in
the middle, after half of this time, so [1]_ takes the width as twice the distance travelled. Without noise, slip and jitter; the twin
without the spall is subtracted.

.. [1] N. Sawalhi, R. B. Randall, "Vibration response of spalled rolling element bearings: Observations, simulations and signal processing
   techniques to track the spall size", Mech. Syst. Signal Process. 25 (2011) 846-870.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.signal import butter, sosfiltfilt

from gen.physics.bearing import Bearing, orders
from gen.physics.kernel_input import KernelInput
from gen.physics.rotor import Machine, as_columns, ball_forces, rest
from gen.scenarios import Scenario, draw_scenarios
from gen.simulation.damage import largest_drop_over
from gen.simulation.inputs import bare_inputs
from gen.simulation.motion import draw_motion
from gen.simulation.simulate import simulate
from gen.simulation.timeline import Timeline, timeline
from gen.support.errors import SimulationError
from tests.reference_machine import TURNING, FloatArray, reference_recipe
from tests.responses import accelerations_of

FS, SECONDS, ABOVE = 102_400, 1.0, 5000.0
CHANNELS = [{"name": "housing", "body": "housing"}, {"name": "sensor", "body": "sensor"}]
RESONATOR = {"mass_kg": 0.02, "frequency_hz": 10_000, "damping_percent": 5}
NEAR_THE_LOAD = math.radians(15)
ENTRY, EXIT = (-1.3, 0.0), (-0.1, 1.6)  # where the events are searched: the spall reaches from -1 to 1


class Passage(NamedTuple):
    """Medians over the balls that pass a spall near the direction of the load; times are shares of W / v."""

    duration: float
    """W / v [s]."""
    unloading: float
    """From the leading edge until a ball has dropped so far that it carries nothing in static equilibrium."""
    exit: float
    """From the leading edge to the exit event."""
    apart: float
    """From the entry event to the exit event."""
    peaks: float
    """Largest acceleration of the exit over that of the entry."""
    fast_peaks: float
    """The same above 5 kHz."""
    entry_fast: float
    """Share of the energy of the entry above 5 kHz."""
    exit_fast: float
    """Share of the energy of the exit above 5 kHz."""

    @property
    def expected(self) -> tuple[float, float]:
        """``exit`` and ``apart`` of a path that is the same in both directions.

        A ball that stays loaded strikes in the middle. An unloaded ball carries load again where it would lose it in the other direction.
        """
        return (0.5, math.nan) if self.unloading >= 0.5 else (1 - self.unloading, 1 - 2 * self.unloading)


def passage(kind: str, width_mm: float, rpm: float, profile: str = "geometric", seconds: float = SECONDS) -> Passage:
    """Entry and exit of a spall on the ``inner`` or ``outer`` race."""
    recipe = reference_recipe(
        {"kind": kind, "width_mm": width_mm, "profile": profile},
        1,
        recording={"sample_rate_hz": FS, "duration_s": seconds, "channels": CHANNELS},
        machine={"balance_mm_s": 0, "resonator": RESONATOR},
        specimen={"waviness_nm": 0, "ball_waviness_nm": 0},
        operation={"shaft_rpm": rpm, "slip_percent": 0, "jitter_deg": 0, "speed_wander_percent": 0},
    )
    scenario = draw_scenarios(recipe)[0]
    runs = simulate([scenario, scenario.without_fault()])
    given, bearing, width = runs[0].kernel_input, scenario.bearing, 1e-3 * width_mm
    assert given is not None
    load = scenario.machine["load_angle"]
    housing, sensor = np.subtract(*accelerations_of(runs).astype(float))
    fast = sosfiltfilt(butter(4, ABOVE, "highpass", fs=FS, output="sos"), sensor)
    kinks = np.abs(np.convolve(housing, [1, -2, 1], "same"))
    duration = width / contact_speed(bearing, given.turning.shaft_rate)
    n = round(FS * duration * (EXIT[1] - ENTRY[0]) / 2)
    place = np.linspace(ENTRY[0], EXIT[1], n)
    parts = [slice(start, start + n) for start in _starts(scenario, given, timeline(recipe), n)]
    events = np.median([_events(place, kinks[part], sensor[part], fast[part]) for part in parts], axis=0)
    needed = unloading_drop(given.machine, bearing, load)
    unloaded = unloading_length(kind, needed, bearing) if profile == "geometric" else 0.0  # others drop at once
    return Passage(duration, unloaded / width, *events)


def contact_speed(bearing: Bearing, shaft_rate: float) -> float:
    """Speed of a contact over the race, the same on both races: pi f (D^2 - d^2) / (2 D) [m/s]."""
    return 2 * math.pi * shaft_rate * orders(bearing).ftf * bearing.outer_radius


def _starts(scenario: Scenario, given: KernelInput, axis: Timeline, n: int) -> list[int]:
    """Samples at which a ball comes to the first place of ``ENTRY``, of those passages whose middle is near the direction of the load."""
    spall, turning, bearing = given.spalls[0], given.turning, given.bearing
    turned = 2 * math.pi * turning.shaft_rate * (axis.dropped + np.arange(axis.returned)) / axis.fs
    middle = spall.angle + (turning.shaft_angle + turned if spall.site == "inner" else 0.0 * turned)
    near = np.abs(wrapped(middle - scenario.machine["load_angle"])) < NEAR_THE_LOAD
    found = []
    for ball in range(bearing.n_balls):
        angle = turning.cage_angle + orders(bearing).ftf * turned + 2 * math.pi * ball / bearing.n_balls
        place = wrapped(angle - middle) / (0.5 * spall.width / bearing.radius(spall.site))
        if spall.site == "inner":
            place = -place  # the spall overtakes the balls
        starts = np.flatnonzero((place[:-1] < ENTRY[0]) & (place[1:] >= ENTRY[0]) & (np.diff(place) > 0)) + 1
        found += [int(start) for start in starts if start + n <= len(place) and near[start + n // 2]]
    return found


def wrapped(angle: FloatArray) -> FloatArray:
    """Angle between -pi and pi [rad]."""
    return np.angle(np.exp(1j * angle))


def _events(place: FloatArray, kinks: FloatArray, sensor: FloatArray, fast: FloatArray) -> list[float]:
    """The fields of :class:`Passage` from ``exit`` on, of one passage."""
    entry, leaving = ((place >= low) & (place < high) for low, high in (ENTRY, EXIT))
    at_entry, at_exit = (place[some][np.argmax(kinks[some])] for some in (entry, leaving))
    peaks, fast_peaks = (np.abs(signal[leaving]).max() / np.abs(signal[entry]).max() for signal in (sensor, fast))
    shares = [np.sum(fast[some] ** 2) / np.sum(sensor[some] ** 2) for some in (entry, leaving)]
    return [(at_exit + 1) / 2, (at_exit - at_entry) / 2, peaks, fast_peaks, *shares]


def contributions(
    kind: str, width_mm: float, n_seeds: int, seconds: float, depth_um: float = 280, **operation: float
) -> FloatArray:
    """What a spall on the ``inner`` or ``outer`` race adds to the records of the seeds, shape (seed, time) [m s-2]."""
    fault = {"kind": kind, "width_mm": width_mm, "depth_um": depth_um}
    if kind == "inner":
        fault["angle_deg"] = TURNING
    recipe = reference_recipe(fault, n_seeds, operation=operation, recording={"duration_s": seconds})
    scenarios = draw_scenarios(recipe)
    response = accelerations_of(simulate(scenarios + [scenario.without_fault() for scenario in scenarios]))
    damaged, healthy = response[:, 0, timeline(recipe).kept].astype(float).reshape(2, n_seeds, -1)
    return damaged - healthy


def unloading_drop(machine: Machine, bearing: Bearing, angle: float) -> float:
    """Drop at which the ball at ``angle`` [rad] carries nothing, in static equilibrium; NaN if it carries nothing without a spall [m]."""
    of_one = as_columns([machine])
    balls = angle + 2 * np.pi * np.arange(bearing.n_balls)[None] / bearing.n_balls
    without = rest(of_one, balls)
    if ball_forces(of_one, without[:, :2] - without[:, 2:], balls)[0][0, 0] <= 0:
        return math.nan
    pressed = rest(of_one, balls[:, 1:])
    along = (pressed[0, :2] - pressed[0, 2:]) @ (math.cos(angle), math.sin(angle))
    return float(along * machine.contact_cosine - machine.half_clearance)


def unloading_length(kind: str, drop: float, bearing: Bearing) -> float:
    """Distance from the edge of a spall at which a rigid ball has dropped so far [m]."""
    race = bearing.inner_radius if kind == "inner" else -bearing.outer_radius
    return math.sqrt(2 * drop / (1 / bearing.radius("ball") + 1 / race))


def unloads(scenario: Scenario, number: int = 0) -> bool | None:
    """Whether a spall takes all load from a ball; None if no ball carries load where the spall is, or no such machine is possible.

    A spall that turns, on the inner race or on a ball, is taken where the load is largest.
    """
    (given,) = bare_inputs([draw_motion(scenario)])
    if isinstance(given, SimulationError):
        return None
    spall = scenario.spalls[number]
    angle = spall.angle if spall.site == "outer" else scenario.machine["load_angle"]
    needed = unloading_drop(given.machine, scenario.bearing, angle)
    return None if math.isnan(needed) else largest_drop_over(scenario, number) >= needed
