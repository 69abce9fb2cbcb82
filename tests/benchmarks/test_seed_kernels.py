"""The kernels our own is timed against compute the same motion."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks import rivals
from benchmarks.compiled import accelerations, compiled, compiler, has_avx512, in_lanes
from benchmarks.pipeline import variant
from benchmarks.seed import GEOMETRIC, NO_SPALL, RECTANGULAR, seed_of, seed_records
from gen.recipe import find_recipe, read_recipe
from gen.scenarios import draw_scenarios
from gen.simulate import simulate

FS, SAMPLES, LANES = 100_000, 500, 8
RECORDING = {"sample_rate_hz": FS, "oversampling": 1, "duration_s": 0.001, "settle_s": 0.05}
PROFILES = {"healthy": NO_SPALL, "rectangular": RECTANGULAR, "geometric": GEOMETRIC}


@pytest.fixture(scope="module", params=PROFILES)
def case(request, tmp_path_factory):
    """Profile, records that have it, and their first 5 ms by our kernel, without a filter, shape (sample, coordinate, record)."""
    faults = {"healthy": {"kind": "healthy"}}.get(
        request.param, {"kind": "inner", "width_mm": 2, "depth_um": 5, "angle_deg": 15, "profile": request.param}
    )
    path = variant(find_recipe("ophel2025"), tmp_path_factory.mktemp("case") / "case.yaml", recording=RECORDING)
    recipe = read_recipe(path)
    recipe = type(recipe).model_validate(recipe.model_dump(mode="json") | {"faults": [faults]})
    scenarios = draw_scenarios(recipe, 0, LANES)
    ours = simulate(scenarios, recipe).acceleration[..., :SAMPLES].transpose(2, 1, 0)
    profile = PROFILES[request.param]
    return profile, seed_records(recipe, LANES)[profile], ours


def distance(found: np.ndarray, ours: np.ndarray) -> float:
    return float(np.abs(found - ours).max() / np.abs(ours).max())


@pytest.mark.parametrize("source", ["plain", "intrinsics"])
def test_a_kernel_in_c_computes_the_motion_of_ours(source, case, tmp_path: Path):
    if compiler() is None or (source == "intrinsics" and not has_avx512()):
        pytest.skip("no C compiler, or no AVX-512")
    profile, records, ours = case
    (batch,) = in_lanes(records, LANES, 1 / FS)
    assert distance(accelerations(compiled(source, LANES, profile, tmp_path), batch, 1 / FS, SAMPLES, 1), ours) < 1e-9


def test_numpy_computes_the_motion_of_ours(case):
    profile, records, ours = case
    if profile == GEOMETRIC:
        pytest.skip("the rivals know the rectangular spall of the recipe alone")
    assert distance(rivals.numpy_march(*seed_of(records), 1 / FS, SAMPLES), ours) < 1e-9
