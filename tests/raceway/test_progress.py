"""Lines of progress: how many units are done, at which speed, and the time that is left."""

import sys
from types import SimpleNamespace

import pytest

from raceway.console import progress_bar


@pytest.fixture
def clock(monkeypatch):
    """Seconds on the clock, which a test sets."""
    now = [0.0]
    monkeypatch.setattr(progress_bar.time, "monotonic", lambda: now[0])
    return now


@pytest.fixture
def lines(monkeypatch):
    found = []
    monkeypatch.setattr(progress_bar, "notice", found.append)
    return found


def test_a_line_comes_every_ten_seconds_and_at_the_end(clock, lines):
    report = progress_bar.show_progress("generating", "records")
    for clock[0], done in ((9.0, 9), (11.0, 11), (12.0, 12), (22.0, 21), (30.0, 30)):
        report(done, 30)
    assert [line.partition(",")[0] for line in lines] == [f"generating: {done} of 30 records" for done in (11, 21, 30)]


def test_speed_and_time_left_are_those_between_the_bursts(clock):
    """Half of the units are kept from before; then a batch of ten is done every five seconds, after a minute of compilation."""
    pace = progress_bar._pace("records")
    clock[0] = 60.0
    assert [pace(done, 200) for done in (99, 100)] == ["speed not known yet"] * 2
    for batch in range(1, 6):
        clock[0] = 60.0 + 5 * batch
        for done in range(10):
            said = pace(100 + 10 * (batch - 1) + done + 1, 200)
    assert said == "2 records/s, 25 s left"


def test_units_of_very_different_times_tell_no_time_left(clock):
    pace = progress_bar._pace("scores")
    pace(10, 200)
    clock[0] = 10.0
    assert pace(20, 200) == "1 scores/s"


def test_a_notebook_renews_one_line(clock, lines, monkeypatch):
    shown = []
    line = SimpleNamespace(update=lambda data, **_: shown.append(data["text/plain"]))
    display = SimpleNamespace(display=lambda *_, **__: line)
    notebook = SimpleNamespace(get_ipython=lambda: SimpleNamespace(kernel=1), display=display)
    monkeypatch.setitem(sys.modules, "IPython", notebook)
    report = progress_bar.show_progress("generating", "records")
    for clock[0], done in ((0.1, 1), (2.1, 2), (2.2, 3)):
        report(done, 3)
    assert lines == []
    assert shown == ["generating: 2 of 3 records, 0.5 records/s, 2 s left", "generating: 3 of 3 records, in 2 s"]


def test_a_terminal_renews_one_line_and_keeps_the_last(clock, lines, monkeypatch, capsys):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    report = progress_bar.show_progress("generating", "records")
    for clock[0], done in ((0.1, 1), (2.1, 2), (2.2, 3)):
        report(done, 3)
    assert capsys.readouterr().err == "generating: 2 of 3 records, 0.5 records/s, 2 s left\x1b[K\r"
    assert lines == ["generating: 3 of 3 records, in 2 s"]


def test_quiet_prints_results_alone(run, tiny_recipe, tmp_path):
    loud = run("generate", tiny_recipe, "-o", tmp_path / "loud", "--records", 2)
    quiet = run("--quiet", "generate", tiny_recipe, "-o", tmp_path / "quiet", "--records", 2)
    assert "generating:" in loud.stderr
    assert quiet.stderr == ""
    assert loud.stdout.replace("loud", "quiet") == f"{quiet.stdout}Next: raceway info {tmp_path / 'quiet'}\n"
