"""The statements of the seed paper, in our words, measured on a run of a preset and compared with accepted ranges."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from gen.support.errors import SimulationError
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
from raceway.studies.paper import CHANNELS, FS, FloatArray, Run, power_spectrum

LATE = 0.05  # s, after which the start has decayed
UNSIGNED = "compared without its sign, because the direction of the load is contradictory (E17)"


class Statement(NamedTuple):
    """A statement of the paper on a channel of one figure; displacements in micrometres, frequencies in hertz."""

    figure: str
    channel: str
    finding: str
    accept: tuple[float, float]
    printed: tuple[float, ...] = ()
    """The value that the paper prints, or the edges of the band."""
    amended: str = ""
    """What is changed in the statement, and why; empty if it is measured as printed."""


def _each(
    key: str,
    channels: str,
    figure: str,
    text: str,
    accept: tuple[float, float],
    printed: tuple[float, ...] = (),
) -> dict[str, Statement]:
    """The same statement on several channels."""
    return {f"{key}.{name}": Statement(figure, name, text.format(name), accept, printed) for name in channels.split()}


ANY = math.inf
STATEMENTS: Mapping[str, Statement] = {
    "H1": Statement("figure3", "x1", "x1 settles at 5", (4, 6), (5,)),
    "H2": Statement(
        "figure3",
        "x1",
        "x1 peaks first at 10",
        (8.5, 11.5),
        (1,),
        "1 is printed, below the 5 at which x1 settles; 10 as for x2 (E16)",
    ),
    "H3": Statement("figure3", "x1", "x1 has decayed after 0.05 s", (0, 0.30)),
    **_each("H3", "y1 x2 y2", "figure3", "{} has decayed after 0.05 s", (0, 0.30)),
    "H4": Statement("figure3", "x2", "x2 peaks first at 10", (8, 11.5), (10,)),
    "H5": Statement("figure3", "x2", "x2 settles at 5", (4, 6), (5,)),
    "H6": Statement("figure3", "y1", "y1 is about 1", (0.6, 2), (1,), UNSIGNED),
    "H7": Statement("figure3", "y2", "y2 is at most 1.3", (0.9, 1.7), (1.3,), UNSIGNED),
    "H8": Statement("figure3", "y2", "y2 is at least 0.5", (0.2, 0.8), (0.5,), UNSIGNED),
    "H9": Statement("figure3", "x1", "x1 is not modulated", (0, 0.02)),
    **_each("H9", "y1 x2 y2", "figure3", "{} is not modulated", (0, 0.02)),
    "H10": Statement("figure5", "x1", "energy of x1 lies at 100-250 Hz", (0.6, 1), (100, 250)),
    "H11": Statement("figure5", "x2", "energy of x2 lies at 100-230 Hz", (0.6, 1), (100, 230)),
    "H12": Statement("figure5", "x2", "the spectrum of x2 mirrors that of x1", (0.9, 1)),
    "H12.y": Statement("figure5", "y2", "the spectrum of y2 mirrors that of y1", (0.9, 1)),
    **_each("H13", "x1 y1 x2 y2", "figure5", "{} has no sharp peaks", (0, 10)),
    "H14": Statement("figure5", "y2", "y2 is centred on 230 Hz", (205, 255), (230,)),
    "H15": Statement("figure5", "y1", "y1 is centred on 230 Hz", (205, 255), (230,)),
    "C1": Statement("figure4", "x1", "the crack raises the vibration of x1", (10, ANY)),
    **_each("C1", "y1 x2 y2", "figure4", "the crack raises the vibration of {}", (10, ANY)),
    "C2": Statement("figure4", "x1", "the vibration is sustained", (0.75, 1.3)),
    "C3": Statement("figure4", "x1", "x1 reaches 13", (11, 15), (13,)),
    "C4": Statement("figure4", "x1", "x1 falls to 0", (-1.5, 1.5), (0,)),
    "C5": Statement("figure4", "y1", "y1 reaches 5", (4, 6), (5,)),
    "C6": Statement("figure4", "y1", "y1 falls to -5", (-6, -4), (-5,)),
    "C7": Statement("figure4", "x2", "x2 is 5 on average", (4, 6), (5,)),
    "C8": Statement("figure4", "y2", "y2 reaches 4", (3, 5), (4,), UNSIGNED),
    "C9": Statement("figure4", "y1", "y1 beats", (0.25, ANY)),
    **_each("C9", "x1 x2 y2", "figure4", "{} beats", (0.25, ANY)),
    "C10": Statement("figure6", "x1", "x1 has several sharp peaks at 600-800 Hz", (3, ANY), (600, 800)),
    **_each("C11", "x1 y1 x2 y2", "figure6", "{} is strong at 600-800 Hz", (-10, ANY), (600, 800)),
    **_each("C12", "y1 y2", "figure6", "{} peaks at 740 Hz", (725, 755), (740,)),
    **{
        f"C13.{line}": Statement("figure6", "x1", f"x1 has a line near {line} Hz", (6, ANY), (line,))
        for line in (50, 200, 300)
    },
    "C14": Statement("figure6", "y2", "y2 has harmonic lines below 300 Hz", (3, ANY), (0, 300)),
    **_each("C15", "y1 y2", "figure4", "{} swings wider than when healthy", (1, ANY)),
    **_each("C16", "y1 x2", "figure6", "{} has a cluster of lines at 650-800 Hz", (3, ANY), (650, 800)),
    "C17.x": Statement("figure6", "x2", "the spectrum of x2 mirrors that of x1", (0.9, 1)),
    "C18": Statement("figure4", "x2", "the bursts of x2 are asymmetric", (1.2, ANY)),
}

_MEASURED_LATER = (
    *(f"{key}.{name}" for key in ("H3", "H9", "C1") for name in ("y1", "x2", "y2")),
    *("C9.x1", "C9.x2", "C9.y2", "H12.y", "C15.y1", "C15.y2", "C16.y1", "C16.x2", "C17.x", "C18"),
)
"""Statements that the search for the presets did not use: they test the fit."""


class Finding(NamedTuple):
    """A statement of the paper, measured."""

    id: str
    preset: str
    statement: Statement
    value: float
    holds: bool
    why: str
    """Why the statement does not hold, as a clause; empty if it holds."""
    change: dict[str, float]
    """Constants of the preset with which it holds; empty if it holds without a change."""
    fitted: bool
    """Whether the constants of the presets were chosen to meet this statement."""

    @property
    def text(self) -> str:
        """The value in words."""
        return f"{self.value:,.0f}" if self.value > 1000 else f"{self.value:.{3 + (abs(self.value) > 1)}g}"

    @property
    def reason(self) -> str:
        """Why it does not hold, and the change with which it does."""
        made = experiment(self.preset, self.id)
        return "" if self.holds or made is None else f"{made.why} ({in_words(made)})"

    def facts(self) -> dict[str, object]:
        """All fields, those of the statement among them."""
        facts = self._asdict()
        return facts | facts.pop("statement")._asdict()


def findings(name: str, made: Run) -> list[Finding]:
    """All statements of the paper, measured on a run of the preset ``name``.

    Raises
    ------
    SimulationError
        If the system left the finite range.
    """
    if not (np.isfinite(made.healthy).all() and np.isfinite(made.cracked).all()):
        raise SimulationError(f"{name}: the displacements grow without limit; change its constants less.")
    values, rows = _healthy(made.healthy) | _cracked(made), []
    for key, statement in STATEMENTS.items():
        holds = statement.accept[0] <= values[key] <= statement.accept[1]
        tried = None if holds else experiment(name, key)
        why, change = (tried.why, dict(tried.change)) if tried else ("", {})
        rows.append(Finding(key, name, statement, values[key], holds, why, change, key not in _MEASURED_LATER))
    return rows


def _healthy(x: FloatArray) -> dict[str, float]:
    time = np.arange(x.shape[1]) / FS
    x1, y1, x2, y2 = x
    settled = x[:, time > 0.5]
    frequency, power = power_spectrum(x)
    values = {
        "H1": float(settled[0].mean()),
        "H2": float(x1[time < LATE].max()),
        "H3": decay(time, x1),
        "H4": float(x2[time < LATE].max()),
        "H5": float(settled[2].mean()),
        "H6": float(np.abs(y1).max()),
        "H7": float(np.abs(y2).max()),
        "H8": float(np.abs(y2[(time >= 0.003) & (time <= 0.05)]).min()),
        "H9": unrest(settled[0]),
        "H10": _share(frequency, power[0], "H10"),
        "H11": _share(frequency, power[2], "H11"),
        "H12": similarity(frequency, power[0], power[2]),
        "H12.y": similarity(frequency, power[1], power[3]),
        "H14": highest(frequency, power[3], 1, FS / 2)[0],
        "H15": highest(frequency, power[1], 1, FS / 2)[0],
    }
    for name, displacement, late, spectrum in zip(CHANNELS, x, settled, power, strict=True):
        values[f"H13.{name}"] = sharpest(frequency, spectrum)
        values[f"H3.{name}"], values[f"H9.{name}"] = decay(time, displacement), unrest(late)
    return values


def _share(frequency: FloatArray, power: FloatArray, statement: str) -> float:
    """Share of the power at 20-2000 Hz that lies in the printed band of a statement."""
    low, high = STATEMENTS[statement].printed
    band, wide = (frequency >= low) & (frequency <= high), (frequency >= 20) & (frequency <= 2000)
    return float(power[band].sum() / power[wide].sum())


def _cracked(made: Run) -> dict[str, float]:
    time = np.arange(made.cracked.shape[1]) / FS
    x = made.cracked[:, time >= LATE]
    x1, y1, x2, y2 = x
    half = x.shape[1] // 2
    raised = x.std(axis=1) / made.healthy[:, time > 0.5].std(axis=1)
    swings = np.ptp(x, axis=1) / np.ptp(made.healthy, axis=1)
    values = {
        "C1": float(raised[0]),
        "C2": float(x1[half:].std() / x1[:half].std()),
        "C3": float(x1.max()),
        "C4": float(x1.min()),
        "C5": float(y1.max()),
        "C6": float(y1.min()),
        "C7": float(x2.mean()),
        "C8": float(np.abs(y2).max()),
        "C9": envelope_variation(y1),
        "C18": asymmetry(x2),
    }
    for name, displacement, ratio, swing in zip(CHANNELS, x, raised, swings, strict=True):
        values[f"C1.{name}"], values[f"C15.{name}"] = float(ratio), float(swing)
        values[f"C9.{name}"] = envelope_variation(displacement)
    return values | _crack_spectra(x)


def _crack_spectra(x: FloatArray) -> dict[str, float]:
    frequency, power = power_spectrum(x)
    _, tapered = power_spectrum(x, "hann")
    lines_of = dict(zip(CHANNELS, (lines(frequency, spectrum) for spectrum in tapered), strict=True))
    values = {
        "C10": count_lines(lines_of["x1"], 600, 800),
        "C14": float(sum(f < 300 for f, _, _ in lines_of["y2"])),
        "C17.x": similarity(frequency, tapered[0], tapered[2]),
    }
    for name, spectrum in zip(CHANNELS, power, strict=True):
        ratio = highest(frequency, spectrum, 600, 800)[1] / highest(frequency, spectrum, 20, 600)[1]
        values[f"C11.{name}"] = float(10 * np.log10(ratio))
        values[f"C12.{name}"] = highest(frequency, spectrum, 500, 1000)[0]
        values[f"C16.{name}"] = count_lines(lines_of[name], 650, 800)
    for target, width in ((50, 6), (200, 8), (300, 8)):
        near = [rise for f, _, rise in lines_of["x1"] if abs(f - target) <= width]
        values[f"C13.{target}"] = max(near, default=0.0)
    return values


def span(accept: tuple[float, float]) -> str:
    """Accepted range in words."""
    low, high = accept
    return f"at least {low:g}" if high == float("inf") else f"{low:g} to {high:g}"
