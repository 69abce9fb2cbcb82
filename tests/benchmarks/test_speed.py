"""The table of the benchmark of shaft speeds, on a made-up corpus."""

from benchmarks.speed import recordings, report
from tests.features.table.test_recording_speeds import SPEEDS, TRUTH, WINDOWS, write_machines


def test_the_table_has_a_row_per_class_and_known_speeds(tmp_path):
    corpus = write_machines(tmp_path / "machines", extra=(TRUTH,))
    for recording, (label, true) in zip(recordings(corpus), SPEEDS.values(), strict=True):
        assert (len(recording.x), recording.label, recording.true) == (WINDOWS, label, true)
    lines = list(report(corpus, "made"))
    assert [line.split(" | ")[1] for line in lines] == ["healthy", "inner", "outer", "ball"]
    assert {line.count("|") for line in lines} == {10}
