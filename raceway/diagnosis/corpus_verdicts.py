"""Verdicts on the recordings of a corpus, counted by their true class.

``recordings of the corpus -> lines at their speeds; feature table -> predictions -> verdicts -> counts``

The verdict is as of `raceway.diagnosis.answer` at the speed and bearing of the corpus, which are not searched.
"""

from collections import Counter
from pathlib import Path

import numpy as np
import xarray as xr

from features.baselines.classifying import predict
from features.baselines.models import Model
from features.baselines.predictions import UNSURE, Predictions
from features.baselines.reference_choice import choose_reference
from features.table.channels import channel_number
from features.table.indicators import Orders
from features.table.recording_speeds import rates_to_use
from gen.corpus import FAULTS, SIGNAL, UNKNOWN_CODE, open_corpus
from raceway.diagnosis.evidence import Line, find_evidence
from raceway.diagnosis.quality import quality_of
from raceway.diagnosis.spectrum import band_spectra
from raceway.diagnosis.verdict import judge


def count_verdicts(
    corpus: Path | str, table: xr.Dataset, model: Model, reference: xr.Dataset | None = None
) -> dict[str, dict[str, int]]:
    """Number of recordings by true class and verdict: a class, "damaged" or "unsure".

    "Damaged" is right for a faulty recording if only detection counts, and an alarm for a healthy one. Recordings of class unknown, and
    those of the reference, are left out.

    Parameters
    ----------
    corpus
        Folder or file of the corpus.
    table
        Its feature table.
    model
        A trained model.
    reference
        Feature table with healthy records that they are compared with, as of `Model.score`.

    Raises
    ------
    CorpusError
        As `Model.score`.
    """
    # rows of the corpus, because a reference takes records out of the table
    tested = table.assign(row=("record", np.arange(table.sizes["record"])), rate=("record", rates_to_use(table)))
    if reference is not None:
        tested, reference, _ = choose_reference(tested, reference, model.features)
    tested = tested.isel(record=tested["fault"].values != UNKNOWN_CODE)
    predicted = predict(tested, model, reference)
    whole = predicted.by_recording or predicted
    counts: dict[str, Counter[str]] = {}
    with open_corpus(corpus) as opened:
        names = table["channel"].values.tolist() if "channel" in table["features"].dims else [table.attrs["channel"]]
        channels = [channel_number(opened, name, corpus) for name in names]
        # one recording at a time: its windows in a row are its signal again
        for number in range(len(whole.probabilities)):
            rows = tested.isel(record=predicted.recording == number)
            signals = opened[SIGNAL].isel(record=rows["row"].values, channel=channels).values
            lines = _lines(signals.transpose(1, 0, 2).reshape(len(channels), -1), rows.isel(record=0))
            verdict = UNSURE if lines is None else _verdict(whole, number, lines)
            counts.setdefault(FAULTS[int(rows["fault"][0])], Counter())[verdict] += 1
    return {fault: dict(counts[fault]) for fault in FAULTS if fault in counts}


def _lines(signals: np.ndarray, record: xr.Dataset) -> list[Line] | None:
    """Lines of a recording, shape (channel, time), with the labels of its first record; None if no channel can show any."""
    fs, rate = float(record["sample_rate"]), float(record["rate"])
    values = [float(record[name]) for name in Orders._fields]
    orders = Orders(*map(np.asarray, values))
    known = np.isfinite([rate, *values]).all() and min(rate, *values) > 0
    finite = [x for x in signals if known and np.isfinite(x).all()]
    useful = [x for x in finite if not quality_of(x, fs, rate, orders).useless]
    spectra = [spectrum for x in useful for spectrum in band_spectra(x, fs, rate)]
    return find_evidence(spectra, rate, orders) if spectra else None


def _verdict(whole: Predictions, number: int, lines: list[Line]) -> str:
    probabilities = dict(zip(whole.classes, whole.probabilities[number].tolist(), strict=True))
    distance, impulsive = float(whole.distance[number]), bool(whole.impulsive[number])
    return judge(probabilities, whole.threshold, lines, distance, impulsive=impulsive)[0]
