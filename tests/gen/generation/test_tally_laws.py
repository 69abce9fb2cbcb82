"""Laws of the counts of generation: the parts hold every record once, and the count of a part never falls."""

from gen.generation.corpus import Tally


def test_a_task_that_dask_repeats_does_not_lower_the_count_of_its_part(recipe_with):
    shown = []
    tally = Tally(recipe_with(), lambda *counts: shown.append(counts))
    tally.show()
    for part, records in ((0, 7), (1, 3), (0, 2), (1, 8)):
        tally.note_and_show(part, records)
    assert shown == [(7, 24), (10, 24), (10, 24), (15, 24)]
