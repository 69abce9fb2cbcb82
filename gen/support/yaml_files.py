"""Reader of recipes and common keys of labels in YAML 1.2, safe for files from strangers.

The safe loader of ruamel.yaml builds null, booleans, numbers, text, lists and mappings; a date is text, and other tags are refused. An
alias (``*name``) or a merge (``<<: *name``) counts with all the values that it repeats, so that nested aliases cannot grow beyond the
limit; values are counted while they are read, and reading stops at the limit.
"""

import codecs
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

from ruamel.yaml import YAML
from ruamel.yaml.composer import Composer
from ruamel.yaml.constructor import SafeConstructor
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.events import AliasEvent
from ruamel.yaml.nodes import MappingNode, ScalarNode

from gen.support.errors import RacewayError
from gen.support.limits import check_limit, limit

DEEPEST = 50  # levels; a recipe has about six
LONGEST_NUMBER = 100  # characters

_LONG_TAG = re.compile(r"(?:^|[\s,\[{:-])!\S{500}")  # ruamel.yaml needs 7 s for a tag of one megabyte
_OTHER_VERSION = re.compile(r"^%YAML (?!1\.2\s)", re.MULTILINE)
_SURROGATE = re.compile("[\ud800-\udfff]")


class _TooManyError(Exception):
    """The values are more than the limit; the arguments are their number and the line."""


class _Composer(Composer):
    """Nodes of a document, whose values are counted."""

    def __init__(self, loader: Any) -> None:
        super().__init__(loader)
        self.warn_double_anchors = False
        self.levels = self.count = 0
        self.most = limit("yaml_values")
        self.sizes: dict[Any, int] = {}

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Build the next node; an alias is counted again."""
        event, before = self.parser.peek_event(), self.count
        self.levels += 1
        if self.levels > DEEPEST:
            _refuse(f"more than {DEEPEST} levels deep", event)
        node = super().compose_node(parent, index)
        self.levels -= 1
        if not isinstance(event, AliasEvent):
            # an alias counts as often as the value that it repeats, so that few bytes cannot ask for much
            self.sizes[node] = self.count + 1 - before
            self.count += 1
        elif node in self.sizes:
            self.count += self.sizes[node]
        else:
            _refuse(f"*{event.anchor} is inside the value that it repeats", event)
        if self.count > self.most:
            raise _TooManyError(self.count, event.start_mark.line + 1)
        if isinstance(parent, MappingNode) and index is None and not isinstance(node, ScalarNode):
            _refuse("a key must be one word, not a list or mapping", event)
        if isinstance(node, ScalarNode) and _SURROGATE.search(node.value):
            _refuse("a lone surrogate, which is half a character", event)
        return node


class _Constructor(SafeConstructor):
    """Values of nodes of the plain types."""

    def construct_yaml_int(self, node: Any) -> Any:
        return _number(super().construct_yaml_int, node)

    def construct_yaml_float(self, node: Any) -> Any:
        return _number(super().construct_yaml_float, node)

    def construct_yaml_timestamp(self, node: Any) -> Any:  # pyright: ignore[reportIncompatibleMethodOverride]
        return self.construct_yaml_str(node)

    def construct_undefined(self, node: Any) -> NoReturn:
        _refuse(f"the tag {str(node.tag)[:60]} is not allowed", node)


_Constructor.yaml_constructors = {
    f"tag:yaml.org,2002:{name}": getattr(_Constructor, f"construct_yaml_{name}")
    for name in ("null", "bool", "int", "float", "str", "timestamp", "seq", "map")
} | {None: _Constructor.construct_undefined}


def _number(construct: Callable[[Any], Any], node: Any) -> Any:
    if len(node.value) > LONGEST_NUMBER:
        _refuse(f"a number of {len(node.value)} characters; at most {LONGEST_NUMBER} are read", node)
    try:
        return construct(node)
    except ValueError:
        _refuse(f"{node.value} is no number", node)


def _refuse(problem: str, at: Any) -> NoReturn:
    raise MarkedYAMLError(problem=problem, problem_mark=at.start_mark)


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
            # one byte more than allowed shows a file that is too long, and no more is read
            content = stream.read(limit("yaml_bytes") + 1)
            size = max(len(content), path.stat().st_size)
    except OSError as flaw:
        raise error(f"{path}: cannot be read ({flaw.strerror or flaw}); give a YAML file.") from None
    check_limit("yaml_bytes", size, f"{path}: is", error)
    try:
        # text editors of Windows write UTF-16
        wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        text = content.decode("utf-16" if wide else "utf-8")
    except UnicodeDecodeError as flaw:
        raise error(f"{path}: cannot be read ({flaw}); give a YAML file in UTF-8.") from None
    return parse_yaml(text, path, error)


def parse_yaml(text: str, where: Path | str, error: type[RacewayError]) -> Any:
    """Values of a YAML text; ``where`` is its place, for errors of the class ``error``, which are those of :func:`read_yaml`."""
    check_limit("yaml_bytes", len(text), f"{where}: is", error)
    for unread, reason in ((_LONG_TAG, "a tag of more than 500 characters"), (_OTHER_VERSION, "only YAML 1.2 is read")):
        if unread.search(text):
            raise error(f"{where}: is not valid YAML ({reason}); correct it there.")
    loader = YAML(typ="safe", pure=True)
    loader.Composer, loader.Constructor = _Composer, _Constructor
    try:
        return loader.load(text)
    except _TooManyError as flaw:
        count, line = flaw.args
        check_limit("yaml_values", count, f"{where}: up to line {line}, with aliases expanded, holds", error)
    except Exception as flaw:  # ruamel.yaml raises a dozen unrelated types on damaged text
        place, reason = _place_and_reason(flaw)
        raise error(f"{where}: {place}is not valid YAML ({reason}); correct it there.") from flaw


def _place_and_reason(flaw: Exception) -> tuple[str, str]:
    """Line of an error, if it is known, and the reason."""
    line = getattr(flaw, "line", None)
    reason = str(flaw)
    if isinstance(flaw, MarkedYAMLError):
        line = flaw.problem_mark.line + 1 if flaw.problem_mark else None
        reason = " ".join(filter(None, (flaw.context, flaw.problem)))
    return f"line {line}: " if line else "", " ".join(reason.split())[:200] or type(flaw).__name__
