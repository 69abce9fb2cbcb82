"""Laws of compiling: once per machine, before the first record."""

from functools import partial

import numba

from gen.generation import compilation
from gen.generation.compilation import compile_kernels
from gen.mechanisms.background.looseness import Looseness
from gen.mechanisms.chain.loose_mount import LooseMount
from gen.physics.kernel.batch import input_shape, lay_out
from gen.physics.kernel.decimate import decimation
from gen.scenarios import draw_scenarios
from gen.simulation.compiled_kernel import signature
from tests.responses import input_of


def test_the_kernel_is_compiled_for_the_types_of_the_arguments_it_is_called_with(recipe_with):
    recipe = recipe_with(
        {"operation.speed_profile": {"kind": "run_up", "from_percent": 50, "to_percent": 120, "lasting_s": 0.1}}
    )
    for scenario in draw_scenarios(recipe, 0, 8):
        kernel_input = input_of(scenario)
        shape = input_shape(kernel_input)
        arguments = (shape, lay_out([kernel_input], shape, 1e-4), 1e-5, 4, decimation(4), 3, 5)
        assert tuple(map(numba.typeof, arguments)) == signature()


def test_the_kernel_is_announced_before_it_is_compiled(recipe_with, monkeypatch):
    done = []
    monkeypatch.setattr(compilation, "is_compiled", lambda: False)
    monkeypatch.setattr(compilation, "load_kernel", lambda: done.append("compiled"))
    compile_kernels(recipe_with({}), done.append)
    assert done == [
        "compiling the kernel for this machine, half a minute or so; it is kept for the next time.",
        "compiled",
    ]


def test_mechanisms_that_have_compiled_code_are_compiled_ahead_of_the_workers(recipe_with, monkeypatch):
    compiled = []
    for mechanism in (Looseness, LooseMount):
        monkeypatch.setattr(mechanism, "compile", partial(compiled.append, mechanism))
    loose = {"probability": 1, "lift": 1.5, "frequency_hz": 400, "level_db": 6}
    mount = {"probability": 1, "frequency_hz": 4000, "damping_percent": 5, "holding_m_s2": 100}
    compile_kernels(recipe_with({"machine_conditions.looseness": loose, "sensor_faults.loose_mount": mount}))
    assert compiled == [Looseness, LooseMount]
