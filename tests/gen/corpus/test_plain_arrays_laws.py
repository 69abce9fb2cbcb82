"""Laws of plain arrays: a corpus gives back the signals, classes and groups that it was written from."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from sklearn.model_selection import GroupKFold

import gen
from gen.corpus import FAULTS
from gen.support.errors import CorpusError

FS, SHAPE = 2000.0, (6, 2, 400)
SIGNALS = np.random.default_rng(0).normal(size=SHAPE).astype(np.float32)
LABELS = {"fault": ["inner", "healthy"] * 3, "specimen": ["b", "a", "b", "c", "c", "a"], "shaft_rpm": 1500.0}


@pytest.mark.parametrize("x", [SIGNALS, SIGNALS[:, 0]], ids=["channels", "one channel"])
@pytest.mark.parametrize(("name", "fs"), [("c", FS), ("c.nc", np.array(FS))])
def test_signals_classes_and_groups_come_back(tmp_path, name, fs, x):
    corpus = gen.write_corpus(x, tmp_path / name, fs=fs, labels=pd.DataFrame(LABELS))
    assert gen.validate_corpus(corpus) == []
    found = gen.to_arrays(corpus)
    np.testing.assert_array_equal(found.X, x.reshape(6, -1, 400))
    assert found.y.tolist() == LABELS["fault"]
    assert found.groups.tolist() == [1, 0, 1, 2, 2, 0]
    for train, test in GroupKFold(3).split(*found):
        assert not set(found.groups[train]) & set(found.groups[test])
    with gen.open_corpus(corpus) as opened:
        assert (opened["shaft_rate"] == 25.0).all()
        assert (opened["sample_rate"] == FS).all()
        assert np.isnan(opened["load"]).all()


def test_the_arrays_of_a_choice_are_those_of_its_records(tmp_path):
    labels = LABELS | {"shaft_rpm": np.arange(6) * 60, "rig": [0, 0, 0, 1, 1, 1], "split": ["train", "test"] * 3}
    corpus = gen.write_corpus(SIGNALS, tmp_path / "c", fs=FS, labels=labels)
    found = gen.to_arrays(corpus, split="train", where="shaft_rpm > 60", channels=["channel_2"], label="shaft_rate")
    np.testing.assert_array_equal(found.X, SIGNALS[[2, 4], 1:])
    np.testing.assert_array_equal(found.y, [2, 4])
    assert len(set(found.groups)) == 2


def test_a_bearing_is_numbered_in_its_rig(tmp_path):
    labels = LABELS | {"specimen": [0] * 6, "rig": [0, 0, 0, 1, 1, 1], "fault": [FAULTS.index("ball")] * 6}
    found = gen.to_arrays(gen.write_corpus(SIGNALS, tmp_path / "c", fs=FS, labels=labels))
    assert found.groups.tolist() == [0, 0, 0, 1, 1, 1]
    assert set(found.y) == {"ball"}


def with_sample(value):
    x = SIGNALS.astype(float)
    x[1, 0, 3] = value
    return x


SHAPES = "give numbers of shape (record, channel, time)"
WRONG = {
    "a sample that is lost": ({"records": with_sample(np.nan)}, {}, "1 of 6 have samples that are not finite"),
    "an infinite sample": ({"records": with_sample(np.inf)}, {}, "1 of 6 have samples that are not finite"),
    "a sample beyond single precision": (
        {"records": with_sample(1e300)},
        {},
        "1 of 6 have samples that are not finite",
    ),
    "one signal": ({"records": SIGNALS[0, 0]}, {}, SHAPES),
    "no signal": ({"records": SIGNALS[:0]}, {}, SHAPES),
    "texts": ({"records": SIGNALS.astype(str)}, {}, SHAPES),
    "four axes": ({"records": SIGNALS[None]}, {}, SHAPES),
    "a Dataset, which has labels of its own": ({"records": xr.Dataset()}, {}, "leave fs and labels out"),
    "a masked signal": (
        {"records": np.ma.masked_greater(SIGNALS, 2)},
        {},
        "records: a masked array has samples that are not known",
    ),
    "masked signals in a list": (
        {"records": [np.ma.masked_greater(signal, 2) for signal in SIGNALS]},
        {},
        "records: a masked array has samples that are not known",
    ),
    "signals of different lengths": (
        {"records": [SIGNALS[0], SIGNALS[1][:-1]]},
        {},
        "have different lengths; cut them",
    ),
    "a bearing that is not known": (
        {},
        {"specimen": [1, np.nan, 2, 2, 3, 3]},
        "labels: specimen is masked or lacks values; give one",
    ),
    "bearings in lists": (
        {},
        {"specimen": [[1], [1, 2], [2], [2], [3], [3]]},
        "specimen has shape (6,) of lists, not one value for each",
    ),
    "a bearing without a name": (
        {},
        {"specimen": ["a", None, *"bbcc"]},
        "labels: specimen is masked or lacks values; give one",
    ),
    "masked speeds": (
        {},
        {"shaft_rpm": np.ma.masked_equal([1500, 0] * 3, 0)},
        "labels: shaft_rpm is masked or lacks values",
    ),
    "no sample rate": ({"fs": None}, {}, "an array needs fs, its sample rate in Hz"),
    "no table": ({"labels": None}, {}, "an array needs fs, its sample rate in Hz, and labels"),
    "two sample rates": ({"fs": np.array([FS, FS])}, {}, "an array needs fs, its sample rate in Hz"),
    "a sample rate of zero": ({"fs": 0.0}, {}, "an array needs fs, its sample rate in Hz"),
    "a sample rate of minus one": ({"fs": -1.0}, {}, "sample_rate is -1 Hz, not one rate from"),
    "a class that is none": ({}, {"fault": ["iner"] * 6}, "fault has no value 'iner'; the nearest is inner."),
    "a code that is none": ({}, {"fault": [99] * 6}, "fault has values other than 0 healthy"),
    "half a bearing": ({}, {"n_spalls": [0.5] * 6}, "n_spalls has no value '0.5'; give numbers."),
    "text for a rate": ({"fs": "12k"}, {}, "an array needs fs, its sample rate in Hz"),
    "a list for a table": ({"labels": [1, 2]}, {}, "an array needs fs, its sample rate in Hz, and labels"),
    "a speed in two units": ({}, {"shaft_rate": [25.0] * 6}, "shaft_rate gives shaft_rate twice; leave one"),
    "a shaft that turns back": ({}, {"shaft_rpm": [-60] * 6}, "shaft_rate has values below 0"),
    "too few labels": ({}, {"fault": ["inner"] * 5}, "fault has shape (5,), not one value for each of 6 records."),
    "words for speeds": ({}, {"shaft_rpm": ["fast"] * 6}, "shaft_rate has no value 'fast'; give numbers."),
    "a column that is none": ({}, {"widht_mm": [1.0] * 6}, "there is no column widht_mm; the nearest is width_mm."),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_what_no_record_can_have_is_one_sentence_and_writes_nothing(tmp_path, wrong):
    arguments, labels, sentence = WRONG[wrong]
    usual = {"records": SIGNALS, "fs": FS, "labels": LABELS | {"shaft_rpm": [1500] * 6} | labels}
    with pytest.raises(CorpusError) as refused:
        gen.write_corpus(target=tmp_path / "c", **usual | arguments)
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)
    assert not any(tmp_path.iterdir())


def test_names_of_bearings_are_any_numbers_and_texts(tmp_path):
    labels = LABELS | {"specimen": [10**12, 5, 10**12, 7, 7, 5]}
    found = gen.to_arrays(gen.write_corpus(SIGNALS, tmp_path / "c", fs=FS, labels=labels))
    assert found.groups.tolist() == [0, 1, 0, 2, 2, 1]
