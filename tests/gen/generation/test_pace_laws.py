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
from gen.scenarios import draw_scenarios


@pytest.fixture(scope="module")
def compiled(write_recipe, tmp_path_factory):
    """File of a recipe whose kernel is compiled, of records long enough to be timed."""
    folder = tmp_path_factory.mktemp("compiled")
    path = write_recipe(folder / "r.yaml", {"recording.duration_s": 1.0, "corpus.rigs": 8})
    generate(path, folder / "corpus", records=1)
    return path


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


def test_a_batch_of_too_many_steps_is_not_timed(compiled, monkeypatch):
    recipe = read_recipe(compiled)
    scenarios = draw_scenarios(recipe, 0, 2)
    found = pace.measured_pace(scenarios, recipe.storage.codec, 1000)
    assert found is not None
    assert np.all(np.array(found) > 0)
    monkeypatch.setattr(pace, "LARGEST_SAMPLE", pace.LANES * 1000 - 1)
    assert pace.measured_pace(scenarios, recipe.storage.codec, 1000) is None
