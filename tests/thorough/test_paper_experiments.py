"""The one constant that makes a statement of the seed paper hold: every experiment is run, and the causes that it refutes as well."""

import json

import pytest

from studies.ophel2025.__main__ import main
from studies.ophel2025.experiments import EXPERIMENTS, changed, constant, experiment
from studies.ophel2025.paper import PRESETS, Preset, run_many
from studies.ophel2025.statements import findings


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
