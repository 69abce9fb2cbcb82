"""Lives of the recipe ``pronostia_like`` beside real ones: their shape, and estimates of remaining life that they teach.

``python -m benchmarks.lives REAL`` with REAL the corpus that ``raceway import femto`` makes of PRONOSTIA, or a netCDF file with the
indicators of its snapshots: rms, peak, kurtosis and rms in bands, of shape (bearing, channel, snapshot). It prints the tables of
docs/lives.md. Bearings are known by their indicators once a minute.
"""

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray
from scipy.fft import rfft, rfftfreq
from scipy.stats import ks_2samp, kurtosis

from gen import generate
from gen.corpus import SIGNAL, open_corpus
from raceway.lives.prognosis import METHODS, Lives, score_methods, scores_of

EVERY, CADENCE = 10.0, 60.0  # s
BANDS = (
    (0, 500),
    (500, 1000),
    (1000, 2000),
    (2000, 4000),
    (4000, 6000),
    (6000, 8000),
    (8000, 10_000),
    (10_000, 12_800),
)
NAMES = ("rms", "peak", "kurtosis", *(f"rms_{low}_{high}_hz" for low, high in BANDS))
ABOVE, BLOCK = 1.5, 500
FloatArray = NDArray[np.float64]


def indicators(signal: FloatArray, fs: float) -> FloatArray:
    """Logarithms of the indicators of snapshots of shape (snapshot, channel, time), shape (snapshot, indicator, channel)."""
    steady = signal - signal.mean(axis=-1, keepdims=True)
    power = 2 * np.abs(rfft(steady) / signal.shape[-1]) ** 2
    frequency = rfftfreq(signal.shape[-1], 1 / fs)
    within = [(low <= frequency) & (frequency < high) for low, high in BANDS]
    rms = np.sqrt((steady**2).mean(axis=-1))
    shape = [rms, np.abs(steady).max(axis=-1), kurtosis(steady, axis=-1, fisher=False)]
    return np.log(np.stack([*shape, *(np.sqrt(power[..., band].sum(axis=-1)) for band in within)], axis=1))


def lives_of_corpus(path: Path) -> Lives:
    """Bearings of a corpus."""
    with open_corpus(path) as records:
        _, bearing = np.unique(records["bearing"].values, return_inverse=True)
        order = np.lexsort((records["age"].values, bearing))
        fs, count = float(records["sample_rate"][0]), records.sizes["record"]
        blocks = (records[SIGNAL][first : first + BLOCK].values for first in range(0, count, BLOCK))
        values = np.concatenate([indicators(block.astype(float), fs) for block in blocks]).reshape(count, -1)
        age, rul, event, stage = (records[name].values for name in ("age", "rul", "event", "stage"))
        return Lives(values, age, rul, event == 1, bearing, stage > 0).some(order)


def lives_of_file(path: Path) -> Lives:
    """Bearings of a file of indicators."""
    parts = []
    with xr.open_dataset(path) as opened:
        for number in range(opened.sizes["bearing"]):
            bearing = opened.isel(bearing=number)
            values = np.stack([bearing[name].transpose("snapshot", "channel").values for name in NAMES], axis=1)
            logarithms = np.log(values[np.isfinite(values).all(axis=(1, 2))].astype(float))
            age = np.linspace(0, EVERY * (len(logarithms) - 1), len(logarithms))
            same = np.ones(len(logarithms), bool)
            parts.append(Lives(logarithms.reshape(len(logarithms), -1), age, age[-1] - age, same, number * same, same))
    return Lives(*map(np.concatenate, zip(*parts, strict=True)))


def once_a_minute(lives: Lives) -> Lives:
    """Every sixth snapshot of PRONOSTIA, and the last."""
    return lives.some((lives.age % CADENCE == 0) | (lives.rul == 0))


def shape(lives: Lives) -> pd.DataFrame:
    """Onset, rise of the rms and largest kurtosis of each bearing that failed; the onset is the share of life from which the rms
    stays above 1.5 times its early value."""
    rows = []
    for bearing in np.unique(lives.bearing[lives.failed]):
        own = np.exp(lives.features[lives.bearing == bearing]).reshape(-1, len(NAMES), 2).max(axis=2)
        rms = own[:, 0] / np.median(own[: max(5, len(own) // 10), 0])
        below = np.flatnonzero(rms <= ABOVE)
        onset = (below[-1] + 1) / len(rms) if len(below) else 0.0
        rows.append((onset, rms[-1], own[:, 2].max()))
    return pd.DataFrame(rows, columns=["onset", "end over start rms", "largest kurtosis"])


def trained_on_the_others(lives: Lives) -> pd.DataFrame:
    """Scores of each bearing, estimated from all others."""
    estimates = {name: np.empty(len(lives.age)) for name in METHODS}
    for bearing in np.unique(lives.bearing):
        own = lives.bearing == bearing
        for name, method in METHODS.items():
            estimates[name][own] = method(lives.some(~own))(lives.some(own))
    return scores_of(lives, estimates)


def report(synthetic: Lives, real: Lives) -> Iterator[str]:
    """Both tables in Markdown."""
    of_synthetic, of_real = shape(synthetic), shape(real)
    yield "| | synthetic: 5 %, median, 95 % | real: least, median, largest | distance |"
    yield "|---|---:|---:|---:|"
    for name in of_synthetic:
        ends = of_synthetic[name].quantile([0.05, 0.5, 0.95]), of_real[name].quantile([0, 0.5, 1])
        texts = (", ".join(f"{value:.2f}" for value in each) for each in ends)
        test = ks_2samp(of_synthetic[name], of_real[name])
        yield f"| {name} | {' | '.join(texts)} | {test.statistic:.2f} (p {test.pvalue:.2f}) |"
    yield ""
    yield "| trained on | estimate | error at 50 % | 75 % | 90 % | PHM 2012 | concordance |"
    yield "|---|---|---:|---:|---:|---:|---:|"
    for teachers, scores in (
        ("synthetic", score_methods(synthetic, real)),
        ("the other real", trained_on_the_others(real)),
    ):
        for name, row in scores.iterrows():
            errors = " | ".join(f"{row[score] / 60:.0f} min" for score in ("mae_50", "mae_75", "mae_90"))
            yield f"| {teachers} | {name} | {errors} | {row['phm_2012']:.3f} | {row['concordance']:.2f} |"


def main() -> None:
    """Print the tables."""
    path = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        generate("pronostia_like", Path(folder) / "lives")
        synthetic = lives_of_corpus(Path(folder) / "lives")
    real = lives_of_file(path) if path.suffix == ".nc" else lives_of_corpus(path)
    print(*report(synthetic, once_a_minute(real)), sep="\n")


if __name__ == "__main__":
    main()
