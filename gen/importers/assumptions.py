"""Sentences on what the labels and units of an imported corpus rest on, for its data card.

A corpus is only as right as its mapping: a false unit or a class taken from the wrong part of a path shows in no number. So the card says
where each fact comes from.
"""

from collections.abc import Iterator, Mapping, Sequence

from gen.importers.mapping_keys import Reading
from gen.importers.mapping_values import bearing_of
from gen.importers.paths import groups_in
from gen.importers.section import Section
from gen.physics.bearing import orders

_TOPICS = {"fault": "Class", "specimen": "Specimen", "shaft_rpm": "Shaft speed (rpm)", "load_n": "Load (N)"}
_MOST_TEXTS, _MOST_PATHS = 12, 3  # shown of a table, and of the patterns that a sentence holds for


def assumptions(sections: Sequence[Section], fs: float) -> tuple[str, ...]:
    """One sentence for each fact and each of its sources, with the patterns of paths that it holds for."""
    paths_of: dict[str, list[str]] = {}
    for section in sections:
        for sentence in _of_section(section, fs):
            paths_of.setdefault(sentence, []).append(section.pattern.text)
    return tuple(
        f"{sentence}." if len(paths) == len(sections) else f"{sentence} ({_listed(paths, _MOST_PATHS)})."
        for sentence, paths in sorted(paths_of.items(), key=lambda item: item[0].partition(":")[0])
    )


def _of_section(section: Section, fs: float) -> Iterator[str]:
    for sensor in section.sensors():
        yield f"Unit{f' of channel {sensor.name}' if sensor.name else ''}: {sensor.scale}"
    given = section.keys.bearing
    if given is None:
        yield "Bearing: named in the path, geometry from the catalogue"
    else:
        bearing, source = bearing_of(given), "from the catalogue" if isinstance(given, str) else "as given"
        bpfo, bpfi, bsf = (getattr(orders(bearing), name) for name in ("bpfo", "bpfi", "bsf"))
        yield (
            f"Bearing: {bearing.designation}, geometry {source}: {bearing.n_balls} balls of "
            f"{1e3 * bearing.ball_diameter:g} mm on {1e3 * bearing.pitch_diameter:g} mm; BPFO {bpfo:.4g}, BPFI {bpfi:.4g}, "
            f"2 BSF {2 * bsf:.4g} orders"
        )
    for key, topic in _TOPICS.items():
        yield f"{topic}: {_source(section, key)}"
    rate = _source(section, "sample_rate_hz")
    yield f"Sample rate: {rate if rate != 'not known' else 'stated in the files'}, stored at {fs:g} Hz"


def _source(section: Section, key: str) -> str:
    """Where a fact comes from, in words."""
    form = getattr(section.keys, key)
    times = f", times {form.times:g}" if isinstance(form, Reading) and form.times != 1 else ""
    if key in section.in_file:
        return f"variable {form.variable} of each file{times}"
    if key in section.from_path:
        return (
            f"from the path, {_table(form)}"
            if isinstance(form, dict)
            else f"from the path, {section.pattern.text}{times}"
        )
    if form is None:
        return "not known"
    return f"{form} with the texts of the path" if groups_in(str(form)) else f"given as {_shown(form)}"


def _table(table: Mapping[str, object]) -> str:
    return _listed([f"{text} is {_shown(value)}" for text, value in table.items()], _MOST_TEXTS)


def _shown(value: object) -> str:
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def _listed(items: Sequence[str], most: int) -> str:
    """First items of a list, and the number of the others."""
    return ", ".join(items[:most]) + (f" and {len(items) - most} more" if len(items) > most else "")
