"""The MFPT importer on small made-up files."""

import numpy as np
import pytest
import scipy.io
import scipy.signal

from gen.corpus import FAULTS, open_corpus, validate_corpus
from gen.support.errors import CorpusError
from raceway.importing import import_set

FS = 48_828


def write(folder, name, *, fs=FS, seconds=1.1, **fields):
    folder.mkdir(parents=True, exist_ok=True)
    signal = np.random.default_rng(len(name)).normal(size=(round(seconds * fs), 1))
    scipy.io.savemat(folder / name, {"bearing": {"sr": fs, "rate": 25, "load": 50.0, "gs": signal} | fields})
    return signal[:, 0]


def imported(source, output):
    done = import_set("mfpt", source, output)
    assert validate_corpus(output) == []
    with open_corpus(output) as corpus:
        return done, corpus.load()


def test_the_file_name_tells_the_class_and_each_file_is_a_specimen(tmp_path):
    for name in ("baseline_1.mat", "InnerRaceFault_vload_1.mat", "OuterRaceFault_vload_1.mat", "OuterRaceFault_2.mat"):
        write(tmp_path / "set", name)
    done, corpus = imported(tmp_path / "set", tmp_path / "corpus")
    assert (done.recordings, done.records, done.skipped) == (4, 8, ())
    assert sorted(FAULTS[fault] for fault in corpus.fault.values[::2]) == ["healthy", "inner", "outer", "outer"]
    assert len(set(corpus.specimen.values.tolist())) == 4
    assert set(corpus.n_spalls.values[corpus.fault == 0]) == {0}
    assert np.isnan(corpus.width.values[corpus.fault > 0]).all()


def test_the_published_load_becomes_newtons(tmp_path):
    write(tmp_path / "set", "InnerRaceFault_vload_3.mat")
    _, corpus = imported(tmp_path / "set", tmp_path / "corpus")
    assert corpus["load"].values[0] == pytest.approx(444.822, abs=1e-3)
    assert corpus.shaft_rate.values[0] == 25.0


def test_a_recording_at_twice_the_rate_is_resampled_with_a_warning(tmp_path):
    signal = write(tmp_path / "set", "baseline_1.mat", fs=2 * FS)
    done, corpus = imported(tmp_path / "set", tmp_path / "corpus")
    expected = scipy.signal.resample_poly(signal * 9.80665, 1, 2)[: FS // 2]
    np.testing.assert_array_equal(corpus.acceleration.values[0, 0], expected.astype(np.float32))
    assert corpus.sample_rate.values[0] == FS
    assert any("baseline_1.mat:bearing.gs: resampled from 97656 to 48828 Hz" in text for text in done.warnings)


def test_foreign_damaged_and_repeated_files_are_named(tmp_path):
    source = tmp_path / "set"
    write(source, "InnerRaceFault_vload_1.mat")
    write(source / "more", "InnerRaceFault_vload_1.mat")
    write(source, "OilPumpShaftBearing.mat")
    write(source, "OuterRaceFault_1.mat", sr=3_000_000)
    write(source, "OuterRaceFault_2.mat", gs="none")
    scipy.io.savemat(source / "baseline_1.mat", {"X097_DE_time": np.ones(9)})
    scipy.io.savemat(source / "baseline_2.mat", {"bearing": {"sr": FS}})
    done, _ = imported(source, tmp_path / "corpus")
    told = {sentence.partition(":")[0]: sentence.partition(": ")[2] for sentence in done.skipped}
    assert done.recordings == 1
    assert "has no number of a baseline" in told["OilPumpShaftBearing.mat"]
    assert "again, which InnerRaceFault_vload_1.mat holds" in told["more/InnerRaceFault_vload_1.mat"]
    assert "is at 3e+06 Hz by its header, beyond 500 Hz to 1 MHz" in told["OuterRaceFault_1.mat"]
    assert "not one column of real numbers" in told["OuterRaceFault_2.mat"]
    assert "holds X097_DE_time, not bearing" in told["baseline_1.mat"]
    assert "holds bearing.sr, not bearing.gs" in told["baseline_2.mat"]


def test_a_set_of_foreign_files_is_refused(tmp_path):
    write(tmp_path / "set", "OilPumpShaftBearing.mat")
    with pytest.raises(
        CorpusError, match=r"no recording can be used; the first of 1 skipped: OilPumpShaftBearing\.mat"
    ):
        import_set("mfpt", tmp_path / "set", tmp_path / "corpus")
    assert not (tmp_path / "corpus").exists()
