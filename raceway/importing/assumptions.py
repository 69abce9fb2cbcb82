"""Sentences on what the labels and units of an imported corpus rest on, for its data card.

A corpus is only as right as its labels: a false unit or class shows in no number. So the card says where each fact comes from.
"""

from collections.abc import Iterator, Sequence

from gen.physics.bearing import orders
from gen.physics.bearing_text import geometry_text
from gen.physics.catalogue import CATALOGUE
from gen.support.display import first_few
from raceway.importing.label_keys import Labels

_TOPICS = {
    "fault": ("Class", ""),
    "specimen": ("Specimen", ""),
    "shaft_rpm": ("Shaft speed (rpm)", "stated in the files, or else nominal"),
    "load_n": ("Load (N)", "not known"),
    "sample_rate_hz": ("Sample rate", "stated in the files"),
}
"""Keys with their topic, and the source of a fact that no file has a key for."""
_MOST_PATHS = 3  # shown of the files that a sentence holds for


def assumptions(files: Sequence[Labels], fs: float) -> tuple[str, ...]:
    """One sentence for each fact and its source; for each unit and bearing, with its files if not all have it."""
    stored = {"sample_rate_hz": f", stored at {fs:g} Hz"}
    told = list[str]()
    for key, (topic, otherwise) in _TOPICS.items():
        # a measured speed is told of each file
        of_key = [labels for labels in files if key != "shaft_rpm" or labels.speed_column is None]
        told += [f"{topic}: {_source(of_key, key, otherwise)}{stored.get(key, '')}"] if of_key else []
    paths_of: dict[str, list[str]] = {}
    for labels in files:
        for sentence in _of_file(labels):
            paths_of.setdefault(sentence, []).append(labels.path)
    for sentence, paths in paths_of.items():
        some = "" if len(paths) == len(files) else f" ({first_few(paths, _MOST_PATHS)})"
        told.append(sentence + some)
    return tuple(f"{sentence}." for sentence in sorted(told, key=lambda sentence: sentence.partition(":")[0]))


def _of_file(labels: Labels) -> Iterator[str]:
    for sensor in labels.sensors:
        yield f"Unit{f' of channel {sensor.name}' if labels.channels else ''}: {sensor.scale}"
    if labels.speed_column is not None:
        yield f"Shaft speed (rpm): mean of the course in {labels.speed_column}"
    bearing = labels.bearing
    source = "from the catalogue" if bearing in CATALOGUE.values() else "as given"
    bpfo, bpfi, bsf = (getattr(orders(bearing), name) for name in ("bpfo", "bpfi", "bsf"))
    yield (
        f"Bearing: {bearing.designation}, geometry {source}: {geometry_text(bearing)}; BPFO {bpfo:.4g}, BPFI {bpfi:.4g}, "
        f"2 BSF {2 * bsf:.4g} orders"
    )


def _source(files: Sequence[Labels], key: str, otherwise: str) -> str:
    """Where a fact comes from, in words."""
    values = {getattr(labels, key) for labels in files}
    if len(values) > 1:
        return "given for each file"
    (value,) = values
    return otherwise if value is None else f"given as {f'{value:.10g}' if isinstance(value, float) else value}"
