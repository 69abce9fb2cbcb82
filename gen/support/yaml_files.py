"""Reader of recipes and mapping files in YAML 1.2, safe for files from strangers.

An alias (``*name``) or a merge (``<<: *name``) counts with all the values that it repeats, so that nested aliases cannot grow beyond the
limit; values are counted while they are read, and reading stops at the limit. Only null, booleans, numbers, text, lists and mappings are
built. A date is text, and other tags are refused, so that a file cannot run code.
"""

import codecs
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    Event,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
    StreamEndEvent,
)

from gen.support.errors import RacewayError
from gen.support.limits import check_limit, limit

DEEPEST = 50  # levels, with aliases expanded; a recipe has about six
LONGEST_NUMBER = 100  # characters

_WORDS: dict[str, bool | None] = {
    "": None, "~": None, "null": None, "Null": None, "NULL": None,
    "true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False,
}  # fmt: skip
_INTEGER = re.compile(r"([-+]?)(0b[01_]+|0o[0-7_]+|0x[0-9a-fA-F_]+|[0-9_]+)")
_FLOAT = re.compile(
    r"[-+]?[0-9][0-9_]*\.[0-9_]*(?:[eE][-+]?[0-9]+)?|[-+]?[0-9][0-9_]*[eE][-+]?[0-9]+|[-+]?\.[0-9_]+(?:[eE][-+][0-9]+)?"
    r"|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)"
)
_BASES = {"0b": 2, "0o": 8, "0x": 16}
_LONG_TAG = re.compile(r"(?:^|[\s,\[{:-])!\S{500}")  # ruamel.yaml needs 7 s for a tag of one megabyte
_SURROGATE = re.compile("[\ud800-\udfff]")
_TAG = "tag:yaml.org,2002:"
_TYPES = {"null": type(None), "bool": bool, "int": int, "float": (int, float)}


class _Flaw(Exception):  # noqa: N818 - never leaves this file
    """An error in the YAML, with its line."""

    def __init__(self, problem: str, event: Event) -> None:
        super().__init__(problem)
        self.line: int = event.start_mark.line + 1


class _Node(NamedTuple):
    """A value, the number of values in it with aliases expanded, and the levels below it."""

    value: Any
    size: int
    height: int


def read_yaml(path: Path, error: type[RacewayError]) -> Any:
    """Read the one document of a YAML file.

    Parameters
    ----------
    path : Path
        A file in UTF-8, or in UTF-16 with a byte order mark.
    error : type
        Class of the error that is raised.

    Raises
    ------
    RacewayError
        Of class ``error``, if the file cannot be read, is not YAML of these types, or exceeds the limits ``yaml_bytes`` or
        ``yaml_values``.
    """
    try:
        if path.exists() and not path.is_file():
            raise error(f"{path}: cannot be read (is a folder, a pipe or a device); give a YAML file.")
        with path.open("rb") as stream:
            content = stream.read(limit("yaml_bytes") + 1)
            size = max(len(content), path.stat().st_size)
    except OSError as flaw:
        raise error(f"{path}: cannot be read ({flaw.strerror or flaw}); give a YAML file.") from None
    check_limit("yaml_bytes", size, f"{path}: is", error)
    try:
        wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        text = content.decode("utf-16" if wide else "utf-8")
    except UnicodeDecodeError as flaw:
        raise error(f"{path}: cannot be read ({flaw}); give a YAML file in UTF-8.") from None
    return parse_yaml(text, path, error)


def parse_yaml(text: str, where: Path | str, error: type[RacewayError]) -> Any:
    """Values of a YAML text; ``where`` is its place, for errors of the class ``error``, which are those of :func:`read_yaml`."""
    check_limit("yaml_bytes", len(text), f"{where}: is", error)
    if _LONG_TAG.search(text):
        raise error(f"{where}: is not valid YAML (a tag of more than 500 characters); correct it there.")
    try:
        return _Document(text, where, error).read()
    except RacewayError:
        raise
    except Exception as flaw:  # ruamel.yaml raises a dozen unrelated types on damaged text
        place, reason = _place_and_reason(flaw)
        raise error(f"{where}: {place}is not valid YAML ({reason}); correct it there.") from flaw


def _place_and_reason(flaw: Exception) -> tuple[str, str]:
    """Line of an error, if it is known, and the reason."""
    line = getattr(flaw, "line", None)
    reason = str(flaw)
    if isinstance(flaw, MarkedYAMLError):
        line = flaw.problem_mark.line + 1 if flaw.problem_mark else None
        reason = str(flaw.problem or flaw.context)
    return f"line {line}: " if line else "", " ".join(reason.split())[:200] or type(flaw).__name__


