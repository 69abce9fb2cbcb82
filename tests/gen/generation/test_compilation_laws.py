"""Laws of compiling: once per machine, whatever happens to the processes and to the folder of the kernels."""

import os
import subprocess
import sys

import numba
import pytest

from gen.generation import compilation
from gen.generation.compilation import compile_kernels, needed_shapes
from gen.physics.kernel.batch import input_shape
from gen.physics.kernel.decimate import decimation
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios, settings_of
from gen.simulation.inputs import kernel_inputs
from gen.simulation.kernels import signature
from gen.simulation.motion import draw_motion
from gen.simulation.simulate import laid_out
from gen.simulation.timeline import timeline


def test_kernels_work_where_numba_finds_no_folder():
    code = """
from numba.core.caching import CacheImpl
CacheImpl._locator_classes = []
from features.signal.rows import total
from gen.physics.rattle import _rattle
from gen.physics.kernel.layout import make_shape
from gen.simulation import kernels
print(kernels.is_compiled(make_shape(9, 1)), _rattle.stats.cache_path, total.stats.cache_path)
"""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, env=environment)
    assert run.stdout == "False None None\n", run.stderr


@pytest.mark.parametrize(
    "name", ["domain_randomised", "quickstart", "every_fault", "run_up", "dirty_sensors", "ophel2025"]
)
def test_the_sample_needs_every_kernel_of_a_shipped_recipe(name):
    recipe = read_recipe(name)
    every = set()
    for first in range(0, min(480, recipe.n_records), 48):
        scenarios = draw_scenarios(recipe, first, min(first + 48, recipe.n_records))
        scenarios += [one.without_fault() for one in scenarios] if recipe.truth.twins else []
        inputs, _ = kernel_inputs([draw_motion(one) for one in scenarios], timeline(settings_of(recipe)))
        every |= {input_shape(given) for given in inputs if given is not None}
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
        "compiling 2 kernels for this machine, 10 to 20 s each; they are kept for the next time.",
        "kernel 1 of 2 is compiled: 9 balls, 1 channel, resonator, wavy, spalled.",
        "kernel 2 of 2 is compiled: 9 balls, 1 channel, resonator, wavy, spalled, jittered.",
    ]


def test_nothing_is_said_of_kernels_that_are_compiled(recipe_with, monkeypatch):
    monkeypatch.setattr(compilation, "is_compiled", lambda _: True)
    compile_kernels(recipe_with({}), lambda _: pytest.fail("there is nothing to compile"))
