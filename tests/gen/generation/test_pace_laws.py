"""Laws of the pace of a machine: it is measured without compiling a kernel, and a plan's time is close to that of generation."""

import subprocess
import sys
import time

import numpy as np
import pytest

from gen.generation import pace
from gen.generation.corpus import generate
from gen.generation.plan import plan
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios, settings_of
from gen.simulation.batches import group_of
from gen.simulation.outline import outlined_input
from gen.simulation.timeline import timeline


@pytest.fixture(scope="module")
def compiled(write_recipe, tmp_path_factory):
    """File of a recipe whose kernel is compiled, of records long enough to be timed."""
    folder = tmp_path_factory.mktemp("compiled")
    path = write_recipe(folder / "r.yaml", {"recording.duration_s": 1.0, "corpus.rigs": 8})
    generate(path, folder / "corpus", records=1)
    return path


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Folder in which the pace is kept."""
    monkeypatch.setattr(pace, "cache_folder", lambda: tmp_path)
    return tmp_path


def test_the_time_of_a_plan_is_close_to_that_of_generation(compiled, tmp_path):
    start = time.perf_counter()
    generate(compiled, tmp_path / "corpus")
    taken = time.perf_counter() - start
    assert taken / 4 < plan(compiled).estimated_seconds < 4 * taken


def test_a_plan_does_not_know_its_time_where_no_kernel_is_compiled(compiled, tmp_path):
    code = f"from gen.generation.plan import plan; print(plan({str(compiled)!r}).estimated_seconds)"
    environment = {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": ":".join(sys.path)}
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert run.stdout == "None\n"
    assert not list(tmp_path.rglob("*integrate*.nbc"))


@pytest.fixture
def batch(compiled):
    """Records of one group, the group and the codec."""
    recipe = read_recipe(compiled)
    axis, scenarios = timeline(settings_of(recipe)), draw_scenarios(recipe, 0, 2)
    return scenarios, group_of(outlined_input(scenarios[0], axis), 1), recipe.storage.codec


def test_a_batch_of_too_many_steps_is_not_timed(batch, monkeypatch):
    found = pace.measured_pace(*batch)
    assert found is not None
    assert np.all(np.array(found) > 0)
    monkeypatch.setattr(pace, "LARGEST_SAMPLE", pace.LANES * 1000 - 1)
    assert pace.measured_pace(*batch) is None


def test_a_kind_of_records_is_timed_once(batch, folder, monkeypatch):
    found = pace.measured_pace(*batch)
    with monkeypatch.context() as patch:
        patch.setattr(pace, "_time", lambda *_: pytest.fail("it was timed again"))
        assert pace.measured_pace(*batch) == found
    (kept,) = folder.glob("pace-*.json")
    kept.write_text(kept.read_text()[:-1])
    assert pace.measured_pace(*batch) is not None  # timed again, as the file is damaged
    scenarios, group, codec = batch
    pace.measured_pace(scenarios, group._replace(steps=2), codec)
    assert len(list(folder.glob("pace-*.json"))) == 2


def test_a_pace_that_cannot_be_kept_is_measured(batch, monkeypatch):
    monkeypatch.setattr(pace, "cache_folder", lambda: None)
    assert pace.measured_pace(*batch) is not None
