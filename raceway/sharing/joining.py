"""Several corpora as if they were one: the same variables, numbers that tell machines apart, and no record twice."""

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.choice import channel_names, per_record
from gen.corpus.fault_classes import UNKNOWN
from gen.corpus.schema import SIGNAL, class_names, listed_flags
from gen.corpus.unusable import VERDICTS, judge
from gen.support.errors import CorpusError

_WITHOUT_CONTENT = [VERDICTS.index(verdict) for verdict in ("dead", "constant", "not_finite")]

Named = tuple[str, xr.Dataset]
"""An opened corpus with its name for errors."""


def check_fit(first: Named, other: Named, *, float32: bool) -> None:
    """CorpusError unless two corpora have the same channels, sample rate and length, and the same storage if it is to be kept."""
    (name, wanted), (other_name, tested) = first, other
    own, missing = (
        [channel for channel in channel_names(corpus) if channel not in channel_names(against)]
        for corpus, against in ((tested, wanted), (wanted, tested))
    )
    # an example with channels of these corpora, which may be the answer
    if own or missing:
        example = f"{(own or channel_names(tested))[0]}={(missing or channel_names(wanted))[0]}"
        raise CorpusError(
            f"{other_name}: has the channels {', '.join(channel_names(tested))}, and {name} has {', '.join(channel_names(wanted))}; give "
            f"channels of one sensor one name (--rename-channel {example}; in Python rename), or choose common ones (--channels)."
        )
    for (what, of_other, advice), (_, of_first, _) in zip(_form(tested), _form(wanted), strict=True):
        if of_other != of_first and not (float32 and what.startswith("storage")):
            raise CorpusError(f"{other_name}: has the {what} {of_other}, and {name} has {of_first}; {advice}.")


def _form(corpus: xr.Dataset) -> list[tuple[str, str, str]]:
    """Name of each fact that corpora must share, the fact, and what to do where it differs."""
    encoding = corpus[SIGNAL].encoding
    storage = f"int16 in steps of {encoding['scale_factor']:.9g} m s-2" if "scale_factor" in encoding else "float32"
    return [
        ("sample rate", f"{float(corpus['sample_rate'][0]):.17g} Hz", "make both at one sample rate"),
        ("record length", f"{corpus.sizes['elapsed_time']} samples", "make both with records of one length"),
        ("storage of the signals", storage, "store all in floating point (float32)"),
    ]


def with_same_variables(corpora: Sequence[Named]) -> tuple[list[xr.Dataset], tuple[str, ...]]:
    """Corpora with all per-record variables of any of them, and the names of those that one or more lack.

    A corpus that lacks a variable gets :func:`unknown_value` for all its records. Attributes of the signal are kept
    if they are the same in all corpora, and channels and times are those of the first.

    Raises
    ------
    CorpusError
        If a variable has different types, units or class values in two of them.
    """
    variables: dict[str, tuple[str, xr.Variable]] = {}
    for path, corpus in corpora:
        for name in per_record(corpus):
            _check_same(name, variables.setdefault(name, (path, corpus[name].variable)), (path, corpus[name].variable))
    signals = [corpus[SIGNAL].attrs for _, corpus in corpora]
    # attributes of the signal on which all agree
    common = {key: value for key, value in signals[0].items() if all(of.get(key) == value for of in signals)}
    # h5py gives an axis with its byte order stated, of which netCDF4 warns
    time = corpora[0][1]["elapsed_time"]
    axes = {"elapsed_time": ("elapsed_time", time.values.astype(np.float64), time.attrs)}
    completed = [_with_all(corpus, variables, common).assign_coords(axes) for _, corpus in corpora]
    lacking = tuple(name for name in variables if any(name not in corpus.variables for _, corpus in corpora))
    return completed, lacking


