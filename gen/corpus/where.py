"""Conditions on records, such as ``fault == 'inner' and width_mm > 0.5``: a query of pandas on the table of labels.

A column of that table is a per-record variable in its stored unit, ``width`` in metres, or in a unit that people read, ``width_mm``. A
class variable (``fault``, ``split``) has the names of its values. Before pandas sees a condition, each of its nodes must be in
``_ALLOWED``, which has no call and no attribute, and each of its names must be a column: it cannot run code.
"""

import ast
import difflib
import re
from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.schema import class_names
from gen.support.errors import CorpusError
from gen.support.units import keys_of

MOST_CHARACTERS = 4000
_QUOTED = re.compile(r"""('(?:\\.|[^'\\])*'|"(?:\\.|[^"\\])*")""")
_EXAMPLE = "an example is fault == 'inner' and width_mm > 0.5."
_ALLOWED = (
    ast.BoolOp, ast.boolop, ast.UnaryOp, ast.unaryop, ast.BinOp, ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Compare, ast.Eq, ast.NotEq,
    ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.In, ast.NotIn, ast.Name, ast.Constant, ast.List, ast.Tuple, ast.Load,
)  # fmt: skip

Variables = Mapping[str, xr.DataArray]
"""Per-record variables by name."""


def nearest(name: str, allowed: Sequence[str]) -> str:
    """End of a sentence about an unknown name: the nearest allowed one, or all of them if none is near.

    >>> nearest("shaftrate", ["fault", "shaft_rate"])
    '; the nearest is shaft_rate.'
    """
    near = difflib.get_close_matches(name, allowed, 1)
    return f"; the nearest is {near[0]}." if near else f"; allowed are {', '.join(allowed)}."


def label_columns(variables: Variables) -> dict[str, tuple[str, float]]:
    """Columns of the table of labels: the variable of each, and the factor that turns its unit into the stored one.

    >>> label_columns({"load": xr.DataArray([1.0], attrs={"units": "N"})})
    {'load': ('load', 1.0), 'load_n': ('load', 1.0), 'load_kn': ('load', 1000.0)}
    """
    columns = {name: (name, 1.0) for name in variables}
    for name, variable in variables.items():
        for key, factor in keys_of(name, variable.attrs.get("units", "")).items():
            columns.setdefault(key, (name, factor))
    return columns


def records_where(text: str, variables: Variables) -> NDArray[np.intp]:
    """Places of the records for which a condition is true, ascending.

    Raises
    ------
    CorpusError
        If the text is not a condition, or names another column or a value that a class does not have.
    """
    if len(text) > MOST_CHARACTERS:
        raise CorpusError(f"where: has {len(text)} characters, at most {MOST_CHARACTERS} are allowed; shorten it.")
    line = re.sub(r"\s", " ", text).strip()
    try:
        return np.flatnonzero(_evaluated(line, variables))
    except CorpusError:
        raise
    except SyntaxError as error:
        hint = "equality is written ==; " if re.search(r"[^=!<>]=[^=]", line) else ""
        raise CorpusError(f"where: {error.msg} at character {error.offset or 1}; {hint}{_EXAMPLE}") from None
    except Exception as error:  # noqa: BLE001 - pandas raises many types
        raise CorpusError(f"where: cannot be evaluated ({' '.join(str(error).split())}); {_EXAMPLE}") from None


