"""The benchmark of shortcuts: it finds one that is there, none among permuted labels, and permutes the bearings of a rig."""

import numpy as np
import pytest

from benchmarks.shortcuts import KURTOSIS, STORED, Shortcuts, in_signal, permuted, scores
from features import open_waveforms
from gen import open_corpus, torch_dataset

RIGS, SPECIMENS, EACH = 20, 6, 3


@pytest.fixture
def records():
    """Half the bearings of every rig are faulty; one value tells them by an offset, the other does not."""
    rng = np.random.default_rng(0)
    specimen = np.repeat(np.arange(RIGS * SPECIMENS), EACH)
    faulty, ball, noise = specimen % 2 == 1, specimen % 6 == 3, rng.standard_normal((len(specimen), 3))
    shortcuts = {
        "offset": noise[:, :1] + 3 * faulty[:, None],
        "noise": noise[:, 1:2],
        # races alone would hide what tells the balls
        KURTOSIS: noise[:, 2:] + 4 * ball[:, None],
    }
    return Shortcuts(shortcuts, faulty, specimen // SPECIMENS, specimen, ball)


def test_an_offset_of_faulty_records_is_a_shortcut_and_noise_is_none(records):
    found = {name: (auc, np.mean(null)) for name, auc, null in scores(records, 0, 3)}
    assert found["offset"][0] > 0.95
    assert found[KURTOSIS][0] > 0.95
    assert abs(found["noise"][0] - 0.5) < 0.1  # 3 standard errors of 180 + 180 records
    assert all(abs(null - 0.5) < 0.1 for _, null in found.values())


def test_permuted_labels_stay_in_their_rig_and_are_the_same_for_all_records_of_a_bearing(records):
    label = permuted(records, np.random.default_rng(0))
    assert (label != records.faulty).any()
    for group, of_one in ((records.rig, {SPECIMENS * EACH // 2}), (records.specimen, {0, EACH})):
        assert {int(label[group == one].sum()) for one in np.unique(group)} == of_one


def test_shares_of_power_are_those_of_tones_and_no_shortcut_but_the_rms_knows_the_gain():
    fs, t = 1000.0, np.arange(1000) / 1000
    x = 0.1 + np.sin(2 * np.pi * 10 * t) + 2 * np.sin(2 * np.pi * 200 * t) + np.sin(2 * np.pi * 470 * t)
    found, louder = in_signal(x, fs), in_signal(7 * x, fs)
    assert np.exp(found["power below 20 Hz"]) == pytest.approx(1 / 6)
    assert np.exp(found["power above 0.9 of half the sample rate"]) == pytest.approx(1 / 6)
    assert found["mean over rms"] == pytest.approx(0.1 / np.sqrt(3))
    assert louder.pop("rms") == pytest.approx(7 * found.pop("rms"))
    assert all(louder[name] == pytest.approx(values) for name, values in found.items())


def test_loaders_give_estimators_no_variable_of_a_shortcut(tiny_corpus):
    shortcuts = {variable for variables in STORED.values() for variable in variables}
    assert shortcuts <= set(open_corpus(tiny_corpus).variables)
    for loader in (open_waveforms(tiny_corpus), torch_dataset(tiny_corpus)):
        assert not shortcuts & set(loader.operating)
