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
    ("{corpus} --record 1 --healthy 6 --view psd", "record 1"),
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


@pytest.mark.parametrize(("top", "told"), [(30_000, ["the band is 300-6000 Hz."]), (6000, [])])
def test_a_band_beyond_half_the_sample_rate_is_told(run, tiny_corpus, recording, tmp_path, top, told):
    band = ("--band", 300, top, "-o", tmp_path / "x.png")
    for source in ((tiny_corpus, "--record", 1), (recording, *MACHINE, "--unit", "g")):
        warnings = [line for line in run("plot", *source, *band).stderr.splitlines() if line.startswith("warning: ")]
        assert [line[-len(told[0]) :] for line in warnings] == told


def test_a_picture_of_several_axes_needs_a_channel(run, tmp_path):
    np.save(tmp_path / "axes.npy", np.random.default_rng(0).standard_normal((24_000, 3)))
    result = run("plot", tmp_path / "axes.npy", "--unit", "g", *MACHINE, "-o", tmp_path / "x.png")
    assert (result.exit_code, "one with --channel; axes.npy has 0, 1, 2" in result.stderr) == (2, True), result.stderr


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--view", "psd"), "with --record"),
        (("--channel", "nonsense"), "with --record"),
        (("--bearing", "6205"), "--bearing is for a recording"),
        (("--rpm", 100), "--rpm is for a recording"),
        (("--record", 1, "--unit", "g"), "--unit is for a recording"),
        (("--record", 1, "--healthy", 0, "--speed-column", "n"), "--speed-column is for a recording"),
        (("--record", 0, "--healthy", 1), "cannot be drawn as a record: the record beneath is of class"),
    ],
)
def test_options_that_do_not_act_on_a_corpus_are_refused(run, tiny_corpus, tmp_path, options, sentence):
    result = run("plot", tiny_corpus, *options, "-o", tmp_path / "x.png")
    assert (result.exit_code, sentence in result.stderr) == (2, True), result.stderr


def test_the_number_of_a_record_is_refused_for_a_recording(run, recording, tmp_path):
    result = run("plot", recording, *MACHINE, "--record", 3, "-o", tmp_path / "x.png")
    assert (result.exit_code, "--record is for a corpus" in result.stderr) == (2, True), result.stderr


def test_a_recording_is_drawn_under_a_record_of_a_corpus(run, recording, tiny_corpus, tmp_path):
    machine = (*MACHINE, "--unit", "g")
    result = run("plot", tiny_corpus, "--record", 1, "--healthy", recording, *machine, "-o", tmp_path / "x.png")
    assert result.exit_code == 0, result.stderr