class _Document:
    """State of reading a document: its events, the count of values, and the values that aliases can repeat."""

    def __init__(self, text: str, where: Path | str, error: type[RacewayError]) -> None:
        self.events: Iterator[Event] = YAML(typ="safe", pure=True).parse(text)
        self.where, self.error = where, error
        self.count, self.most = 0, limit("yaml_values")
        self.anchors: dict[str, _Node | None] = {}

    def read(self) -> Any:
        """Value of the document; None if the file is empty."""
        next(self.events)
        start = next(self.events)
        if isinstance(start, StreamEndEvent):
            return None
        if isinstance(start, DocumentStartEvent) and start.version not in (None, (1, 2)):
            raise _Flaw("only YAML 1.2 is read", start)
        value = self.node(next(self.events), 0).value
        next(self.events)
        after = next(self.events)
        if not isinstance(after, StreamEndEvent):
            raise _Flaw("a second document begins here", after)
        return value

    def node(self, event: Any, depth: int) -> _Node:
        """Build the value that begins with ``event``, at ``depth`` levels."""
        if isinstance(event, AliasEvent):
            return self.repeat(event, depth)
        if depth > DEEPEST:
            raise _Flaw(f"more than {DEEPEST} levels deep", event)
        before = self.count
        self.add(1, event)
        if event.anchor is not None:
            self.anchors[event.anchor] = None
        if isinstance(event, ScalarEvent):
            value, height = _scalar(event), 0
        elif isinstance(event, SequenceStartEvent):
            value, height = self.sequence(event, depth)
        elif isinstance(event, MappingStartEvent):
            value, height = self.mapping(event, depth)
        else:
            raise _Flaw("no value begins here", event)
        built = _Node(value, self.count - before, height)
        if event.anchor is not None:
            self.anchors[event.anchor] = built
        return built

    def add(self, values: int, event: Event) -> None:
        """Count values; stop at the limit."""
        self.count += values
        if self.count > self.most:
            line = event.start_mark.line + 1
            check_limit(
                "yaml_values", self.count, f"{self.where}: up to line {line}, with aliases expanded, holds", self.error
            )

    def repeat(self, event: Any, depth: int) -> _Node:
        """Value that an alias repeats; it is counted again."""
        if event.anchor not in self.anchors:
            raise _Flaw(f"there is no &{event.anchor} before *{event.anchor}", event)
        anchored = self.anchors[event.anchor]
        if anchored is None:
            raise _Flaw(f"*{event.anchor} is inside the value that it repeats", event)
        if depth + anchored.height > DEEPEST:
            raise _Flaw(f"more than {DEEPEST} levels deep", event)
        self.add(anchored.size, event)
        return anchored

    def sequence(self, start: Any, depth: int) -> tuple[list[Any], int]:
        """List that begins with ``start``, and the number of levels below it."""
        _check_tag(start, "seq")
        values: list[Any] = []
        height = 0
        while not isinstance(event := next(self.events), SequenceEndEvent):
            value, _, below = self.node(event, depth + 1)
            values.append(value)
            height = max(height, below + 1)
        return values, height

    def mapping(self, start: Any, depth: int) -> tuple[dict[Any, Any], int]:
        """Mapping that begins with ``start``, with merged mappings first, and the number of levels below it."""
        _check_tag(start, "map")
        own: dict[Any, Any] = {}
        merged: dict[Any, Any] | None = None
        height = 0
        while not isinstance(key_event := next(self.events), MappingEndEvent):
            key = self.key(key_event)
            merging = key == "<<" and isinstance(key_event, ScalarEvent) and key_event.implicit[0]
            if (merging and merged is not None) or (not merging and key in own):
                raise _Flaw(f"the key {str(key)[:60]} occurs twice", key_event)
            event = next(self.events)
            value, _, below = self.node(event, depth + 1)
            height = max(height, below + 1)
            if merging:
                merged = _merge(value, event)
            else:
                own[key] = value
        return (own if merged is None else merged | own), height

    def key(self, event: Any) -> Any:
        """Key of a mapping, which cannot be a list or mapping."""
        if isinstance(event, AliasEvent):
            key = self.repeat(event, 0).value
        elif isinstance(event, ScalarEvent):
            key = _scalar(event)
            if event.anchor is not None:
                self.anchors[event.anchor] = _Node(key, 1, 0)
        else:
            key = []
        if isinstance(key, list | dict):
            raise _Flaw("a key must be one word, not a list or mapping", event)
        return key


def _merge(value: Any, event: Event) -> dict[Any, Any]:
    """Keys that ``<<`` merges from one mapping or several; the first mapping takes precedence."""
    merged: dict[Any, Any] = {}
    for mapping in reversed(value) if isinstance(value, list) else (value,):
        if not isinstance(mapping, dict):
            raise _Flaw("<< merges a mapping or a list of mappings", event)
        merged |= mapping
    return merged


def _check_tag(event: Any, kind: str) -> None:
    if event.tag not in (None, "!", _TAG + kind):
        _refuse_tag(event)


def _refuse_tag(event: Any) -> NoReturn:
    raise _Flaw(f"the tag {str(event.tag)[:60]} is not allowed", event)


def _scalar(event: Any) -> Any:
    """Value of a scalar: null, a boolean, a number or text."""
    text, tag = event.value, event.tag
    if _SURROGATE.search(text):
        raise _Flaw("a lone surrogate, which is half a character", event)
    if tag in (None, "!"):
        return text if event.style else _plain(text, event)
    if tag == _TAG + "str":
        return text
    kind = tag.removeprefix(_TAG)
    if kind not in _TYPES or not tag.startswith(_TAG):
        _refuse_tag(event)
    value = _plain(text, event)
    if not isinstance(value, _TYPES[kind]) or (isinstance(value, bool) and kind != "bool"):
        raise _Flaw(f"{text[:60]} is not of type {kind}", event)
    return float(value) if kind == "float" else value


def _plain(text: str, event: Any) -> Any:
    """Value of text without quotes, by the rules of YAML 1.2."""
    if text in _WORDS:
        return _WORDS[text]
    if text[0] not in "-+.0123456789":
        return text
    integer = _INTEGER.fullmatch(text)
    if integer is None and _FLOAT.fullmatch(text) is None:
        return text
    if len(text) > LONGEST_NUMBER:
        raise _Flaw(f"a number of {len(text)} characters; at most {LONGEST_NUMBER} are read", event)
    try:
        if integer is None:
            number = text.replace("_", "").lower()
            return float(number.replace(".", "") if number.endswith(("inf", "nan")) else number)
        sign, digits = integer[1], integer[2].replace("_", "")
        base = _BASES.get(digits[:2], 10)
        return int(sign + (digits if base == 10 else digits[2:]), base)
    except ValueError:  # underscores alone
        return text
