"""Compiled code that a recipe needs, compiled before its first record; the kernel takes about half a minute, once per installation."""

from collections.abc import Callable

from gen.measurement.measure import compile_measuring
from gen.mechanisms.background.background import machine_sources_of
from gen.mechanisms.mechanism import mechanisms_of
from gen.recipe import Recipe
from gen.scenarios import draw_scenarios
from gen.simulation.compiled_kernel import is_compiled, load_kernel
from gen.support.garbage import keep_garbage


def compile_kernels(recipe: Recipe, notice: Callable[[str], None] = lambda _: None) -> None:
    """Compile what this machine does not have yet; ``notice`` is called with a sentence before the kernel is compiled."""
    with keep_garbage():
        compile_measuring(draw_scenarios(recipe, 0, 1)[0])
        for mechanism in (*machine_sources_of(recipe), *mechanisms_of(recipe.sensor_faults)):
            mechanism.compile()
    if not is_compiled():
        notice("compiling the kernel for this machine, half a minute or so; it is kept for the next time.")
        load_kernel()
