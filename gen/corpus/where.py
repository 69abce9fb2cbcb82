"""Conditions on records, such as ``fault == 'inner' and shaft_rate > 20``: read by Python's own parser and never run.

Allowed are comparisons of per-record variables with numbers, with texts in quotes or with each other, ``in`` with a list of values,
``and``, ``or``, ``not`` and parentheses. A class variable (``fault``, ``split``) is compared with the names of its values. A comparison
with NaN is false, ``!=`` too.
"""

import ast
import difflib
import operator
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.support.errors import CorpusError

MOST_CHARACTERS = 4000
DEEPEST = 50
"""Largest depth of ``and``, ``or`` and ``not`` within each other."""

Compare = Callable[[Any, Any], Any]
Truth = NDArray[np.bool_]
"""Whether a condition is true, shape (record,)."""

_SIGNS: Mapping[type[ast.cmpop], Compare] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}
_MIRRORED = {operator.lt: operator.gt, operator.le: operator.ge, operator.gt: operator.lt, operator.ge: operator.le}
_VALUE = "the name of a variable, a number or a text in quotes"


class Column(NamedTuple):
    """Values of a per-record variable, shape (record,), and the names of its values if it is a class variable."""

    values: NDArray[Any]
    flags: Mapping[int, str] = {}

    @property
    def kind(self) -> str:
        """Class, number or text."""
        return "class" if self.flags else "number" if self.values.dtype.kind in "iuf" else "text"


def nearest(name: str, allowed: Sequence[str]) -> str:
    """End of a sentence about an unknown name: the nearest allowed one, or all of them if none is near.

    >>> nearest("shaftrate", ["fault", "shaft_rate"])
    '; the nearest is shaft_rate.'
    """
    near = difflib.get_close_matches(name, allowed, 1)
    return f"; the nearest is {near[0]}." if near else f"; allowed are {', '.join(allowed)}."


def records_where(text: str, variables: Sequence[str], column: Callable[[str], Column]) -> Truth:
    """Whether a condition is true, for each record.

    ``variables`` are the names of all per-record variables; ``column`` is called with those that the condition names.

    >>> records_where("n_spalls >= 1", ["n_spalls"], lambda name: Column(np.array([0, 1, 2])))
    array([False,  True,  True])

    Raises
    ------
    CorpusError
        If the text is not a condition, or names another variable or a value that a variable cannot have. The sentence has the place.
    """
    if len(text) > MOST_CHARACTERS:
        raise CorpusError(f"where: has {len(text)} characters, at most {MOST_CHARACTERS} are allowed; shorten it.")
    line = re.sub(r"\s", " ", text).strip()
    try:
        with warnings.catch_warnings(action="error"):  # Python warns of an unknown escape in a text
            tree = ast.parse(line, mode="eval")
    except SyntaxError as error:
        place = min(max(error.offset or 1, 1), len(line) + 1)
        hint = "; equality is written ==" if line[place - 1 : place] == "=" else ""
        raise _error(place, f"{error.msg}{hint}; an example is fault == 'inner' and shaft_rate > 20.") from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise _error(1, f"the condition cannot be read ({error}); write it shorter.") from None
    return _Condition(line, variables, column).holds(tree.body)


def _error(place: int, what: str) -> CorpusError:
    return CorpusError(f"where: character {place}: {what}")


