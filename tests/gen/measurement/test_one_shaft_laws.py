"""Laws of the one shaft: all that the machine locks to it stands at its orders, whatever course the speed takes."""

import numpy as np
import pytest

from gen.mechanisms.path import Modes, transmissibility
from gen.simulation.motion import draw_motion
from gen.simulation.shaft import angles_of
from gen.simulation.timeline import timeline
from tests.measuring import FLOAT, background_of, direct, drawn, lines, quiet

FAST = FLOAT | {"recording.duration_s": 1.0, "operation.shaft_rpm": 1800}
COURSES = {
    "wandering": {"operation.speed_wander_percent": 1},
    "ramp": {"operation.speed_profile": {"kind": "ramp", "from_percent": 50, "to_percent": 130}},
    "run-up": {"operation.speed_profile": {"kind": "run_up", "from_percent": 30, "to_percent": 100, "lasting_s": 0.8}},
    "steps": {"operation.speed_profile": {"kind": "steps", "levels_percent": [60, 100, 80], "step_s": 0.1}},
    "table": {"operation.speed_profile": {"kind": "table", "times_s": [0, 0.4, 1], "percent": [100, 50, 90]}},
}
courses = pytest.mark.parametrize("changes", COURSES.values(), ids=COURSES)
KNOCKING = quiet(knocks={"orders": 3, "level_db": 30})
CROSSED = [
    {"name": "horizontal", "body": "housing", "angle_deg": 0},
    {"name": "vertical", "body": "housing", "angle_deg": 90},
]


def harmonics_of(levels, **keys):
    """Background with harmonics of some orders at their levels [dB], and hardly any others."""
    every = [levels.get(order, -80) for order in range(1, 1 + max(levels))]
    return quiet(harmonics=lines(every) | keys)


def angles_over(scenario):
    """Angle of the shaft over a record, shape (time,) [rad]."""
    return angles_of(draw_motion(scenario))[timeline(scenario.recipe).kept]


def by_order(signal, scenario):
    """Spectrum over orders of the shaft, shape (line,), and orders of the lines [1]; along the true angle."""
    turns = angles_over(scenario) / (2 * np.pi)
    even = np.linspace(turns[0], turns[-1], 4 * len(turns))
    resampled = np.interp(even, turns, signal) * np.hanning(len(even))
    return np.abs(np.fft.rfft(resampled, 4 * len(even))), np.arange(2 * len(even) + 1) / (4 * (even[-1] - even[0]))


def turns_of(scenario):
    """Turns of the shaft in a record; one line of its order spectrum is one over this."""
    return np.ptp(angles_over(scenario)) / (2 * np.pi)


def nearest_line(spectrum, orders, order):
    """Order of the strongest line within a third of an order."""
    near = np.abs(orders - order) < 1 / 3
    return orders[near][np.argmax(spectrum[near])]


@courses
def test_every_harmonic_stands_at_its_order(recipe_with, changes):
    """With 1 % wander the rate at the twelfth harmonic moves by many lines of the spectrum; its order does not."""
    harmonics = harmonics_of(dict.fromkeys((1, 2, 5, 12), 0))
    signals, scenarios = background_of(recipe_with(FAST | changes | harmonics), 2)
    for signal, scenario in zip(signals[:, 0], scenarios, strict=True):
        spectrum, orders = by_order(signal, scenario)
        turns = turns_of(scenario)
        assert turns > 10
        for order in (1, 2, 5, 12):
            assert nearest_line(spectrum, orders, order) == pytest.approx(order, abs=0.5 / turns)


def test_a_harmonic_passes_through_the_path_of_its_channel_at_its_own_frequency(recipe_with):
    modes = {"count": 1, "frequency_hz": 150, "damping_percent": 10, "gain_db": 10, "sign": 1}
    paths = {"direct": {"direct": 1.0}, "resonant": {"direct": 0.5, "modes": modes}}
    channels = [{"name": name, "body": "housing", "angle_deg": 0, "path": path} for name, path in paths.items()]
    steady = {"operation.speed_wander_percent": 0, "operation.label_error_percent": 0}
    recipe = recipe_with(FAST | steady | {"recording.channels": channels} | harmonics_of({5: 40}))
    (signal,), (scenario,) = background_of(recipe)
    found = signal @ np.exp(-5j * angles_over(scenario))
    resonant = transmissibility(drawn(Modes, **modes), np.array([150.0]))[0]
    assert found[1] / found[0] == pytest.approx(complex(0.5 + resonant), rel=0.01)


def test_the_knocks_of_all_records_of_a_rig_come_at_the_same_angles_of_the_shaft(recipe_with):
    wandering = {"path.modes": None, "operation.speed_wander_percent": 1}
    signals, scenarios = background_of(recipe_with(FAST | wandering | KNOCKING), 2)
    of_records = []
    for signal, scenario in zip(signals[:, 0], scenarios, strict=True):
        angles = angles_over(scenario)[np.abs(signal) > 10]
        assert len(angles) == pytest.approx(3 * turns_of(scenario), abs=1)
        of_records.append(np.angle(np.mean(np.exp(3j * angles))))
    one_sample = 3 * 2 * np.pi * 30 / 12_000
    assert np.angle(np.exp(1j * np.diff(of_records)))[0] == pytest.approx(0.0, abs=one_sample)


