"""One recording in, a diagnosis out: class, probabilities, and the lines that stand above the floor.

``recording -> quality -> shaft speed -> windows -> features -> prediction``, and beside it ``-> band spectra -> evidence``

The verdict is that of the classifier. It becomes "unsure" if the classifier is, if the signal tells nothing, if the
labelled speed is clearly wrong and the classifier says different classes at both speeds without a line that decides, or
if the lines plainly tell another class. Evidence is measured in the signal alone, whatever the verdict.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from features.band import Band
from features.baselines.models import Model, estimator_probabilities, predict
from features.baselines.predictions import UNSURE, Predictions, predictions
from features.baselines.references import with_energies
from features.diagnosis.evidence import Line, find_evidence, strange_series
from features.diagnosis.quality import quality_of
from features.diagnosis.spectrum import BandSpectrum, band_spectra
from features.diagnosis.wording import (
    by_family,
    candidates,
    family_in_words,
    probability_in_words,
    reasons,
    speed_in_words,
)
from features.faults import CLASSES, HEALTHY
from features.indicators import GROUPS, Orders, feature_names, indicators
from features.recording_table import recording_table, windows_of
from features.signal.rows import FloatArray
from features.signal.speed import TOLERANCE
from features.speed import shaft_speed
from gen.corpus import FAULTS, UNKNOWN_CODE
from gen.support.errors import CorpusError

if TYPE_CHECKING:
    import xarray as xr

    from features.recording_speeds import Speed

LONGEST = 60.0  # s; of a longer recording the beginning is used
# dB; lines of another class this high contradict the classifier, if they are a fundamental and a harmonic, or three harmonics
CONTRADICTING = 15.0
NEARLY_AS_HIGH = 5.0  # dB; lines of no part of the bearing are reported unless they are further below the evidence
WATCH = "The bearing shows lines of its own: record it again in some weeks and compare, or compare it with a healthy one (--healthy)."


class Recorded(NamedTuple):
    """A recording: signal [m s-2], shape (time,), sample rate and labelled shaft rate [Hz], nominal orders as numbers, and name."""

    signal: FloatArray
    fs: float
    shaft_rate: float
    orders: Orders
    name: str = "the recording"


@dataclass(frozen=True)
class Diagnosis:
    """A diagnosis.

    Attributes
    ----------
    verdict
        A class of the model, or "unsure".
    probabilities
        Of each class that the model can predict, combined over the windows; all equal if there is no prediction.
    threshold
        The least probability that is answered; NaN if there is no prediction.
    labelled_rate
        Shaft rate as given [Hz].
    shaft_rate
        Shaft rate [Hz] that the orders of the evidence refer to: the one found where the recording clearly tells another
        than the labelled one, else the labelled one.
    evidence
        Lines that stand above the floor, strongest family first.
    sentence
        The verdict with its reason.
    advice
        How to get a surer answer, one sentence each; empty if there is no advice.
    warnings
        Reasons to read the diagnosis with care, one sentence each.
    windows
        Number of windows that the classifier used.
    spectrum
        Envelope spectrum of the band with the highest evidence, or of the most impulsive band; None for a useless signal.
    """

    verdict: str
    probabilities: Mapping[str, float]
    threshold: float
    labelled_rate: float
    shaft_rate: float
    evidence: tuple[Line, ...]
    sentence: str
    advice: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    windows: int = 0
    spectrum: BandSpectrum | None = field(default=None, repr=False, compare=False)


def diagnose(
    recording: Recorded, model: Model, *, healthy: Recorded | None = None, speed: "Speed" = "check"
) -> Diagnosis:
    """Diagnose one recording.

    Parameters
    ----------
    recording
        At least 0.05 s; of more than 60 s the first 60 s are used.
    model
        A trained model.
    healthy
        A recording of the same machine with a healthy bearing, from the same sensor.
    speed
        ``check`` searches the shaft speed in the recording; if the label is clearly wrong it warns, and answers only if
        the classifier says the same class at both speeds or if lines tell that of the estimated speed. ``correct`` takes
        the estimated speed, and ``off`` believes the label.

    Raises
    ------
    CorpusError
        If a recording has values that are not finite, or the model cannot take its features or the healthy recording.
    """
    for checked in (recording, healthy):
        wrong = 0 if checked is None else int(np.count_nonzero(~np.isfinite(checked.signal)))
        if checked is not None and wrong:
            raise CorpusError(
                f"{checked.name}: {wrong:,} of {checked.signal.size:,} samples are not finite numbers; export it again."
            )
    if not set(model.groups) <= set(GROUPS) or not set(model.features) <= set(
        feature_names(model.groups, Band(*model.band))
    ):
        raise CorpusError(f"{model.name}: the model takes features that this version does not make; train it again.")
    signal, warnings = _beginning(recording)
    quality = quality_of(signal, recording.fs, recording.shaft_rate, recording.orders)
    if quality.useless:
        return _useless(recording, model, quality.useless, quality.advice)
    warnings += quality.warnings
    if healthy is not None:
        reason = quality_of(healthy.signal, healthy.fs, healthy.shaft_rate, healthy.orders).useless
        if reason:
            raise CorpusError(
                f"{healthy.name}: cannot be used as the healthy recording, since {reason}; give another, or none."
            )
    used = recording._replace(signal=signal)
    other_rate, uncertainty = _speed(used) if speed != "off" else (None, 0.0)
    rate = recording.shaft_rate if other_rate is None else other_rate
    spectra = band_spectra(signal, recording.fs, rate)
    lines = find_evidence(spectra, rate, recording.orders)
    reference = (
        None
        if healthy is None
        else _table(healthy._replace(signal=_beginning(healthy)[0]), model, FAULTS.index(HEALTHY))
    )
    predicted = _predict(used._replace(shaft_rate=rate), model, reference)
    if other_rate is not None:
        warnings.append(_speed_warning(recording.shaft_rate, other_rate, uncertainty))
        if speed == "check":
            predicted = _reconcile(predicted, _predict(used, model, reference), lines)
    diagnosis = replace(
        predicted,
        labelled_rate=recording.shaft_rate,
        shaft_rate=rate,
        evidence=tuple(lines),
        spectrum=_shown_spectrum(spectra, lines),
        warnings=tuple(warnings + _bearing_warning(spectra, lines, rate, recording.orders)),
    )
    return _put_into_words(diagnosis, other_rate, speed, len(signal) / recording.fs, healthy is not None)


def _beginning(recording: Recorded) -> tuple[FloatArray, list[str]]:
    """At most the first 60 s, and a sentence if there is more."""
    most = round(LONGEST * recording.fs)
    if len(recording.signal) <= most:
        return recording.signal, []
    duration = len(recording.signal) / recording.fs
    return recording.signal[:most], [f"Only the first {LONGEST:g} s of {duration:,.0f} s are used."]


def _useless(recording: Recorded, model: Model, reason: str, advice: str) -> Diagnosis:
    return Diagnosis(
        verdict=UNSURE,
        probabilities=dict.fromkeys(model.classes, 1 / len(model.classes)),
        threshold=np.nan,
        labelled_rate=recording.shaft_rate,
        shaft_rate=recording.shaft_rate,
        evidence=(),
        sentence=f"Unsure: {reason}; {advice}.",
        advice=(f"{advice[0].upper()}{advice[1:]}.",),
    )


def _speed(recording: Recorded) -> tuple[float | None, float]:
    """Shaft rate found, if it is clearly another than the labelled one, and its uncertainty [Hz]."""
    estimate = shaft_speed(
        windows_of(recording.signal, recording.fs), recording.fs, recording.shaft_rate, recording.orders
    )
    return (float(estimate.rate) if estimate.clear and not estimate.agrees else None), float(estimate.uncertainty)


def _table(recording: Recorded, model: Model, fault: int) -> "xr.Dataset":
    windows = windows_of(recording.signal, recording.fs)
    groups = with_energies(model.groups)
    table = recording_table(
        windows, recording.fs, recording.shaft_rate, recording.orders, fault, groups, Band(*model.band)
    )
    return table.assign_attrs(title=recording.name)


def _predict(recording: Recorded, model: Model, reference: "xr.Dataset | None") -> Diagnosis:
    """Diagnosis with the prediction of the model alone."""
    if reference is None:
        predicted = _prediction_of_windows(recording, model)
    else:
        predicted = predict(_table(recording, model, UNKNOWN_CODE), model, reference)
    whole = predicted.by_recording
    assert whole is not None  # noqa: S101 - only the predictions by recording have none
    probabilities = dict(zip(whole.classes, map(float, whole.probabilities[0]), strict=True))
    return Diagnosis(
        whole.answers[0], probabilities, whole.threshold, recording.shaft_rate, recording.shaft_rate, (), "",
        windows=len(predicted.probabilities),
    )  # fmt: skip


def _prediction_of_windows(recording: Recorded, model: Model) -> Predictions:
    """Predictions as of `predict`, without xarray, whose first use imports dask: a tenth of the time of a diagnosis."""
    from pandas import DataFrame, Index

    windows = windows_of(recording.signal, recording.fs)
    each = Orders(*(np.full(len(windows), order) for order in recording.orders))
    rates = np.full(len(windows), recording.shaft_rate)
    values, names = indicators(windows, recording.fs, rates, each, model.groups, Band(*model.band))
    columns = [names.index(name) for name in model.features]
    rows = DataFrame(values[:, columns], columns=Index(model.features))
    each, whole = (
        estimator_probabilities(model, some, recording.name) for some in (rows, rows.mean().to_frame().transpose())
    )
    alone = np.zeros(len(windows), dtype=np.intp)
    return predictions(each, model.classes, alone, model.calibration, of_recordings=whole)


def _reconcile(estimated: Diagnosis, labelled: Diagnosis, lines: list[Line]) -> Diagnosis:
    """Prediction at the estimated speed, unless the classifier says another class at the labelled speed and no line decides."""
    families = {line.fault for line in lines}
    if labelled.verdict in (estimated.verdict, UNSURE) or estimated.verdict in families:
        return estimated
    why = (
        f"at the labelled speed the classifier says {labelled.verdict} ({candidates(labelled.probabilities, 1)}) and at the "
        f"estimated speed {estimated.verdict} ({candidates(estimated.probabilities, 1)})"
    )
    advice = "Measure the speed again and give it with --rpm, or take the estimated speed with --speed correct."
    return replace(estimated, verdict=UNSURE, sentence=why, advice=(advice,))


def _put_into_words(
    diagnosis: Diagnosis, other_rate: float | None, speed: "Speed", duration: float, compared: bool
) -> Diagnosis:
    """Diagnosis with its sentence and advice; the verdict becomes unsure if the lines plainly tell another class."""
    at_speed = speed_in_words(diagnosis.labelled_rate, other_rate, speed != "off")
    contradiction = "" if diagnosis.verdict == UNSURE else _contradiction(diagnosis)
    if diagnosis.verdict != UNSURE and not contradiction:
        probability = probability_in_words(diagnosis.probabilities[diagnosis.verdict])
        why = reasons(diagnosis.verdict, diagnosis.evidence)
        text = f"{CLASSES[diagnosis.verdict].words} (probability {probability}): {why}; {at_speed}."
        advice = (WATCH,) if diagnosis.verdict == HEALTHY and diagnosis.evidence else ()
        return replace(diagnosis, sentence=text, advice=advice)
    why = contradiction or diagnosis.sentence or _doubt(diagnosis)
    likely = candidates(diagnosis.probabilities)
    advice = diagnosis.advice or _advice(duration, compared)
    return replace(diagnosis, verdict=UNSURE, sentence=f"Unsure ({likely}): {why}; {at_speed}.", advice=advice)


def _contradiction(diagnosis: Diagnosis) -> str:
    """Clause on lines that plainly tell another class than the verdict; empty if there are none."""
    families = by_family(diagnosis.evidence)
    linked = diagnosis.verdict == HEALTHY or CLASSES[diagnosis.verdict].evidence
    if diagnosis.verdict in families or not linked:
        return ""
    for fault, lines in families.items():
        harmonics = {line.harmonic for line in lines if not line.sideband}
        plain = len(harmonics) >= (2 if 1 in harmonics else 3)
        if plain and max(line.level for line in lines) >= CONTRADICTING:
            return f"the classifier says {diagnosis.verdict}, but {family_in_words(lines)}, which tells of {fault}"
    return ""


def _doubt(diagnosis: Diagnosis) -> str:
    """Why the classifier does not answer, and what the strongest lines tell."""
    families = by_family(diagnosis.evidence)
    least = f"no class reaches the probability of {diagnosis.threshold:.2f} from which the classifier answers"
    if not families:
        return f"{least}, and no line stands out"
    fault, lines = next(iter(families.items()))
    return f"{least}; {family_in_words(lines)}, which tells of {fault}"


def _advice(duration: float, compared: bool) -> tuple[str, ...]:
    sentences = []
    if duration < 10:
        sentences.append(f"Record longer: 10 s instead of {duration:.2g} s.")
    if not compared:
        sentences.append("Give a recording of the machine with a healthy bearing (--healthy).")
    return (*sentences, "Measure the speed during the recording, and check the bearing designation.")


def _speed_warning(labelled: float, other: float, uncertainty: float) -> str:
    off = 100 * (other / labelled - 1)
    return (
        f"The labelled speed of {60 * labelled:,.0f} rpm does not fit the lines of this recording; they fit {60 * other:,.0f} rpm "
        f"(± {60 * uncertainty:.0f}), {off:+.1f} %."
    )


def _bearing_warning(spectra: list[BandSpectrum], lines: list[Line], shaft_rate: float, orders: Orders) -> list[str]:
    """Warning of a series of lines that belongs to no part of the bearing and is about as high as the evidence, or higher."""
    series = strange_series(spectra, shaft_rate, orders, lines)
    if series is None or series.level < max((line.level for line in lines), default=0.0) - NEARLY_AS_HIGH:
        return []
    sentence = (
        f"A line at {series.order:.2f} orders and its harmonics stand {series.level:.0f} dB above the floor, and no part of this bearing "
        f"has that order: the bearing may be another one, or the speed wrong by more than {100 * TOLERANCE:g} %, or the lines come from "
        "another part of the machine."
    )
    return [sentence]


def _shown_spectrum(spectra: list[BandSpectrum], lines: list[Line]) -> BandSpectrum:
    """Spectrum of the band with the highest line, or of the most impulsive band, which is the last."""
    if not lines:
        return spectra[-1]
    best = max(lines, key=lambda line: line.level)
    return next(spectrum for spectrum in spectra if spectrum.band == best.band)
