"""Lives that cannot be are refused with one sentence."""

import pytest

from gen.recipe import Recipe
from gen.support.errors import RecipeError
from tests.conftest import small_with
from tests.recipes import LIVES


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"operation.load_n": 15_000}, "1.07 times the dynamic rating"),
        ({"life": {"cadence_h": 40, "end": {"length_mm": 0.3}}}, "begins longer than life.end.length_mm"),
        ({"life": {"cadence_h": 40, "end": {"peak_m_s2": 900}}}, "above the full scale of the converter"),
        ({"life": {"cadence_h": 1e-3}}, "its end is never reached"),
        ({"life": {"cadence_h": 1, "withdrawal_h": 2}}, "its end is never reached"),
        ({"life": {"cadence_h": 1e6}}, "longer than half of the lives"),
        ({"life": {"cadence_h": 40, "damaged_cadence_h": 50}}, "longer than cadence_h"),
        ({"life": {"cadence_h": 40, "damaged_from_mm": 6}}, "beyond life.end.length_mm"),
        ({"life": {"cadence_h": 40, "entry_h": 3000, "withdrawal_h": 2000}}, "before entry_h"),
        ({"faults": [{"kind": "inner", "profile": "trace", "trace_um": [0, 3, 0], "width_mm": 0.3}]}, "would stretch"),
        ({"life": {"cadence_h": 40, "history_h": 1e-4}}, "life.history_h: is too short"),
        ({"life": {"cadence_h": 40, "temperature_history_k": 3}}, "no effect without oil"),
        ({"faults": [{"kind": "cage"}]}, "cage has no life"),
        ({"faults": [{"kind": "healthy"}]}, "healthy has no life"),
        ({"faults": [{"kind": "inner", "width_mm": 0.3, "n_spalls": 2}]}, "one spall grows"),
        ({"operation.load_n": "uniform(3000, 4000)"}, "add per=specimen"),
        ({"storage.records_per_part": 60}, "a multiple of the 40 snapshots"),
        ({"records": 60}, "a multiple of the 40 snapshots"),
        (
            {"level": {"kind": "snr", "healthy_db": 0, "faulty_db": 0, "rms_m_s2": 1}},
            "a drawn level would hide the growth",
        ),
        ({"truth": {"undetected": "redraw"}}, "a life is never drawn again"),
        ({"bearing": {"n_balls": 9, "pitch_diameter_mm": 40, "ball_diameter_mm": 8}}, "no dynamic rating"),
        ({"specimen.contact_angle_deg": 10, "operation.axial_load_n": 3000}, "under radial loads alone"),
    ],
)
def test_a_life_that_cannot_be_is_refused_in_one_sentence(changes, sentence):
    with pytest.raises(RecipeError) as error:
        Recipe(small_with(LIVES | changes))
    assert sentence in str(error.value)
    assert "\n" not in str(error.value)


def test_an_overload_test_must_be_asked_for():
    life = LIVES["life"] | {"accelerated": True, "cadence_h": 0.1, "history_h": 10}
    assert Recipe(small_with(LIVES | {"operation.load_n": 15_000, "life": life})).life.accelerated
