"""Conditions on records, such as ``fault == 'inner' and shaft_rate > 1200 rpm``: evaluated by pandas, after a check of each word.

Allowed are comparisons of per-record variables with numbers, with texts or with each other, ``in`` with a list of values, ``and``, ``or``,
``not`` and parentheses: no call, no attribute, no name but those of the variables, so that a condition cannot run code. A class variable
(``fault``, ``split``) is compared with the names of its values. A text that is one word needs no quotes, ``fault == inner``. A number may
have a unit, ``width > 0.5 mm``; without one it is in the stored unit.
"""

import ast
import difflib
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from gen.support.errors import CorpusError
from gen.support.units import READABLE

MOST_CHARACTERS = 4000
_EXAMPLE = "an example is fault == 'inner' and shaft_rate > 1200 rpm."
# a text in quotes, or a number with a unit
_WITH_UNIT = re.compile(
    r"""('[^']*'|"[^"]*")|((?>(?<![\w.])(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?))\s*(?!(?:and|or|not|in|is)\b)([^\W\d_]\w*)"""
)
_MICRO = re.compile("[µμ]")
_SIGNS = (ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.In, ast.NotIn)


def nearest(name: str, allowed: Sequence[str]) -> str:
    """End of a sentence about an unknown name: the nearest allowed one, or all of them if none is near.

    >>> nearest("shaftrate", ["fault", "shaft_rate"])
    '; the nearest is shaft_rate.'
    """
    near = difflib.get_close_matches(name, allowed, 1)
    return f"; the nearest is {near[0]}." if near else f"; allowed are {', '.join(allowed)}."


def records_where(text: str, variables: Mapping[str, str], column: Callable[[str], pd.Series]) -> NDArray[np.bool_]:
    """Whether a condition is true, for each record, shape (record,).

    ``variables`` are the stored units of all per-record variables by name; ``column`` is called with those that the condition names, and
    gives numbers, texts or a categorical.

    >>> records_where("width >= 1 mm", {"width": "m"}, lambda name: pd.Series([0, 0.001, 0.002]))
    array([False,  True,  True])

    Raises
    ------
    CorpusError
        If the text is not a condition, or names another variable or a value that a variable cannot have.
    """
    if len(text) > MOST_CHARACTERS:
        raise CorpusError(f"where: has {len(text)} characters, at most {MOST_CHARACTERS} are allowed; shorten it.")
    line = re.sub(r"\s", " ", text).strip()
    try:
        return _evaluated(line, variables, column)
    except CorpusError:
        raise
    except SyntaxError as error:
        hint = "equality is written ==; " if re.search(r"[^=!<>]=[^=]", line) else ""
        raise CorpusError(f"where: {error.msg} at character {error.offset or 1}; {hint}{_EXAMPLE}") from None
    except Exception as error:  # noqa: BLE001 - pandas raises many types
        raise CorpusError(f"where: cannot be evaluated ({' '.join(str(error).split())}); {_EXAMPLE}") from None