def _check_same(name: str, first: tuple[str, xr.Variable], other: tuple[str, xr.Variable]) -> None:
    (path, array), (other_path, second) = first, other
    # the same name must mean the same quantity
    for what, describe in (
        ("type", lambda of: "text" if of.dtype.kind in "OSUT" else str(of.dtype.newbyteorder("="))),
        ("unit", lambda of: of.attrs.get("units")),
        ("values", lambda of: listed_flags(class_names(of.attrs))),
    ):
        if describe(array) != describe(second):
            raise CorpusError(
                f"{other_path}: the {what} of {name} is {describe(second)}, in {path} {describe(array)}; make both with one version of "
                "raceway."
            )


def _with_all(
    corpus: xr.Dataset, variables: Mapping[str, tuple[str, xr.Variable]], signal: Mapping[str, Any]
) -> xr.Dataset:
    """Corpus with all variables in the order given; those that it lacks take no memory."""
    columns = {SIGNAL: _with_attributes(corpus[SIGNAL].variable, signal)}
    for name, (_, like) in variables.items():
        if name in corpus.variables:
            columns[name] = _with_attributes(corpus[name].variable, like.attrs)
            continue
        text = like.dtype.kind not in "iuf"
        # one value for all records, repeated without memory
        value = np.array(unknown_value(like.dtype, like.attrs), object if text else like.dtype.newbyteorder("="))
        columns[name] = xr.Variable("record", np.broadcast_to(value, corpus.sizes["record"]), like.attrs)
    texts = [name for name, column in columns.items() if column.dtype.kind not in "iuf"]
    stored = corpus.drop_vars([name for name, variable in corpus.variables.items() if variable.dims == ("record",)])
    return stored.assign(columns).set_coords(texts)


def _with_attributes(variable: xr.Variable, attributes: Mapping[Any, Any]) -> xr.Variable:
    """Variable with other attributes, still unread."""
    view = variable.copy(deep=False)
    view.attrs = dict(attributes)
    return view


def unknown_value(dtype: np.dtype[Any], attributes: Mapping[Any, Any]) -> Any:
    """Value of a variable in records of a corpus that lacks it: empty text, NaN, ``unjudged`` or ``unknown`` of a class, or else -1.

    >>> unknown_value(np.dtype("f8"), {}), unknown_value(np.dtype("i4"), {}), unknown_value(np.dtype("O"), {})
    (nan, -1, '')
    """
    if dtype.kind == "f":
        return np.nan
    if dtype.kind not in "iu":
        return ""
    names = class_names(attributes).items()
    return next((code for code, name in names if name in ("unjudged", UNKNOWN)), -1)


def sample_digests(signal: NDArray[Any]) -> NDArray[np.bytes_]:
    """Half of the SHA-256 of the stored samples of each record, shape (record,); empty if they are constant or not numbers.

    Labels do not count: two records with the same samples and different labels are no more different than two equal ones.
    """
    texts = [hashlib.sha256(np.ascontiguousarray(record).data).hexdigest()[:32] for record in signal]
    digests = np.array(texts, "S32")
    digests[np.isin(judge(signal), _WITHOUT_CONTENT)] = b""
    return digests


def check_repeats(digests: NDArray[np.bytes_], places: Sequence[tuple[str, NDArray[np.intp]]]) -> None:
    """CorpusError if two corpora hold a record with the same samples; ``places`` are the names of the corpora and their records."""
    names = np.array([name for name, _ in places], object)
    owner = np.repeat(np.arange(len(places)), [len(records) for _, records in places])
    number = np.concatenate([records for _, records in places])
    # equal digests become neighbours
    order = np.argsort(digests, kind="stable")
    earlier, later = order[:-1], order[1:]
    same = np.flatnonzero(
        (digests[earlier] == digests[later]) & (digests[earlier] != b"") & (owner[earlier] != owner[later])
    )
    if same.size:
        # the first repeated record, so that the sentence does not depend on the order of the digests
        place = same[np.argmin(later[same])]
        first, second = int(earlier[place]), int(later[place])
        raise CorpusError(
            f"{names[owner[second]]}: record {number[second]} has the same samples as record {number[first]} of "
            f"{names[owner[first]]}, and a record that occurs twice can be in the training and in the test set; give corpora of "
            "different seeds, or leave these records out (where)."
        )
