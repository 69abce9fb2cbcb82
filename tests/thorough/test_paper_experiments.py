"""The one constant that makes a statement of the seed paper hold: every experiment is run, and the causes that it refutes as well."""

import itertools
import json
import math

import numpy as np
import pytest

from gen.physics.catalogue import CATALOGUE
from studies.ophel2025.__main__ import main
from studies.ophel2025.experiments import EXPERIMENTS, UNITS, changed, constant, experiment
from studies.ophel2025.paper import PRESETS, SHAFT_MASS, Preset, run_many
from studies.ophel2025.statements import findings

BPFI = CATALOGUE["6205-paper"].n_balls * (1 + CATALOGUE["6205-paper"].gamma) / 2  # orders


def held(presets: list[Preset]) -> list[dict[str, bool]]:
    return [{f.id: f.holds for f in findings("changed", made)} for made in run_many(presets)]


@pytest.fixture(scope="module")
def without():
    return dict(zip(PRESETS, held(list(PRESETS.values())), strict=True))


@pytest.fixture(scope="module")
def changes():
    return held([changed(PRESETS[each.preset], each.change) for each in EXPERIMENTS])


def test_every_statement_that_fails_holds_with_its_one_change(without, changes):
    for each, found in zip(EXPERIMENTS, changes, strict=True):
        if each.holds:
            assert len(each.change) == 1
            assert [(key, without[each.preset][key], found[key]) for key in each.statements] == [
                (key, False, True) for key in each.statements
            ]


def test_the_causes_that_were_wrong_change_nothing(without, changes):
    refuted = [(each, found) for each, found in zip(EXPERIMENTS, changes, strict=True) if not each.holds]
    assert {key for each, _ in refuted for key in each.statements} == {"H8", "C3", "C4", "C5", "C6", "C8"}
    for each, found in refuted:
        assert not any(without[each.preset][key] or found[key] for key in each.statements)


def test_every_statement_that_fails_has_one_experiment_and_no_other_has_one(without):
    for preset, found in without.items():
        failing = [key for key, holds in found.items() if not holds]
        tried = [key for each in EXPERIMENTS if each.holds and each.preset == preset for key in each.statements]
        assert sorted(tried) == sorted(failing)
        for key in found:
            assert (experiment(preset, key) is None) == found[key]


@pytest.mark.parametrize(
    "each", [each for each in EXPERIMENTS if each.holds], ids=lambda each: "-".join((each.preset, *each.statements))
)
def test_a_change_up_to_one_percent_off_does_the_same_unless_it_is_called_narrow(each):
    preset = PRESETS[each.preset]
    ((name, value),) = each.change.items()
    unit = value or constant(preset, name)
    near = held([changed(preset, {name: value + share * unit}) for share in (-0.01, -0.005, 0.005, 0.01)])
    assert all(found[key] for found in near for key in each.statements) is not each.narrow


def contact_mode(preset: Preset, axis: str) -> float:
    """Frequency of shaft against housing, of the linearised preloaded bearing [Hz]."""
    tangent = 1.5 * preset.load_deflection_factor * math.sqrt(-preset.half_clearance)
    rings = preset.ring_stiffness + CATALOGUE["6205-paper"].n_balls / 2 * tangent
    support = constant(preset, f"support_stiffness_{axis}")
    stiffness = np.array([[rings, -rings], [-rings, rings + support]])
    squares = np.linalg.eigvals(stiffness / np.array([[SHAFT_MASS], [preset.housing_mass]]))
    return math.sqrt(squares.real.max()) / (2 * math.pi)


def quotable(preset: Preset) -> set[int]:
    """Frequencies [Hz] and the force of the preload on a ball [N] that a reason may quote, rounded."""
    rate = preset.shaft_rate
    housing = {
        math.sqrt(constant(preset, f"support_stiffness_{axis}") / preset.housing_mass) / (2 * math.pi) for axis in "xy"
    }
    lines = {(3 * BPFI + 1) * rate, (4 * BPFI - 1) * rate, (BPFI + 1) * rate}
    preload = max(-preset.half_clearance, 0.0)
    force = preset.load_deflection_factor * preload**1.5
    modes = {contact_mode(preset, axis) for axis in "xy"} if preload else set()
    return {round(value) for value in (*housing, *lines, *modes, force)}


def test_the_frequencies_and_forces_in_the_reasons_are_those_of_the_presets():
    checked = 0
    for each in EXPERIMENTS:
        known = quotable(PRESETS[each.preset]) | quotable(changed(PRESETS[each.preset], each.change))
        words = each.why.replace(",", "").replace(";", "").split()
        numbers = [float(word) for word, unit in itertools.pairwise(words) if unit in ("Hz", "N")]
        for number in numbers:
            checked += number not in each.change.values()
            assert number in known or number in each.change.values(), (each, number)
    assert checked > 20


def test_load_and_its_angle_change_the_two_components_together():
    preset = changed(PRESETS["paper"], {"load": 50.0, "load_angle": 90.0})
    assert (preset.load_x, preset.load_y) == pytest.approx((0, 50), abs=1e-12)
    assert constant(preset, "load") == pytest.approx(50)
    assert constant(preset, "load_angle") == pytest.approx(90)
    assert changed(PRESETS["paper"], {}) == PRESETS["paper"]
    assert set(UNITS) == {*Preset._fields, "load", "load_angle"}


def test_an_experiment_is_run_by_hand_and_replaces_the_page(tmp_path, capsys):
    for change, name, holds in ((), "paper", False), (("--change", "support_damping_y=4500"), "paper-changed", True):
        assert main(["--preset", "paper", *change, "-o", str(tmp_path)]) == 0
        found = json.loads((tmp_path / "findings.json").read_text())["findings"]
        assert [finding["holds"] for finding in found if finding["id"] == "H8"] == [holds]
        assert {finding["preset"] for finding in found} == {name}
        assert (
            f"{name}: {sum(finding['holds'] for finding in found)} of {len(found)} statements hold."
            in capsys.readouterr().out
        )
    assert "paper-changed" in (tmp_path / "ophel2025.html").read_text()
