"""``raceway plot`` of records and recordings."""

import numpy as np
import pytest

MACHINE = ("--bearing", "6205", "--rpm", 1797, "--rate", 12000)


@pytest.fixture
def recording(tmp_path):
    np.save(tmp_path / "pump.npy", np.random.default_rng(0).standard_normal(24_000))
    return tmp_path / "pump.npy"


DRAWN = [
    ("{recording} --bearing 6205 --rpm 1797 --rate 12000 --view envelope --healthy {recording}", "pump.npy."),
    ("{corpus} --record 1 --healthy 0 --view psd", "record 1"),
    ("{corpus}", "a record of each class"),
]


@pytest.mark.parametrize(("line", "told"), DRAWN)
def test_records_and_recordings_are_drawn_alone_and_over_others(run, recording, tiny_corpus, tmp_path, line, told):
    words = line.format(recording=recording, corpus=tiny_corpus).split()
    assert told in run("plot", *words, "-o", tmp_path / "x.png").stdout
    assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ((), "give --bearing and --rpm"),
        ((*MACHINE, "--channel", "0,1"), "a picture shows one channel"),
        ((*MACHINE, "--band", 6000, 9000), "lies above half the sample rate"),
        ((*MACHINE, "--healthy", "none.npy"), "none.npy"),
    ],
)
def test_what_a_picture_of_a_recording_lacks_is_told_in_one_sentence(run, recording, tmp_path, given, sentence):
    result = run("plot", recording, "--unit", "g", *given, "-o", tmp_path / "x.png")
    assert result.exit_code == 2
    assert sentence in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_a_view_of_a_corpus_needs_the_number_of_a_record(run, tiny_corpus, tmp_path):
    result = run("plot", tiny_corpus, "--view", "psd", "-o", tmp_path / "x.png")
    assert (result.exit_code, "with --record" in result.stderr) == (2, True)
