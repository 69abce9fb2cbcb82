"""Laws of waveforms: they are the stored signals, read when they are indexed, and are classified like features."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import FunctionTransformer

from features import open_waveforms
from features.baselines import controls, cross_validate
from features.table.waveforms import _samples_in_turns
from gen.corpus import UNKNOWN_CODE
from gen.support.errors import CorpusError
from tests.tone_corpora import FS, TONES, write_corpus


def psd(X):
    return np.square(np.abs(np.fft.rfft(np.asarray(X)))) / X.shape[1]


ON_THE_PSD = make_pipeline(FunctionTransformer(psd), LogisticRegression(max_iter=500))


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tones") / "corpus"
    return folder, write_corpus(folder)


def test_waveforms_are_the_stored_signals_however_they_are_indexed(corpus):
    folder, signal = corpus
    X = open_waveforms(folder)
    assert (X.shape, X.dtype, X.ndim, len(X)) == (signal.shape, np.float32, 2, len(signal))
    np.testing.assert_array_equal(np.asarray(X), signal)
    np.testing.assert_array_equal(X[20:30], signal[20:30])
    np.testing.assert_array_equal(X[[40, 3, 3]], signal[[40, 3, 3]])
    np.testing.assert_array_equal(X[np.arange(48) % 5 == 0], signal[::5])
    np.testing.assert_array_equal(X[-1], signal[-1])
    np.testing.assert_array_equal(np.stack(list(X)), signal)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(X))[2:4], signal[2:4])  # noqa: S301


def test_chosen_waveforms_keep_their_labels_and_read_nothing(corpus, monkeypatch):
    folder, signal = corpus
    X = open_waveforms(folder)
    with monkeypatch.context() as patch:
        patch.setattr(type(X), "_read", lambda *_: pytest.fail("signals were read"))
        chosen = X.take([30, 2, 11]).take([2, 0])
    np.testing.assert_array_equal(chosen[:], signal[[11, 30]])
    np.testing.assert_array_equal(chosen.labels.specimen, [3, 10])


def test_a_slice_decodes_a_limited_number_of_records_at_a_time(corpus, monkeypatch):
    folder, signal = corpus
    X, sizes = open_waveforms(folder), []
    monkeypatch.setattr("features.table.waveforms.BLOCK", 10)
    read = type(X)._read
    monkeypatch.setattr(type(X), "_read", lambda self, rows: sizes.append(len(rows)) or read(self, rows))
    np.testing.assert_array_equal(X[:], signal)
    assert sizes == [10, 10, 10, 10, 8]


def test_a_normalised_record_has_no_mean_and_an_rms_of_one(corpus):
    X = open_waveforms(corpus[0], normalise=True)[:]
    np.testing.assert_allclose(X.mean(axis=1), 0, atol=1e-6)
    np.testing.assert_allclose(np.square(X).mean(axis=1), 1, rtol=1e-5)


def test_a_resampled_record_has_its_tone_at_the_order_of_its_class(corpus):
    X = open_waveforms(corpus[0], per_turn=64)
    turns = X.shape[1] // 64
    assert turns == int(X.labels.shaft_rate.min() * 1000 / FS)
    lines = np.abs(np.fft.rfft(X[:]))[:, 1:].argmax(axis=1) + 1
    np.testing.assert_array_equal(lines / turns, np.array(TONES)[X.labels.fault])


@given(turns=st.integers(1, 500), fs=st.sampled_from([12_000.0, 12_800.0, 25_600.0, 48_000.0, 97_656.25]))
def test_a_record_of_whole_turns_keeps_all_of_them(turns, fs):
    samples = 2 * int(fs)
    rates = xr.Dataset({"shaft_rate": ("record", [turns * fs / samples]), "sample_rate": ("record", [fs])})
    assert _samples_in_turns("tones", rates, samples, 64, None) == 64 * turns


def test_turns_beyond_the_end_of_a_record_are_zero(corpus):
    X = open_waveforms(corpus[0], per_turn=64, turns=12)
    assert X.shape == (48, 768)
    assert not X[:][:, -64:].any()


def test_a_pipeline_on_the_psd_is_cross_validated_with_its_controls(corpus):
    X = open_waveforms(corpus[0], normalise=True, per_turn=64)
    scores = cross_validate(X, ON_THE_PSD, folds=4)
    assert scores.balanced_accuracy > 0.9
    assert scores.records == 48
    assert controls(X, ON_THE_PSD, folds=4)["null"].balanced_accuracy < 0.5


def test_samples_that_are_not_finite_are_zero(corpus):
    X = open_waveforms(corpus[0])
    signal = X.signal.load().copy()
    signal[5, 7] = np.nan
    holed = replace(X, signal=signal)
    assert holed[5][7] == 0
    assert np.isfinite(holed[:]).all()


def test_records_of_unknown_class_are_left_out(corpus):
    X = open_waveforms(corpus[0], normalise=True)
    labels = X.labels.assign(fault=X.labels["fault"].where(np.arange(48) >= 3, UNKNOWN_CODE))
    assert cross_validate(replace(X, labels=labels), ON_THE_PSD, folds=3).records == 45


def test_given_shaft_rates_replace_the_labelled_ones(corpus):
    labelled = open_waveforms(corpus[0], per_turn=64, turns=3)
    rates = 1.05 * labelled.operating["shaft_rate"]
    X = open_waveforms(corpus[0], per_turn=64, turns=3, shaft_rate=rates)
    np.testing.assert_array_equal(X.operating["shaft_rate"], rates)
    slower = open_waveforms(corpus[0], per_turn=64, turns=3, shaft_rate=rates / 1.05)
    np.testing.assert_allclose(slower[:5], labelled[:5], atol=1e-5)
    assert np.abs(X[:5] - labelled[:5]).max() > 0.1


def test_a_record_without_a_shaft_rate_cannot_be_resampled(tmp_path):
    write_corpus(tmp_path / "corpus", specimens=4, shaft_rate=np.where(np.arange(12) == 7, np.nan, 30.0))
    with pytest.raises(CorpusError, match="record 7 has no shaft rate; leave out per_turn"):
        open_waveforms(tmp_path / "corpus", per_turn=64)
