"""Door for arrays: the public functions of `features.signal` take their arguments through it.

``annotation of an argument -> rule -> value that the function can rely on, or one sentence``

A function under `checked` declares with the types below what it takes. Integers and all floating-point types become
floating-point numbers of single or double precision. One record of shape (time,) counts as one row, and its results have
no axis of records. Arrays and numbers without meaning are refused in one sentence.
"""

import inspect
from collections.abc import Callable, Mapping
from functools import lru_cache, wraps
from typing import Annotated, Any, ParamSpec, TypeVar, get_args, get_origin, get_type_hints

import numpy as np

from features.signal.rows import ComplexArray, FloatArray

P = ParamSpec("P")
R = TypeVar("R")
Rule = Callable[[str, Any], Any]

FEWEST_SAMPLES = 8  # of a record: an array of shape (time, channel) is not taken for short records


def rows(name: str, value: Any, axis: str = "record") -> FloatArray:
    """Records of shape (record, time), in single precision if it holds the values exactly, else in double precision.

    ``axis`` names the first axis in sentences.

    Raises
    ------
    ValueError
        For an array that is empty, masked, complex, not finite, no array of numbers, or of another shape.
    """
    x = _records(name, _array(name, value, "biuf", "real numbers"), axis)
    return np.require(x, np.float32 if np.can_cast(x.dtype, np.float32) else np.float64, ["C", "W"])


def spectra(name: str, value: Any) -> ComplexArray:
    """Complex coefficients of shape (record, frequency), in single or double precision."""
    x = _records(name, _array(name, value, "c", "complex numbers"))
    return np.require(x, np.complex64 if np.can_cast(x.dtype, np.complex64) else np.complex128, ["C", "W"])


def values(name: str, value: Any) -> FloatArray:
    """Real and finite numbers of any shape, in double precision."""
    return _finite(name, _array(name, value, "biuf", "real numbers")).astype(float)


def number(name: str, value: Any) -> float:
    """A finite real number."""
    x = _array(name, value, "iuf", "a number")
    if x.size != 1 or not np.isfinite(x).all():
        raise ValueError(f"{name}: {_shown(value)} is given in place of one finite number.")
    return float(x.item())


def positive(name: str, value: Any) -> float:
    """A finite number above 0."""
    if (found := number(name, value)) <= 0:
        raise ValueError(f"{name}: {found:g} is not above 0.")
    return found


def not_negative(name: str, value: Any) -> float:
    """A finite number from 0."""
    if (found := number(name, value)) < 0:
        raise ValueError(f"{name}: {found:g} is below 0.")
    return found


def share(name: str, value: Any) -> float:
    """A number between 0 and 1, without both."""
    if not 0 < (found := number(name, value)) < 1:
        raise ValueError(f"{name}: {found:g} is not between 0 and 1.")
    return found


def count(name: str, value: Any) -> int:
    """A whole number from 1."""
    if (whole := int(found := number(name, value))) != found or whole < 1:
        raise ValueError(f"{name}: {_shown(value)} is not a whole number from 1.")
    return whole


def band(name: str, value: Any) -> tuple[float, float]:
    """Two ascending numbers from 0, the upper one perhaps infinite."""
    low, high = _pair(name, value)
    if not 0 <= low < high:
        raise ValueError(f"{name}: {low:g} to {high:g} is no range; give two ascending numbers from 0.")
    return low, high


def bands(name: str, value: Any) -> list[tuple[float, float]]:
    """One or more ranges as of `band`."""
    if np.ndim(value) != 2 or not len(value):
        raise ValueError(f"{name}: {_shown(value)} is given in place of ranges such as [(0, 0.002)].")
    return [band(f"{name}[{place}]", one) for place, one in enumerate(value)]


def of_each(name: str, value: Any) -> FloatArray:
    """Positive numbers, one for all records or one for each."""
    found = values(name, value)
    if found.ndim > 1 or not found.size or (found <= 0).any():
        raise ValueError(f"{name}: {_shown(value)} is given in place of a number above 0 for each record.")
    return found


def fault_orders(name: str, value: Any) -> FloatArray:
    """Nominal orders ``ftf, bpfo, bpfi, bsf`` of one bearing, shape (4,)."""
    x = np.asarray(value)
    if x.shape != (4,) or x.dtype.kind not in "iuf" or not (np.isfinite(x) & (x > 0)).all():
        raise ValueError(
            f"{name}: {_shown(value)} is given in place of ftf, bpfo, bpfi and bsf, four numbers above 0; "
            'gen.bearing_orders("6205") gives them.'
        )
    return x.astype(float)


_RECORDS = (rows, spectra)

