"""Statements of the seed paper: those that held when they were first measured still hold, with the same values."""

import math

import numpy as np
import pytest

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import load_deflection_factor
from raceway.studies.paper import CHANNELS, FIGURES, FS, PRESETS, draw_figures, power_spectrum, run
from raceway.studies.statements import findings

# values of the model study, in thousandths of a millimetre, Hz or 1, that the runs must meet within 2 %
PAPER = {
    "H1": 5.61, "H2": 9.74, "H4": 8.30, "H5": 4.53, "H6": 1.83, "H7": 1.44, "H10": 0.87, "H11": 0.87, "H12": 0.891, "H14": 226, "H15": 226,
    "C3": 11.5, "C5": 4.22, "C6": -5.95, "C7": 4.53, "C9": 0.40, "C10": 3, "C12.y1": 771.6, "C12.y2": 771.6,
}  # fmt: skip
PAPER_HERTZ = {"H1": 4.63, "H2": 8.63, "H4": 8.31, "H7": 0.93, "C3": 7.9, "C7": 4.33, "C9": 0.48, "C12.y1": 773.7}


@pytest.fixture(scope="module")
def runs():
    return {name: run(preset) for name, preset in PRESETS.items()}


@pytest.mark.parametrize(("preset", "values"), [("paper", PAPER), ("paper-hertz", PAPER_HERTZ)])
def test_the_statements_have_the_values_they_had(runs, preset, values):
    found = {finding.id: finding.value for finding in findings(preset, runs[preset])}
    assert {key: found[key] for key in values} == pytest.approx(values, rel=0.02)


@pytest.mark.parametrize(
    ("preset", "fitted", "all_of_them"), [("paper", 33, 49), ("paper-hertz", 29, 45), ("paper-refit", 35, 51)]
)
def test_at_least_as_many_statements_hold_as_did(runs, preset, fitted, all_of_them):
    found = findings(preset, runs[preset])
    assert len(found) == len({finding.id for finding in found}) == 61
    assert sum(finding.fitted for finding in found) == 38
    assert sum(finding.holds for finding in found if finding.fitted) >= fitted
    assert sum(finding.holds for finding in found) >= all_of_them


def test_every_channel_is_judged_where_the_paper_speaks_of_all(runs):
    """Growth, decay, steadiness, modulation and the cluster at 650-800 Hz: one statement for each of the four displacements."""
    found = {finding.id for finding in findings("paper", runs["paper"])}
    for key, first in (("C1", "x1"), ("H3", "x1"), ("H9", "x1"), ("C9", "y1")):
        assert {key, *(f"{key}.{name}" for name in CHANNELS if name != first)} <= found
    assert {f"C16.{name}" for name in CHANNELS} <= found
    assert {"H12", "H12.y", "C17.x", "C17.y", "C18"} <= found


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


def test_figures_carry_the_numbers_of_the_paper():
    """Displacements are figures 3 and 4, power spectra 5 and 6; of each pair the healthy bearing comes first."""
    numbered = {number: (state, spectral) for number, _, state, spectral in FIGURES}
    assert numbered == {
        "figure3": ("healthy", False),
        "figure4": ("cracked", False),
        "figure5": ("healthy", True),
        "figure6": ("cracked", True),
    }


def test_the_figures_show_what_their_numbers_say(runs):
    made = runs["paper"]
    drawn = dict(draw_figures(made))
    assert list(drawn) == ["figure3", "figure4", "figure5", "figure6"]
    for number, state, spectral in (
        (3, "healthy", False),
        (4, "cracked", False),
        (5, "healthy", True),
        (6, "cracked", True),
    ):
        figure = drawn[f"figure{number}"]
        title = figure.get_suptitle()
        assert title.startswith(f"Figure {number}. {state.capitalize()}")
        assert title.endswith("power spectra" if spectral else "displacements")
        for axes, x in zip(figure.axes, getattr(made, state), strict=True):
            line = axes.lines[0].get_ydata()
            expected = power_spectrum(x)[1][1:] if spectral else x
            assert np.array_equal(line, expected[: len(line)])
