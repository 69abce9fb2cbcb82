"""The kernels that benchmarks compare with ours compute the same motion."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from benchmarks import rivals
from benchmarks.kernel import compiled, compiler, in_lanes
from benchmarks.seed import GEOMETRIC, NO_SPALL, RECTANGULAR, seed_of, seed_records
from gen.physics.kernel.batch import input_shape, lay_out
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel_input import KernelInput
from gen.recipe import Recipe, read_recipe
from gen.scenarios import draw_scenarios
from gen.simulation.batches import integrate_batch
from gen.simulation.timeline import timeline
from tests.lanes import march_lanes
from tests.responses import input_of

FS, SAMPLES, LANES = 100_000, 500, 8
RECORDING = {"sample_rate_hz": FS, "oversampling": 1, "duration_s": 0.001, "settle_s": 0.05}
PROFILES = {"healthy": NO_SPALL, "rectangular": RECTANGULAR, "geometric": GEOMETRIC}


class Case(NamedTuple):
    """Records with one spall profile, and their first 5 ms by our kernel in double precision."""

    profile: int
    records: list[KernelInput]
    ours: np.ndarray
    """Shape (sample, coordinate, record) [m s-2]."""


@pytest.fixture(scope="module", params=PROFILES)
def case(request: pytest.FixtureRequest) -> Case:
    spall = {"kind": "inner", "width_mm": 2, "depth_um": 5, "angle_deg": 15, "profile": request.param}
    seed = read_recipe("ophel2025").model_dump(mode="json", exclude_unset=True)
    seed["recording"].update(RECORDING)
    seed["faults"] = [{"kind": "healthy"} if request.param == "healthy" else spall]
    recipe, profile = Recipe.model_validate(seed), PROFILES[request.param]
    given = [input_of(scenario) for scenario in draw_scenarios(recipe, 0, LANES)]
    made = np.stack([trip.accelerations for trip in march_lanes(given, SAMPLES, 1, 1 / FS)], axis=2)
    return Case(profile, seed_records(recipe, LANES)[profile], made[:, :4])


def distance(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.abs(found - expected).max() / np.abs(expected).max())


@pytest.mark.parametrize("steps", [3, 4])  # one filter, and two
def test_the_kernel_in_c_returns_the_outputs_of_ours(steps: int, brief_seed: Path, tmp_path: Path):
    """In single precision, which rounds to 6e-8; the outputs of the filters are sums of some hundred terms."""
    if compiler() is None:
        pytest.skip("no C compiler")
    recipe = read_recipe(brief_seed)
    axis, filters = timeline(recipe), decimation(steps)
    for profile, records in seed_records(recipe, 2 * LANES).items():
        shape, some = input_shape(records[0]), records[:LANES]
        ours = integrate_batch(shape, steps, lay_out(some, shape, 1 / axis.fs), axis).response
        (batch,) = in_lanes(some, LANES, 1 / (axis.fs * steps))
        outputs = compiled(LANES, profile, tmp_path, filters)
        taps = filters.last.kept * filters.first.factor + filters.first.kept  # after the newest step of an output
        skipped = axis.dropped + taps // (2 * steps)
        made = outputs(batch, 1 / (axis.fs * steps), skipped + axis.returned)[skipped:, :, : len(some)]
        assert distance(made, ours.transpose(1, 0, 2)[:, :, : len(some)]) < 1e-5


@pytest.mark.parametrize(
    "case", ["healthy", "rectangular"], indirect=True
)  # the other implementations have no other spall
def test_numpy_computes_the_motion_of_ours(case: Case):
    assert distance(rivals.numpy_march(*seed_of(case.records), 1 / FS, SAMPLES), case.ours) < 1e-9


@pytest.mark.parametrize("case", ["rectangular"], indirect=True)
def test_solve_ivp_follows_the_motion_of_ours(case: Case):
    """A fixed step detects the edge of a spall up to one step late; an adaptive step resolves it."""
    seed, state = seed_of(case.records)
    found = rivals.adaptive(seed, state, SAMPLES / FS, 1 / FS)
    ours = case.ours[:, :, 0].T
    assert np.linalg.norm(found - ours) < 0.02 * np.linalg.norm(ours)
