"""Conditions on records, such as ``fault == 'inner' and shaft_rate > 20``: a small grammar that is parsed, never evaluated as Python.

::

    condition   = term { "or" term }
    term        = factor { "and" factor }
    factor      = "not" factor | "(" condition ")" | comparison
    comparison  = value ("==" | "!=" | "<" | "<=" | ">" | ">=") value
                | name [ "not" ] "in" "(" literal { "," literal } ")"
    value       = name | literal
    literal     = number | text in single or double quotes

A name is a per-record variable. A class variable (``fault``, ``split``) is compared with the names of its values, and a text with text in
quotes; both know ``==``, ``!=`` and ``in`` only. Two variables can be compared if both have numbers. A comparison with NaN is false, ``!=``
too.
"""

import difflib
import math
import operator
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.errors import CorpusError

MOST_CHARACTERS = 4000
DEEPEST = 50
"""Largest depth of parentheses and ``not``."""

_OPERATORS: Mapping[str, Callable[[Any, Any], Any]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_EQUALITY = ("==", "!=")
_WORDS = ("and", "or", "not", "in")
_TOKEN = re.compile(
    r"""\s*(?:(?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![\w.]))|(?P<name>[^\W\d]\w*)"""
    r"""|(?P<text>'[^']*'|"[^"]*")|(?P<sign>[=!<>]=|[<>(),])|(?P<other>\S.{0,9}))""",
    re.ASCII | re.DOTALL,
)


class Column(NamedTuple):
    """Values of a per-record variable, shape (record,), and the names of its values if it is a class variable."""

    values: NDArray[Any]
    flags: Mapping[int, str] = {}


class Name(NamedTuple):
    """Name of a variable, and its place in the condition [characters from 1]."""

    text: str
    place: int


class Literal(NamedTuple):
    """A number or a text, and its place in the condition [characters from 1]."""

    value: float | str
    place: int


Value = Name | Literal
Columns = Callable[[Name], Column]


@dataclass(frozen=True)
class Comparison:
    """Two values and the operator between them."""

    left: Value
    operator: str
    right: Value

    def holds(self, column: Columns) -> NDArray[np.bool_]:
        """Whether the comparison is true, shape (record,)."""
        return _compared(self.left, self.operator, self.right, column)


@dataclass(frozen=True)
class Membership:
    """A variable and the values that it may have."""

    name: Name
    allowed: tuple[Literal, ...]

    def holds(self, column: Columns) -> NDArray[np.bool_]:
        """Whether the variable has one of the values, shape (record,)."""
        return np.logical_or.reduce([_compared(self.name, "==", literal, column) for literal in self.allowed])


@dataclass(frozen=True)
class Negation:
    """The opposite of a condition."""

    of: "Node"

    def holds(self, column: Columns) -> NDArray[np.bool_]:
        """Whether the condition is false, shape (record,)."""
        return ~self.of.holds(column)


@dataclass(frozen=True)
class Combination:
    """Conditions of which all must be true (``and``) or one (``or``)."""

    word: str
    terms: "tuple[Node, ...]"

    def holds(self, column: Columns) -> NDArray[np.bool_]:
        """Whether the combination is true, shape (record,)."""
        combine = np.logical_and if self.word == "and" else np.logical_or
        return combine.reduce([term.holds(column) for term in self.terms])


Node = Comparison | Membership | Negation | Combination


@dataclass(frozen=True)
class Condition:
    """A parsed condition."""

    text: str
    node: Node

    def holds(self, variables: Iterable[str], column: Callable[[str], Column]) -> NDArray[np.bool_]:
        """Whether the condition is true, shape (record,).

        ``variables`` are the names of all per-record variables; ``column`` is called with those that the condition names.

        Raises
        ------
        CorpusError
            If it names another variable, or compares one with a value that it cannot have.
        """
        known = list(variables)
        columns: dict[str, Column] = {}

        def found(name: Name) -> Column:
            if name.text not in known:
                raise _error(name.place, f"there is no variable {name.text}{nearest(name.text, known)}")
            if name.text not in columns:
                columns[name.text] = column(name.text)
            return columns[name.text]

        return self.node.holds(found)


def parse_where(text: str) -> Condition:
    """Condition from its text; the grammar is in the docstring of this module.

    >>> parse_where("n_spalls >= 1").holds(["n_spalls"], lambda name: Column(np.array([0, 1, 2])))
    array([False,  True,  True])

    Raises
    ------
    CorpusError
        If the text is not a condition, is too long or too deeply nested; the sentence has the place of the error.
    """
    if len(text) > MOST_CHARACTERS:
        raise CorpusError(f"where: has {len(text)} characters, at most {MOST_CHARACTERS} are allowed; shorten it.")
    return Condition(text, _Parser(_tokens(text)).whole())


def nearest(name: str, allowed: Sequence[str]) -> str:
    """End of a sentence about an unknown name: the nearest allowed one, or all of them if none is near.

    >>> nearest("shaftrate", ["fault", "shaft_rate"])
    '; the nearest is shaft_rate.'
    """
    near = difflib.get_close_matches(name, allowed, 1)
    return f"; the nearest is {near[0]}." if near else f"; allowed are {', '.join(allowed)}."


class _Token(NamedTuple):
    kind: str
    text: str
    place: int


def _tokens(text: str) -> list[_Token]:
    found = [
        _Token(str(match.lastgroup), match[str(match.lastgroup)], match.start(str(match.lastgroup)) + 1)
        for match in _TOKEN.finditer(text.rstrip())
    ]
    return [*found, _Token("end", "", len(text) + 1)]


class _Parser:
    """Reads tokens from left to right."""

    def __init__(self, tokens: list[_Token]) -> None:
        self._tokens, self._at, self._depth = tokens, 0, 0

    def whole(self) -> Node:
        node = self._combination("or")
        if self._next.kind != "end":
            raise self._expected("'and', 'or' or the end of the condition")
        return node

    @property
    def _next(self) -> _Token:
        return self._tokens[self._at]

    def _take(self, *texts: str) -> str | None:
        """Take the next token if it is one of ``texts``."""
        token = self._next
        if token.kind not in ("name", "sign") or token.text not in texts:
            return None
        self._at += 1
        return token.text

    def _combination(self, word: str) -> Node:
        part = self._factor if word == "and" else lambda: self._combination("and")
        terms = [part()]
        while self._take(word):
            terms.append(part())
        return terms[0] if len(terms) == 1 else Combination(word, tuple(terms))

    def _factor(self) -> Node:
        self._depth += 1
        if self._depth > DEEPEST:
            raise _error(self._next.place, f"parentheses and not are more than {DEEPEST} deep; write it with fewer.")
        try:
            if self._take("not"):
                return Negation(self._factor())
            if not self._take("("):
                return self._comparison()
            node = self._combination("or")
            if not self._take(")"):
                raise self._expected("a closing parenthesis, 'and' or 'or'")
            return node
        finally:
            self._depth -= 1

    def _comparison(self) -> Node:
        left = self._value()
        if isinstance(left, Name) and self._next.text in ("in", "not"):
            negated = bool(self._take("not"))
            if not self._take("in"):
                raise self._expected("in")
            member = Membership(left, self._literals())
            return Negation(member) if negated else member
        sign = self._take(*_OPERATORS)
        if sign is None:
            raise self._expected("a comparison (==, !=, <, <=, >, >=, in)")
        right = self._value()
        if isinstance(left, Literal) and isinstance(right, Literal):
            raise _error(left.place, "neither side of the comparison is the name of a variable; put one there.")
        if self._next.text in _OPERATORS:
            raise _error(self._next.place, "a comparison has two sides; join two comparisons with and.")
        return Comparison(left, sign, right)

    def _literals(self) -> tuple[Literal, ...]:
        if not self._take("("):
            raise self._expected("a list in parentheses, such as ('inner', 'outer'),")
        found = [self._literal()]
        while self._take(","):
            found.append(self._literal())
        if not self._take(")"):
            raise self._expected("a comma or a closing parenthesis")
        return tuple(found)

    def _literal(self) -> Literal:
        value = self._value()
        if isinstance(value, Name):
            raise _error(value.place, f"{value.text} is a name; put a text in quotes: '{value.text}'.")
        return value

    def _value(self) -> Value:
        token = self._next
        if token.kind == "name" and token.text not in _WORDS:
            self._at += 1
            return Name(token.text, token.place)
        if token.kind == "text":
            self._at += 1
            return Literal(token.text[1:-1], token.place)
        if token.kind == "number" and math.isfinite(float(token.text)):
            self._at += 1
            return Literal(float(token.text), token.place)
        raise self._expected("the name of a variable, a number or a text in quotes")

    def _expected(self, what: str) -> CorpusError:
        token = self._next
        found = "the condition ends" if token.kind == "end" else f"found {token.text!r}"
        hint = "; equality is written ==" if token.text.startswith("=") else ""
        return _error(token.place, f"{found} where {what} should follow{hint}.")


def _error(place: int, what: str) -> CorpusError:
    return CorpusError(f"where: character {place}: {what}")


def _compared(left: Value, sign: str, right: Value, column: Columns) -> NDArray[np.bool_]:
    """Result of a comparison of which one side or both are variables, shape (record,)."""
    if isinstance(left, Literal):
        mirrored = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}.get(sign, sign)
        return _compared(right, mirrored, left, column)
    one = column(left)
    if one.flags or not _has_numbers(one):
        return _names_compared(left, one, sign, right)
    if isinstance(right, Literal):
        if isinstance(right.value, str):
            raise _error(right.place, f"{left.text} has numbers; write the number without quotes.")
        against: Any = right.value
    else:
        other = column(right)
        if other.flags or not _has_numbers(other):
            raise _error(right.place, f"{left.text} has numbers and {right.text} has not; compare it with a number.")
        against = other.values.astype(np.float64)
    numbers = one.values.astype(np.float64)
    return _OPERATORS[sign](numbers, against) & ~np.isnan(numbers) & ~np.isnan(against)


def _has_numbers(column: Column) -> bool:
    return column.values.dtype.kind in "iuf"


def _names_compared(left: Name, one: Column, sign: str, right: Value) -> NDArray[np.bool_]:
    """Comparison of a class variable with the name of one of its values, or of a text with a text."""
    kind, names = "a class" if one.flags else "a text", list(one.flags.values())
    allowed = f"; allowed are {', '.join(names)}." if names else "."
    if isinstance(right, Name):
        raise _error(right.place, f"{left.text} is {kind}; put its value in quotes, such as '{right.text}'.")
    if not isinstance(right.value, str):
        raise _error(right.place, f"{left.text} is {kind}; put its value in quotes{allowed}")
    if sign not in _EQUALITY:
        raise _error(left.place, f"{left.text} is {kind} and has no order; use ==, != or in.")
    if not names:
        return np.asarray(_OPERATORS[sign](one.values.astype(str), right.value), bool)
    if right.value not in names:
        raise _error(right.place, f"{left.text} has no value {right.value!r}{allowed}")
    return np.asarray(_OPERATORS[sign](one.values, [*one.flags][names.index(right.value)]), bool)
