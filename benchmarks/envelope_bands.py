"""How often the strongest comb of a real recording is that of its fault, by band and by whitening.

``python -m benchmarks.envelope_bands REAL`` with REAL a folder that holds ``cwru``, ``mfpt`` and ``uestc`` as their providers publish them.
A comb is the mean level of the lines of outer race, inner race or balls at three harmonics over the floor of the envelope spectrum, at the
speed that is known best. A recording carries a line if the comb of its fault has 1 neper in any of the cells, averaged over its windows.
One of three is chance.
"""

import argparse
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import numpy as np
from scipy.fft import irfft

from benchmarks.speed import Recording, real_corpora, recordings
from features.signal import comb_bands, kurtogram
from features.signal.demodulation import ZERO_PADDING, analytic_band, envelope_spectrum, log_level
from features.signal.lines import combs
from features.signal.spectra import fourier_coefficients, whiten_by_psd, whiten_cepstrally
from features.table.band import DEFAULT_BAND
from features.table.record_batch import FLOOR_WIDTH, WHITENING_WIDTH

FAMILIES = ("outer", "inner", "ball")
CLEAR = 1.0  # nepers
NARROWEST = 600.0  # Hz, of a band of the kurtogram: a line and three harmonics must fit
WINDOW_SECONDS = 1.0

Signal = np.ndarray
Cell = tuple[str, str]


def whitened(x: Signal, fs: float, method: Callable) -> Signal:
    """Records whose Fourier coefficients are whitened."""
    return np.asarray(irfft(method(fourier_coefficients(x, fs, fs / 2)), n=x.shape[-1], norm="forward"))


WHITENINGS: Mapping[str, Callable[[Signal, float], Signal]] = {
    "as recorded": lambda x, _: x,
    "whitened by its spectrum": lambda x, fs: whitened(
        x, fs, lambda c: whiten_by_psd(c, round(WHITENING_WIDTH * x.shape[-1] / fs))
    ),
    "cepstral pre-whitening": lambda x, fs: whitened(x, fs, whiten_cepstrally),
}


def chosen_bands(x: Signal, fs: float, rates: np.ndarray) -> dict[str, np.ndarray]:
    """Edges of the band of each family [Hz], shape (family, 2), by way of choice; one band for all windows."""
    by_kurtosis = kurtogram(x, fs, narrowest=NARROWEST)
    by_comb = [comb_bands(x, fs, np.full(len(x), rate)) for rate in rates]
    best = [tree._replace(score=tree.score.mean(axis=0)[None]).best()[0] for tree in (by_kurtosis, *by_comb)]
    fixed = (DEFAULT_BAND.low, min(DEFAULT_BAND.high, fs / 2))
    return {"fixed": np.tile(fixed, (3, 1)), "kurtogram": np.tile(best[0], (3, 1)), "comb": np.stack(best[1:])}


def record_combs(x: Signal, fs: float, band: np.ndarray, rate: np.ndarray, shaft_rate: np.ndarray) -> np.ndarray:
    """Comb of a rate [Hz] of each record in the envelope spectrum of a band [Hz], shape (record,) [nepers]."""
    duration = x.shape[-1] / fs
    low, high = np.rint(band * duration).astype(int)
    z = analytic_band(fourier_coefficients(x, fs, fs / 2), low, high)
    _, spectrum = envelope_spectrum(z, z.shape[-1] / duration)
    width = np.maximum(FLOOR_WIDTH[0] * shaft_rate, FLOOR_WIDTH[1]) * duration * ZERO_PADDING
    level = log_level(spectrum, width, spectrum.shape[-1])
    return combs(level, (rate * duration * ZERO_PADDING)[:, None])[:, 0]


def comb_levels(recording: Recording) -> Iterator[tuple[Cell, list[float]]]:
    """Comb of each family in each cell of the table."""
    fs, rate = recording.fs, recording.true if np.isfinite(recording.true) else recording.label
    _, bpfo, bpfi, bsf = recording.orders
    rates = rate * np.array([bpfo, bpfi, 2 * bsf])
    whole = recording.x.reshape(1, -1).astype(np.float32)
    length = min(round(WINDOW_SECONDS * fs), whole.shape[-1])
    for whitening, whiten in WHITENINGS.items():
        x = whiten(whole, fs)[0, : whole.shape[-1] // length * length].reshape(-1, length)
        every = np.ones(len(x))
        for band, edges in chosen_bands(x, fs, rates).items():
            levels = [
                record_combs(x, fs, *pair, rate * every) for pair in zip(edges, rates[:, None] * every, strict=True)
            ]
            yield (whitening, band), [float(of_windows.mean()) for of_windows in levels]


def main() -> None:
    """Print a table for each set and one for all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    right: dict[str, list[dict[Cell, bool]]] = {"all": []}
    with tempfile.TemporaryDirectory() as name:
        for title, corpus in real_corpora(parser.parse_args().real, Path(name)).items():
            for recording in recordings(corpus):
                if recording.fault in FAMILIES:
                    own = FAMILIES.index(recording.fault)
                    levels = dict(comb_levels(recording))
                    if max(values[own] for values in levels.values()) > CLEAR:
                        hits = {cell: int(np.argmax(values)) == own for cell, values in levels.items()}
                        right.setdefault(title, []).append(hits)
                        right["all"].append(hits)
    print(
        "| set | recordings | whitening | fixed band, % | kurtogram, % | comb band, % |\n|---|---:|---|---:|---:|---:|"
    )
    for title, hits in right.items():
        for whitening in WHITENINGS:
            rates = [100 * np.mean([hit[whitening, band] for hit in hits]) for band in ("fixed", "kurtogram", "comb")]
            print(f"| {title} | {len(hits)} | {whitening} | {' | '.join(f'{rate:.1f}' for rate in rates)} |")


if __name__ == "__main__":
    main()
