"""Laws of drawn lives: the cadence tells nothing and changes nothing, and a spall stays itself while it grows."""

from itertools import groupby

import numpy as np
import pytest

from gen.life.fatigue import life_share, rating_life
from gen.scenarios import draw_scenarios
from tests.recipes import LIVES


def lives_of(recipe):
    """Scenarios of each bearing, by its number."""
    return {
        number: list(of) for number, of in groupby(draw_scenarios(recipe), lambda scenario: scenario.origin.specimen)
    }


@pytest.fixture(scope="module")
def lives(recipe_with):
    return lives_of(recipe_with(LIVES))


def states(scenarios, name):
    return np.array([getattr(scenario.origin.life, name) for scenario in scenarios])


def test_some_bearings_fail_and_some_are_censored(lives):
    events = [of[0].origin.life.event for of in lives.values()]
    assert 0 < sum(events) < len(lives) == 12


def test_remaining_life_falls_by_the_time_that_passes(lives):
    for of in lives.values():
        np.testing.assert_allclose(states(of, "rul") + states(of, "age"), of[0].origin.life.rul + of[0].origin.life.age)
        assert (np.diff(states(of, "rul_revolutions")) < 0).all()
        assert (states(of, "rul") >= 0).all()
        if of[0].origin.life.event:
            assert states(of, "rul")[-1] <= 40 * 3600


def test_half_the_cadence_changes_no_remaining_life(recipe_with, lives):
    denser = LIVES["life"] | {"cadence_h": 20}
    changed = LIVES | {"life": denser, "corpus": LIVES["corpus"] | {"records_per_specimen": 80}}
    for number, of in lives_of(recipe_with(changed)).items():
        rul_at = dict(zip(states(of, "age"), states(of, "rul"), strict=True))
        for scenario in lives[number]:
            assert rul_at[scenario.origin.life.age] == pytest.approx(scenario.origin.life.rul, rel=1e-9)


def test_a_spall_stays_itself_while_it_grows(lives):
    for of in lives.values():
        lengths = states(of, "spall_length")
        damaged = [scenario for scenario in of if scenario.origin.life.spall_length > 0]
        assert (np.diff(lengths[lengths > 0]) > 0).all()
        assert ((states(of, "age") >= states(of, "initiation_time")) == (lengths > 0)).all()
        for scenario in damaged:
            (spall,), (first,) = scenario.spalls, damaged[0].spalls
            assert (spall.angle, spall.ball, spall.site) == (first.angle, first.ball, first.site)
            assert spall.depth == scenario.origin.life.spall_depth == pytest.approx(280e-6 * min(1, spall.width / 2e-3))
            assert spall.width == scenario.origin.life.spall_length
            assert scenario.fault == spall.site
        for scenario in of[: len(of) - len(damaged)]:
            assert (scenario.fault, scenario.spalls) == ("healthy", [])


def test_wear_opens_the_clearance_in_proportion_to_the_turns(lives):
    for of in lives.values():
        turns = of[0].origin.life.rul_revolutions - states(of, "rul_revolutions")
        for name in ("diametral_clearance", "waviness"):
            worn = np.array([scenario.properties[name] for scenario in of])
            assert np.corrcoef(turns, worn)[0, 1] > 1 - 1e-9


def test_load_and_speed_vary_slowly_about_their_values(lives):
    loads = [np.log([scenario.conditions["load"] for scenario in of]) for of in lives.values() if len(of) == 40]
    spread = np.sqrt(np.mean([np.var(of, ddof=1) for of in loads]))
    assert 0.05 < spread < 0.12
    assert np.mean([np.std(np.diff(of)) for of in loads]) < 0.8 * spread * np.sqrt(2)


def test_late_entry_leaves_out_those_that_failed_before(recipe_with):
    changed = {"life": LIVES["life"] | {"entry_h": 2000}}
    for of in lives_of(recipe_with(LIVES | changed)).values():
        assert of[0].origin.life.age == 2000 * 3600
        assert of[0].origin.life.rul > 0


