"""Laws of the counts of generation: the parts hold every record once, and the count of a part never falls."""

from hypothesis import given
from hypothesis import strategies as st

from gen.generation.corpus import Tally


@given(per_part=st.integers(1, 50), records=st.integers(1, 24))
def test_the_parts_hold_every_record_once(recipe_with, per_part, records):
    recipe = recipe_with({"storage.records_per_part": per_part, "records": records})
    numbers = [number for part in range(recipe.n_parts) for number in recipe.records_of_part(part)]
    assert numbers == list(range(recipe.n_records))
    assert recipe.n_records == records


def test_a_task_that_dask_repeats_does_not_lower_the_count_of_its_part(recipe_with):
    shown = []
    tally = Tally(recipe_with(), lambda *counts: shown.append(counts))
    tally.show()
    for part, records in ((0, 7), (1, 3), (0, 2), (1, 8)):
        tally.note_and_show(part, records)
    assert shown == [(7, 24), (10, 24), (10, 24), (15, 24)]
