"""The statements of the seed paper, each measured on a run of one preset and compared with its accepted range."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.signal import find_peaks, hilbert

from features.report.pictures import picture
from gen.corpus import write_durably, write_text_durably
from raceway.console.show import json_text
from raceway.studies.paper import CHANNELS, FIGURES, FS, PRESETS, FloatArray, Run, draw_figure, power_spectrum, run

LATE = 0.05  # s, after which the start has decayed


class Finding(NamedTuple):
    """A statement of the paper, measured."""

    id: str
    preset: str
    finding: str
    value: float
    accept: tuple[float, float]
    holds: bool
    why: str
    """Why the statement does not hold, as a clause; empty if it holds."""


def findings(name: str, made: Run) -> list[Finding]:
    """All statements of the paper, measured on a run of the preset ``name``."""
    found = []
    for key, text, value, accept in (*_healthy(made.healthy), *_cracked(made)):
        holds = accept[0] <= value <= accept[1]
        found.append(Finding(key, name, text, value, accept, holds, "" if holds else _WHY.get(key, "")))
    return found


_WHY = {
    "H8": "the second swing of y2 goes deeper, since the load points down while the figure shows it up (E17)",
    "H12": "x1 carries a little of the contact mode that x2 does not",
    "C3": "the ball falls less far with the stiffness that the geometry gives",
    "C4": "with the rotor's weight alone the shaft does not fall back to zero",
    "C5": "with the rotor's weight alone the swing across the load is smaller",
    "C6": "with the rotor's weight alone the swing across the load is smaller",
    "C8": "with the rotor's weight alone the housing swings less",
    "C10": "fewer lines of the contact mode stand out",
    "C12.y1": "the strongest line stands one turn of the shaft beside 3 or 4 BPFI; 3 BPFI, near 740 Hz, is there but weaker",
    "C12.y2": "the strongest line stands one turn of the shaft beside 3 or 4 BPFI; 3 BPFI, near 740 Hz, is there but weaker",
    "C13.300": "BPFI + fr lies 14 Hz below 300 Hz at the shaft rate that fits the rest",
    "C14": "the load along x leaves y2 fewer harmonics",
}  # fmt: skip

Row = tuple[str, str, float, tuple[float, float]]


def _healthy(x: FloatArray) -> list[Row]:
    time = np.arange(x.shape[1]) / FS
    x1, y1, x2, y2 = x
    settled = x1[time > 0.5]
    away = np.abs(x1 - settled.mean())
    frequency, power = power_spectrum(x)
    band, wide = (frequency >= 100) & (frequency <= 250), (frequency >= 20) & (frequency <= 2000)
    shares = power[:, band].sum(axis=1) / power[:, wide].sum(axis=1)
    both = (frequency >= 20) & (frequency <= 1000)
    logs = np.log(power[:, both])
    rows: list[Row] = [
        ("H1", "x1 settles at 5", float(settled.mean()), (4, 6)),
        ("H2", "x1 peaks first at 10", float(x1[time < 0.05].max()), (8.5, 11.5)),
        (
            "H3",
            "x1 has decayed after 0.05 s",
            float(away[(time >= 0.05) & (time < 0.1)].max() / away[time < 0.05].max()),
            (0, 0.30),
        ),
        ("H4", "x2 peaks first at 10", float(x2[time < 0.05].max()), (8, 11.5)),
        ("H5", "x2 settles at 5", float(x2[time > 0.5].mean()), (4, 6)),
        ("H6", "y1 is about 1", float(np.abs(y1).max()), (0.6, 2)),
        ("H7", "y2 is at most 1.3", float(np.abs(y2).max()), (0.9, 1.7)),
        ("H8", "y2 is at least 0.5", float(np.abs(y2[(time >= 0.003) & (time <= 0.05)]).min()), (0.2, 0.8)),
        ("H9", "x1 is not modulated", float(settled.std() / settled.mean()), (0, 0.02)),
        ("H10", "energy of x1 lies at 100-250 Hz", float(shares[0]), (0.6, 1)),
        ("H11", "energy of x2 lies at 100-250 Hz", float(shares[2]), (0.6, 1)),
        ("H12", "the spectrum of x2 mirrors that of x1", float(np.corrcoef(logs[0], logs[2])[0, 1]), (0.9, 1)),
    ]
    for name, spectrum in zip(CHANNELS, power, strict=True):
        rows.append((f"H13.{name}", f"{name} has no sharp peaks", _sharpest(frequency, spectrum), (0, 10)))
    for key, name, spectrum in (("H14", "y2", power[3]), ("H15", "y1", power[1])):
        rows.append((key, f"{name} is centred on 230 Hz", float(frequency[np.argmax(spectrum)]), (205, 255)))
    return rows


def _sharpest(frequency: FloatArray, power: FloatArray) -> float:
    """Highest rise over the running median of 25 bins, of the bins within 30 dB of the maximum between 20 and 2000 Hz [dB]."""
    level = 10 * np.log10(power[(frequency >= 20) & (frequency <= 2000)])
    floor = np.median(np.lib.stride_tricks.sliding_window_view(np.pad(level, 12, mode="edge"), 25), axis=1)
    return float((level - floor)[level > level.max() - 30].max())


def _cracked(made: Run) -> list[Row]:
    time = np.arange(made.cracked.shape[1]) / FS
    x = made.cracked[:, time >= LATE]
    x1, y1, x2, y2 = x
    half = x.shape[1] // 2
    frequency, power = power_spectrum(x)
    rows: list[Row] = [
        ("C1", "the crack raises the vibration", float(x1.std() / made.healthy[0, time > 0.5].std()), (10, math.inf)),
        ("C2", "the vibration is sustained", float(x1[half:].std() / x1[:half].std()), (0.75, 1.3)),
        ("C3", "x1 reaches 13", float(x1.max()), (11, 15)),
        ("C4", "x1 falls to 0", float(x1.min()), (-1.5, 1.5)),
        ("C5", "y1 reaches 5", float(y1.max()), (4, 6)),
        ("C6", "y1 falls to -5", float(y1.min()), (-6, -4)),
        ("C7", "x2 is 5 on average", float(x2.mean()), (4, 6)),
        ("C8", "y2 reaches 4", float(np.abs(y2).max()), (3, 5)),
        ("C9", "y1 beats", _envelope_variation(y1), (0.25, math.inf)),
    ]
    frequency, tapered = power_spectrum(x, "hann")
    lines = [_lines(frequency, spectrum) for spectrum in tapered]
    high = [f for f, below, _ in lines[0] if 600 <= f <= 800 and below > -20]
    rows.append(("C10", "x1 has several sharp peaks at 600-800 Hz", float(len(high)), (3, math.inf)))
    for name, spectrum in zip(CHANNELS, power, strict=True):
        ratio = _top(frequency, spectrum, 600, 800) / _top(frequency, spectrum, 20, 600)
        rows.append((f"C11.{name}", f"{name} is strong at 600-800 Hz", float(10 * np.log10(ratio)), (-10, math.inf)))
    for name, spectrum in (("y1", power[1]), ("y2", power[3])):
        inside = (frequency >= 500) & (frequency <= 1000)
        rows.append(
            (
                f"C12.{name}",
                f"{name} peaks at 740 Hz",
                float(frequency[inside][np.argmax(spectrum[inside])]),
                (725, 755),
            )
        )
    for target, width in ((50, 6), (200, 8), (300, 8)):
        near = [rise for f, _, rise in lines[0] if abs(f - target) <= width]
        rows.append((f"C13.{target}", f"x1 has a line near {target} Hz", max(near, default=0.0), (6, math.inf)))
    low = [f for f, _, _ in lines[3] if f < 300]
    rows.append(("C14", "y2 has harmonic lines below 300 Hz", float(len(low)), (3, math.inf)))
    return rows


def _envelope_variation(x: FloatArray) -> float:
    envelope = np.abs(hilbert(x - x.mean()))
    return float(envelope.std() / envelope.mean())


def _top(frequency: FloatArray, power: FloatArray, low: float, high: float) -> float:
    return float(power[(frequency >= low) & (frequency <= high)].max())


def _lines(frequency: FloatArray, power: FloatArray) -> list[tuple[float, float, float]]:
    """Lines above 20 Hz and within 30 dB of the highest: frequency [Hz], level below the highest [dB], prominence [dB] of 10 and more."""
    level = 10 * np.log10(power[frequency >= 20] + 1e-30)
    peaks, found = find_peaks(level, height=level.max() - 30, prominence=10, wlen=61)
    columns = (frequency[frequency >= 20][peaks], level[peaks] - level.max(), found["prominences"])
    return [(float(f), float(below), float(rise)) for f, below, rise in zip(*columns, strict=True)]


def span(accept: tuple[float, float]) -> str:
    """Accepted range in words."""
    low, high = accept
    return f"over {low:g}" if high == float("inf") else f"{low:g} to {high:g}"


def reproduced(folder: Path) -> list[Finding]:
    """Statements measured with every preset; the figures and ``findings.json`` go into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for name, preset in PRESETS.items():
        made = run(preset)
        found += findings(name, made)
        for figure, title, state, spectral in FIGURES:
            drawn = draw_figure(made, state, spectral, f"{title}, preset {name}")
            write_durably(picture(drawn, "png"), folder / f"{name}-{figure}.png")
    write_text_durably(json_text({"findings": [finding._asdict() for finding in found]}), folder / "findings.json")
    return found
