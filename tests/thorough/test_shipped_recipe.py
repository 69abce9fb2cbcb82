"""The recipe for training, which needs kernels for each number of balls."""

from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate
from tests.gen.measurement.test_record_rms_laws import check


def test_its_records_have_the_drawn_rms():
    scenarios = draw_scenarios(read_recipe("domain_randomised"), 0, 24)
    check(simulate(scenarios).acceleration, scenarios)
