"""The statements of the seed paper, in our words, measured on a run of a preset and compared with accepted ranges."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from gen.support.errors import SimulationError
from studies.ophel2025.experiments import experiment, in_words
from studies.ophel2025.measures import (
    asymmetry,
    count_lines,
    decay,
    highest,
    lines,
    modulation,
    oscillations,
    sharpest,
    similarity,
    steadiness,
    unrest,
)
from studies.ophel2025.paper import CHANNELS, FS, FloatArray, Run, power_spectrum

LATE = 0.05  # s, the start, in which x1 oscillates rapidly
IN_MM = "read in mm, not in m (E15)"
UNSIGNED = f"{IN_MM}, and without its sign, because the direction of the load is contradictory (E17)"
SYSTEM = "abstract, VII"
ANY = math.inf


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
    elsewhere: str = ""
    """Where the paper says it, if not in the text about the panel of its channel."""

    @property
    def place(self) -> str:
        """Section and figure of the paper in which the statement is made."""
        number, panel = self.figure[-1], "abcd"[CHANNELS.index(self.channel)]
        return self.elsewhere or f"{'V' if number in '34' else 'VI'}, Fig. {number}({panel})"


STATEMENTS: Mapping[str, Statement] = {
    "H1": Statement("figure3", "x1", "x1 settles at 5", (4, 6), (5,), IN_MM),
    "H2": Statement(
        "figure3",
        "x1",
        "x1 peaks first at 10",
        (8.5, 11.5),
        (1,),
        f"{IN_MM}; 1 is printed, below the 5 at which x1 settles; 10 as for x2 (E16)",
    ),
    # 5 to 12.5 oscillations at 100-250 Hz, as Fig. 5(a) has them; of a gradual decay at least a twentieth is left to be seen
    "H3.rapid": Statement("figure3", "x1", "x1 oscillates rapidly in the first 0.05 s", (5, 12.5)),
    "H3.decay": Statement("figure3", "x1", "x1 then decays gradually", (0.05, 0.5)),
    "H16": Statement("figure3", "x2", "the decay of x2 is smooth", (0.9, 1)),
    "H4": Statement("figure3", "x2", "x2 peaks first at 10", (8, 11.5), (10,), IN_MM),
    "H5": Statement("figure3", "x2", "x2 settles at 5", (4, 6), (5,), IN_MM),
    "H6": Statement("figure3", "y1", "y1 is about 1", (0.6, 2), (1,), UNSIGNED),
    "H7": Statement("figure3", "y2", "y2 is at most 1.3", (0.9, 1.7), (1.3,), UNSIGNED, "V, on Fig. 3(b) for 3(d)"),
    "H8": Statement("figure3", "y2", "y2 is at least 0.5", (0.2, 0.8), (0.5,), UNSIGNED, "V, on Fig. 3(b) for 3(d)"),
    "H9": Statement("figure3", "y2", "y2 and the whole system are not modulated", (0, 0.02)),
    "H10": Statement("figure5", "x1", "energy of x1 lies at 100-250 Hz", (0.6, 1), (100, 250)),
    "H11": Statement("figure5", "x2", "energy of x2 lies at 100-230 Hz", (0.6, 1), (100, 230)),
    "H12": Statement("figure5", "x2", "the spectrum of x2 mirrors that of x1", (0.9, 1)),
    "H12.y": Statement("figure5", "y2", "the spectrum of y2 is like that of y1", (0.9, 1)),
    "H13.x1": Statement("figure5", "x1", "x1 has no sharp peaks", (0, 10)),
    "H13.y1": Statement("figure5", "y1", "y1 has no sharp peaks", (0, 10), elsewhere=SYSTEM),
    "H13.x2": Statement("figure5", "x2", "x2 has no sharp peaks", (0, 10)),
    "H13.y2": Statement("figure5", "y2", "y2 has no sharp peaks", (0, 10), elsewhere=SYSTEM),
    "H14": Statement("figure5", "y2", "y2 is centred on 230 Hz", (205, 255), (230,)),
    "H15": Statement("figure5", "y1", "y1 is centred on 230 Hz", (205, 255), (230,), elsewhere="VI, Fig. 5(d)"),
    "C1": Statement("figure4", "x1", "the crack raises the vibration of x1", (10, ANY), elsewhere=SYSTEM),
    "C1.y1": Statement("figure4", "y1", "the crack raises the vibration of y1", (10, ANY), elsewhere=SYSTEM),
    "C1.x2": Statement("figure4", "x2", "the crack raises the vibration of x2", (10, ANY), elsewhere=SYSTEM),
    "C1.y2": Statement("figure4", "y2", "the crack raises the vibration of y2", (10, ANY)),
    "C2": Statement("figure4", "y1", "the vibration of y1 is sustained", (0.75, 1.3)),
    "C3": Statement("figure4", "x1", "x1 reaches 13", (11, 15), (13,), IN_MM),
    "C4": Statement("figure4", "x1", "x1 falls to 0", (-1.5, 1.5), (0,), IN_MM),
    "C5": Statement("figure4", "y1", "y1 reaches 5", (4, 6), (5,), IN_MM),
    "C6": Statement("figure4", "y1", "y1 falls to -5", (-6, -4), (-5,), IN_MM),
    "C7": Statement("figure4", "x2", "x2 is 5 on average", (4, 6), (5,), IN_MM),
    "C8": Statement("figure4", "y2", "y2 reaches 4", (3, 5), (4,), UNSIGNED),
    "C9": Statement("figure4", "y1", "y1 is modulated and may beat", (0.15, ANY)),
    "C9.x1": Statement("figure4", "x1", "x1 is modulated, intermittently", (0.15, ANY)),
    "C9.x2": Statement("figure4", "x2", "the amplitude of x2 comes in bursts", (0.15, ANY)),
    "C9.y2": Statement("figure4", "y2", "y2 is modulated", (0.15, ANY)),
    "C10": Statement("figure6", "x1", "x1 has several sharp peaks at 600-800 Hz", (3, ANY), (600, 800)),
    "C11.x1": Statement(
        "figure6", "x1", "x1 is strong at 600-800 Hz", (-10, ANY), (600, 800), elsewhere="abstract; VI, Fig. 6(a)"
    ),
    "C11.y1": Statement("figure6", "y1", "y1 is strong at 650-800 Hz", (-10, ANY), (650, 800)),
    "C11.x2": Statement("figure6", "x2", "x2 is strong at 650-800 Hz", (-10, ANY), (650, 800)),
    "C11.y2": Statement("figure6", "y2", "y2 is strong near 740 Hz", (-10, ANY), (740,)),
    "C12.y1": Statement("figure6", "y1", "y1 peaks at 740 Hz", (725, 755), (740,)),
    "C12.y2": Statement("figure6", "y2", "the power of y2 is concentrated near 740 Hz", (725, 755), (740,)),
    **{
        f"C13.{line}": Statement("figure6", "x1", f"x1 has a line near {line} Hz", (6, ANY), (line,))
        for line in (50, 200, 300)
    },
    "C14": Statement("figure6", "y2", "y2 has harmonic lines below 300 Hz", (3, ANY), (0, 300)),
    "C15.y1": Statement(
        "figure4", "y1", "y1 swings wider than when healthy", (1, ANY), elsewhere="V, Fig. 3(b) and 4(b)"
    ),
    "C15.y2": Statement("figure4", "y2", "y2 swings wider than when healthy", (1, ANY)),
    "C16.y1": Statement("figure6", "y1", "the energy of y1 at 650-800 Hz is a cluster", (3, ANY), (650, 800)),
    "C16.x2": Statement("figure6", "x2", "the energy of x2 at 650-800 Hz is in several lines", (3, ANY), (650, 800)),
    "C17.x": Statement("figure6", "x2", "the spectrum of x2 is like that of x1", (0.9, 1)),
    "C18": Statement("figure4", "x2", "the oscillations of x2 are asymmetric", (1.2, ANY)),
    "C19": Statement("figure4", "x1", "x1 is damped less than when healthy", (1, ANY)),
    "C20": Statement("figure4", "x2", "the oscillations of x2 decay", (0, 0.9)),
}

_MEASURED_LATER = (
    *("H3.rapid", "H12.y", "H16", "C1.y1", "C1.x2", "C1.y2", "C2", "C9.x1", "C9.x2", "C9.y2"),
    *("C15.y1", "C15.y2", "C16.y1", "C16.x2", "C17.x", "C18", "C19", "C20"),
)
"""Statements that the search for the presets did not use in any form: they test the fit."""


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
        amendment = experiment(self.preset, self.id)
        return "" if self.holds or amendment is None else f"{amendment.why} ({in_words(amendment)})"

    def facts(self) -> dict[str, object]:
        """All fields, those of the statement among them."""
        facts = self._asdict() | self.statement._asdict() | {"place": self.statement.place}
        return {name: fact for name, fact in facts.items() if name not in ("statement", "elsewhere")}


def findings(name: str, run: Run) -> list[Finding]:
    """All statements of the paper, measured on a run of the preset ``name``.

    Raises
    ------
    SimulationError
        If the system left the finite range.
    """
    if not (np.isfinite(run.healthy).all() and np.isfinite(run.cracked).all()):
        raise SimulationError(f"{name}: the displacements grow without limit; change its constants less.")
    values, rows = _healthy(run.healthy) | _cracked(run), []
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
        "H3.rapid": oscillations(time, x1),
        "H3.decay": decay(time, x1),
        "H16": steadiness(time, x2),
        "H4": float(x2[time < LATE].max()),
        "H5": float(settled[2].mean()),
        "H6": float(np.abs(y1).max()),
        "H7": float(np.abs(y2).max()),
        "H8": float(np.abs(y2[(time >= 0.003) & (time <= 0.05)]).min()),
        "H9": max(unrest(displacement) for displacement in settled),
        "H10": _share(frequency, power[0], "H10"),
        "H11": _share(frequency, power[2], "H11"),
        "H12": similarity(frequency, power[0], power[2]),
        "H12.y": similarity(frequency, power[1], power[3]),
        "H14": highest(frequency, power[3], 1, FS / 2)[0],
        "H15": highest(frequency, power[1], 1, FS / 2)[0],
    }
    for name, spectrum in zip(CHANNELS, power, strict=True):
        values[f"H13.{name}"] = sharpest(frequency, spectrum)
    return values


def _share(frequency: FloatArray, power: FloatArray, statement: str) -> float:
    """Share of the power at 20-2000 Hz that lies in the printed band of a statement."""
    low, high = STATEMENTS[statement].printed
    band, wide = (frequency >= low) & (frequency <= high), (frequency >= 20) & (frequency <= 2000)
    return float(power[band].sum() / power[wide].sum())


def _cracked(run: Run) -> dict[str, float]:
    time = np.arange(run.cracked.shape[1]) / FS
    x = run.cracked[:, time >= LATE]
    x1, y1, x2, y2 = x
    half = x.shape[1] // 2
    raised = x.std(axis=1) / run.healthy[:, time > 0.5].std(axis=1)
    swings = np.ptp(x, axis=1) / np.ptp(run.healthy, axis=1)
    values = {
        "C1": float(raised[0]),
        "C2": float(y1[half:].std() / y1[:half].std()),
        "C3": float(x1.max()),
        "C4": float(x1.min()),
        "C5": float(y1.max()),
        "C6": float(y1.min()),
        "C7": float(x2.mean()),
        "C8": float(np.abs(y2).max()),
        "C9": modulation(y1, FS / run.shaft_rate),
        "C18": asymmetry(x2),
        "C19": decay(time, run.cracked[0]) / decay(time, run.healthy[0]),
        "C20": float(x2[-len(x2) // 5 :].std() / run.cracked[2][time < LATE].std()),
    }
    for name, displacement, ratio, swing in zip(CHANNELS, x, raised, swings, strict=True):
        values[f"C1.{name}"], values[f"C15.{name}"] = float(ratio), float(swing)
        values[f"C9.{name}"] = modulation(displacement, FS / run.shaft_rate)
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
        low, high = STATEMENTS["C12.y2"].accept if name == "y2" else STATEMENTS[f"C11.{name}"].printed
        ratio = highest(frequency, spectrum, low, high)[1] / highest(frequency, spectrum, 20, 600)[1]
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