def test_a_bearing_that_is_withdrawn_is_censored_there(recipe_with, lives):
    changed = {"life": LIVES["life"] | {"withdrawal_h": 500}}
    for number, of in lives_of(recipe_with(LIVES | changed)).items():
        whole = lives[number][0].origin.life
        assert of[-1].origin.life.age <= 500 * 3600
        assert of[0].origin.life.rul == pytest.approx(whole.rul)
        assert of[0].origin.life.event == (whole.rul <= 500 * 3600)


def test_snapshots_are_denser_once_the_spall_is_long(recipe_with):
    changed = {"life": LIVES["life"] | {"damaged_cadence_h": 5, "damaged_from_mm": 0.8}}
    seen = 0
    for of in lives_of(recipe_with(LIVES | changed)).values():
        steps, long = np.diff(states(of, "age")) / 3600, states(of, "spall_length")[:-1] > 0.8e-3
        np.testing.assert_allclose(steps, np.where(long, 5, 40))
        seen += long.sum()
    assert seen > 10


def test_bearings_live_as_the_standard_says(recipe_with):
    corpus = {"rigs": 1, "specimens_per_rig": 400, "records_per_specimen": 1}
    life = {"cadence_h": 100, "first_length_scatter": 0, "history_h": 20_000}
    operation = {"operation.shaft_rpm": 1500, "operation.load_n": 4000}
    of = draw_scenarios(
        recipe_with(LIVES | operation | {"corpus": corpus, "life": life, "storage.records_per_part": 400})
    )
    begun = np.sort([scenario.origin.life.initiation_time for scenario in of])
    turns = rating_life(4000 / of[0].drawing.dynamic_rating, "ball") / 25
    expected = turns * np.array([life_share(share, "ball") for share in (0.25, 0.5, 0.75)])
    np.testing.assert_allclose(np.quantile(begun, (0.25, 0.5, 0.75)), expected, rtol=0.2)


def levels(scenarios):
    """Levels of the noise of the machine [dB re 1 m s-2]."""
    return 20 * np.log10([scenario.recipe.level.background_m_s2 for scenario in scenarios])


def test_a_new_machine_is_louder_and_runs_in(recipe_with):
    life = LIVES["life"] | {"louder_when_new_db": 6, "running_in_h": 200}
    for of in lives_of(recipe_with(LIVES | {"life": life})).values():
        expected = 20 * np.log10(2) + 6 * np.exp(-states(of, "age") / (200 * 3600))
        np.testing.assert_allclose(levels(of), expected)


def test_the_noise_of_a_machine_varies_slowly_whatever_its_bearing_does(recipe_with, lives):
    life = LIVES["life"] | {"background_history_db": 3}
    varied = lives_of(recipe_with(LIVES | {"life": life}))
    away = [levels(of) - 20 * np.log10(2) for of in varied.values()]
    assert np.concatenate(away).std() == pytest.approx(3, rel=0.35)
    assert np.concatenate([np.diff(of) for of in away]).std() < 3
    for number, of in varied.items():
        assert states(of, "age").tolist() == states(lives[number], "age").tolist()


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_knocks_come_and_go_for_their_share_of_the_life(recipe_with, share):
    knocks = {"probability": 1, "orders": 1, "level_db": 0}
    changes = {"life": LIVES["life"] | {"knocks_share": share}, "background.knocks": knocks}
    changes["corpus"] = LIVES["corpus"] | {"rigs": 10}
    there = [
        [scenario.recipe.background.knocks is not None for scenario in of]
        for of in lives_of(recipe_with(LIVES | changes)).values()
    ]
    every = np.concatenate(there)
    assert every.mean() == pytest.approx(share, abs=0.15 * (0 < share < 1))
    # five snapshots in the correlation time: the next one is mostly as the last
    assert np.mean(np.concatenate([np.diff(of) for of in there])) < 0.3
