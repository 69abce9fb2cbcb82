"""A synthetic corpus against real ones: AUC and quantiles of every measure by class, and the yardstick of the real sets.

Each real set counts equally in a class, whatever its number of windows, so that the largest does not dominate.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from sklearn.metrics import roc_auc_score

from features.signal.rows import FloatArray
from gen.corpus import FAULTS
from gen.support.errors import CorpusError
from gen.support.progress import Progress, counter
from raceway.comparing.measures import MEASURES, NAMES
from raceway.comparing.windows import CommonForm, Windows, common_ground, measured_windows

FEWEST = 10  # windows of a class, below which a set is not compared in it
SHARES = (0.05, 0.5, 0.95)
TOP = 5000.0  # Hz: above it the healthy recordings of CWRU are attenuated

Table = dict[str, dict[str, float | None]]


@dataclass(frozen=True)
class Comparison:
    """Result of a comparison.

    Attributes
    ----------
    auc
        By class and measure: probability that a real window has a higher value than a synthetic one; None where one
        side has too few values.
    quantiles
        By class, measure and set ("synthetic", "real" pooled, and each real set): 5, 50 and 95 %.
    yardstick
        By name of a real set, class and measure: the same as ``auc`` with this set in place of the synthetic one and the
        other real sets pooled. Empty with one real set.
    counts
        By class, measure and set: number of windows that have the measure.
    common
        Length of a window [s], sample rate [Hz], and upper edge of the band [Hz].
    synthetic, real
        The measured windows.
    """

    auc: Table
    quantiles: dict[str, dict[str, dict[str, list[float]]]]
    yardstick: dict[str, Table]
    counts: dict[str, dict[str, dict[str, int]]]
    common: CommonForm
    synthetic: Windows
    real: tuple[Windows, ...]

    def plain(self) -> dict[str, object]:
        """The result in types of JSON, without the windows."""
        return {
            "auc": self.auc,
            "yardstick": self.yardstick,
            "quantiles": self.quantiles,
            "counts": self.counts,
            "window_s": self.common.window,
            "sample_rate_hz": self.common.rate,
            "top_hz": self.common.top,
            "units": {measure.name: measure.unit for measure in MEASURES},
            "synthetic": str(self.synthetic.folder),
            "real": {windows.name: str(windows.folder) for windows in self.real},
        }


def compare(
    synthetic: Path | str,
    real: Sequence[Path | str],
    *,
    top: float = TOP,
    window: float | None = None,
    records: int = 500,
    progress: Progress | None = None,
) -> Comparison:
    """Compare a synthetic corpus with real ones, class by class.

    Parameters
    ----------
    synthetic, real
        Folders of corpora, at least one of real recordings.
    top
        Upper edge of the compared band [Hz].
    window
        Length that all records are cut to [s]; by default that of the shortest record.
    records
        Largest number of windows of each class and corpus, spread evenly over rigs and specimens.
    progress
        Called with the number of corpora done and of all.

    Raises
    ------
    CorpusError
        If a corpus cannot be read, has no shaft rates or is given twice as a real one, or no class has
        enough windows in the synthetic and a real corpus.
    ValueError
        Without a real corpus.
    """
    folders = [Path(synthetic), *map(Path, real)]
    if len(folders) < 2:
        message = "real: no corpus of real recordings is given; give at least one."
        raise ValueError(message)
    if len({folder.resolve() for folder in folders[1:]}) < len(folders) - 1:
        raise CorpusError("a real corpus is given twice; give each once.")
    common = common_ground(folders, top, window)
    measured: list[Windows] = []
    done = counter(progress, len(folders))
    for name, folder in zip(["synthetic", *_names(folders[1:])], folders, strict=True):
        measured.append(measured_windows(folder, name, common, records))
        done(1)
    return contrast(measured[0], tuple(measured[1:]), common)


def _names(folders: Sequence[Path]) -> list[str]:
    """Name of each real set: its folder, or its whole path if that is not unique or a name of the results."""
    short = [folder.resolve().name for folder in folders]
    clear = len({*short, "synthetic", "real"}) == len(short) + 2
    return short if clear else [str(folder) for folder in folders]


def contrast(synthetic: Windows, real: tuple[Windows, ...], common: CommonForm) -> Comparison:
    """Compare measured windows.

    Raises
    ------
    CorpusError
        If no class has enough windows on both sides.
    """
    tables, quantiles, counts = dict[str, Any](), dict[str, Any](), dict[str, Any]()
    yardstick = dict[str, Table]()
    for fault in _classes(synthetic, real):
        samples = {windows.name: windows.values_of(fault) for windows in (synthetic, *real)}
        samples = {name: values for name, values in samples.items() if len(values) >= FEWEST}
        columns = {
            measure.name: {name: finite(values[:, NAMES.index(measure.name)]) for name, values in samples.items()}
            for measure in MEASURES
            if measure.belongs_to(fault)
        }
        tables[fault] = {name: _auc(sets, synthetic.name) for name, sets in columns.items()}
        quantiles[fault] = {name: _quantiles(sets, synthetic.name) for name, sets in columns.items()}
        counts[fault] = {name: {key: len(values) for key, values in sets.items()} for name, sets in columns.items()}
        others = [windows.name for windows in real if windows.name in samples]
        for held in others if len(others) > 1 else []:
            of_real = {name: {key: sets[key] for key in others} for name, sets in columns.items()}
            yardstick.setdefault(held, {})[fault] = {name: _auc(sets, held) for name, sets in of_real.items()}
    return Comparison(tables, quantiles, yardstick, counts, common, synthetic, real)


def _classes(synthetic: Windows, real: tuple[Windows, ...]) -> list[str]:
    simulated = np.bincount(synthetic.fault, minlength=len(FAULTS))
    recorded = np.stack([np.bincount(w.fault, minlength=len(FAULTS)) for w in real])
    if not (recorded.sum(axis=0) * simulated).any():
        here, there = (
            ", ".join(FAULTS[c] for c in np.flatnonzero(n)) or "none" for n in (simulated, recorded.sum(axis=0))
        )
        message = f"{synthetic.folder}: has no class that the real corpora have: {here} here, {there} there; nothing can be compared."
        raise CorpusError(message)
    # an AUC of a few windows tells nothing
    enough = (simulated >= FEWEST) & (recorded >= FEWEST).any(axis=0)
    if not enough.any():
        message = (
            f"{synthetic.folder}: no class has {FEWEST} usable windows both here and in a real corpus; give larger "
            f"corpora, or a shorter window."
        )
        raise CorpusError(message)
    return [FAULTS[code] for code in np.flatnonzero(enough)]


def finite(values: FloatArray) -> FloatArray:
    """Values that are finite."""
    return values[np.isfinite(values)]


def pool(sets: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Values of several sets, and weights with which each set that is not too small has the total weight 1."""
    enough = [values for values in sets if len(values) >= FEWEST]
    if not enough:
        return np.empty(0), np.empty(0)
    return np.concatenate(enough), np.concatenate([np.full(len(values), 1 / len(values)) for values in enough])


def _auc(sets: dict[str, FloatArray], below: str) -> float | None:
    """AUC of the other sets above the set ``below``; None if either side has too few values."""
    low, low_weights = pool([values for name, values in sets.items() if name == below])
    high, high_weights = pool([values for name, values in sets.items() if name != below])
    if not len(low) or not len(high):
        return None
    is_high = np.repeat([False, True], [len(low), len(high)])
    weights = np.concatenate([low_weights, high_weights])
    return float(roc_auc_score(is_high, np.concatenate([low, high]), sample_weight=weights))


def _quantiles(sets: dict[str, FloatArray], synthetic: str) -> dict[str, list[float]]:
    pools = {name: pool([values]) for name, values in sets.items()}
    pools["real"] = pool([values for name, values in sets.items() if name != synthetic])
    return {
        name: np.quantile(values, SHARES, weights=weights, method="inverted_cdf").tolist()
        for name, (values, weights) in pools.items()
        if len(values)
    }
