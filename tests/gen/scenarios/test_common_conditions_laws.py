"""Laws of conditions that a rig or a specimen has in common, and of conditions that one fault changes."""

from itertools import product

import numpy as np
import pytest

from gen import uniform
from gen.scenarios import draw_scenarios
from gen.support.units import split_unit
from tests.drawn_values import anywhere, with_key_of


def of_each(scenarios, level, name):
    """Values of an operating quantity of each rig or specimen."""
    by_number = {}
    for scenario in scenarios:
        by_number.setdefault(getattr(scenario.origin, level), []).append(scenario.conditions[name])
    return [np.array(values) for values in by_number.values()]


@pytest.mark.parametrize("level", ["rig", "specimen"])
@pytest.mark.parametrize(
    ("key", "sampling"), [("shaft_rpm", "random"), ("load_n", "sobol"), ("mean_slip_percent", "halton")]
)
def test_a_rig_or_specimen_has_one_value(recipe_with, level, key, sampling):
    name = split_unit(key)[0]
    usual = recipe_with({f"operation.{key}": uniform(3, 9), "corpus.sampling": sampling})
    common = recipe_with({f"operation.{key}": uniform(3, 9, per=level), "corpus.sampling": sampling})
    values = of_each(draw_scenarios(common), level, name)
    assert all(len(set(of_one)) == 1 for of_one in values)
    assert len({of_one[0] for of_one in values}) == len(values)
    for scenario, other in zip(draw_scenarios(common), draw_scenarios(usual), strict=True):
        assert with_key_of(scenario, other, "operation", key) == anywhere(other)


@pytest.mark.parametrize("level", ["rig", "specimen"])
def test_records_scatter_about_the_value_of_their_rig_or_specimen(recipe_with, level):
    changes = {"corpus.rigs": 8, "corpus.records_per_specimen": 50}
    steady, scattered = (
        of_each(
            draw_scenarios(recipe_with(changes | {"operation.shaft_rpm": uniform(1500, 2000, per=level, **more)})),
            level,
            "shaft_rate",
        )
        for more in ({}, {"scatter_percent": 2})
    )
    deviations = np.concatenate([values / value[0] - 1 for values, value in zip(scattered, steady, strict=True)])
    assert np.abs(deviations).max() <= 0.02 * (1 + 1e-9)
    assert np.abs(deviations).max() > 0.0195
    assert deviations.std() == pytest.approx(0.02 / 3**0.5, rel=0.05)  # of a uniform distribution
    assert deviations.mean() == pytest.approx(0, abs=1e-3)


def test_grids_of_a_rig_enumerate_all_combinations_with_those_of_its_machine(recipe_with):
    changes = {
        "corpus.rigs": 12,
        "machine.shaft_mass_kg": "grid(2, 3)",
        "operation.shaft_rpm": "grid(600, 900, 1200, per=rig)",
        "operation.load_n": "grid(100, 200, per=rig)",
        "operation.slip_percent": "grid(1, 2)",
    }
    scenarios = draw_scenarios(recipe_with(changes))
    rigs = {}
    for scenario in scenarios:
        conditions = scenario.conditions
        rigs[scenario.origin.rig] = (
            scenario.machine["shaft_mass"],
            round(60 * conditions["shaft_rate"]),
            conditions["load"],
        )
    assert sorted(rigs.values()) == sorted(product([2, 3], [600, 900, 1200], [100, 200]))
    slips = [100 * scenario.conditions["slip"] for scenario in scenarios]
    assert slips == pytest.approx([1, 2] * (len(scenarios) // 2))


def changed(**outer):
    """Faults of the small recipe, with changes for those of the outer race."""
    return [
        {"kind": "healthy"},
        {"kind": "inner", "width_mm": 0.5},
        {"kind": "outer", "width_mm": 0.5, **outer},
        {"kind": "ball", "width_mm": 0.5},
    ]


SNR = {"kind": "snr", "faulty_db": uniform(-5, 5), "healthy_db": 0, "rms_m_s2": uniform(1, 2)}
GRIDS = {
    "operation.slip_percent": "grid(1, 2)",
    "operation.jitter_deg": "grid(0.1, 0.2, 0.3)",
    "operation.speed_profile": {"kind": "ramp", "from_percent": uniform(50, 60), "to_percent": "grid(90, 95, 99)"},
    "operation.load_profile": {"kind": "ramp", "from_percent": uniform(50, 60), "to_percent": uniform(90, 99)},
    "level": SNR,
}  # fmt: skip


@pytest.mark.parametrize(
    "value", [7.0, uniform(5, 9), uniform(5, 9, per="rig", scatter_percent=1)], ids=["number", "uniform", "per rig"]
)
@pytest.mark.parametrize(
    ("key", "sampling"), [("load_n", "random"), ("spin_wander_percent", "sobol"), ("mean_slip_percent", "halton")]
)
def test_a_change_is_of_its_fault_alone_and_moves_no_other_quantity(recipe_with, key, value, sampling):
    usual, name = GRIDS | {"corpus.sampling": sampling}, split_unit(key)[0]
    factor = split_unit(key)[1]
    without = draw_scenarios(recipe_with(usual | {"faults": changed()}))
    drawn = draw_scenarios(recipe_with(usual | {"faults": changed(operation={key: value})}))
    for scenario, other in zip(drawn, without, strict=True):
        if scenario.fault != "outer":
            assert anywhere(scenario) == anywhere(other)
            continue
        assert with_key_of(scenario, other, "operation", key) == anywhere(other)
        assert 4.9 * factor < scenario.conditions[name] < 9.1 * factor


def test_a_changed_level_is_of_its_fault_alone(recipe_with):
    level = {"faulty_db": uniform(20, 30), "rms_m_s2": uniform(7, 8)}
    without = draw_scenarios(recipe_with(GRIDS | {"faults": changed()}))
    drawn = draw_scenarios(recipe_with(GRIDS | {"faults": changed(level=level)}))
    for scenario, other in zip(drawn, without, strict=True):
        if scenario.fault != "outer":
            assert anywhere(scenario) == anywhere(other)
            continue
        level, usual = scenario.recipe.level, other.recipe.level
        assert 20 < level.faulty_db < 30
        assert (level.faulty_db - 20) / 10 == pytest.approx((usual.faulty_db + 5) / 10)  # at the same quantile
        assert 7 < level.rms_m_s2 < 8
        assert anywhere(scenario.edited(level=usual)) == anywhere(other)


def test_the_balance_grade_holds_at_the_highest_speed_of_all_faults(recipe_with):
    fast = draw_scenarios(recipe_with({"faults": changed(operation={"shaft_rpm": 4000})}), 0, 1)[0]
    slow = draw_scenarios(recipe_with({"faults": changed()}), 0, 1)[0]
    assert fast.recipe.machine.unbalance == pytest.approx(slow.recipe.machine.unbalance / 2)
