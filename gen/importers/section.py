"""A section of a mapping file: the files of one path, with their own keys and those at the top.

A group of the path with the name of a fact, such as ``{shaft_rpm}``, gives that fact; ``{group}`` in a text is filled in.
"""

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

from gen.importers.conversion import VOLTAGES, Scale, unit_problem, volts_per_acceleration
from gen.importers.mapping_keys import NUMBERS, SPALL_KEYS, WITHOUT_SPALL, Facts, FileKeys, Reading, Sensor
from gen.importers.paths import PathPattern, Suits, fill_in, groups_in, parse_pattern
from gen.importers.signals import STATING_RATES, Place

_LONGEST_NUMBER = 20
_NOTHING: Mapping[str, Any] = MappingProxyType({})
_ELSEWHERE = "is missing; give it there, or at the top for all files."


class Section(NamedTuple):
    """A section: its number, its path, and the keys of its files."""

    position: int
    pattern: PathPattern
    keys: FileKeys

    @property
    def from_path(self) -> tuple[str, ...]:
        """Facts that the path gives."""
        return tuple(group for group in self.pattern.groups if group in Facts.model_fields)

    @property
    def in_file(self) -> dict[str, Reading]:
        """Facts that are numbers in the file."""
        forms = {key: getattr(self.keys, key) for key in NUMBERS}
        return {key: form for key, form in forms.items() if isinstance(form, Reading) and form.variable is not None}

    @property
    def tables(self) -> dict[str, dict[str, Any]]:
        """Facts with a value for each text in the path."""
        forms = {key: getattr(self.keys, key) for key in self.from_path}
        return {key: form for key, form in forms.items() if isinstance(form, dict)}

    def suits(self) -> dict[str, Suits]:
        """For each group that not every text suits, whether a text does."""
        numbers: dict[str, Suits] = {key: _is_number for key in self.from_path if key in NUMBERS}
        return numbers | {key: table.__contains__ for key, table in self.tables.items()}

    def wanted(self) -> str:
        """Words on what the groups of a path must be; empty if any text will do."""
        needs = [f"{key} a number" for key in self.from_path if key in NUMBERS and key not in self.tables]
        needs += [f"{key} one of {', '.join([*table][:8])}" for key, table in self.tables.items()]
        return f" with {' and '.join(needs)}" if needs else ""

    def facts(self, groups: Mapping[str, str], measured: Mapping[str, float] = _NOTHING) -> Facts:
        """Facts of a file with the texts of its path and the numbers ``measured`` in it.

        Raises
        ------
        ValidationError
            If the path or the file gives a value that is not allowed.
        """
        values: dict[str, Any] = {}
        for key in Facts.model_fields:
            form = getattr(self.keys, key)
            if key in self.from_path:
                values[key] = _from_path(key, form, groups[key])
            elif isinstance(form, Reading):
                values[key] = measured.get(key)
            elif form is not None:
                values[key] = fill_in(form, groups) if isinstance(form, str) else form
        if "fault" in self.from_path and values["fault"] in WITHOUT_SPALL:
            values = {key: value for key, value in values.items() if key not in SPALL_KEYS}
        return Facts.model_validate(values)

    def sensors(self, groups: Mapping[str, str] = _NOTHING) -> Iterator[Sensor]:
        """Channels in their order, with the keys of the file where a channel has none; a single one has no name."""
        keys = self.keys
        for channel in keys.channels or (None,):
            own = channel or keys
            unit = own.unit or keys.unit
            given = own if own.sensitivity_mv_per_g or own.sensitivity_mv_per_m_s2 or unit not in VOLTAGES else keys
            sensitivity = volts_per_acceleration(given.sensitivity_mv_per_g, given.sensitivity_mv_per_m_s2)
            variable = own.variable or keys.variable
            column = keys.column if own.column is None else own.column
            place = Place(variable and fill_in(variable, groups), column, keys.delimiter)
            yield Sensor(channel.name if channel else "", place, Scale(unit or "m/s2", sensitivity))