def _evaluated(line: str, variables: Variables) -> pd.Series:
    """Whether a condition is true for each record, after a check of all that it names."""
    # & and | bind as "and" and "or", as in every query of pandas, but for those in quotes
    parts = _QUOTED.split(line)
    parts[::2] = [outside.replace("&", " and ").replace("|", " or ") for outside in parts[::2]]
    tree = ast.parse("".join(parts), mode="eval").body
    columns = label_columns(variables)
    # a condition comes from strangers: names, numbers, texts and comparisons alone
    wrong = next((node for node in ast.walk(tree) if not _is_allowed(node)), None)
    if wrong is not None:
        part = ast.unparse(wrong)[:60] or type(wrong).__name__  # an operator has no text of its own
        raise CorpusError(f"where: {part!r} cannot be part of a condition; {_EXAMPLE}")
    named = dict.fromkeys(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
    unknown = next((name for name in named if name not in columns), None)
    if unknown is not None:
        near = difflib.get_close_matches(unknown, columns, 3)
        told = f"the nearest are {', '.join(near)}" if near else "docs/format.md lists them"
        raise CorpusError(f"where: there is no column {unknown}; {told}; a text stands in quotes.")
    # only the columns that it names
    table = pd.DataFrame({name: _column(variables[columns[name][0]], columns[name][1]) for name in named})
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare):
            _check_values(node, table, variables)
    tree = _Parts(table).visit(tree)
    chosen = table.eval(ast.unparse(tree), engine="python", local_dict={}, global_dict={})  # what query does first
    if not isinstance(chosen, pd.Series) or chosen.dtype.kind != "b":
        raise CorpusError(f"where: {line[:60]!r} compares no column; {_EXAMPLE}")
    return chosen


class _Parts(ast.NodeTransformer):
    """Gives `'rub' in machine_condition` the meaning that it has for each text, which pandas does not know, as columns of the table."""

    def __init__(self, table: pd.DataFrame) -> None:
        self.table = table

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        match node:
            case ast.Compare(
                left=ast.Constant(value=str(part)), ops=[ast.In() | ast.NotIn() as how], comparators=[ast.Name(id=name)]
            ):
                column = f"part_{len(self.table.columns)}_"
                contains = self.table[name].astype(str).str.contains(part, regex=False)
                self.table[column] = contains if isinstance(how, ast.In) else ~contains
                return ast.Name(column, ast.Load())
        return node


def _is_allowed(node: ast.AST) -> bool:
    match node:
        case ast.Constant(value=value):
            return isinstance(value, str | int | float) and not isinstance(value, bool)
        case ast.BinOp(left=left, right=right):  # a text or a list times a number could fill the memory
            sides = (left, right)
            return not any(
                isinstance(side, ast.List | ast.Tuple) or isinstance(getattr(side, "value", 0), str) for side in sides
            )
        case ast.BoolOp(values=parts):
            return all(isinstance(part, ast.Compare | ast.BoolOp | ast.UnaryOp) for part in parts)
    return isinstance(node, _ALLOWED)


def _column(variable: xr.DataArray, factor: float) -> pd.Series:
    """Values of all records; those of a class by their names, and texts as categories, which have no arithmetic."""
    classes, stored = class_names(variable.attrs), pd.Series(variable.values)
    if classes:
        return pd.Series(pd.Categorical(stored.map(classes), categories=[*classes.values()]))
    if variable.dtype.kind not in "iuf":
        return stored.astype("category")
    # rounded, so that 0.3 mm equals 0.3: a product with a factor misses it by a bit
    return stored if factor == 1 else (stored * (1 / factor)).round(9)


def _check_values(comparison: ast.Compare, table: pd.DataFrame, variables: Variables) -> None:
    """Refuse texts beside numbers, and a text that names no class: pandas would find them unequal."""
    parts = [*ast.walk(comparison)]
    values = [part.value for part in parts if isinstance(part, ast.Constant)]
    names = [part.id for part in parts if isinstance(part, ast.Name)]
    texts = [name for name in names if isinstance(table[name].dtype, pd.CategoricalDtype)]
    kinds = {isinstance(value, str) for value in values} | {name in texts for name in names}
    for name in texts:
        classes = class_names(variables[name].attrs).values()
        wrong = next((value for value in values if classes and value not in classes), None)
        if wrong is not None:
            raise CorpusError(f"where: {name} has no value {wrong!r}; allowed are {', '.join(map(repr, classes))}.")
    # pandas would call a number and a text unequal without a word
    if len(kinds) > 1:
        told = f"{ast.unparse(comparison)[:60]!r} compares texts with numbers"
        raise CorpusError(f"where: {told}; texts stand in quotes, and numbers do not.")
