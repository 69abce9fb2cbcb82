"""One recording in, a diagnosis out: class, probabilities, and the lines that stand above the floor.

``recording -> quality -> pairs of bearing and speed -> of each: features -> prediction, band spectra -> evidence -> verdict``

Bearing and speed are searched within what is given. The verdict is that of the classifier if the lines agree with it. No part
is named if they do not, if pairs that cannot be told apart give different classes, if no pair explains a strong comb, or if the
signal tells nothing: then it is "unsure", or "damaged" where a fault is certain. Evidence is measured in the signal alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from features.baselines.classifying import RECORDED, predict, suited
from features.baselines.models import Model
from features.baselines.predictions import DAMAGED, UNSURE, Predictions
from features.baselines.references import with_energies
from features.table.band import Band
from features.table.channels import joined_channels
from features.table.definitions import ALL_GROUPS
from features.table.durations import windows_of
from features.table.indicators import feature_names
from features.table.recording_features import recording_table
from gen.corpus import FAULTS, UNKNOWN_CODE
from gen.corpus.fault_classes import HEALTHY
from gen.support.errors import CorpusError
from raceway.diagnosis.evidence import Line, find_evidence
from raceway.diagnosis.levels import levels_of
from raceway.diagnosis.quality import Quality, enough, quality_of
from raceway.diagnosis.result import Diagnosis
from raceway.diagnosis.search import Given, Pair, find_pairs, mean_spectra, strange_comb
from raceway.diagnosis.spectrum import BandSpectrum, band_spectra
from raceway.diagnosis.verdict import certainly_faulty, judge, strange_colour
from raceway.diagnosis.wording import (
    answer_in_words,
    candidates,
    damaged_in_words,
    different_classes,
    listed,
    missed_faults,
    pair_in_words,
    speed_warning,
    unexplained,
)
from raceway.importing.recorded import LONGEST, Recorded

BY_HEALTHY = "(--healthy FILE; in Python healthy)"
SAME_STATE = f"Check load, mounting and sensor, and give a healthy recording of the same state {BY_HEALTHY}."
WATCH = f"The bearing shows lines of its own: record it again in some weeks and compare, or compare it with a healthy one {BY_HEALTHY}."


class Judged(NamedTuple):
    """Verdict, probabilities and evidence at one pair; ``why`` is the reason of "unsure", ``distance`` that of the colour."""

    pair: Pair
    verdict: str
    why: str
    probabilities: Mapping[str, float]
    threshold: float
    windows: int
    lines: list[Line]
    spectra: list[BandSpectrum]
    distance: float = 0.0


def diagnose_recording(
    recording: Recorded, machine: Given, model: Model, *, healthy: Sequence[Recorded] = ()
) -> Diagnosis:
    """Diagnose one recording.

    Parameters
    ----------
    recording
        At least 8 turns of the shaft and 0.05 s, or the answer is unsure; of more than 60 s the first 60 s are used. Several channels are
        axes of one housing.
    machine
        The bearings it may be of, and the lowest and highest shaft rate. One bearing and one speed are believed unless
        the lines clearly tell another speed within 8 %.
    model
        A trained model.
    healthy
        Recordings of the same machine with a healthy bearing, with the same channels. Several tell how much it varies.

    Raises
    ------
    CorpusError
        If a recording has values that are not finite, or the model cannot take its features or the healthy recording.
    """
    if not set(model.groups) <= set(ALL_GROUPS) or not set(model.features) <= set(
        feature_names(model.groups, Band(*model.band))
    ):
        raise CorpusError(f"{model.name}: the model takes features that this version does not make; train it again.")
    # a signal that cannot tell anything ends here, with the reason
    used, quality = _usable(recording, machine)
    shown = (recording.used, *(each.used for each in healthy))
    if quality.useless:
        return _with_levels(_useless(machine, model, quality), shown)
    references = [_reference(reference, recording, used, machine) for reference in healthy]
    spectra = mean_spectra(list(used.signals.values()), used.fs, machine)
    # every speed and bearing that the lines allow, and those that they rather tell
    pairs, elsewhere = find_pairs(spectra, machine)
    # the classifier is asked at each of them
    judged = [_judge(used, pair, model, references) for pair in pairs]
    # strong lines of no part of this bearing: it may be another bearing
    strange = strange_comb(spectra, judged[0].pair, judged[0].lines)
    diagnosis = _conclude(used, machine, model, judged, elsewhere, strange, compared=bool(healthy))
    return _with_levels(replace(diagnosis, warnings=(*quality.warnings, *diagnosis.warnings)), shown)


def _with_levels(diagnosis: Diagnosis, recordings: Sequence[Recorded]) -> Diagnosis:
    levels = tuple(
        levels_of(signal, each.fs, each.name, channel, each.unit, diagnosis.shaft_rate)
        for each in recordings
        for channel, signal in each.signals.items()
    )
    return replace(diagnosis, levels=levels)


def _usable(recording: Recorded, machine: Given) -> tuple[Recorded, Quality]:
    """At most the first 60 s of the channels that tell something, and warnings; or why no channel tells anything."""
    wrong = sum(int(np.count_nonzero(~np.isfinite(signal))) for signal in recording.signals.values())
    if wrong:
        total = sum(signal.size for signal in recording.signals.values())
        raise CorpusError(f"{recording.name}: {wrong:,} of {total:,} samples are not finite numbers; export it again.")
    signals = recording.used.signals
    # the middle of the given speeds and the first bearing are enough to tell a useless signal
    rate, orders = float(np.sqrt(np.prod(machine.rates))), next(iter(machine.bearings.values()))
    checked = {name: quality_of(signal, recording.fs, rate, orders) for name, signal in signals.items()}
    kept = {name: signals[name] for name, quality in checked.items() if not quality.useless}
    if not kept:
        return recording, next(iter(checked.values()))
    duration = recording.duration
    # what is left out is told
    warnings = [f"Only the first {LONGEST:g} s of {duration:,.0f} s are used."] if duration > LONGEST else []
    warnings += [f"Channel {name} is left out, since {checked[name].useless}." for name in checked if name not in kept]
    several = len(signals) > 1
    for name in kept:
        warnings += [f"Channel {name}: {warning}" if several else warning for warning in checked[name].warnings]
    return recording._replace(signals=kept), Quality("", "", tuple(warnings))


def _reference(healthy: Recorded, recording: Recorded, used: Recorded, machine: Given) -> Recorded:
    """What is used of a healthy recording, which must have the channels of the recording, and tell something in those that are used."""
    if not set(recording.signals) <= set(healthy.signals):
        their, own = (
            listed([name or "one without a name" for name in recorded.signals], "and")
            for recorded in (healthy, recording)
        )
        raise CorpusError(
            f"{healthy.name}: has other channels ({their}) than the recording ({own}), and cannot be used as the healthy recording; "
            "choose channels that both have, or write both as .csv with the same names of columns."
        )
    if all(np.array_equal(signal, healthy.signals[name]) for name, signal in recording.signals.items()):
        raise CorpusError(f"{healthy.name}: is the recording itself; give a healthy one of the same machine, or none.")
    reference, quality = _usable(healthy, machine)
    if quality.useless or not set(used.signals) <= set(reference.signals):
        why = quality.useless or " ".join(quality.warnings)
        raise CorpusError(
            f"{healthy.name}: cannot be used as the healthy recording, since {why}; give another, or none."
        )
    return reference


def _useless(machine: Given, model: Model, quality: Quality) -> Diagnosis:
    name, orders = next(iter(machine.bearings.items()))
    return Diagnosis(
        verdict=UNSURE,
        probabilities=dict.fromkeys(model.classes, 1 / len(model.classes)),
        threshold=np.nan,
        given=machine,
        bearing=name,
        orders=orders,
        shaft_rate=machine.rates[0],
        evidence=(),
        sentence=f"Unsure: {quality.useless}.",
        advice=(f"{quality.advice[0].upper()}{quality.advice[1:]}.",),
    )


def _judge(recording: Recorded, pair: Pair, model: Model, references: Sequence[Recorded]) -> Judged:
    """Prediction and evidence at one pair of bearing and speed."""
    spectra = [
        spectrum
        for name, signal in recording.signals.items()
        for spectrum in band_spectra(signal, recording.fs, pair.rate, name)
    ]
    # evidence is searched whatever the classifier says, and compared with it
    lines = find_evidence(spectra, pair.rate, pair.orders)
    predicted = _predict(recording, pair, model, references)
    whole = predicted.by_recording
    assert whole is not None  # noqa: S101 - only the predictions by recording have none
    probabilities = dict(zip(whole.classes, map(float, whole.probabilities[0]), strict=True))
    distance = float(whole.distance[0])
    verdict, why = judge(probabilities, whole.threshold, lines, distance)
    windows = len(predicted.probabilities)
    return Judged(pair, verdict, why, probabilities, whole.threshold, windows, lines, spectra, distance)


def _predict(recording: Recorded, pair: Pair, model: Model, references: Sequence[Recorded]) -> Predictions:
    """Predictions of windows and recording."""
    recordings = (recording, *references)
    model = suited(model, [each.duration for each in recordings], RECORDED * min(each.fs for each in recordings))
    tested = _table(recording, recording.signals, pair, model, UNKNOWN_CODE)
    if not references:
        return predict(tested, model)
    healthy = [_table(each, recording.signals, pair, model, FAULTS.index(HEALTHY)) for each in references]
    # each healthy recording keeps a number of its own, since they tell how much the machine varies
    numbered = [table.assign(recording=table["recording"] + number) for number, table in enumerate(healthy)]
    return predict(tested, model, xr.concat(numbered, "record", combine_attrs="override"))


def _table(recording: Recorded, channels: Iterable[str], pair: Pair, model: Model, fault: int) -> xr.Dataset:
    """Feature table of a recording; axes of one housing are channels of one record."""
    groups, band = with_energies(model.groups), Band(*model.band)
    tables = {}
    for name in channels:
        windows = windows_of(recording.signals[name], recording.fs, model.durations)
        tables[name] = recording_table(windows, recording.fs, pair.rate, pair.orders, fault, groups, band)
    return joined_channels(tables).assign_attrs(title=recording.name)


def _conclude(
    used: Recorded,
    machine: Given,
    model: Model,
    judged: list[Judged],
    elsewhere: tuple[Pair, ...],
    strange: float | None,
    *,
    compared: bool,
) -> Diagnosis:
    """Diagnosis at the first pair; no part is named if others give another class or if a strong comb is not explained."""
    first = judged[0]
    why, advice = first.why, ["Measure the speed during the recording, and check the bearing designation."]
    # neither speed nor bearing changes the colour
    if strange_colour(first.probabilities, first.distance):
        advice = [SAME_STATE]
    # the strongest doubt goes before: lines that this bearing and speed do not explain
    if elsewhere or strange is not None:
        why = unexplained(first.pair, elsewhere, strange)
        advice = [
            "Measure the speed, check the bearing, and give them as ranges or alternatives if they are not known."
        ]
    elif len({each.verdict for each in judged}) > 1:
        why = different_classes([(each.pair, each.verdict) for each in judged])
        advice = ["Measure the speed during the recording, and give it as a narrow range (--rpm; in Python rpm)."]
    # whatever the doubt is, several bearings fit
    if len({each.pair.bearing for each in judged}) > 1:
        advice = ["Give the bearing (--bearing; in Python orders)."]
    verdict = first.verdict
    # its kind may be unsure, and a fault certain
    if why:
        verdict = DAMAGED if certainly_faulty(each.probabilities for each in judged) else UNSURE
    if verdict == UNSURE:
        answer = f"Unsure ({candidates(first.probabilities)}): {why}"
    elif verdict == DAMAGED:
        answer = damaged_in_words(first.probabilities, why)
    else:
        answer = answer_in_words(verdict, first.probabilities, first.lines)
        advice = [WATCH] if verdict == HEALTHY and first.lines else []
    clauses = [answer]
    # pairs that give the same answer are named; those that leave a doubt are in its reason
    if why == first.why:
        clauses.append(pair_in_words(first.pair, machine, [each.pair for each in judged[1:]]))
    if len(used.signals) > 1:
        clauses.append(f"channels {listed([*used.signals], 'and')}, as axes of one housing")
    # a healthy verdict says how often such verdicts were wrong, which was counted for the reference model: it alone has a wide part
    missed, of = np.nan, 1
    if verdict == HEALTHY and model.wide is None:
        clauses.append("how often this model calls faulty recordings healthy was not measured")
    elif verdict == HEALTHY:
        length, missed, of = missed_faults(used.duration, compared=compared)
        faulty, machines = ("comparisons of faulty recordings", "two") if compared else ("faulty recordings", "three")
        clauses.append(f"{missed} of {of} {faulty} of up to {length:g} s from {machines} machines were called healthy")
    # healthy answers from ten seconds were not wrong less often than those from two
    if verdict in (UNSURE, DAMAGED) and used.duration < (seconds := enough(first.pair.rate)):
        advice.append(f"Record longer: {seconds:,.0f} s instead of {used.duration:.2g} s.")
    if verdict in (UNSURE, DAMAGED, HEALTHY) and not compared:
        advice.append(f"Give a recording of the machine with a healthy bearing {BY_HEALTHY}.")
    return Diagnosis(
        verdict=verdict,
        probabilities=first.probabilities,
        threshold=first.threshold,
        given=machine,
        bearing=first.pair.bearing,
        orders=first.pair.orders,
        shaft_rate=first.pair.rate,
        evidence=tuple(first.lines),
        sentence=f"{'; '.join(clauses)}.",
        advice=tuple(advice),
        warnings=speed_warning(first.pair, machine),
        explanations=tuple(answer.pair for answer in judged),
        elsewhere=elsewhere,
        windows=first.windows,
        missed=missed / of,
        spectrum=_shown_spectrum(first),
    )


def _shown_spectrum(judged: Judged) -> BandSpectrum:
    """Spectrum of the band with the highest line, or of the most impulsive band, which is the last."""
    if not judged.lines:
        return judged.spectra[-1]
    best = max(judged.lines, key=lambda line: line.level)
    return next(each for each in judged.spectra if (each.band, each.channel) == (best.band, best.channel))
