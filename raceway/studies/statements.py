"""The statements of the seed paper, each measured on a run of one preset and compared with its accepted range."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from features.report.pictures import picture
from gen.corpus import make_result_folder, write_durably, write_numbers
from gen.support.errors import SimulationError
from raceway.console.show import plain
from raceway.studies.experiments import experiment, in_words
from raceway.studies.measures import (
    asymmetry,
    count_lines,
    decay,
    envelope_variation,
    highest,
    lines,
    sharpest,
    similarity,
    unrest,
)
from raceway.studies.paper import CHANNELS, FS, PRESETS, FloatArray, Preset, Run, draw_figures, power_spectrum, run
from raceway.studies.schematics import draw_schematics

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
    change: dict[str, float]
    """Constants of the preset with which it holds; empty if it holds without a change."""
    fitted: bool
    """Whether the constants of the presets were chosen to meet this statement."""

    @property
    def reason(self) -> str:
        """Why it does not hold, and the change with which it does."""
        made = experiment(self.preset, self.id)
        return "" if self.holds or made is None else f"{made.why} ({in_words(made)})"


def findings(name: str, made: Run) -> list[Finding]:
    """All statements of the paper, measured on a run of the preset ``name``."""
    rows = []
    for key, text, value, accept in (*_healthy(made.healthy), *_cracked(made)):
        holds = accept[0] <= value <= accept[1]
        tried = None if holds else experiment(name, key)
        why, change = (tried.why, dict(tried.change)) if tried else ("", {})
        rows.append(Finding(key, name, text, value, accept, holds, why, change, key not in _MEASURED_LATER))
    return rows


_MEASURED_LATER = (
    *(f"{key}.{name}" for key in ("H3", "H9", "C1", "C15") for name in ("y1", "x2", "y2")),
    *("C9.x1", "C9.x2", "C9.y2", "H12.y", "C17.x", "C17.y", "C18"),
    *(f"C16.{name}" for name in ("x1", "y1", "x2", "y2")),
)
"""Statements that the search for the presets did not use: they test the fit."""

Row = tuple[str, str, float, tuple[float, float]]


def _healthy(x: FloatArray) -> list[Row]:
    time = np.arange(x.shape[1]) / FS
    x1, y1, x2, y2 = x
    settled = x[:, time > 0.5]
    frequency, power = power_spectrum(x)
    band, wide = (frequency >= 100) & (frequency <= 250), (frequency >= 20) & (frequency <= 2000)
    shares = power[:, band].sum(axis=1) / power[:, wide].sum(axis=1)
    rows: list[Row] = [
        ("H1", "x1 settles at 5", float(settled[0].mean()), (4, 6)),
        ("H2", "x1 peaks first at 10", float(x1[time < LATE].max()), (8.5, 11.5)),
        ("H3", "x1 has decayed after 0.05 s", decay(time, x1), (0, 0.30)),
        ("H4", "x2 peaks first at 10", float(x2[time < LATE].max()), (8, 11.5)),
        ("H5", "x2 settles at 5", float(settled[2].mean()), (4, 6)),
        ("H6", "y1 is about 1", float(np.abs(y1).max()), (0.6, 2)),
        ("H7", "y2 is at most 1.3", float(np.abs(y2).max()), (0.9, 1.7)),
        ("H8", "y2 is at least 0.5", float(np.abs(y2[(time >= 0.003) & (time <= 0.05)]).min()), (0.2, 0.8)),
        ("H9", "x1 is not modulated", unrest(settled[0]), (0, 0.02)),
        ("H10", "energy of x1 lies at 100-250 Hz", float(shares[0]), (0.6, 1)),
        ("H11", "energy of x2 lies at 100-250 Hz", float(shares[2]), (0.6, 1)),
        ("H12", "the spectrum of x2 mirrors that of x1", similarity(frequency, power[0], power[2]), (0.9, 1)),
    ]
    for name, spectrum in zip(CHANNELS, power, strict=True):
        rows.append((f"H13.{name}", f"{name} has no sharp peaks", sharpest(frequency, spectrum), (0, 10)))
    for key, name, spectrum in (("H14", "y2", power[3]), ("H15", "y1", power[1])):
        rows.append((key, f"{name} is centred on 230 Hz", highest(frequency, spectrum, 1, FS / 2)[0], (205, 255)))
    for name, displacement, late in zip(CHANNELS[1:], x[1:], settled[1:], strict=True):
        rows.append((f"H3.{name}", f"{name} has decayed after 0.05 s", decay(time, displacement), (0, 0.30)))
        rows.append((f"H9.{name}", f"{name} is not modulated", unrest(late), (0, 0.02)))
    rows.append(("H12.y", "the spectrum of y2 mirrors that of y1", similarity(frequency, power[1], power[3]), (0.9, 1)))
    return rows


def _cracked(made: Run) -> list[Row]:
    time = np.arange(made.cracked.shape[1]) / FS
    x = made.cracked[:, time >= LATE]
    x1, y1, x2, y2 = x
    half = x.shape[1] // 2
    raised = x.std(axis=1) / made.healthy[:, time > 0.5].std(axis=1)
    rows: list[Row] = [
        ("C1", "the crack raises the vibration of x1", float(raised[0]), (10, math.inf)),
        ("C2", "the vibration is sustained", float(x1[half:].std() / x1[:half].std()), (0.75, 1.3)),
        ("C3", "x1 reaches 13", float(x1.max()), (11, 15)),
        ("C4", "x1 falls to 0", float(x1.min()), (-1.5, 1.5)),
        ("C5", "y1 reaches 5", float(y1.max()), (4, 6)),
        ("C6", "y1 falls to -5", float(y1.min()), (-6, -4)),
        ("C7", "x2 is 5 on average", float(x2.mean()), (4, 6)),
        ("C8", "y2 reaches 4", float(np.abs(y2).max()), (3, 5)),
        ("C9", "y1 beats", envelope_variation(y1), (0.25, math.inf)),
        *_crack_spectra(x),
    ]
    swings = np.ptp(x, axis=1) / np.ptp(made.healthy, axis=1)
    for name, ratio, swing in list(zip(CHANNELS, raised, swings, strict=True))[1:]:
        rows.append((f"C1.{name}", f"the crack raises the vibration of {name}", float(ratio), (10, math.inf)))
        rows.append((f"C15.{name}", f"{name} swings wider than when healthy", float(swing), (1, math.inf)))
    for name, displacement in (("x1", x1), ("x2", x2), ("y2", y2)):
        rows.append((f"C9.{name}", f"{name} beats", envelope_variation(displacement), (0.25, math.inf)))
    rows.append(("C18", "the bursts of x2 are asymmetric", asymmetry(x2), (1.2, math.inf)))
    return rows


def _crack_spectra(x: FloatArray) -> list[Row]:
    frequency, power = power_spectrum(x)
    _, tapered = power_spectrum(x, "hann")
    lines_of = dict(zip(CHANNELS, (lines(frequency, spectrum) for spectrum in tapered), strict=True))
    rows: list[Row] = [
        ("C10", "x1 has several sharp peaks at 600-800 Hz", count_lines(lines_of["x1"], 600, 800), (3, math.inf))
    ]
    for name, spectrum in zip(CHANNELS, power, strict=True):
        ratio = highest(frequency, spectrum, 600, 800)[1] / highest(frequency, spectrum, 20, 600)[1]
        rows.append((f"C11.{name}", f"{name} is strong at 600-800 Hz", float(10 * np.log10(ratio)), (-10, math.inf)))
    for name, spectrum in (("y1", power[1]), ("y2", power[3])):
        rows.append((f"C12.{name}", f"{name} peaks at 740 Hz", highest(frequency, spectrum, 500, 1000)[0], (725, 755)))
    for target, width in ((50, 6), (200, 8), (300, 8)):
        near = [rise for f, _, rise in lines_of["x1"] if abs(f - target) <= width]
        rows.append((f"C13.{target}", f"x1 has a line near {target} Hz", max(near, default=0.0), (6, math.inf)))
    low = sum(f < 300 for f, _, _ in lines_of["y2"])
    rows.append(("C14", "y2 has harmonic lines below 300 Hz", float(low), (3, math.inf)))
    for name in CHANNELS:
        cluster = count_lines(lines_of[name], 650, 800)
        rows.append((f"C16.{name}", f"{name} has a cluster of lines at 650-800 Hz", cluster, (3, math.inf)))
    for axis, shaft, housing in (("x", 0, 2), ("y", 1, 3)):
        alike = similarity(frequency, tapered[shaft], tapered[housing])
        rows.append((f"C17.{axis}", f"the spectrum of {axis}2 mirrors that of {axis}1", alike, (0.9, 1)))
    return rows


def span(accept: tuple[float, float]) -> str:
    """Accepted range in words."""
    low, high = accept
    return f"at least {low:g}" if high == float("inf") else f"{low:g} to {high:g}"


def reproduce(folder: Path, presets: Mapping[str, Preset] = PRESETS) -> list[Finding]:
    """Statements measured with every preset; the figures and ``findings.json`` go into ``folder``.

    Raises
    ------
    SimulationError
        If a system leaves the finite range.
    """
    make_result_folder(folder)
    measured = []
    for name, preset in presets.items():
        made = run(preset)
        if not (np.isfinite(made.healthy).all() and np.isfinite(made.cracked).all()):
            raise SimulationError(f"{name}: the displacements grow without limit; change its constants less.")
        measured += findings(name, made)
        for figure, drawn in (*draw_schematics(preset), *draw_figures(made)):
            write_durably(picture(drawn, "png"), folder / f"{name}-{figure}.png")
    write_numbers(plain({"findings": [finding._asdict() for finding in measured]}), folder / "findings.json")
    return measured
