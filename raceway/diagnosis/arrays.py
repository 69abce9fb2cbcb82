"""Diagnosis of a recording that is at hand as an array."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from features.baselines.models import Model
from features.signal.arguments import as_records, fault_orders
from features.table.indicators import Orders
from gen.support.units import from_si, rpm_to_hertz
from raceway.diagnosis.answer import diagnose_recording
from raceway.diagnosis.result import Diagnosis
from raceway.diagnosis.search import ANY_RATE, Given
from raceway.importing.recorded import Recorded


def diagnose(
    x: ArrayLike,
    fs: float,
    *,
    orders: Sequence[float] | Mapping[str, Sequence[float]],
    rpm: float | tuple[float, float] | None = None,
    model: Model | Path | str,
    healthy: Sequence[ArrayLike] = (),
) -> Diagnosis:
    """Diagnose one recording of a machine.

    Parameters
    ----------
    x
        Acceleration [m s-2], shape (time,), or (channel, time) of several sensors on one housing; at least 0.05 s.
    fs
        Sample rate [Hz].
    orders
        Nominal fault orders ``ftf, bpfo, bpfi, bsf`` of the bearing, as `gen.bearing_orders` gives them; or those of several by name.
    rpm
        Speed of the shaft, or its lowest and highest; by default 300 to 6000 rpm are searched.
    model
        A trained model or its file; ``raceway.reference_model()`` is that of ``raceway diagnose``.
    healthy
        Recordings of the same machine with a healthy bearing, with the sample rate and the channels of ``x``.

    Raises
    ------
    ValueError
        If a recording has other dimensions or values that are not finite, or ``fs``, ``rpm`` or an order is not a positive number.
    CorpusError
        If the model cannot take the features of the recording or the healthy recording.
    """
    low, high = (from_si(rate, "rpm") for rate in ANY_RATE) if rpm is None else np.broadcast_to(rpm, 2).tolist()
    if not (0 < fs < np.inf and 0 < low <= high < np.inf):
        raise ValueError(f"fs and rpm: {fs} and {rpm} are not positive numbers; give Hz, and revolutions per minute.")
    bearings = orders if isinstance(orders, Mapping) else {"the bearing": orders}
    nominal = {name: Orders(*map(np.asarray, fault_orders(one, f"orders of {name}"))) for name, one in bearings.items()}
    given = Given(nominal, (rpm_to_hertz(low), rpm_to_hertz(high)))
    known = model if isinstance(model, Model) else Model.load(model)
    references = [_recorded(one, fs, f"healthy recording {number}") for number, one in enumerate(healthy, start=1)]
    return diagnose_recording(_recorded(x, fs, "the recording"), given, known, healthy=references)


def _recorded(x: ArrayLike, fs: float, name: str) -> Recorded:
    signals = as_records(x, name, "channel").astype(float)
    if np.ndim(x) == 1:
        return Recorded({"": signals[0]}, fs, name)
    return Recorded({str(number): signal for number, signal in enumerate(signals)}, fs, name)
