"""Laws of the durations of records, and of the model that suits them."""

from hypothesis import given
from hypothesis import strategies as st

from features.baselines import Model
from features.table.durations import SAME_DURATION, durations_of, suited
from tests.model_files import make_table


@given(st.lists(st.floats(0.01, 100), max_size=4))
def test_shorter_records_are_for_the_model_of_these(durations):
    short = Model(durations=(0.5, 0.5))
    model = Model(durations=(2.0, 2.0), shorter=short)
    below = bool(durations) and min(durations) < 2 / SAME_DURATION
    assert suited(model, durations) is (short if below else model)
    assert suited(short, durations) is short


def test_a_table_tells_its_shortest_and_longest_duration_or_none():
    table = make_table()
    told = table.assign(duration=("record", [0.5, 2.0, 1.0] * 8))
    assert (durations_of(table), durations_of(told), durations_of(told.isel(record=[]))) == ((), (0.5, 2.0), ())
