"""Patterns of paths: ``*`` and ``?`` stand for letters of one name, ``**`` for folders, ``{fault}`` for letters that are a fact.

Patterns come from strangers. They cannot leave the folder, and they are not regular expressions: a name is compared in a time that is
bounded by the number of wildcards, at most eight in a name of the path, and its length squared.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

_GROUP = re.compile(r"\{([a-z][a-z0-9_]{0,39})\}")
_MOST_WILDCARDS = 8  # of one name of a path
Suits = Callable[[str], bool]


class Token(NamedTuple):
    """Part of a pattern: a text, ``*`` (any letters), ``?`` (one letter), or a group (one letter or more) with its name."""

    kind: str
    text: str = ""


class PathPattern(NamedTuple):
    """A pattern as written, and the tokens of each name of the path; None stands for ``**``."""

    text: str
    names: tuple[tuple[Token, ...] | None, ...]

    @property
    def groups(self) -> tuple[str, ...]:
        """Names of the groups."""
        return tuple(token.text for name in self.names for token in name or () if token.kind == "group")

    @property
    def wildcard(self) -> str:
        """The pattern with ``*`` in place of each group, for ``Path.glob``."""
        names = (re.sub(r"\*+", "*", _GROUP.sub("*", name)) if name != "**" else name for name in self.text.split("/"))
        return "/".join(names) if self.groups else self.text


def parse_pattern(text: str) -> PathPattern:
    """Pattern of a path with forward slashes.

    Raises
    ------
    ValueError
        With a sentence on what is wrong.
    """
    parts = Path(text).parts
    if Path(text).is_absolute() or ".." in parts:
        raise ValueError(
            f"{text} leads out of the folder of the recordings; put the mapping file in a folder above them"
        )
    beside_names = any("**" in part for part in parts if part != "**")  # Python 3.13 takes it for a single *
    if not parts or parts.count("**") > 1 or beside_names:  # each further ** looks at every folder once more
        raise ValueError(f"{text} is not a pattern of file names; write it like data/*.mat, with ** at most once")
    pattern = PathPattern(text, tuple(None if part == "**" else tuple(_tokens(part)) for part in parts))
    groups = pattern.groups
    twice = next((name for name in groups if groups.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"{text} has the group {{{twice}}} twice; write * for the second one")
    if groups and any(sum(token.kind != "text" for token in name or ()) > _MOST_WILDCARDS for name in pattern.names):
        raise ValueError(f"{text} has a name with more than {_MOST_WILDCARDS} wildcards and groups; use fewer")
    return pattern


def _tokens(name: str) -> Iterator[Token]:
    """Tokens of one name of a path; a set of letters in brackets is one letter, because the search for files has compared it."""
    for number, part in enumerate(_GROUP.split(name)):
        if number % 2:
            yield Token("group", part)
            continue
        for piece in re.findall(r"\*|\?|\[[^]]+\]|[^*?[]+|\[", part):
            if piece == "*":
                yield Token("any")
            elif piece == "?" or (piece[0] == "[" and len(piece) > 1):
                yield Token("one")
            else:
                yield Token("text", piece)


def match_path(pattern: PathPattern, path: str, suits: Mapping[str, Suits]) -> dict[str, str] | None:
    """Texts of the groups in a path with forward slashes; None if it does not fit.

    Earlier groups are as short as possible. ``suits`` tells of some groups whether a text is allowed.

    >>> pattern = parse_pattern("{rig}/{fault}_{shaft_rpm}_*.mat")
    >>> match_path(pattern, "a/outer_race_800_1.mat", {"shaft_rpm": str.isdigit})
    {'rig': 'a', 'fault': 'outer_race', 'shaft_rpm': '800'}
    """
    names = path.split("/")
    wanted = pattern.names
    if None in wanted:
        place = wanted.index(None)
        after = len(wanted) - place - 1
        if len(names) < len(wanted) - 1:
            return None
        wanted, names = wanted[:place] + wanted[place + 1 :], names[:place] + names[len(names) - after :]
    if len(names) != len(wanted):
        return None
    found: dict[str, str] = {}
    for tokens, name in zip(wanted, names, strict=True):
        ends = _ends(tokens or (), name, suits)
        if ends is None:
            return None
        found |= ends
    return found


def _ends(tokens: tuple[Token, ...], name: str, suits: Mapping[str, Suits]) -> dict[str, str] | None:
    """Texts of the groups in one name of a path; a place that once led nowhere is not tried again."""
    hopeless: set[tuple[int, int]] = set()

    def fit(number: int, start: int) -> dict[str, str] | None:
        if number == len(tokens):
            return {} if start == len(name) else None
        if (number, start) in hopeless:
            return None
        kind, text = tokens[number]
        for end in _candidates(kind, text, name, start):
            if kind == "group" and not suits.get(text, _anything)(name[start:end]):
                continue
            rest = fit(number + 1, end)
            if rest is not None:
                return {text: name[start:end], **rest} if kind == "group" else rest
        hopeless.add((number, start))
        return None

    return fit(0, 0)


def _candidates(kind: str, text: str, name: str, start: int) -> range | list[int]:
    """Places at which a token that starts at ``start`` can end."""
    if kind == "text":
        return [start + len(text)] if name.startswith(text, start) else []
    if kind == "one":
        return [start + 1] if start < len(name) else []
    return range(start + (kind == "group"), len(name) + 1)


def _anything(text: str) -> bool:  # noqa: ARG001
    return True


def fill_in(template: str, groups: Mapping[str, str]) -> str:
    """Text with the groups of a path in the place of their names in braces.

    >>> fill_in("X{number}_DE_time of {other}", {"number": "097"})
    'X097_DE_time of {other}'
    """
    return _GROUP.sub(lambda found: groups.get(found[1], found[0]), template)


def groups_in(text: str) -> list[str]:
    """Names of the groups that a text has in braces."""
    return _GROUP.findall(text)