def sections_of(common: FileKeys, files: Sequence[FileKeys]) -> tuple[Section, ...]:
    """Sections with all keys that hold for their files; a value at the top gives way to the path and to a key of the file.

    Raises
    ------
    ValueError
        If the keys of a section do not belong together; with one sentence.
    """
    sections: list[Section] = []
    for position, own in enumerate(files):
        path = own.path or common.path
        if path is None:
            raise ValueError(f"files[{position}].path: {_ELSEWHERE}")
        pattern = parse_pattern(path)
        shared = {key: getattr(common, key) for key in FileKeys.model_fields
                  if key in common.model_fields_set - own.model_fields_set
                  and (key not in pattern.groups or _is_of_the_path(getattr(common, key)))}  # fmt: skip
        section = Section(position, pattern, own.model_copy(update=shared))
        problem = _path_problem(section) or _missing(section) or _fault_problem(section) or _sensor_problem(section)
        if problem is not None:
            raise ValueError(f"files[{position}]{problem}")
        sections.append(section)
    return tuple(sections)


def _is_of_the_path(form: Any) -> bool:
    return isinstance(form, dict) or (isinstance(form, Reading) and form.variable is None)


def _path_problem(section: Section) -> str | None:
    """End of a sentence on a fact that is given twice, or that needs a group that the path does not have."""
    keys, groups = section.keys, section.pattern.groups
    for key in Facts.model_fields:
        form = getattr(keys, key)
        if key in groups and form is not None and not _is_of_the_path(form):
            return f".{key}: is given, and {{{key}}} in the path tells it too; remove one of the two."
        if key not in groups and _is_of_the_path(form):
            kind = "a table" if isinstance(form, dict) else "a factor"
            return (
                f".{key}: is {kind}, and path has no group {{{key}}}; write {{{key}}} in the path where it tells {key}."
            )
    texts = (text for text in (keys.specimen, keys.rig, keys.recording, keys.variable) if isinstance(text, str))
    lost = next((name for text in texts for name in groups_in(text) if name not in groups), None)
    return lost and f".path: has no group {{{lost}}}, which another key refers to; write {{{lost}}} in the path."


def _missing(section: Section) -> str | None:
    """End of a sentence on a key that every file needs."""
    keys = section.keys
    needed = ["bearing", "fault", "specimen", "shaft_rpm"]
    if not section.pattern.text.lower().endswith(STATING_RATES):
        needed.append("sample_rate_hz")
    if not (keys.channels and all(channel.unit for channel in keys.channels)):
        needed.append("unit")
    lacking = next((key for key in needed if getattr(keys, key) is None and key not in section.from_path), None)
    return lacking and f".{lacking}: {_ELSEWHERE}"


def _fault_problem(section: Section) -> str | None:
    """End of a sentence on a key of a spall where the fault has none."""
    keys = section.keys
    spall = next((key for key in SPALL_KEYS if getattr(keys, key) is not None or key in section.from_path), None)
    if spall is None or not isinstance(keys.fault, str) or keys.fault not in WITHOUT_SPALL:
        return None
    return f": {spall} describes a spall, and fault is {keys.fault}; remove one of the two."


def _sensor_problem(section: Section) -> str | None:
    """End of a sentence on units and sensitivities that do not belong together."""
    for keys in (section.keys, *(section.keys.channels or ())):
        if keys.sensitivity_mv_per_g is not None and keys.sensitivity_mv_per_m_s2 is not None:
            return ": sensitivity_mv_per_g and sensitivity_mv_per_m_s2 are both given; remove one of the two."
    for sensor in section.sensors():
        problem = unit_problem(*sensor.scale)
        if problem is not None:
            return f": {f'channel {sensor.name}: ' if sensor.name else ''}{problem}."
    return None


def _from_path(key: str, form: Any, text: str) -> Any:
    """Value of a fact that a text in the path tells."""
    if isinstance(form, dict):
        return form[text]
    times = form.times if isinstance(form, Reading) else 1.0
    return float(text) * times if key in NUMBERS else text


def _is_number(text: str) -> bool:
    whole, _, decimals = text.removeprefix("-").partition(".")
    digits = whole + decimals
    return len(text) <= _LONGEST_NUMBER and digits.isascii() and digits.isdigit() and whole != ""
