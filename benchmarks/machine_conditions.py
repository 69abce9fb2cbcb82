"""Conditions of machines beside those of a recorded machine: growth with speed, orbits, lines by order, combs in envelopes.

``python -m benchmarks.machine_conditions [REAL]`` with REAL a folder that holds ``limerick/healthy.nc``: healthy bearings in a machine that
is sound, bent, misaligned and out of balance. The synthetic machines are those of ``domain_randomised`` with one condition each, a healthy
bearing and two sensors at right angles; all recordings last 2 s at 20 kHz. Each value is a median; all but the growth are at 1800 rpm.
"""

import argparse
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.signal import butter, hilbert, sosfiltfilt
from scipy.stats import kurtosis

from gen import generate, open_corpus
from gen.mechanisms.background.machine_conditions import CONDITIONS
from gen.recipe import find_recipe
from gen.support.errors import RecipeError
from gen.support.yaml_files import read_yaml

FloatArray = NDArray[np.float64]

FS, SECONDS, RECORDS = 20_000.0, 2.0, 24
SPEEDS = (600.0, 1200.0, 1800.0)
ORDERS = {"order 1": (1, 1), "orders 2 to 5": (2, 5), "orders 6 to 20": (6, 20), "orders 21 to 100": (21, 100)}
ENVELOPE_HZ = (1000.0, 5000.0)


class Recording(NamedTuple):
    """One recording of two channels at right angles, shape (channel, time)."""

    condition: str
    rpm: float
    x: FloatArray


def recorded(real: Path) -> Iterator[Recording]:
    """Recordings of ``limerick``, without their means."""
    with xr.open_dataset(real / "limerick" / "healthy.nc") as opened:
        for place in range(opened.sizes["recording"]):
            recording = opened.isel(recording=place)
            x = recording["acceleration"].values[:2]
            yield Recording(
                str(recording["condition"].values), float(recording["shaft_rpm"]), x - x.mean(axis=1, keepdims=True)
            )


def synthetic(condition: str, rpm: float, folder: Path) -> Iterator[Recording]:
    """Healthy records of machines with one condition, at a fixed level of the noise."""
    recipe = read_yaml(find_recipe("domain_randomised"), RecipeError)
    section = recipe["machine_conditions"]
    only = {condition: section[condition] | {"probability": 1}} if condition in section else {}
    channels = [{"name": name, "angle_deg": angle} for name, angle in (("x", 0), ("y", 90))]
    recipe["recording"] |= {"duration_s": SECONDS, "sample_rate_hz": int(FS), "channels": channels}
    recipe["operation"] |= {"shaft_rpm": rpm, "label_error_percent": 0}
    recipe["machine"] |= {"bow_n": 0, "balance_mm_s": 0}
    del recipe["background"]["harmonics"], recipe["truth"]
    recipe |= {
        "machine_conditions": only,
        "faults": [{"kind": "healthy"}],
        "level": {"kind": "physical", "background_m_s2": 20.0},
        "corpus": {"rigs": RECORDS, "specimens_per_rig": 1, "records_per_specimen": 1},
    }
    with open_corpus(generate(recipe, folder / f"{condition}-{rpm:g}", workers=2).path) as corpus:
        for x in corpus["acceleration"].values.astype(float):
            yield Recording(condition, rpm, x - x.mean(axis=1, keepdims=True))


def amplitudes(x: FloatArray) -> NDArray[np.complex128]:
    """Amplitudes of lines, under a Hann window, shape (channel, frequency) [rms, unit of x]."""
    window = np.hanning(x.shape[-1])
    return np.sqrt(2) * np.fft.rfft(x * window) / window.sum()


def at(spectrum: FloatArray, place: float) -> FloatArray:
    """Largest values within two bins of a place, shape (channel,)."""
    return spectrum[:, max(round(place) - 2, 0) : round(place) + 3].max(axis=1)


def first_line(recording: Recording) -> float:
    """Amplitude at the shaft rate, rms over the channels."""
    spectrum = np.abs(amplitudes(recording.x))
    return float(np.sqrt(np.mean(at(spectrum, recording.rpm / 60 * SECONDS) ** 2)))


def measures(recording: Recording) -> dict[str, float]:
    """What a recording shows of the condition of its machine."""
    turned = amplitudes(recording.x)
    spectrum, bins = np.abs(turned), recording.rpm / 60 * SECONDS
    first = round(bins) - 2 + int(np.argmax(spectrum[:, round(bins) - 2 : round(bins) + 3].sum(axis=0)))
    across = turned[1, first] / turned[0, first]
    lines = np.stack([at(spectrum, order * bins) for order in range(1, 101)]) / recording.x.std(axis=1)
    values = {
        "second over first channel at 1x [dB]": 20 * np.log10(abs(across)),
        "phase between the channels at 1x [deg]": abs(np.degrees(np.angle(across))),
        "share of power in whole orders": np.mean(np.sum(lines**2, axis=0)),
        **{f"{name} [dB]": 20 * np.log10(np.median(lines[low - 1 : high])) for name, (low, high) in ORDERS.items()},
    }
    band = sosfiltfilt(butter(4, ENVELOPE_HZ, "bandpass", fs=FS, output="sos"), recording.x)
    envelope = np.abs(hilbert(band)) ** 2
    comb = np.abs(amplitudes(envelope - envelope.mean(axis=1, keepdims=True)))
    rest = np.median(comb[:, round(0.3 * bins) : round(10 * bins)], axis=1)
    for order in (1, 2, 3, 5, 8, 12):
        values[f"envelope at order {order} [dB]"] = float(np.mean(20 * np.log10(at(comb, order * bins) / rest)))
    return {name: float(value) for name, value in values.items()} | {
        "kurtosis": float(kurtosis(recording.x, axis=1, fisher=False).mean())
    }


def summary(recordings: list[Recording]) -> dict[str, float]:
    """Medians of recordings of one condition, and the power of the speed with which the line at 1x grows."""
    each = [measures(recording) for recording in recordings if recording.rpm == SPEEDS[-1]]
    medians = {name: float(np.median([values[name] for values in each])) for name in each[0]}
    middles = [np.median([first_line(recording) for recording in recordings if recording.rpm == rpm]) for rpm in SPEEDS]
    growth = np.polyfit(np.log(SPEEDS), np.log(middles), 1)[0]
    return {"growth of 1x with speed, exponent": float(growth)} | medians


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path, nargs="?", help="folder that holds limerick/healthy.nc")
    options = parser.parse_args()
    columns: dict[str, list[Recording]] = {}
    for recording in [] if options.real is None else recorded(options.real):
        columns.setdefault(f"recorded: {recording.condition}", []).append(recording)
    with tempfile.TemporaryDirectory() as folder:
        for condition in ("sound", *(kind.place for kind in CONDITIONS)):
            columns[condition] = [record for rpm in SPEEDS for record in synthetic(condition, rpm, Path(folder))]
    summaries = {name: summary(recordings) for name, recordings in columns.items()}
    print(f"| | {' | '.join(summaries)} |\n|---|{'---:|' * len(summaries)}")
    for name in next(iter(summaries.values())):
        print(f"| {name} | {' | '.join(f'{values[name]:.2f}' for values in summaries.values())} |")


if __name__ == "__main__":
    main()
