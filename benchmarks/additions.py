"""Whether more features of the fault lines raise transfer: the default set with one addition at a time.

``python -m benchmarks.additions REAL`` with REAL a folder that holds ``cwru``, ``mfpt`` and ``uestc`` as their providers publish them. An
addition has one column for each of outer race, inner race and balls, from the records below 5 kHz. The ensemble learns from
``domain_randomised`` and is scored on unseen rigs of it and on the three real sets, as in :mod:`benchmarks.transfer`. A figure is the mean
over the seeds, of an addition less that of the default set; the lowest and the highest are in brackets.
"""

import argparse
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from scipy.fft import irfft

from benchmarks.envelope_bands import NARROWEST, Signal, record_combs
from benchmarks.speed import real_corpora
from benchmarks.transfer import BEST, GROUPS, RECIPE, corpora_of, figures
from features import feature_table, signal
from features.baselines import Model, cross_validate
from features.signal.lines import Orders, families, single_lines
from features.signal.spectra import fourier_coefficients
from features.table.band import DEFAULT_BAND
from gen.corpus import SIGNAL, open_corpus
from gen.recipe import read_recipe

FS = 2 * DEFAULT_BAND.high
HIGHEST = 500.0  # Hz, above every fault line
CHANCE = 0.01  # that a bin of noise exceeds the threshold of the enhanced envelope spectrum
BLOCK = 200  # records

Rates = np.ndarray
Addition = Callable[[Signal, Rates, Rates], np.ndarray]
"""Columns (record, family) of records (record, time), shaft rates (record,) and fault rates (record, family) [Hz]."""


def combs_in(x: Signal, bands: list[np.ndarray], shaft_rate: Rates, rates: Rates) -> np.ndarray:
    """Combs of each family in its band [Hz], each band of shape (record, 2) or (1, 2)."""
    out = np.empty(rates.shape)
    for family, edges in enumerate(bands):
        for band in np.unique(edges, axis=0):
            rows = np.broadcast_to((edges == band).all(axis=1), len(x))
            out[rows, family] = record_combs(x[rows], FS, band, rates[rows, family], shaft_rate[rows])
    return out


def kurtogram_band(x: Signal, shaft_rate: Rates, rates: Rates) -> np.ndarray:
    return combs_in(x, [signal.kurtogram(x, FS, narrowest=NARROWEST).best()] * rates.shape[1], shaft_rate, rates)


def comb_band(x: Signal, shaft_rate: Rates, rates: Rates) -> np.ndarray:
    return combs_in(x, [signal.comb_bands(x, FS, rate).best() for rate in rates.T], shaft_rate, rates)


def enhanced_lines(x: Signal, _: Rates, rates: Rates) -> np.ndarray:
    coherence = signal.spectral_coherence(x, FS, HIGHEST)
    level = np.log(signal.enhanced_envelope_spectrum(coherence) / coherence.envelope_threshold(CHANCE))
    return single_lines(level, rates / coherence.cyclic[1])


ADDITIONS: Mapping[str, Addition] = {
    "combs in the band of `comb_bands`": comb_band,
    "combs in the band of the kurtogram": kurtogram_band,
    "lines of the enhanced envelope spectrum": enhanced_lines,
    "noise (control)": lambda _x, fr, rates: np.random.default_rng(int(1e6 * fr.sum())).standard_normal(rates.shape),
}


def added_columns(corpus: Path) -> dict[str, np.ndarray]:
    """Columns of every addition for the records of a corpus, shape (record, family)."""
    heights: dict[str, list[np.ndarray]] = {name: [] for name in ADDITIONS}
    with open_corpus(corpus) as opened:
        fs, shaft_rate = float(opened["sample_rate"][0]), opened["shaft_rate"].values
        rates = shaft_rate[:, None] * families(Orders(*(opened[name].values for name in Orders._fields)))
        for start in range(0, len(rates), BLOCK):
            rows = slice(start, start + BLOCK)
            x = np.asarray(irfft(fourier_coefficients(opened[SIGNAL][rows, 0].values, fs, FS / 2), norm="forward"))
            for name, addition in ADDITIONS.items():
                heights[name].append(addition(x, shaft_rate[rows], rates[rows]))
    return {name: np.concatenate(parts) for name, parts in heights.items()}


def tables(corpus: Path) -> dict[str, xr.Dataset]:
    """The default table of a corpus, and that with each addition."""
    tables = {"default set": feature_table(corpus, GROUPS)}
    features, rest = tables["default set"]["features"], tables["default set"].drop_dims("feature")
    for name, columns in added_columns(corpus).items():
        added = features[:, : columns.shape[1]].copy(data=columns).assign_coords(feature=["outer", "inner", "ball"])
        tables[name] = rest.assign(features=xr.concat([features, added], "feature"))
    return tables


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    parser.add_argument("--seeds", type=int, default=5)
    options = parser.parse_args()
    rows: dict[str, list[dict[str, Any]]] = {}
    with tempfile.TemporaryDirectory() as name:
        real = {title: tables(corpus) for title, corpus in real_corpora(options.real, Path(name)).items()}
        for seed, corpus in enumerate(corpora_of(read_recipe(RECIPE), options.seeds, Path(name), 2)):
            for addition, table in tables(corpus).items():
                model = Model(BEST, seed=seed).fit(table)
                scored = {"unseen rigs": figures(cross_validate(table, BEST, track="rig", seed=seed))["window"]}
                for title, tested in real.items():
                    on_real = figures(model.score(tested[addition]))
                    scored |= {f"{title}, {unit}": on_real[unit] for unit in ("window", "recording")}
                rows.setdefault(addition, []).append(scored)
    default = rows["default set"]
    print(f"| | {' | '.join(default[0])} |\n|---|{'---:|' * len(default[0])}")
    for addition, each in rows.items():
        less = [dict.fromkeys(default[0], 0.0)] * len(default) if each is default else default
        cells = [[own[key] - other[key] for own, other in zip(each, less, strict=True)] for key in default[0]]
        sign = "" if each is default else "+"
        texts = [f"{np.mean(v):{sign}.3f} ({min(v):{sign}.3f} to {max(v):{sign}.3f})" for v in cells]
        print(f"| {addition} | {' | '.join(texts)} |")


if __name__ == "__main__":
    main()
