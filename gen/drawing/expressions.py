"""Distributions written as calls, such as ``loguniform(0.005, 0.3) * static_rating_n``: read by Python's own parser and never run.

Allowed is one number, or one call of a distribution with numbers, and behind it the quantity that it is a share of.
"""

import ast
import difflib
import reprlib
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from gen.support.sentences import sentences

MOST_CHARACTERS = 20_000
_EXAMPLES = "write 1.5, uniform(1, 2), or a share such as uniform(0.1, 0.2) * load_n, of another quantity."


def read_expression(text: Any, kinds: Mapping[str, Any]) -> Any:
    """Distribution that a text names, one of some ``kinds``; ValueError with a sentence if it names none."""
    shown = reprlib.repr(text)
    if not isinstance(text, str):
        raise ValueError(f"{shown} is neither a number nor a distribution; {_EXAMPLES}")  # noqa: TRY004 - pydantic needs it
    if len(text) > MOST_CHARACTERS:
        raise ValueError(f"has {len(text)} characters, at most {MOST_CHARACTERS} are allowed; shorten it.")
    try:
        with warnings.catch_warnings(action="error"):
            # parsed, and never run: only calls of these kinds with numbers are read
            tree = ast.parse(text.strip(), mode="eval").body
        share: dict[str, Any] = {}
        # a share: a distribution times the name of a quantity
        if isinstance(tree, ast.BinOp) and isinstance(tree.op, ast.Mult) and isinstance(tree.right, ast.Name):
            tree, share = tree.left, {"share_of": tree.right.id}
        # a plain number
        if not isinstance(tree, ast.Call):
            return called(kinds["constant"], [+_value(tree)], share)
        kind, values = _value(tree.func), [_value(value) for value in tree.args]
        named = {str(keyword.arg): _value(keyword.value) for keyword in tree.keywords}
    except (SyntaxError, TypeError, RecursionError, MemoryError):
        if text.count("(") > text.count(")"):
            raise ValueError(f"{shown} ends too early; close its bracket, and within braces give it quotes.") from None
        raise ValueError(f"{shown} is neither a number nor a distribution; {_EXAMPLES}") from None
    if kind not in kinds:
        # help with a misspelt name
        near = difflib.get_close_matches(str(kind), kinds, 1)
        advice = f"did you mean {near[0]}?" if near else f"choose from {', '.join(kinds)}."
        raise ValueError(f"{reprlib.repr(kind)} is no distribution; {advice}")
    return called(kinds[kind], values, named | share)


def _value(node: ast.expr) -> Any:
    """Number, word, or list of them; TypeError for everything else."""
    match node:
        case ast.Constant(value=float() | int() | str() as value) if not isinstance(value, bool):
            return value
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=float() | int() as value)):
            return -value
        case ast.Name(id=word):
            return word
        case ast.Tuple(elts=items) | ast.List(elts=items):
            return tuple(map(_value, items))
    raise TypeError


def called(model: Any, values: Sequence[Any], named: Mapping[str, Any]) -> Any:
    """Distribution from the arguments of its call; ValueError with a sentence if they are wrong."""
    kind, names = model.model_fields["kind"].annotation.__args__[0], model.arguments
    form = f"{kind}({', '.join(names)})"
    # choice(7, 8, 9) and choice((7, 8, 9)) are the same
    if names == ("values",) and values and not isinstance(values[0], tuple | list):
        values = [tuple(values)]
    if len(values) > len(names):
        raise ValueError(f"{len(values)} numbers are too many for {form}.")
    arguments = {"kind": kind, **dict(zip(names, values, strict=False))}
    if twice := arguments.keys() & named.keys():
        raise ValueError(f"{min(twice)} of {form}: is given twice; give it once.")
    try:
        return model.model_validate({**arguments, **named})
    except ValidationError as error:
        argument, colon, rest = sentences(error, model)[0].partition(": ")
        raise ValueError(f"{argument} of {form}: {rest}" if colon else argument) from None


def expression_of(distribution: Any) -> str:
    """Text of a distribution, which is read as the same distribution.

    >>> from gen.drawing.distributions import Choice, Uniform
    >>> Choice(kind="choice", values=(1, 2), weights=(3, 1)), Uniform(kind="uniform", low=0.5, high=1, share_of="load_n")
    (choice(1, 2, weights=(3, 1)), uniform(0.5, 1) * load_n)
    """
    fields = {name: value for name, value in distribution if name in distribution.model_fields_set}
    kind, share = distribution.kind, fields.pop("share_of", None)
    fields.pop("kind", None)
    positional = [fields.pop(name) for name in distribution.arguments[:2]]
    if kind == "constant" and not fields:
        text = _shown(positional[0])
    else:
        values = positional[0] if isinstance(positional[0], tuple) else positional
        text = f"{kind}({', '.join([*map(_shown, values), *(f'{name}={_shown(value)}' for name, value in fields.items())])})"
    return text if share is None else f"{text} * {share}"


def _shown(value: Any) -> str:
    """Number without needless digits, list in parentheses, or word."""
    if isinstance(value, tuple):
        return f"({', '.join(map(_shown, value))}{',' * (len(value) == 1)})"
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return str(value)
