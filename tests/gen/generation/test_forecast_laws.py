"""Laws of forecasts: the work of a corpus is about what generation integrates, and a longer run leaves its rate for the next."""

import pytest

from gen.generation import forecast
from gen.generation.corpus import generate
from gen.generation.forecast import LEAST_S, TYPICAL_RATE, expected_work, leave_rate, seconds_of
from gen.physics.kernel.integrate import integrate
from gen.recipe import read_recipe


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Folder in which the rate is kept."""
    monkeypatch.setattr(forecast, "cache_folder", lambda: tmp_path)
    return tmp_path


@pytest.mark.parametrize("changes", [{}, {"truth.twins": False}, {"operation.jitter_deg": "grid(0, 0.3)"}])
def test_the_work_of_a_forecast_is_that_of_the_records_that_generation_integrates(
    write_recipe, tmp_path, monkeypatch, changes
):
    """The check at half the step counts too."""
    counted = []

    def count(shape, lanes, dt, n_steps, taps, n_settle, n_out):
        counted.append(len(shape.balls) * n_steps * (n_settle + n_out) * lanes.n_records)
        return integrate(shape, lanes, dt, n_steps, taps, n_settle, n_out)

    path = write_recipe(tmp_path / "r.yaml", {"storage.records_per_part": 20} | changes)
    monkeypatch.setattr("gen.simulation.batches.integrate", count)
    generate(path, tmp_path / "corpus")
    assert expected_work(read_recipe(path)) == pytest.approx(sum(counted), rel=0.4)


def test_a_forecast_takes_the_rate_that_the_last_long_run_left(folder):
    assert seconds_of(TYPICAL_RATE) == 1
    leave_rate(TYPICAL_RATE, LEAST_S / 2)  # too short to tell
    assert seconds_of(TYPICAL_RATE) == 1
    leave_rate(TYPICAL_RATE * 3 * LEAST_S, LEAST_S)
    assert seconds_of(TYPICAL_RATE) == pytest.approx(1 / 3, rel=0.01)
    (kept,) = folder.iterdir()
    for damaged in ("", "fast", "nan", "-1", "inf"):
        kept.write_text(damaged)
        assert seconds_of(TYPICAL_RATE) == 1


def test_without_a_folder_for_kernels_the_rate_is_the_typical_one(monkeypatch):
    monkeypatch.setattr(forecast, "cache_folder", lambda: None)
    leave_rate(1.0, 100.0)
    assert seconds_of(TYPICAL_RATE) == 1


def test_generation_says_how_long_it_takes_before_it_begins(write_recipe, tmp_path):
    said = []
    path = write_recipe(tmp_path / "r.yaml")
    generate(path, tmp_path / "corpus", records=4, notice=said.append)
    assert said[0].startswith("about ")
    assert said[0].endswith(" records/s")
    said.clear()
    generate(path, tmp_path / "corpus", records=4, notice=said.append)
    assert said == []  # all is there