Rows = Annotated[FloatArray, rows]
"""Records of shape (record, time); as a result, an array of shape (record, ...)."""
Spectra = Annotated[ComplexArray, spectra]
OfEach = Annotated[FloatArray, of_each]
Values = Annotated[FloatArray, values]
Number = Annotated[float, number]
Positive = Annotated[float, positive]
NotNegative = Annotated[float, not_negative]
Share = Annotated[float, share]
Count = Annotated[int, count]
Band = Annotated[tuple[float, float], band]
Bands = Annotated[list[tuple[float, float]], bands]


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """Take the arguments of a function through the rules of their annotations.

    Records and `OfEach` numbers have as many rows as the first records. If these have shape (time,), the results have no
    axis of records.
    """
    signature = inspect.signature(function)

    @wraps(function)
    def through_the_door(*args: P.args, **kwargs: P.kwargs) -> R:
        call = signature.bind(*args, **kwargs)
        first: np.ndarray | None = None
        single = False
        for name, (rule, optional) in _rules(function).items():
            value: Any = call.arguments.get(name)
            if name not in call.arguments or (optional and value is None):
                continue
            taken = rule(name, value)
            if rule in _RECORDS and first is None:
                first, single = taken, np.ndim(value) == 1
            elif first is not None and rule in (*_RECORDS, of_each):
                taken = _suited(name, taken, first)
            call.arguments[name] = taken
        result = function(*call.args, **call.kwargs)
        return _first_row(result, _hints(function)["return"]) if single else result

    return through_the_door


@lru_cache(None)
def _hints(described: Any) -> Mapping[str, Any]:
    return get_type_hints(described, include_extras=True)


@lru_cache(None)
def _rules(function: Callable[..., Any]) -> Mapping[str, tuple[Rule, bool]]:
    """Rule of each argument that has one, and whether it may be None."""
    found = {
        name: (_rule(hint), type(None) in get_args(hint)) for name, hint in _hints(function).items() if name != "return"
    }
    return {name: (rule, optional) for name, (rule, optional) in found.items() if rule is not None}


def _rule(hint: Any) -> Rule | None:
    if get_origin(hint) is Annotated:
        return get_args(hint)[1]
    if isinstance(hint, type) and hasattr(hint, "_fields"):
        return lambda name, value: _of_class(name, value, hint)
    return next((rule for part in get_args(hint) if (rule := _rule(part))), None)


def _first_row(result: Any, hint: Any) -> Any:
    """A result without its axis of records."""
    if hasattr(result, "_fields"):
        return type(result)(*map(_first_row, result, _hints(type(result)).values()))
    if isinstance(result, tuple):
        return tuple(map(_first_row, result, get_args(hint)))
    return result[0] if _rule(hint) in _RECORDS else result


def _array(name: str, value: Any, kinds: str, meant: str) -> np.ndarray:
    """Value as an array of one of the kinds of NumPy types."""
    if np.ma.is_masked(value):
        raise ValueError(f"{name}: values are masked; leave out these records, or fill them with numbers.")
    try:
        x = np.asarray(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: {_shown(value)} is no array of {meant}.") from None
    if x.dtype.kind not in kinds:
        raise ValueError(f"{name}: {_shown(value)} is given in place of {meant}.")
    return x


def _records(name: str, x: np.ndarray, axis: str = "record") -> np.ndarray:
    if x.ndim not in (1, 2) or not x.size or x.shape[-1] < FEWEST_SAMPLES:
        raise ValueError(
            f"{name}: an array of shape {x.shape} is given in place of ({axis}, time) or (time,), with at least "
            f"{FEWEST_SAMPLES} samples in time."
        )
    return _finite(name, np.atleast_2d(x))


def _finite(name: str, x: np.ndarray) -> np.ndarray:
    wrong = ~np.isfinite(x)
    if wrong.any():
        place = tuple(int(n) for n in np.argwhere(wrong)[0])
        raise ValueError(f"{name}: {wrong.sum()} of {x.size} values are not finite, the first at {list(place)}.")
    return x


def _pair(name: str, value: Any) -> tuple[float, float]:
    x = _array(name, value, "iuf", "two numbers")
    if x.shape != (2,) or np.isnan(x).any():
        raise ValueError(f"{name}: {_shown(value)} is given in place of two numbers.")
    return float(x[0]), float(x[1])


def _suited(name: str, taken: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Argument with the number of rows of the first records: records of one row stay, a number is repeated."""
    if taken.ndim == 2 and len(taken) in (1, len(first)) and taken.shape[1] == first.shape[1]:
        return taken
    if taken.ndim < 2 and taken.size in (1, len(first)):
        return np.broadcast_to(taken, len(first)).copy()
    raise ValueError(f"{name}: an array of shape {taken.shape} does not suit records of shape {first.shape}.")


def _of_class(name: str, value: Any, wanted: type) -> Any:
    if not isinstance(value, wanted):
        raise TypeError(f"{name}: {_shown(value)} is given in place of a {wanted.__name__}.")
    return value


def _shown(value: Any) -> str:
    """A value in a few words for a sentence."""
    shape = getattr(value, "shape", ())
    if shape:
        return f"{type(value).__name__} of {getattr(value, 'dtype', 'values')}, shape {tuple(shape)},"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
