"""Statements of the seed paper: those that held when they were first measured still hold, with the same values."""

import math

import numpy as np
import pytest

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import load_deflection_factor
from studies.ophel2025.measures import modulation, oscillations
from studies.ophel2025.page import draw_figure
from studies.ophel2025.paper import CHANNELS, FIGURES, FS, PRESETS, power_spectrum, run
from studies.ophel2025.statements import LATE, STATEMENTS, findings

# values of the model study, in thousandths of a millimetre, Hz or 1, that the runs must meet within 2 %
PAPER = {
    "H1": 5.61, "H2": 9.74, "H4": 8.30, "H5": 4.53, "H6": 1.83, "H7": 1.44, "H10": 0.87, "H11": 0.843, "H12": 0.891, "H14": 226, "H15": 226,
    "C3": 11.5, "C5": 4.22, "C6": -5.95, "C7": 4.53, "C10": 3, "C12.y1": 771.6, "C12.y2": 771.6,
}  # fmt: skip
PAPER_HERTZ = {"H1": 4.63, "H2": 8.63, "H4": 8.31, "H7": 0.93, "C3": 7.9, "C7": 4.33, "C12.y1": 773.7}


@pytest.fixture(scope="module")
def runs():
    return {name: run(preset) for name, preset in PRESETS.items()}


@pytest.mark.parametrize(("preset", "values"), [("paper", PAPER), ("paper-hertz", PAPER_HERTZ)])
def test_the_statements_have_the_values_they_had(runs, preset, values):
    found = {finding.id: finding.value for finding in findings(preset, runs[preset])}
    assert {key: found[key] for key in values} == pytest.approx(values, rel=0.02)


@pytest.mark.parametrize(
    ("preset", "fitted", "all_of_them"), [("paper", 30, 44), ("paper-hertz", 27, 42), ("paper-refit", 33, 47)]
)
def test_at_least_as_many_statements_hold_as_did(runs, preset, fitted, all_of_them):
    found = findings(preset, runs[preset])
    assert len(found) == len({finding.id for finding in found}) == 55
    assert sum(finding.fitted for finding in found) == 37
    assert sum(finding.holds for finding in found if finding.fitted) >= fitted
    assert sum(finding.holds for finding in found) >= all_of_them


def test_noise_of_the_colour_of_the_crack_is_not_modulated(runs):
    """The envelope of Gaussian noise varies by sqrt(4 / pi - 1) = 0.52, but not in step with the shaft."""
    rng = np.random.default_rng(0)
    accepted = STATEMENTS["C9"].accept[0]
    for made in runs.values():
        for x in made.cracked[:, round(LATE * FS) :]:
            power = np.convolve(
                np.abs(np.fft.rfft(x - x.mean())) ** 2, np.ones(48), "same"
            )  # lines become bands of 50 Hz
            shaped = np.sqrt(power) * (rng.normal(size=(10, power.size)) + 1j * rng.normal(size=(10, power.size)))
            noise = np.fft.irfft(shaped, x.size)
            assert max(modulation(one, FS / made.shaft_rate) for one in noise) < accepted


def test_the_depth_of_a_modulation_in_step_with_the_shaft_is_measured():
    time = np.arange(38_000) / FS
    x = (1 + 0.4 * np.sin(2 * np.pi * 45 * time)) * np.sin(2 * np.pi * 740 * time)
    assert modulation(x, FS / 45) == pytest.approx(0.4 / math.sqrt(2), rel=0.01)
    assert modulation(x, FS / 41) < 0.05


def test_oscillations_before_005_s_are_counted():
    time = np.arange(FS) / FS
    assert oscillations(time, 5 + np.exp(-60 * time) * np.cos(2 * np.pi * 201 * time)) == 10


def test_the_refit_has_the_contact_of_the_geometry_and_the_weight_of_the_rotor_pulling_as_the_figures_show():
    preset = PRESETS["paper-refit"]
    assert preset.load_deflection_factor == pytest.approx(load_deflection_factor(CATALOGUE["6205-paper"]), rel=1e-9)
    assert math.hypot(preset.load_x, preset.load_y) == pytest.approx(5.5 * 9.81)
    assert preset.ring_stiffness == 0
    assert preset.load_x > 0
    assert preset.load_y > 0


def test_the_values_do_not_depend_on_the_step(runs):
    fine = {finding.id: finding.value for finding in findings("paper", run(PRESETS["paper"], 8 * FS))}
    for key in ("H1", "H2", "H5", "C3", "C5", "C6", "C7"):
        coarse = next(finding.value for finding in findings("paper", runs["paper"]) if finding.id == key)
        assert math.isclose(coarse, fine[key], rel_tol=0.01), key


@pytest.mark.parametrize("number", FIGURES)
def test_the_figures_show_the_run_and_the_printed_values(runs, number):
    _, state, spectral = FIGURES[number]
    figure = draw_figure(number, runs["paper"])
    for axes, name, x in zip(figure.axes, CHANNELS, getattr(runs["paper"], state), strict=True):
        line = axes.lines[0].get_ydata()
        expected = power_spectrum(x)[1][1:] if spectral else x
        assert np.array_equal(line, expected[: len(line)])
        about = [one for one in STATEMENTS.values() if (one.figure, one.channel) == (number, name)]
        texts = {text.get_text() for text in axes.texts}
        assert texts == {"–".join(f"{value:g}" for value in one.printed) for one in about if one.printed}