class _Condition:
    """A condition over the variables of one corpus."""

    def __init__(self, line: str, variables: Sequence[str], column: Callable[[str], Column]) -> None:
        self._line, self._variables, self._column = line, variables, column

    def holds(self, node: ast.expr, depth: int = 0) -> Truth:
        """Whether a part of the condition is true, for each record."""
        if depth > DEEPEST:
            raise self._wrong(node, f"and, or and not are more than {DEEPEST} deep; write it with fewer.")
        match node:
            case ast.BoolOp(op=word, values=parts):
                combine = np.logical_and if isinstance(word, ast.And) else np.logical_or
                return combine.reduce([self.holds(part, depth + 1) for part in parts])
            case ast.UnaryOp(op=ast.Not(), operand=part):
                return ~self.holds(part, depth + 1)
            case ast.Compare(left=left, ops=signs, comparators=others):
                sides = zip([left, *others[:-1]], signs, others, strict=True)
                return np.logical_and.reduce([self._compare(*side) for side in sides])
            case _:
                raise self._misplacement(node, "a comparison (==, !=, <, <=, >, >=, in)")

    def _compare(self, left: ast.expr, sign: ast.cmpop, right: ast.expr) -> Truth:
        """Whether two sides compare as the sign between them says."""
        if isinstance(sign, ast.In | ast.NotIn):
            items = right.elts if isinstance(right, ast.Tuple | ast.List) else [right]
            if name := next((item for item in items if isinstance(item, ast.Name)), None):
                raise self._wrong(name, f"{name.id} is a name; put a text in quotes: '{name.id}'.")
            within = isinstance(sign, ast.In)
            truths = [self._compare(left, ast.Eq() if within else ast.NotEq(), item) for item in items]
            combine, of_none = (np.logical_or, np.zeros_like) if within else (np.logical_and, np.ones_like)
            return combine.reduce([of_none(self._of(left).values, bool), *truths])
        compare = _SIGNS.get(type(sign))
        if compare is None:
            raise self._misplacement(left, "a comparison (==, !=, <, <=, >, >=, in)")
        if isinstance(left, ast.Name):
            return self._of_variable(left, compare, right)
        self._literal(left)
        if not isinstance(right, ast.Name):
            raise self._wrong(left, "neither side of the comparison is the name of a variable; put one there.")
        return self._of_variable(right, _MIRRORED.get(compare, compare), left)

    def _of_variable(self, name: ast.Name, compare: Compare, other: ast.expr) -> Truth:
        """Whether a variable compares with a literal or with another variable."""
        column = self._of(name)
        if column.kind == "number":
            numbers, against = column.values.astype(np.float64), self._number(other, name.id)
            return compare(numbers, against) & ~np.isnan(numbers) & ~np.isnan(against)
        names = list(column.flags.values())
        allowed = f"; allowed are {', '.join(names)}." if names else "."
        if isinstance(other, ast.Name):
            raise self._wrong(other, f"{name.id} is a {column.kind}; put its value in quotes, such as '{other.id}'.")
        text = self._literal(other)
        if not isinstance(text, str):
            raise self._wrong(other, f"{name.id} is a {column.kind}; put its value in quotes{allowed}")
        if compare in _MIRRORED:
            raise self._wrong(name, f"{name.id} is a {column.kind} and has no order; use ==, != or in.")
        if not names:
            return np.asarray(compare(column.values.astype(str), text), bool)
        if text not in names:
            raise self._wrong(other, f"{name.id} has no value {text!r}{allowed}")
        return np.asarray(compare(column.values, list(column.flags)[names.index(text)]), bool)

    def _number(self, node: ast.expr, name: str) -> Any:
        """Number, or numbers of another variable, with which those of a variable are compared."""
        if isinstance(node, ast.Name):
            if self._of(node).kind != "number":
                raise self._wrong(node, f"{name} has numbers and {node.id} has not; compare it with a number.")
            return self._of(node).values.astype(np.float64)
        number = self._literal(node)
        if isinstance(number, str):
            raise self._wrong(node, f"{name} has numbers; write the number without quotes.")
        return number

    def _literal(self, node: ast.expr) -> float | str:
        """Value of a number or of a text in quotes."""
        match node:
            case ast.Constant(value=str(text)):
                return text
            case ast.Constant(value=int(number) | float(number)) if not isinstance(number, bool):
                return float(str(number))  # infinite beyond the range of floating point
            case ast.UnaryOp(op=ast.USub() | ast.UAdd() as sign, operand=ast.Constant(value=int() | float()) as number):
                return float(self._literal(number)) * (-1 if isinstance(sign, ast.USub) else 1)
            case _:
                raise self._misplacement(node, _VALUE)

    def _of(self, node: ast.expr) -> Column:
        """Values of the variable that a node names."""
        if not isinstance(node, ast.Name):
            raise self._misplacement(node, "the name of a variable")
        if node.id not in self._variables:
            raise self._wrong(node, f"there is no variable {node.id}{nearest(node.id, self._variables)}")
        return self._column(node.id)

    def _misplacement(self, node: ast.expr, wanted: str) -> CorpusError:
        source = ast.get_source_segment(self._line, node) or ""
        return self._wrong(node, f"found {source[:30]!r} where {wanted} should be.")

    def _wrong(self, node: ast.expr, what: str) -> CorpusError:
        before = self._line.encode()[: node.col_offset]  # the parser counts bytes
        return _error(len(before.decode()) + 1, what)
