"""What is diagnosed, and the diagnosis: a recording, and the answer with all that it rests on."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from features.table.indicators import Orders
from gen.support.display import Shown
from gen.support.units import from_si
from raceway.diagnosis.evidence import Line
from raceway.diagnosis.levels import Levels
from raceway.diagnosis.search import Given, Pair
from raceway.diagnosis.spectrum import BandSpectrum
from raceway.diagnosis.wording import candidates


@dataclass(frozen=True, repr=False)
class Diagnosis(Shown):
    """A diagnosis.

    Attributes
    ----------
    verdict
        A class of the model, "damaged" for a fault whose part is not known, or "unsure".
    probabilities
        Of each class that the model can predict, combined over windows and channels; all equal if there is no prediction.
    threshold
        The least probability that is answered; NaN if there is no prediction.
    given
        Bearings and speeds as given.
    bearing, orders, shaft_rate
        Name, nominal orders and shaft rate [Hz] that the evidence refers to.
    evidence
        Lines that stand above the floor, strongest family first.
    explanations
        Pairs of bearing and speed within those given that explain the lines, the one of the evidence first.
    elsewhere
        Other pairs, which explain a strong comb that the given ones do not explain.
    sentence
        The verdict with its reason.
    advice
        How to get a surer answer, one sentence each; empty if there is no advice.
    warnings
        Reasons to read the diagnosis with care, one sentence each.
    windows
        Number of windows that the classifier used.
    missed
        Share of faulty recordings of the nearest length that was measured that were called healthy; NaN unless the verdict
        is healthy and the model is the reference model, for which it was measured.
    levels
        Of each channel of the recording, then of the healthy ones.
    spectrum
        Envelope spectrum of the band with the highest evidence, or of the most impulsive band; None for a useless signal.
    """

    verdict: str
    probabilities: Mapping[str, float]
    threshold: float
    given: Given
    bearing: str
    orders: Orders
    shaft_rate: float
    evidence: tuple[Line, ...]
    sentence: str
    advice: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    explanations: tuple[Pair, ...] = ()
    elsewhere: tuple[Pair, ...] = ()
    windows: int = 0
    missed: float = np.nan
    levels: tuple[Levels, ...] = ()
    spectrum: BandSpectrum | None = field(default=None, compare=False)

    def _heading(self) -> str:
        return f"Diagnosis: {self.verdict}"

    def _facts(self) -> Mapping[str, object]:
        lines = [f"{line.name} at {line.frequency:.4g} Hz, {line.level:.0f} dB" for line in self.evidence]
        return {
            "why": self.sentence,
            "probabilities": candidates(self.probabilities),
            "bearing": self.bearing,
            "speed": f"{from_si(self.shaft_rate, 'rpm'):,.4g} rpm",
            "lines": "; ".join(lines),
            "advice": " ".join(self.advice),
            "warnings": " ".join(self.warnings),
        }
