"""Laws of compiling: once per machine, whatever happens to the processes and to the folder of the kernels."""

import errno
import fcntl
import os
import subprocess
import sys
import threading

import numba
import pytest
from numba import njit

from gen.generation import compilation
from gen.generation.compilation import compile_kernels, needed_shapes
from gen.physics.kernel.batch import input_shape
from gen.physics.kernel.decimate import decimation
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios, settings_of
from gen.simulation.kernels import SharedCache, lock_file, signature
from gen.simulation.outline import outlined_input
from gen.simulation.simulate import laid_out
from gen.simulation.timeline import timeline

ENVIRONMENT = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
HOLD = "import sys, time; from gen.simulation.kernels import lock_file; from pathlib import Path\n"
HOLD += "with lock_file(Path(sys.argv[1])): print('held', flush=True); time.sleep(60)"
# loads a small function, and says when it compiles it
LOAD = """
import sys, time, numba
sys.path.insert(0, sys.argv[1])
from kernel_of_a_test import twice
from numba.core import event
from gen.simulation.kernels import SharedCache
class Said(event.Listener):
    def on_start(self, event):
        print("compiling", flush=True)
        time.sleep(0.5)
    def on_end(self, event): pass
event.register("numba:compile", Said())
SharedCache(numba.njit(cache=True)(twice)).load((numba.float64,))
print("loaded")
"""


def python(code, *arguments, **environment):
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=ENVIRONMENT | environment)


@pytest.fixture
def twice(tmp_path, monkeypatch):
    """A small function that is not compiled yet, and its cache."""
    (tmp_path / "kernel_of_a_test.py").write_text("def twice(x):\n    return 2 * x\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "kernel_of_a_test", raising=False)
    monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path / "cache"))
    function = njit(cache=True)(__import__("kernel_of_a_test").twice)
    return function, SharedCache(function)


def test_the_lock_of_a_killed_process_is_free(tmp_path):
    path = tmp_path / "kernel.lock"
    process = python(HOLD, path)
    assert process.stdout.readline() == "held\n"
    with path.open() as file, pytest.raises(BlockingIOError):
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    process.kill()
    process.communicate()
    taken = threading.Event()

    def take():
        with lock_file(path):
            taken.set()

    threading.Thread(target=take, daemon=True).start()
    assert taken.wait(20)


def test_of_two_processes_one_compiles_and_the_other_waits_and_loads(tmp_path, twice):
    cache = str(tmp_path / "cache")
    first = python(LOAD, tmp_path, NUMBA_CACHE_DIR=cache)
    assert first.stdout.readline() == "compiling\n"
    second = python(LOAD, tmp_path, NUMBA_CACHE_DIR=cache)
    assert [process.communicate(timeout=60)[0] for process in (first, second)] == ["loaded\n", "loaded\n"]
    assert twice[1].has((numba.float64,))
    assert not twice[1].has((numba.float32,))


def test_a_function_that_cannot_be_saved_is_compiled_all_the_same(twice, monkeypatch):
    function, cache = twice

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(cache._cache_file, "save", full)
    cache.load((numba.float64,))
    assert function(1.5) == 3.0
    assert not cache.has((numba.float64,))


def test_nothing_is_locked_where_no_file_can_be_made():
    with lock_file(compilation.Path(os.devnull) / "kernel.lock"):
        pass


def test_kernels_work_where_numba_finds_no_folder():
    code = """
from numba.core.caching import CacheImpl
CacheImpl._locator_classes = []
from gen.measurement.rattle import _rattle
from gen.physics.kernel.layout import make_shape
from gen.simulation import kernels
print(kernels.is_compiled(make_shape(9, 1)), _rattle.stats.cache_path)
"""
    assert python(code).communicate(timeout=60)[0] == "False None\n"


@pytest.mark.parametrize(
    "name", ["domain_randomised", "quickstart", "every_fault", "run_up", "dirty_sensors", "ophel2025"]
)
def test_the_sample_needs_every_kernel_of_a_shipped_recipe(name):
    recipe = read_recipe(name)
    every = {
        input_shape(outlined_input(some, timeline(settings_of(recipe))))
        for scenario in draw_scenarios(recipe, 0, 480)
        for some in [scenario, scenario.without_fault()][: 2 if recipe.truth.twins else 1]
    }
    assert set(needed_shapes(recipe)) == every


def test_kernels_are_compiled_for_the_types_of_the_arguments_they_are_called_with(recipe_with):
    recipe = recipe_with(
        {"operation.speed_profile": {"kind": "run_up", "from_percent": 50, "to_percent": 120, "lasting_s": 0.1}}
    )
    for group, batch in laid_out(draw_scenarios(recipe, 0, 8)):
        given = (group.shape, batch, 1e-5, group.steps, decimation(group.steps), 3, 5)
        assert tuple(map(numba.typeof, given)) == signature(group.shape)


def test_each_kernel_is_announced_with_how_many_there_are(recipe_with, monkeypatch):
    recipe = recipe_with({"operation.jitter_deg": "grid(0, 0.3)"})
    said, loaded = [], []
    monkeypatch.setattr(compilation, "is_compiled", lambda _: False)
    monkeypatch.setattr(compilation, "load_kernel", loaded.append)
    monkeypatch.setattr("os.sched_getaffinity", lambda _: {0})
    compile_kernels(recipe, said.append)
    assert loaded == needed_shapes(recipe)
    assert said == [
        "compiling kernel 1 of 2 (9 balls, 1 channel, resonator, wavy, spalled) for this machine",
        "compiling kernel 2 of 2 (9 balls, 1 channel, resonator, wavy, spalled, jittered) for this machine",
    ]


def test_kernels_that_are_compiled_are_not_announced(recipe_with, monkeypatch):
    monkeypatch.setattr(compilation, "is_compiled", lambda _: True)
    compile_kernels(recipe_with({}), pytest.fail)
