"""Lines of progress: how many units are done, at which speed, and the time that is left."""

import pytest

from raceway.console import progress


@pytest.fixture
def clock(monkeypatch):
    """Seconds on the clock, which a test sets."""
    now = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    return now


@pytest.fixture
def lines(monkeypatch):
    found = []
    monkeypatch.setattr(progress, "notice", found.append)
    return found


def test_a_line_comes_every_ten_seconds_and_at_the_end(clock, lines):
    report = progress._lines("generating", "records")
    for clock[0], done in ((9.0, 9), (11.0, 11), (12.0, 12), (22.0, 21), (30.0, 30)):
        report(done, 30)
    assert [line.partition(",")[0] for line in lines] == [f"generating: {done} of 30 records" for done in (11, 21, 30)]


def test_speed_and_time_left_are_those_of_the_last_reports(clock):
    """Half of the units are there after a second, kept from before; then each takes a second."""
    pace = progress._pace("records")
    assert pace(0, 200) == "speed not known yet"
    clock[0] = 1.0
    assert pace(100, 200) == "100 records/s, 1 s left"
    for clock[0] in range(2, 51):
        said = pace(99 + clock[0], 200)
    assert said == "1 records/s, 51 s left"
    clock[0] = 51.0
    assert pace(200, 200).endswith("records/s")
