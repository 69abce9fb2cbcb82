"""Plain arrays in and out: signals with a table of labels as records, and records as signals, classes and groups."""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from gen.corpus.contents import specimen_numbers
from gen.corpus.fault_classes import FAULT_NAMES
from gen.corpus.index import open_corpus
from gen.corpus.items import torch_dataset
from gen.corpus.schema import IDENTITY, SCHEMA, SPLITS, identity, make_dataset
from gen.corpus.where import nearest
from gen.support.errors import CorpusError
from gen.support.units import keys_of

_OWN = (IDENTITY, "sample_rate")
_UNKNOWN = {"f8": np.nan, "str": "", "i4": 0, "i1": 0, "i2": -1}
"""Values by type where no label is given; a record without split is for training."""
_CLASSES = {"fault": FAULT_NAMES, "split": dict(enumerate(SPLITS))}


class Arrays(NamedTuple):
    """Records as scikit-learn takes them."""

    X: NDArray[np.float32]
    """Signals, shape (record, channel, time) [m s-2]."""
    y: NDArray[Any]
    """Label of each record; a class by its name."""
    groups: NDArray[np.intp]
    """Number of the physical bearing of each record: no bearing should be in the training and in the test set."""


def to_arrays(
    corpus: Path | str | xr.Dataset,
    *,
    split: str | None = None,
    where: str | None = None,
    channels: Sequence[str] | None = None,
    label: str = "fault",
) -> Arrays:
    """Signals, labels and numbers of the physical bearings of records, all in memory; of a class, the labels are names.

    The other arguments and the errors are those of :func:`gen.torch_dataset`.

    ``X, y, groups = gen.to_arrays("corpus")``, then ``cross_validate(model, X[:, 0], y, groups=groups, cv=GroupKFold())``.
    """
    opened = open_corpus(corpus)
    items = torch_dataset(opened, split=split, where=where, channels=channels, label=label)
    ((x, y),) = items.batches(len(items))
    groups = specimen_numbers(opened.isel(record=items.records))
    return Arrays(x, np.array([items.names[code] for code in y]) if items.names else y, groups)


def records_of_arrays(
    signals: object, fs: float | None, labels: pd.DataFrame | Mapping[str, ArrayLike] | None
) -> xr.Dataset:
    """Records with the variables of the format, of signals of shape (record, time) or (record, channel, time) [m s-2].

    Raises
    ------
    CorpusError
        If the shapes do not fit, or a label is missing, unknown or has a wrong value.
    """
    if isinstance(signals, xr.Dataset):
        raise CorpusError("records: a Dataset has its own sample rate and labels; leave fs and labels out.")
    if any(map(np.ma.is_masked, (signals, *(signals if isinstance(signals, list | tuple) else ())))):
        raise CorpusError(
            "records: a masked array has samples that are not known; fill them, or leave its records out."
        )
    try:
        x, rate = np.asarray(signals), np.asarray(fs)
    except ValueError:
        raise CorpusError("records: their signals have different lengths; cut them to one length.") from None
    if x.dtype.kind not in "iuf" or x.ndim not in (2, 3) or not x.size:
        raise CorpusError(f"records: {x.dtype} of shape {x.shape}; give numbers of shape (record, channel, time).")
    stated = rate.dtype.kind in "iuf" and rate.ndim == 0 and rate != 0
    if not stated or not isinstance(labels, Mapping | pd.DataFrame) or not {"fault", "specimen"} <= {*labels.keys()}:
        raise CorpusError(
            "labels: an array needs fs, its sample rate in Hz, and labels, a table with fault and specimen, the bearing of each record."
        )
    variables = {variable.name: variable for variable in SCHEMA if variable.name not in _OWN}
    # each quantity in its stored unit, or in one that people read
    keys = {name: (name, 1.0) for name in variables}
    keys |= {key: (name, factor) for name, of in variables.items() for key, factor in keys_of(name, of.units).items()}
    columns = {
        name: np.full(len(x), _UNKNOWN[of.dtype], None if of.dtype == "str" else of.dtype)
        for name, of in variables.items()
    }
    columns |= {"recording": np.arange(len(x)), "sample_rate": np.full(len(x), float(rate))}
    labelled = set[str]()
    for key in labels.keys():  # noqa: SIM118 - of a DataFrame too
        if key not in keys:
            raise CorpusError(f"labels: there is no column {key}{nearest(f'{key}', [*keys])}")
        (name, factor), values = keys[key], _values(labels[key])
        nested = values.dtype.kind == "O" and any(map(np.ndim, values.flat))
        if nested or values.shape not in ((), (len(x),)):
            shape = f"{values.shape}{' of lists' * nested}"
            raise CorpusError(f"labels: {key} has shape {shape}, not one value for each of {len(x)} records.")
        # a missing quantity is NaN in a corpus too, but a missing name would be a name
        missing = variables[name].dtype != "f8" and pd.isna(values).any()
        if missing or np.ma.is_masked(labels[key]):
            raise CorpusError(
                f"labels: {key} is masked or lacks values; give one for each record, or leave the column out."
            )
        if name in labelled:
            raise CorpusError(f"labels: {key} gives {name} twice; leave one of its columns out.")
        labelled.add(name)
        columns[name] = _column(name, np.broadcast_to(values, len(x)), factor, variables[name].dtype)
    corpus = hashlib.sha256(np.ascontiguousarray(x[0]).tobytes()).hexdigest()[:12]
    numbers = zip(*(columns[name].tolist() for name in ("rig", "specimen", "recording")), strict=True)
    columns[IDENTITY] = np.array([identity(corpus, *some) for some in numbers])
    with np.errstate(over="ignore"):
        signal = (x[:, None] if x.ndim == 2 else x).astype(np.float32)
    if lost := int((~np.isfinite(signal).all(axis=(1, 2))).sum()):
        raise CorpusError(f"records: {lost} of {len(x)} have samples that are not finite; leave them out.")
    channels = tuple(f"channel_{number}" for number in range(1, signal.shape[1] + 1))
    attributes = {"title": "Vibration records", "history": "written from arrays"}
    return make_dataset(signal, float(rate), channels, columns, attributes=attributes)


def _values(of_records: ArrayLike) -> NDArray[Any]:
    """Values of a label; lists of different lengths among them as they are."""
    try:
        return np.asarray(of_records)
    except ValueError:
        return np.asarray(of_records, object)


def _column(name: str, values: NDArray[Any], factor: float, dtype: str) -> NDArray[Any]:
    """Values of a label as the format has them: classes by their codes, names of machines and bearings by numbers."""
    if dtype == "str":
        return values.astype(str)
    if values.dtype.kind in "iuf":
        with np.errstate(invalid="ignore"):
            stored = (values * factor).astype(dtype)
        if dtype == "f8" or np.array_equal(stored, values):
            return stored
    texts: list[str] = values.astype(str).tolist()
    if dtype == "i4":
        return np.unique(texts, return_inverse=True)[1]
    codes = {text: code for code, text in _CLASSES.get(name, {}).items()}
    if (wrong := next((text for text in texts if text not in codes), None)) is not None:
        allowed = nearest(wrong, [*codes]) if codes else "; give numbers."
        raise CorpusError(f"labels: {name} has no value {wrong!r}{allowed}")
    return np.array([codes[text] for text in texts])