@courses
def test_knocks_and_the_modulation_of_the_noise_stand_at_their_orders(recipe_with, changes):
    modulated = quiet(modulation={"first": 0.9, "second": 0})
    for background, order in ((KNOCKING, 3), (modulated, 1)):
        signals, (scenario,) = background_of(recipe_with(FAST | changes | {"path.modes": None} | background))
        power = signals[0, 0] ** 2
        spectrum, orders = by_order(power - power.mean(), scenario)
        turns = turns_of(scenario)
        assert nearest_line(spectrum, orders, order) == pytest.approx(order, abs=0.5 / turns)


def test_harmonics_have_the_same_phase_to_the_shaft_in_every_record_of_a_rig(recipe_with):
    signals, scenarios = background_of(recipe_with(FAST | harmonics_of({1: 20, 3: 20})), 2)
    for order in (1, 3):
        phases = [
            np.angle(at_order(one, scenario, order)) for one, scenario in zip(signals[:, 0], scenarios, strict=True)
        ]
        assert phases[0] == pytest.approx(phases[1], abs=0.02)


def at_order(signal, scenario, order):
    """Complex amplitude of a line at an order of the shaft, over the largest whole number of turns."""
    angles = angles_over(scenario)
    whole = angles - angles[0] < 2 * np.pi * np.floor(np.ptp(angles) / (2 * np.pi))
    return 2 * np.mean(signal[whole] * np.exp(-1j * order * angles[whole]))


def test_the_first_harmonic_is_in_phase_with_the_unbalance(recipe_with):
    """A sensor at the direction of the mark of the shaft sees the positive peak of a circular orbit, behind a path without delay."""
    steady = {"recording.channels": CROSSED, "operation.speed_wander_percent": 0}
    signals, (scenario,) = background_of(recipe_with(FAST | direct() | steady | harmonics_of({1: 20})))
    horizontal, vertical = (at_order(one, scenario, 1) for one in signals[0])
    forward = (horizontal + 1j * vertical) / 2  # the part that turns with the shaft
    assert np.angle(forward) == pytest.approx(0.0, abs=0.02)


def test_lines_have_their_level_on_average_over_the_channels_and_a_phase_of_their_own_in_each(recipe_with):
    steady = {"recording.channels": CROSSED, "operation.speed_wander_percent": 0}
    both = quiet(harmonics=lines([0, 6]), tones=lines([10], frequency_hz=1000))
    signals, (scenario,) = background_of(recipe_with(FAST | steady | both))
    for order, level in ((1, 0), (2, 6)):
        x, y = (at_order(one, scenario, order) for one in signals[0])
        assert np.sqrt((abs(x) ** 2 + abs(y) ** 2) / 2) == pytest.approx(np.sqrt(2) * 10 ** (level / 20), rel=0.03)
        assert abs(np.sin(np.angle(x / y))) > 0.05  # not a straight line
    tones = [2 * np.mean(one * np.exp(-2j * np.pi * 1000 * np.arange(len(one)) / 12000)) for one in signals[0]]
    assert np.sqrt(np.mean(np.abs(tones) ** 2)) == pytest.approx(np.sqrt(2) * 10 ** (10 / 20), rel=0.03)


@pytest.mark.parametrize("coherence", [0.0, 0.25, 1.0])
def test_the_noise_of_two_channels_has_the_drawn_coherence(recipe_with, coherence):
    from scipy.signal import coherence as measured

    long = {"recording.channels": CROSSED, "recording.duration_s": 8.0}
    signals, _ = background_of(recipe_with(FAST | long | quiet(coherence=coherence)))
    _, found = measured(*signals[0], 12000, nperseg=256)
    assert found[4:-4].mean() == pytest.approx(coherence, abs=0.02)
    assert np.std(signals[0], axis=1) == pytest.approx([1.0, 1.0], rel=0.03)


def test_harmonics_grow_with_the_drawn_power_of_the_speed(recipe_with):
    steps = {"kind": "steps", "levels_percent": [50, 100], "step_s": 0.01}
    stepped = FAST | {"operation.speed_profile": steps, "operation.speed_wander_percent": 0}
    signals, _ = background_of(recipe_with(stepped | harmonics_of({4: 0}, growth=2)))
    slow, fast = np.std(signals[0, 0][:5500]), np.std(signals[0, 0][6500:])
    noise = np.std(background_of(recipe_with(stepped | quiet()))[0][0, 0])
    assert np.sqrt((slow**2 - noise**2) / (fast**2 - noise**2)) == pytest.approx(0.25, abs=0.05)
