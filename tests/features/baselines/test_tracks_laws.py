"""Laws of the tracks: no specimen on both sides, tested groups that were not trained, and controls that say so."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.baselines import TRACKS, benchmark, controls, cross_validate
from features.baselines.records import records_of
from features.baselines.tracks import ranges, track_splits
from gen.support.errors import CorpusError
from tests.features.baselines.test_baselines_laws import make_table

GROUPS = ("lines", "shape")
pytestmark = pytest.mark.usefixtures("few_trees")


def varied_table(specimens=48, records=3, *, ladder=False, seed=0, **made):
    """A feature table with speeds and bearings; with ``ladder``, every third record is healthy."""
    table = make_table(specimens, records, rigs=12, seed=seed, **made)
    rng = np.random.default_rng(seed)
    specimen = table.specimen.values
    fault = np.where((np.arange(len(specimen)) % 3 == 0) & ladder, 0, table.fault.values)
    balls = 7 + np.arange(12) % 4
    columns = {
        "fault": fault.astype(np.int8),
        "shaft_rate": rng.uniform(10, 50, len(specimen)),
        "bpfo": 0.4 * balls[table.rig.values],
        "bpfi": 0.6 * balls[table.rig.values],
    }
    return table.assign({name: ("record", values) for name, values in columns.items()})


def records(**options):
    return records_of(varied_table(**options), GROUPS)


tables = st.fixed_dictionaries({"seed": st.integers(0, 50), "ladder": st.booleans(), "records": st.integers(1, 4)})


def group_of(found, track):
    """Group of each record that a track may not train and test in one split; None for any group."""
    if track in ("specimen", "rig"):
        return getattr(found, track)
    if track == "speed":
        return ranges(found.shaft_rate, 4)
    return found.bearing


@pytest.mark.parametrize("track", TRACKS)
@given(options=tables, folds=st.integers(2, 5))
def test_no_specimen_is_on_both_sides_no_record_is_tested_twice_and_tested_groups_were_not_trained(
    track, options, folds
):
    found = records(**options)
    group, splits = group_of(found, track), track_splits(found, found.fault, track, folds, options["seed"])
    tested = np.concatenate([test for _, test in splits])
    assert len(np.unique(tested)) == len(tested)
    assert len(tested) == len(found.fault) or track not in ("specimen", "rig")
    assert set(found.specimen[tested]) == set(found.specimen)
    assert set(found.fault[tested]) == set(found.fault)
    for train, test in splits:
        assert len(train)
        assert set(found.fault[train]) == set(found.fault) or track not in ("specimen", "rig")
        assert not set(found.specimen[train]) & set(found.specimen[test])
        if folds == 4:  # the groups of speed are four ranges here
            asked = set(group[test]) - {-1}
            assert asked
            assert not asked & set(group[train])


def test_a_bearing_type_is_that_of_the_first_record_of_a_specimen():
    table = varied_table()
    first = records_of(table, GROUPS).bearing
    assert len(np.unique(first)) == 4
    table.bpfo.values[np.flatnonzero(table.specimen == 0)[1:]] += 1
    np.testing.assert_array_equal(records_of(table, GROUPS).bearing, first)


@given(seed=st.integers(0, 100))
def test_a_range_of_speeds_in_which_no_specimen_is_tested_makes_no_fold(seed):
    found = records(specimens=8, records=6)
    found = found._replace(shaft_rate=np.tile([10.0, 20, 30, 40, 50, 60], 8))
    splits = track_splits(found, found.fault, "speed", 6, seed)
    assert all(len(test) for _, test in splits)
    assert set(found.specimen[np.concatenate([test for _, test in splits])]) == set(found.specimen)


@pytest.mark.parametrize("track", TRACKS)
def test_random_labels_score_high_in_a_leaky_split_and_at_chance_on_every_track(track):
    table = varied_table(96, 5, told=0.0, signature=5.0)
    found = controls(table, "extra_trees", track=track, folds=4)
    grouped = cross_validate(table, "extra_trees", track=track, folds=4)
    assert found["leaky"].balanced_accuracy > 0.9
    assert grouped.balanced_accuracy < 0.4
    assert found["null"].balanced_accuracy < 0.4


@pytest.mark.parametrize("track", TRACKS)
def test_the_null_control_is_at_chance_although_the_labels_are_told_by_the_features(track):
    scores = []
    for seed in range(3):
        found = controls(varied_table(96, 2, seed=seed), "logistic_regression", track=track, folds=4, seed=seed)
        scores.append(found["null"].balanced_accuracy)
    assert 0.15 < np.mean(scores) < 0.3


@pytest.mark.parametrize(
    ("track", "changed", "sentence"),
    [
        ("bearing", {"bpfo": 3.0, "bpfi": 5.0}, "1 bearing type.s. cannot fill 5 folds; test on another corpus"),
        ("speed", {"shaft_rate": 30.0}, "there is only one labelled shaft rate, or none; choose another track"),
    ],
)
def test_a_track_without_groups_is_refused_in_one_sentence(track, changed, sentence):
    table = varied_table()
    plain = table.assign({name: ("record", np.full(144, value)) for name, value in changed.items()})
    with pytest.raises(CorpusError, match=sentence):
        cross_validate(plain, "majority", track=track)


@pytest.mark.parametrize(
    "score",
    [lambda table: cross_validate(table, "majority", track="rgi"), lambda table: benchmark(table, tracks=("rgi",))],
)
def test_a_track_that_does_not_exist_is_refused_with_the_names_of_all(score):
    with pytest.raises(ValueError, match=r"^track: 'rgi' does not exist; choose from specimen, rig, bearing, speed"):
        score(varied_table())


def test_tracks_without_groups_are_left_out():
    table = varied_table()
    one = table.assign(bpfo=0 * table.bpfo + 3.0, bpfi=0 * table.bpfi + 5.0, shaft_rate=0 * table.shaft_rate + 30.0)
    results = benchmark(one, tracks="all", estimators={"majority": "majority"}, folds=3)
    assert set(results.left_out) == {"bearing", "speed"}
    assert (results.track, set(results.further)) == ("specimen", {*TRACKS} - {"specimen", "bearing", "speed"})
