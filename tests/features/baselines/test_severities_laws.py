"""Laws of the fault widths that a test contains and its training does not."""

import json

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.baselines import Model, benchmark, cross_validate
from features.baselines.records import Records
from features.baselines.results_file import write_results
from features.baselines.severities import covered_widths, severity_warning, uncovered_in_splits, uncovered_widths
from tests.model_files import make_table

INNER, OUTER = 1, 2
widths_mm = st.lists(st.floats(0.1, 5.0), min_size=1, max_size=12)


def records_of(widths_of_specimens, fault=INNER, records=3):
    """Records of specimens of one class with the given widths [mm]."""
    specimen = np.repeat(np.arange(len(widths_of_specimens)), records)
    width = 1e-3 * np.repeat(widths_of_specimens, records)
    code, unused = np.full(len(specimen), fault), np.zeros(len(specimen), int)
    return Records("made up", pd.DataFrame(index=range(len(specimen))), code, unused, specimen, specimen, width)


def uncovered(trained, tested):
    """Widths [mm] of the inner race that are tested and not trained."""
    found = uncovered_widths(covered_widths(records_of(trained)), records_of(tested))
    return tuple(round(1e3 * width, 9) for width in found.get("inner", ()))


@given(widths_mm)
def test_a_training_covers_its_own_widths(widths):
    assert uncovered(widths, widths) == ()


@given(widths_mm, widths_mm)
def test_a_width_far_outside_the_range_of_training_is_always_uncovered(trained, tested):
    low, high = min(trained), max(trained)
    outside = {round(width, 9) for width in tested if width < 0.79 * low or width > 1.26 * high}
    assert outside <= set(uncovered(trained, tested))


@given(st.lists(st.floats(0.1, 5.0), min_size=2, max_size=12, unique=True), st.floats(0, 1))
def test_a_range_of_widths_covers_all_widths_between_its_ends(trained, place):
    assert uncovered(trained, [min(trained) + place * (max(trained) - min(trained))]) == ()


def test_a_level_that_only_the_test_has_is_uncovered_although_it_lies_between_trained_levels():
    assert uncovered([0.5, 0.5, 1.5, 1.5], [1.0, 1.0]) == (1.0,)
    assert uncovered([0.5, 0.5, 1.5, 1.5], [1.6, 1.4]) == (1.4, 1.6)
    assert uncovered([0.5, 0.5, 1.0, 1.0, 1.5, 1.5], [1.0, 1.0]) == ()


def test_a_width_near_the_ends_of_a_range_is_covered():
    assert uncovered([0.5, 1.0, 2.0], [0.39, 0.41, 2.4, 2.6]) == (0.39, 2.6)


def test_a_healthy_or_unknown_width_and_a_class_that_was_not_trained_are_no_severities():
    assert covered_widths(records_of([0.0, np.nan])) == {}
    assert uncovered([1.0], [0.0, np.nan]) == ()
    assert uncovered_widths(covered_widths(records_of([1.0])), records_of([3.0], OUTER)) == {}


@given(st.permutations(range(4)))
def test_the_widths_of_all_splits_are_joined(order):
    records = records_of([0.5, 1.0, 2.0, 3.0], records=1)
    splits = [(np.setdiff1d(np.arange(4), [n]), np.array([n])) for n in order]
    assert uncovered_in_splits(records, splits) == {"inner": (0.0005, 0.003)}


def test_the_warning_is_one_sentence_that_names_each_class_with_its_widths():
    assert severity_warning({"inner": (0.0014,), "ball": (0.0002, 0.0003, 0.0004)}) == (
        "tested but not trained: inner 1.4 mm wide, ball 0.2 to 0.4 mm wide; "
        "the scores of these classes include extrapolation."
    )


def with_widths(table, of_inner):
    """The same table with widths [m] for the records of the inner race, in turn."""
    inner = table.fault.values == INNER
    width = np.where(table.fault.values == 0, 0.0, 1e-3)
    width[inner] = np.resize(of_inner, inner.sum())
    return table.assign(width=("record", width))


@pytest.fixture(scope="module")
def table():
    return with_widths(make_table(records=48), [0.5e-3, 1e-3])


def test_a_model_knows_its_widths_after_it_was_saved_and_says_which_others_it_is_tested_on(table, tmp_path):
    Model("logistic_regression").fit(table).save(tmp_path / "m")
    model = Model.load(tmp_path / "m")
    assert {name: len(intervals) for name, intervals in model.widths.items()} == {"inner": 2, "outer": 1}
    assert model.score(table).uncovered_widths == {}
    other = with_widths(make_table(records=48, seed=1), [0.7e-3, 2e-3])
    assert model.score(other).uncovered_widths == {"inner": (0.7e-3, 2e-3)}


@given(st.integers(0, 5))
def test_a_cross_validation_that_leaves_a_severity_out_of_training_says_so(seed):
    alone = with_widths(make_table(records=48), [3e-3] + [1e-3] * 15)
    assert cross_validate(alone, "majority", folds=4, seed=seed).uncovered_widths == {"inner": (3e-3,)}


def test_the_results_of_a_benchmark_contain_the_severities_of_both_tests(table, tmp_path):
    other = with_widths(make_table(records=48, seed=1), [2e-3])
    alone = with_widths(table, [3e-3] + [1e-3] * 15)
    results = benchmark(alone, other, folds=4, estimators={"majority": "majority"})
    assert results.uncovered_widths == {"inner": (3e-3,)}
    assert results.baselines["majority"].tests[0].uncovered_widths == {"inner": (2e-3,)}
    write_results(results, tmp_path / "results.json")
    assert json.loads((tmp_path / "results.json").read_text())["uncovered_widths"] == {"inner": [3e-3]}
