"""Laws of growth: a corpus of many parts is like one of few."""

import shutil

from gen.corpus import RECIPE_NAME, part_name, read_manifest
from gen.corpus.manifest import facts_of_parts, write_manifest


def test_parts_beyond_the_hundred_thousandth_are_in_the_order_of_their_records(copied):
    names = [part_name(number) for number in (99_999, 100_000)]
    for name in names:
        shutil.copy(copied / "parts" / part_name(0), copied / "parts" / name)
    for number in range(3):
        (copied / "parts" / part_name(number)).unlink()
    write_manifest(copied, facts_of_parts([], {"title": "unfinished"}, complete=False))
    assert (copied / RECIPE_NAME).is_file()
    assert [row.name for row in read_manifest(copied).parts] == names
