"""``raceway limit`` and ``raceway.limit`` on a ladder that is simulated, and on records and tables made by hand."""

import numpy as np
import pytest
import xarray as xr

import raceway
from features import feature_table
from gen.corpus import FAULTS, UNKNOWN_CODE
from gen.corpus.simulated import UNJUDGED
from gen.support.errors import CorpusError
from raceway.visibility.limit_picture import draw_limits
from tests.pulses import write_pulses
from tests.recipes import LADDER

TWIN_SEES = {"seen_50": 0.1040e-3, "seen_90": 0.1553e-3}
"""Widths [m] of 2,000 other records of the ladder; `tests/thorough/test_limit_truth.py` finds them again."""


def sized(folder, **changed):
    """Feature table of pulses, 30 records of each of two classes, the outer ones of 0.1 to 1 mm; those from 0.3 mm on can be seen."""
    width = np.append(np.zeros(30), np.geomspace(0.1e-3, 1e-3, 30))
    write_pulses(folder, classes=("healthy", "outer"), records=30, duration=0.2, width=width, **changed)
    return feature_table(folder).assign(detectable=("record", (width > 0.3e-3).astype(np.int8)))


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    return sized(tmp_path_factory.mktemp("limits") / "corpus")


def test_the_twin_sees_a_ladder_of_400_records_as_it_sees_2000_others(told, write_recipe, tmp_path):
    recipe = write_recipe(tmp_path / "ladder.yaml", LADDER | {"seed": 3})
    told_limits = told("limit", recipe, "--workers", 1)
    twin, classifier = told_limits["limits"]
    assert told_limits["durations"] == [0.2, 0.2]
    for name, truth in TWIN_SEES.items():
        size, low, high = twin[name]
        assert low < size < high
        # an interval of two standard deviations misses the truth one time in twenty, one of six never
        assert (low / size) ** 3 <= truth / size <= (high / size) ** 3
    # faint faults are seen in few records, plain ones in all
    for limit in (twin, classifier):
        assert (limit["fault"], limit["variable"], limit["unit"]) == ("outer", "width", "m")
        shares = [width_bin["detected"] for width_bin in limit["bins"]]
        assert shares[0] < 0.5 < shares[2]
        assert shares[-3:] == [1, 1, 1]


def test_sizes_are_those_from_which_records_can_be_seen(table):
    twin, classifier = raceway.limit(table, estimator="logistic_regression")
    assert (twin.criterion, classifier.criterion) == ("twin", "classifier")
    assert twin.seen_50[0] == pytest.approx(0.3e-3, rel=0.05)
    assert twin.text(twin.seen_50).startswith("0.292 mm (0.2")
    # pulses of every width are plain
    assert classifier.text(classifier.seen_90) == "< 0.1 mm (< 0.1 to < 0.1)"


def test_records_that_were_not_judged_or_are_of_unknown_class_do_not_count(table):
    options = {"estimator": "logistic_regression"}
    twin, classifier = raceway.limit(table, **options)
    unjudged = table.assign(detectable=("record", np.full(60, UNJUDGED, np.int8)))
    (alone,) = raceway.limit(unjudged, **options)
    assert alone == classifier
    (without,) = raceway.limit(table.drop_vars("detectable"), **options)
    assert without == classifier
    more = xr.concat(
        [table, table.isel(record=range(40, 60)).assign(fault=("record", np.full(20, UNKNOWN_CODE)))], "record"
    )
    assert raceway.limit(more, **options) == [twin, classifier]


def test_a_fault_without_a_width_has_its_own_size(table):
    cage = table.rename(width="knock").assign(fault=table["fault"].where(table["fault"] == 0, FAULTS.index("cage")))
    cage["knock"].attrs["units"] = "N"
    twin, _ = raceway.limit(cage, estimator="logistic_regression")
    assert (twin.fault, twin.variable, twin.text(twin.seen_50)[-1]) == ("cage", "knock", ")")
    assert " N (" in twin.text(twin.seen_50)


def test_the_picture_has_a_panel_for_each_class_and_a_curve_for_each_criterion(table):
    limits = raceway.limit(table, estimator="logistic_regression")
    (axes,) = draw_limits(limits).axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["twin", "classifier"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("width [mm]", "outer seen")
    assert {label.get_text().strip("0.")[:1] for label in axes.get_xticklabels()} <= {"1", "2", "5"}
    assert [label.get_text() for label in axes.get_yticklabels()] == ["0 %", "50 %", "90 %", "100 %"]


HEALTHY, OUTER = range(30), range(30, 60)


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        (lambda t: t.isel(record=OUTER), r"has no healthy records; make more, or add kind: healthy"),
        (lambda t: t.isel(record=HEALTHY), r"has no faulty records; make more, or add"),
        (lambda t: t.isel(record=range(41)), r"11 outer record\(s\) are too few; make 20 or more of each class\.$"),
        (lambda t: t.assign(width=(t["width"] > 0) * 0.5e-3), r"no class has a size that varies; draw it, such as width_mm: loguniform\("),
        (lambda t: t.drop_vars("width"), r"no class has a size that varies"),
        (lambda t: t.assign(fault_tries=t["fault"]), r"were drawn again, or labelled healthy \(truth\.undetected\)"),
        (lambda t: t.assign(fault_share=0.1 + 0 * t["width"]), r"or labelled healthy \(truth\.undetected\); give the recipe"),
        (lambda t: t.assign(rig=0 * t["rig"], specimen=t["fault"]), r"a class is on one specimen alone; make two or more"),
    ],
)  # fmt: skip
def test_records_that_give_no_limit_are_refused_in_one_sentence(table, changed, sentence):
    with pytest.raises(CorpusError, match=sentence):
        raceway.limit(changed(table))


def test_a_recipe_that_gives_no_limit_is_refused_before_its_records_are_made(run, write_recipe, tmp_path):
    healthy, *faulty = LADDER["faults"]
    fixed = [healthy, *(fault | {"width_mm": 0.5} for fault in faulty)]
    for name, faults, lacking in (
        ("healthy", [healthy], "has no faulty"),
        ("faulty", faulty, "has no healthy"),
        ("fixed", fixed, "no class has a size that varies"),
    ):
        recipe = write_recipe(tmp_path / f"{name}.yaml", LADDER | {"faults": faults})
        result = run("limit", recipe)
        assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1), result.output
        assert f"{name}.yaml: {lacking}" in result.stderr


def test_few_healthy_records_are_told_and_a_corpus_takes_no_number_of_records(run, tmp_path):
    sized(tmp_path / "corpus")
    result = run("limit", tmp_path / "corpus", "--workers", 1)
    assert "warning: 30 healthy records are too few for false alarms of 1 %" in result.stderr
    assert "On a recorded background this needs a longer recording" in result.stderr
    assert result.stdout.splitlines()[-1] == "Records of 0.2 s."
    refused = run("limit", tmp_path / "corpus", "--records", 10)
    assert refused.exit_code == 2
    assert "give --records with a recipe" in refused.stderr
