"""Arguments of the public functions: records in any form, and the numbers beside them. What has no meaning is refused in one sentence."""

from collections.abc import Callable, Mapping
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from features.signal.rows import FloatArray

FEWEST_SAMPLES = 8  # of a record: an array of shape (time, channel) is not taken for short records


def as_records(x: ArrayLike, name: str = "x", axis: str = "record") -> FloatArray:
    """Finite records of shape (record, time), in single precision if it holds the values exactly, else in double precision.

    One record of shape (time,) is a row; `like` gives its results the shape back. ``name`` and ``axis`` stand in sentences.

    Raises
    ------
    ValueError
        For an array that is empty, masked, complex, not finite, no array of numbers, or of another shape.
    """
    values = np.atleast_2d(as_numbers(x, name))
    if values.ndim != 2 or not values.size or values.shape[1] < FEWEST_SAMPLES:
        raise ValueError(
            f"{name}: an array of shape {np.shape(x)} is given in place of ({axis}, time) or (time,), with at least "
            f"{FEWEST_SAMPLES} samples in time."
        )
    return np.require(values, np.float32 if np.can_cast(values.dtype, np.float32) else np.float64, ["C", "W"])


def as_numbers(x: ArrayLike, name: str) -> np.ndarray:
    """Array of finite real numbers; ValueError for anything else."""
    if np.ma.is_masked(x):
        raise ValueError(f"{name}: values are masked; leave out these records, or fill them with numbers.")
    try:
        values = np.asarray(x)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: {_shown(x)} is no array of real numbers.") from None
    if values.dtype.kind not in "biuf":
        raise ValueError(f"{name}: {_shown(x)} is given in place of real numbers.")
    wrong = np.argwhere(~np.isfinite(values))
    if len(wrong):
        first = wrong[0].tolist()
        raise ValueError(f"{name}: {len(wrong)} of {values.size} values are not finite, the first at {first}.")
    return values


def like(x: ArrayLike, result: Any) -> Any:
    """A result of shape (record, ...), without its axis of records if ``x`` is one record of shape (time,)."""
    return result[0] if np.ndim(x) == 1 else result


def of_each(x: ArrayLike, name: str, records: FloatArray) -> FloatArray:
    """Number above 0 for each record, shape (record,), from one for all or one for each."""
    values = as_numbers(x, name)
    if values.ndim > 1 or values.size not in (1, len(records)) or not (values > 0).all():
        raise ValueError(
            f"{name}: {_shown(x)} is given in place of a number above 0 for each of {len(records)} records."
        )
    return np.broadcast_to(values.astype(float), len(records)).copy()


def one_or_each(values: ArrayLike, name: str, records: int) -> FloatArray:
    """Numbers of any value, shape (record,), from one for all records or one for each."""
    try:
        return np.broadcast_to(np.asarray(values, float), records)
    except (TypeError, ValueError):
        raise ValueError(
            f"{name}: {_shown(values)} is given in place of a number, or one for each of {records} records."
        ) from None


def check_finite(**numbers: object) -> None:
    """ValueError that names a number that is not finite."""
    _check(numbers, Real, lambda value: bool(np.isfinite(value)), "a finite number")


def check_positive(**numbers: object) -> None:
    """ValueError that names a number that is not finite and above 0."""
    _check(numbers, Real, lambda value: 0 < value < np.inf, "a finite number above 0")


def check_whole(**numbers: object) -> None:
    """ValueError that names a number that is not whole and at least 1."""
    _check(numbers, Integral, lambda value: value >= 1, "a whole number from 1")


def check_probability(probability: object) -> None:
    """ValueError for a probability that is not between 0 and 1."""
    _check({"probability": probability}, Real, lambda value: 0 < value < 1, "between 0 and 1")


def _check(numbers: Mapping[str, object], kind: type, holds: Callable[[Any], bool], meant: str) -> None:
    for name, value in numbers.items():
        if not (isinstance(value, kind) and holds(value)):
            raise ValueError(f"{name}: {_shown(value)} is not {meant}.")


def band_ends(values: ArrayLike) -> tuple[float, float]:
    """Lower and upper edge of a band from 0, the upper one perhaps infinite; ValueError for anything else."""
    match values:
        case (Real() as low, Real() as high) if 0 <= low < high:
            return float(low), float(high)
    raise ValueError(f"band: {_shown(values)} is no range; give two ascending numbers from 0.")


def fault_orders(values: ArrayLike, name: str) -> FloatArray:
    """Nominal orders ``ftf, bpfo, bpfi, bsf`` of one bearing, shape (4,)."""
    orders = np.asarray(values)
    if orders.shape != (4,) or orders.dtype.kind not in "iuf" or not (np.isfinite(orders) & (orders > 0)).all():
        raise no_orders(values, name)
    return orders.astype(float)


def no_orders(values: object, name: str) -> ValueError:
    """Error for anything but the nominal orders of a bearing."""
    return ValueError(
        f"{name}: {_shown(values)} is given in place of ftf, bpfo, bpfi and bsf, four numbers above 0; "
        'gen.bearing_orders("6205") gives them.'
    )


def _shown(value: object) -> str:
    """A value in a few words for a sentence."""
    shape = getattr(value, "shape", ())
    return f"an array of shape {tuple(shape)}" if shape else " ".join(repr(value).split())[:60]
