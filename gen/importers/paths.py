"""Patterns of paths: ``*`` and ``?`` stand for letters of one name, ``**`` for folders, ``{fault}`` for letters that are a fact.

Patterns come from strangers. They cannot leave the folder, and they are not regular expressions, which can take for ever: a path is
compared in a time that is bounded by the number of wildcards, its length, and the length of a name.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

_GROUP = re.compile(r"\{([a-z][a-z0-9_]{0,39})\}")
# folders, letters, a letter, a letter of a set, a group, a text
_TOKEN = re.compile(r"\*\*(?:/|$)|\*|\?|\[[^]/{}]+\]|\{[a-z][a-z0-9_]{0,39}\}|[^*?\[{]+|.")
_MOST_WILDCARDS = 16
Suits = Callable[[str], bool]


class PathPattern(NamedTuple):
    """A pattern as written, and its tokens."""

    text: str
    tokens: tuple[str, ...]

    @property
    def groups(self) -> tuple[str, ...]:
        """Names of the groups."""
        return tuple(name for token in self.tokens for name in _GROUP.findall(token))

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
            f"{text} leads out of the folder of the recordings; put the mapping file in a folder above them."
        )
    beside_names = any("**" in part for part in parts if part != "**")  # Python 3.13 takes it for a single *
    if not parts or parts.count("**") > 1 or beside_names:  # each further ** looks at every folder once more
        raise ValueError(f"{text} is not a pattern of file names; write it like data/*.mat, with ** at most once.")
    pattern = PathPattern(text, tuple(_TOKEN.findall(text)))
    groups = pattern.groups
    twice = next((name for name in groups if groups.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"{text} has the group {{{twice}}} twice; write * for the second one.")
    if groups and sum(not _is_text(token) for token in pattern.tokens) > _MOST_WILDCARDS:
        raise ValueError(f"{text} has more than {_MOST_WILDCARDS} wildcards and groups; use fewer.")
    return pattern


def _is_text(token: str) -> bool:
    return token[0] not in "*?[{" or token in ("[", "{")


def match_path(pattern: PathPattern, path: str, suits: Mapping[str, Suits]) -> dict[str, str] | None:
    """Texts of the groups in a path with forward slashes; None if it does not fit.

    Earlier groups are as short as possible. ``suits`` tells of some groups whether a text is allowed.

    >>> pattern = parse_pattern("{rig}/{fault}_{shaft_rpm}_*.mat")
    >>> match_path(pattern, "a/outer_race_800_1.mat", {"shaft_rpm": str.isdigit})
    {'rig': 'a', 'fault': 'outer_race', 'shaft_rpm': '800'}
    """

    @cache  # a place that once led nowhere is not tried again
    def fit(number: int, start: int) -> dict[str, str] | None:
        if number == len(pattern.tokens):
            return {} if start == len(path) else None
        token = pattern.tokens[number]
        group = _GROUP.fullmatch(token)
        for end in _ends(token, path, start):
            if group and not suits.get(group[1], bool)(path[start:end]):
                continue
            rest = fit(number + 1, end)
            if rest is not None:
                return {group[1]: path[start:end], **rest} if group else rest
        return None

    return fit(0, 0)


def _ends(token: str, path: str, start: int) -> Iterable[int]:
    """Places at which a token that starts at ``start`` can end; a set of letters is any letter, because ``Path.glob`` has compared it."""
    if _is_text(token):
        return [start + len(token)] if path.startswith(token, start) else []
    if token.startswith("**"):
        return [start, *(place + 1 for place in range(start, len(path)) if path[place] == "/"), len(path)]
    slash = path.find("/", start)
    stop = len(path) if slash < 0 else slash
    if token[0] in "?[":
        return [start + 1] if start < stop else []
    return range(start + (token[0] == "{"), stop + 1)


def fill_in(template: str, groups: Mapping[str, str]) -> str:
    """Text with the groups of a path in the place of their names in braces.

    >>> fill_in("X{number}_DE_time of {other}", {"number": "097"})
    'X097_DE_time of {other}'
    """
    return _GROUP.sub(lambda match: groups.get(match[1], match[0]), template)


def groups_in(text: str) -> list[str]:
    """Names of the groups that a text has in braces."""
    return _GROUP.findall(text)
