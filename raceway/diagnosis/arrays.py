"""Diagnosis of a recording that is at hand as an array."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from features.baselines.models import Model
from features.signal.arguments import as_records, check_positive, fault_orders
from gen.physics.bearing_text import bearing_orders
from raceway.diagnosis.answer import diagnose_recording
from raceway.diagnosis.result import Diagnosis
from raceway.diagnosis.search import given_of
from raceway.importing.reading_options import speeds_in
from raceway.importing.recorded import Recorded
from raceway.kept_models import reference_model


def diagnose(
    x: ArrayLike,
    fs: float,
    *,
    orders: str | Sequence[float] | Mapping[str, str | Sequence[float]],
    rpm: float | tuple[float, float] | None = None,
    model: Model | Path | str | None = None,
    healthy: Sequence[ArrayLike] = (),
) -> Diagnosis:
    """Diagnose one recording of a machine.

    Parameters
    ----------
    x
        Acceleration [m s-2], shape (time,), or (channel, time) of several sensors on one housing; at least 8 turns
        of the shaft and 0.05 s.
    fs
        Sample rate [Hz].
    orders
        A bearing as in ``--bearing``, such as ``"6205"``, or its nominal fault orders ``ftf, bpfo, bpfi, bsf``; or those of several by
        name.
    rpm
        Speed of the shaft, or its lowest and highest; by default 300 to 6000 rpm are searched.
    model
        A trained model or its file; by default ``raceway.reference_model()``, which the first call trains.
    healthy
        Recordings of the same machine with a healthy bearing, with the sample rate and the channels of ``x``.

    Raises
    ------
    ValueError
        If a recording has other dimensions or values that are not finite, ``fs`` or an order is not a positive number, or ``rpm`` is no
        speed and no ascending range.
    CorpusError
        If a bearing is not known, or the model cannot take the features of the recording or the healthy recording.
    """
    bearings = orders if isinstance(orders, Mapping) else {"the bearing": orders}
    nominal = {
        name: fault_orders(bearing_orders(bearing) if isinstance(bearing, str) else bearing, f"orders of {name}")
        for name, bearing in bearings.items()
    }
    check_positive(fs=fs)
    try:
        speeds = None if rpm is None else speeds_in("-".join(f"{each}" for each in np.ravel(rpm)))
    except ValueError as error:
        raise ValueError(f"rpm: {error}.") from None
    machine = given_of(nominal, speeds)
    if model is None:
        model = reference_model()
    classifier = model if isinstance(model, Model) else Model.load(model)
    references = [
        _recorded(signals, fs, f"healthy recording {number}") for number, signals in enumerate(healthy, start=1)
    ]
    return diagnose_recording(_recorded(x, fs, "the recording"), machine, classifier, healthy=references)


def _recorded(x: ArrayLike, fs: float, name: str) -> Recorded:
    signals = as_records(x, name, "channel").astype(float)
    names = [""] if np.ndim(x) == 1 else map(str, range(len(signals)))
    return Recorded(dict(zip(names, signals, strict=True)), fs, name)
