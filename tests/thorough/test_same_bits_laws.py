"""The same bits from a compiled kernel and from one in the cache, on other processors, and for any number of lanes."""

import os
import shutil
import subprocess
import sys

import pytest

from tests.paths import ROOT
from tests.recipes import EVERYTHING

GEN = ROOT / "gen"
SCRIPT = """
import hashlib, sys
from gen import draw_scenarios, read_recipe
from gen.simulation.simulate import simulate
from gen.measurement.measure import measure
recipe = read_recipe(sys.argv[1])
scenarios = draw_scenarios(recipe)
runs = [run for run in simulate(scenarios) if run.failure is None]
assert len(runs) > len(scenarios) * 3 / 4
for arrays in ([run.acceleration for run in runs], [record.signal for record in measure(runs)]):
    print(hashlib.sha256(b"".join(array.tobytes() for array in arrays)).hexdigest())
"""
# instructions of a processor of 2013, for numba, NumPy and its linear algebra
AVX2 = {
    "NUMBA_CPU_NAME": "haswell",
    "NUMBA_CPU_FEATURES": "+avx,+avx2,+bmi,+bmi2,+cmov,+cx16,+f16c,+fma,+fxsr,+lzcnt,+mmx,+movbe,+popcnt,+sse,+sse2,+sse3,+sse4.1,"
    "+sse4.2,+ssse3,+xsave",
    "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR",
    "OPENBLAS_CORETYPE": "Haswell",
}


@pytest.fixture(scope="module")
def recipe(tmp_path_factory, write_recipe):
    return write_recipe(tmp_path_factory.mktemp("recipe") / "everything.yaml", EVERYTHING)


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    return {"NUMBA_CACHE_DIR": str(tmp_path_factory.mktemp("cache"))}


def hashes(recipe, environment, folder=None):
    """Hashes of motion and signal of every record, from a new process."""
    command = [sys.executable, "-W", "ignore", "-c", SCRIPT, str(recipe)]
    run = subprocess.run(command, env=os.environ | environment, capture_output=True, text=True, check=True, cwd=folder)
    return run.stdout.split()


@pytest.fixture(scope="module")
def compiled(recipe, cache):
    """From the process that compiles the kernel."""
    found = hashes(recipe, cache)
    assert len(found) == 2
    return found


def test_a_kernel_just_compiled_gives_the_bits_of_the_kernel_in_the_cache(recipe, cache, compiled):
    assert hashes(recipe, cache) == compiled


# each compiles a kernel, so the narrow processor has its own number of lanes
@pytest.mark.parametrize(
    ("lanes", "processor"), [(8, {}), (64, {}), (32, AVX2)], ids=["8 lanes", "64 lanes", "32 lanes and AVX2"]
)
def test_neither_the_number_of_lanes_nor_the_width_of_the_vectors_changes_a_bit(
    recipe, tmp_path, compiled, lanes, processor
):
    shutil.copytree(GEN, tmp_path / "gen", ignore=shutil.ignore_patterns("__pycache__"))
    source = tmp_path / "gen" / "physics" / "kernel" / "compiling.py"
    text = source.read_text()
    assert text.count("\nLANES = 16\n") == 1
    source.write_text(text.replace("\nLANES = 16\n", f"\nLANES = {lanes}\n"))
    assert hashes(recipe, processor | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}, tmp_path) == compiled
