"""The importer of PRONOSTIA on small made-up files."""

from pathlib import Path

import numpy as np
import pytest

from features import feature_table
from gen.corpus import LIFE, open_corpus, validate_corpus
from gen.support.errors import CorpusError
from raceway.importing import import_set
from raceway.lives.prognosis import score_lives
from tests.labels import import_labelled


def write(folder, number, *, mark=",", samples=2560, start=9 * 3600 + 39 * 60):
    folder.mkdir(parents=True, exist_ok=True)
    signal = np.random.default_rng(number).normal(size=(samples, 2))
    clock = start + 10 * (number - 1)
    time = [clock // 3600 % 24, clock % 3600 // 60, clock % 60, 65664.0]
    rows = [mark.join(f"{value:g}" for value in (*time, *row)) for row in signal]
    (folder / f"acc_{number:05d}.csv").write_text("\n".join(rows) + "\n")
    return signal


def imported(source, output):
    done = import_set("femto", source, output)
    assert validate_corpus(output) == []
    with open_corpus(output) as corpus:
        return done, corpus.load()


def test_a_folder_is_a_life_whose_last_snapshot_is_its_end(tmp_path):
    signals = [write(tmp_path / "set" / "Bearing1_1", number) for number in (1, 2, 3)]
    for number in (1, 2):
        write(tmp_path / "set" / "Bearing3_2", number, mark=";")
    done, corpus = imported(tmp_path / "set", tmp_path / "corpus")
    assert (done.recordings, done.records, done.skipped, done.warnings) == (5, 5, (), ())
    assert {variable.name for variable in LIFE} <= set(corpus.variables)
    assert corpus.bearing.values.tolist() == ["6804 Bearing1_1"] * 3 + ["6804 Bearing3_2"] * 2
    assert corpus.age.values.tolist() == [0, 10, 20, 0, 10]
    assert corpus.rul.values.tolist() == [20, 10, 0, 10, 0]
    assert corpus.rul_revolutions.values.tolist() == [600, 300, 0, 250, 0]
    assert corpus["load"].values.tolist() == [4000] * 3 + [5000] * 2
    assert set(corpus.event.values) == {1}
    np.testing.assert_allclose(corpus.acceleration[1].values, 9.80665 * signals[1].T, rtol=1e-4, atol=1e-3)


def test_of_a_life_in_two_folders_the_longer_course_is_read(tmp_path):
    for place, last in (("Test_set", 2), ("Full_Test_Set", 3)):
        for number in range(1, last + 1):
            write(tmp_path / "set" / place / "Bearing1_3", number)
    done, corpus = imported(tmp_path / "set", tmp_path / "corpus")
    assert corpus.event.values.tolist() == [1, 1, 1]
    assert done.warnings == (
        "Test_set/Bearing1_3: is left out, since Full_Test_Set/Bearing1_3 holds more of the same life.",
    )


@pytest.mark.parametrize("inside", ["set", "set/Test_set", "set/Test_set/Bearing1_3"])
def test_truncated_lives_are_censored_from_wherever_the_importer_is_called(tmp_path, monkeypatch, inside):
    write(tmp_path / "set" / "Test_set" / "Bearing1_3", 1)
    monkeypatch.chdir(tmp_path / inside)
    _, corpus = imported(Path(), tmp_path / "corpus")
    assert corpus.event.values.tolist() == [0]
    assert np.isnan(corpus.rul.values).all()


def test_missing_and_damaged_snapshots_are_named(tmp_path):
    folder = tmp_path / "set" / "Bearing2_1"
    for number in (1, 2, 6, 7):
        write(folder, number)
    write(folder, 8, samples=900)
    write(folder, 9)
    (folder / "acc_00006.csv").write_text("9,39,49,65664,0.1,x\n")
    (folder / "acc_00007.csv").write_text("9,39,49,65664,0.1\n")
    done, corpus = imported(tmp_path / "set", tmp_path / "corpus")
    assert corpus.age.values.tolist() == [0, 10, 80]
    assert corpus.rul.values.tolist() == [80, 70, 0]
    assert done.warnings[0] == "Bearing2_1: 3 snapshots are missing, the first is number 3."
    assert [sentence.partition(":")[0] for sentence in done.skipped] == [
        f"Bearing2_1/acc_0000{number}.csv" for number in (6, 7, 8)
    ]


def test_a_snapshot_with_a_number_of_its_own_takes_no_memory(tmp_path):
    folder = tmp_path / "set" / "Bearing2_1"
    write(folder, 1)
    (folder / f"acc_{10**11}.csv").write_bytes((folder / "acc_00001.csv").read_bytes())
    (folder / "acc_1.csv").write_bytes((folder / "acc_00001.csv").read_bytes())
    done = import_set("femto", tmp_path / "set", tmp_path / "corpus")
    assert done.warnings[0] == f"Bearing2_1: {10**11 - 2} snapshots are missing, the first is number 2."


def test_a_folder_without_lives_is_refused(tmp_path):
    write(tmp_path / "set" / "Other", 1)
    with pytest.raises(CorpusError, match="has no folder such as Bearing1_1"):
        import_set("femto", tmp_path / "set", tmp_path / "corpus")


def test_truncated_lives_are_scored_by_what_their_full_course_tells(tmp_path):
    """The protocol of the challenge: learn from whole lives, estimate the rest of cut ones at their last snapshot."""
    lives = (
        ("Learning_set", "1_1", 30),
        ("Learning_set", "1_2", 36),
        ("Test_set", "1_3", 20),
        ("Full_Test_Set", "1_3", 32),
    )
    for place, bearing, last in lives:
        for number in range(1, last + 1):
            write(tmp_path / "set" / place / f"Bearing{bearing}", number)
    learned = import_set("femto", tmp_path / "set" / "Learning_set", tmp_path / "learned")
    cut = import_set("femto", tmp_path / "set", tmp_path / "cut", subset="truncated")
    with open_corpus(cut.path) as corpus:
        assert corpus.bearing.values.tolist() == ["6804 Bearing1_3"] * 20
        assert corpus.event.values.tolist() == [0] * 20
        assert corpus.rul.values.tolist() == [10 * (32 - number) for number in range(1, 21)]
    tables = [feature_table(done.path, ("shape",)) for done in (learned, cut)]
    scores = score_lives(*tables)
    assert np.isfinite(scores.phm_2012).all()
    assert np.isnan(scores.mae_50).all()
    # half of the two lives is over at 290 s, so 100 s are left at 190 s and 120 s are true
    assert scores.phm_2012["age"] == pytest.approx(0.5 ** (100 * (120 - 100) / 120 / 20))
    with pytest.raises(CorpusError, match="no bearing of the feature table failed"):
        score_lives(tables[1], tables[0])


def test_lives_of_ones_own_have_the_variables_of_lives(tmp_path):
    rng = np.random.default_rng(0)
    rows = []
    for specimen, last, event in (("a", 3, "failed"), ("b", 2, "censored")):
        for age in range(last):
            np.save(tmp_path / f"{specimen}{age}.npy", rng.normal(size=1000))
            rows.append({"path": f"{specimen}{age}.npy", "specimen": specimen, "age_s": 100 * age, "event": event})
    rows[-1] |= {"rul_s": 50}
    facts = {
        "fault": "unknown",
        "bearing": "6205",
        "shaft_rpm": 1200,
        "unit": "g",
        "sample_rate_hz": 2000,
        "load_n": 8000,
    }
    done = import_labelled(tmp_path, rows, **facts)
    assert validate_corpus(done.path) == []
    with open_corpus(done.path) as corpus:
        assert corpus.bearing.values.tolist() == ["6205 a"] * 3 + ["6205 b"] * 2
        assert corpus.age.values.tolist() == [0, 100, 200, 0, 100]
        np.testing.assert_array_equal(corpus.rul.values, [200, 100, 0, np.nan, 50])
        assert corpus.rul_revolutions.values[0] == 4000
        assert corpus.event.values.tolist() == [1, 1, 1, 0, 0]
        assert corpus.overloaded.values.tolist() == [1] * 5