def _evaluated(line: str, variables: Mapping[str, str], column: Callable[[str], pd.Series]) -> NDArray[np.bool_]:
    marked = _WITH_UNIT.sub(lambda found: found[1] or f"{found[2]} @ '{_MICRO.sub('u', found[3])}'", line)
    with warnings.catch_warnings(action="error"):  # Python warns of an unknown escape in a text
        tree = ast.parse(marked, mode="eval").body
    names = dict.fromkeys(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
    table = pd.DataFrame({name: column(name) for name in names if name in variables})
    tree = _Stored(variables, table).visit(tree)
    unknown = next((one.id for one in ast.walk(tree) if isinstance(one, ast.Name) and one.id not in variables), None)
    if unknown is not None:
        near = difflib.get_close_matches(unknown, variables, 1)
        told = f"the nearest is {near[0]}." if near else f"docs/format.md lists them; {_EXAMPLE}"
        raise CorpusError(f"where: there is no variable {unknown}; {told}")
    _check(tree, table)
    chosen: Any = table.eval(ast.unparse(tree), engine="python", local_dict={}, global_dict={})
    return chosen.to_numpy(bool)


class _Stored(ast.NodeTransformer):
    """Replaces values by stored ones, as the variables that they are compared with need them.

    A number with a unit becomes one in the stored unit; a word beside a variable of text, and no variable itself, becomes a text.
    """

    def __init__(self, units: Mapping[str, str], table: pd.DataFrame) -> None:
        self._units, self._named = units, list[str]()
        self._texts = {str(name) for name in table if not pd.api.types.is_numeric_dtype(table[name])}

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        names = [one.id for one in ast.walk(node) if isinstance(one, ast.Name)]
        self._named = [name for name in names if name in self._units]
        return self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> ast.AST:
        word = node.id not in self._units and self._texts & {*self._named}
        return ast.Constant(node.id) if word else node

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        match node:
            case ast.BinOp(left=number, op=ast.MatMult(), right=ast.Constant(value=str() as unit)):
                return ast.Constant(ast.literal_eval(number) * self._factor(unit))
        return node

    def _factor(self, unit: str) -> float:
        factor = 1.0
        for name in self._named:
            stored = self._units[name]
            if stored == "1":
                raise CorpusError(f"where: {name} has no unit; write its value without {unit!r}.")
            allowed = READABLE.get(stored, {stored: 1.0})
            if unit not in allowed:
                raise CorpusError(f"where: {name} is not in {unit!r}; allowed are {', '.join(allowed)}.")
            factor = allowed[unit]
        return factor


def _check(node: ast.expr, table: pd.DataFrame) -> None:
    """Refuse whatever is not a comparison, or several of them with and, or, not."""
    match node:
        case ast.BoolOp(values=parts):
            for part in parts:
                _check(part, table)
        case ast.UnaryOp(op=ast.Not(), operand=part):
            _check(part, table)
        case ast.Compare(left=left, ops=signs, comparators=others) if all(isinstance(sign, _SIGNS) for sign in signs):
            sides = [item for side in (left, *others) for item in _items(side)]
            _check_sides(sides, table, ast.unparse(node))
        case _:
            raise CorpusError(
                f"where: {ast.unparse(node)[:60]!r} is no comparison (==, !=, <, <=, >, >=, in); {_EXAMPLE}"
            )


def _items(side: ast.expr) -> list[str | float | ast.Name]:
    """Variables and values on a side of a comparison."""
    match side:
        case ast.List(elts=items) | ast.Tuple(elts=items):
            return [value for item in items for value in _items(item)]
        case ast.Name():
            return [side]
        case ast.Constant(value=str() | int() | float() as value) if not isinstance(value, bool):
            return [value]
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=ast.Constant(value=int() | float() as value)):
            return [value]
        case _:
            wanted = "the name of a variable, a number or a text in quotes"
            raise CorpusError(f"where: found {ast.unparse(side)[:60]!r} where {wanted} should be; {_EXAMPLE}")


def _check_sides(sides: list[str | float | ast.Name], table: pd.DataFrame, source: str) -> None:
    """Refuse a comparison without a variable, of texts with numbers, or with a value that a class variable does not have."""
    columns = [table[side.id] for side in sides if isinstance(side, ast.Name)]
    values = [side for side in sides if not isinstance(side, ast.Name)]
    if not columns:
        raise CorpusError(f"where: {source[:60]!r} names no variable; {_EXAMPLE}")
    for one in columns:
        classes = list(one.cat.categories) if isinstance(one.dtype, pd.CategoricalDtype) else []
        allowed = f"; allowed are {', '.join(classes)}." if classes else "."
        numeric = pd.api.types.is_numeric_dtype(one)
        others = [other for other in columns if pd.api.types.is_numeric_dtype(other) != numeric]
        if others or any(isinstance(value, str) == numeric for value in values):
            kind = "numbers; write numbers without quotes." if numeric else f"text; put its value in quotes{allowed}"
            raise CorpusError(f"where: in {source[:60]!r}, {one.name} has {kind}")
        for value in values:
            if classes and value not in classes:
                raise CorpusError(f"where: {one.name} has no value {value!r}{allowed}")
