"""Windows of corpora: which are compared, and how they are read.

All corpora are cut into windows of one length, and brought to one band and sample rate. Windows are read and measured in
blocks, so that memory does not grow with the signals of a corpus.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from pandas import DataFrame

from features.signal.rows import FloatArray
from features.table.indicators import Orders
from gen.corpus import FAULTS, SIGNAL, UNKNOWN_CODE, open_corpus
from gen.support.errors import CorpusError
from gen.support.rounding import rounded_down
from raceway.comparing.measures import NAMES, compute_measures, limit_band

BLOCK = 32  # windows read and measured together
SHORTEST = 0.05  # s


class CommonForm(NamedTuple):
    """What all corpora are brought to: length of a window [s], sample rate [Hz] and upper edge of the band [Hz]."""

    window: float
    rate: float
    top: float


class Windows(NamedTuple):
    """Measured windows of one corpus.

    Attributes
    ----------
    name
        Of the corpus.
    folder
        Of the corpus.
    record, start
        Record that each window was cut from, and its first sample, shapes (window,).
    fault
        Code of the class, shape (window,).
    values
        Measures, shape (window, measure).
    unknown
        Number of records left out because their class is not known.
    """

    name: str
    folder: Path
    record: np.ndarray
    start: np.ndarray
    fault: np.ndarray
    values: FloatArray
    unknown: int = 0

    def values_of(self, fault: str) -> FloatArray:
        """Measures of the windows of a class, shape (window, measure)."""
        return self.values[self.fault == FAULTS.index(fault)]


def common_ground(folders: list[Path], top: float, window: float | None) -> CommonForm:
    """Shortest record (or ``window``, if that is shorter), lowest sample rate, and the upper edge of the band.

    Raises
    ------
    CorpusError
        If a corpus cannot be read, its sample rate is too low for ``top``, or its records are shorter than ``window``.
    """
    lengths, rates = [], []
    for folder in folders:
        with open_corpus(folder) as corpus:
            fs = float(corpus["sample_rate"].values.min())
            lengths.append(corpus.sizes["elapsed_time"] / fs)
        rates.append(fs)
        if not fs >= 2 * top:
            message = (
                f"{folder}: its sample rate of {fs:g} Hz shows nothing above {fs / 2:g} Hz, and records are compared up "
                f"to {top:g} Hz; choose an upper frequency of at most {rounded_down(fs / 2, 6)} Hz."
            )
            raise CorpusError(message)
        if window is not None and lengths[-1] < window * (1 - 1e-9):
            message = f"{folder}: its records are {lengths[-1]:g} s long, shorter than the window of {window:g} s; choose a shorter one."
            raise CorpusError(message)
    # what all corpora can give: a machine must not be known by its sample rate
    common = CommonForm(min(lengths) if window is None else window, min(rates), top)
    if common.window < SHORTEST:
        folder = folders[int(np.argmin(lengths))]
        message = f"{folder}: its records are {min(lengths):g} s long; envelopes need at least {SHORTEST:g} s."
        raise CorpusError(message)
    return common


def measured_windows(folder: Path, name: str, common: CommonForm, most: int) -> Windows:
    """Measure at most ``most`` windows of each class of a corpus, spread evenly over its rigs and specimens.

    Windows without a finite, varying signal are left out, and records whose class is not known.

    Raises
    ------
    CorpusError
        If the corpus cannot be read, or none of its records has a shaft rate and fault orders.
    """
    with open_corpus(folder, check="size") as corpus:
        names, fs = ("fault", "rig", "specimen", "shaft_rate", *Orders._fields), float(corpus["sample_rate"].values[0])
        labels = DataFrame({key: corpus[key].values for key in names})
        # a line is looked up at a rate and at orders that are known
        needed = labels[["shaft_rate", *Orders._fields]]
        complete = ((needed > 0) & (needed < np.inf)).all(axis=1)
        if not complete.any():
            message = (
                f"{folder}: no record has a shaft rate and fault orders above 0, which are needed to find its lines."
            )
            raise CorpusError(message)
        labelled = labels["fault"] != UNKNOWN_CODE
        each = corpus.sizes["elapsed_time"] // window_length(common, fs)
        chosen = _chosen(labels[complete & labelled], window_length(common, fs), each, most)
        values = np.full((len(chosen), len(NAMES)), np.nan)
        # records of one class at a time, so that memory does not grow with the corpus
        groups: Any = chosen.groupby("fault").indices
        for code, places in groups.items():
            for block in np.array_split(places, range(BLOCK, len(places), BLOCK)):
                values[block] = _measure_block(corpus, chosen.iloc[block], common, FAULTS[code], fs)
    # a constant signal has no measures
    usable = np.isfinite(values).any(axis=1)
    record, start, fault = chosen.index.to_numpy(), chosen["start"].to_numpy(), chosen["fault"].to_numpy()
    return Windows(name, folder, record[usable], start[usable], fault[usable], values[usable], int((~labelled).sum()))


def _chosen(labels: DataFrame, length: int, each: int, most: int) -> DataFrame:
    """Labels and first sample of the windows to measure, by the number of their record and in the order of the corpus.

    ``each`` record has so many windows of ``length`` samples.
    """
    cut = labels.loc[labels.index.repeat(each)]
    cut["start"] = cut.groupby(level=0).cumcount() * length
    cut["place"] = np.arange(len(cut))
    # the first windows of all specimens come before the second ones, each in a random order
    shuffled = cut.iloc[np.random.default_rng(0).permutation(len(cut))]
    turn = shuffled.groupby(["fault", "rig", "specimen"]).cumcount()
    by_turn = shuffled.iloc[np.argsort(turn.to_numpy(), kind="stable")]
    return by_turn.groupby("fault").head(most).sort_values("place")


def _measure_block(corpus: xr.Dataset, windows: DataFrame, common: CommonForm, fault: str, fs: float) -> FloatArray:
    """Measures of some windows, shape (window, measure); NaN for those that are not finite or constant."""
    x = read_windows(corpus, windows.index.to_numpy(), windows["start"].to_numpy(), window_length(common, fs))
    values = np.full((len(x), len(NAMES)), np.nan)
    usable = np.isfinite(x).all(axis=1) & (np.ptp(x, axis=1) > 0)
    if usable.any():
        limited = limit_band(x[usable], fs, common.rate, common.top)
        exact = limited.shape[-1] * fs / x.shape[-1]
        rate, *orders = (windows[key].to_numpy()[usable] for key in ("shaft_rate", *Orders._fields))
        values[usable] = compute_measures(limited, exact, common.top, rate, Orders(*orders), fault)
    return values


def window_length(common: CommonForm, fs: float) -> int:
    """Samples of a window at a sample rate [Hz]; the last sample is not lost to rounding."""
    return int(common.window * fs * (1 + 1e-9))


def read_windows(corpus: xr.Dataset, record: np.ndarray, start: np.ndarray, length: int) -> FloatArray:
    """Accelerations of the first channel [m s-2], shape (window, time)."""
    rows, place = np.unique(record, return_inverse=True)
    signal = corpus[SIGNAL].isel(record=rows, channel=0).values
    return np.stack([signal[row, first : first + length] for row, first in zip(place, start, strict=True)]).astype(
        float
    )


def typical_window(
    windows: Windows, fault: str, measure: str, common: CommonForm
) -> tuple[int, FloatArray, dict[str, float]]:
    """The window with the median of a measure in its class: number of its record, band-limited signal, and conditions.

    The signal has the shape (time,); the conditions are its exact sample rate, ``sample_rate``, its ``shaft_rate`` [Hz] and
    its fault orders.
    """
    column = windows.values[:, NAMES.index(measure)]
    places = np.flatnonzero((windows.fault == FAULTS.index(fault)) & np.isfinite(column))
    place = places[np.argsort(column[places], kind="stable")[len(places) // 2]]
    record, start = windows.record[place : place + 1], windows.start[place : place + 1]
    with open_corpus(windows.folder, check="size") as corpus:
        of_record = corpus.isel(record=int(record[0]))
        operation = {key: float(of_record[key]) for key in ("sample_rate", "shaft_rate", *Orders._fields)}
        fs = operation["sample_rate"]
        x = read_windows(corpus, record, start, window_length(common, fs))
    limited = limit_band(x, fs, common.rate, common.top)[0]
    return int(record[0]), limited, operation | {"sample_rate": limited.size * fs / x.shape[-1]}
