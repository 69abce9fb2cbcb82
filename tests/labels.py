"""Tables of labels, and the corpora that are imported with them."""

import csv

from ruamel.yaml import YAML

from raceway.importing import import_generic


def write_labels(folder, rows, *, mark=",", name="labels.csv", **common):
    """Table with a row for each dict of keys, and beside it the keys of all rows; returns the path of the table."""
    columns = dict.fromkeys(key for row in rows for key in row)
    with (folder / name).open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, delimiter=mark)
        writer.writerows([columns, *([row.get(key, "") for key in columns] for row in rows)])
    if common:
        with (folder / name).with_suffix(".yaml").open("w", encoding="utf-8") as stream:
            YAML(typ="safe").dump(common, stream)
    return folder / name


def import_labelled(folder, rows, *, window=0.5, **common):
    """Corpus of recordings in a folder, and the counts and sentences of its import."""
    return import_generic(write_labels(folder, rows, **common), folder / "corpus", window=window)
