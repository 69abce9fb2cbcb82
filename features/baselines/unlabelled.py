"""Answers of a model for recordings whose class is not known; there is nothing to score them against."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from features.baselines.classifying import predict
from features.baselines.models import Model
from features.baselines.predictions import Predictions
from features.baselines.reference_choice import choose_reference
from gen.corpus import UNKNOWN_CODE


@dataclass(frozen=True)
class Answer:
    """Answer for one recording.

    Attributes
    ----------
    source
        File of the recording, or its number if the table does not tell the file.
    records
        Number of its records.
    answer
        A class, or "unsure".
    probabilities
        Of each class, all records combined.
    """

    source: str
    records: int
    answer: str
    probabilities: dict[str, float]


def unlabelled_answers(table: xr.Dataset, model: Model, reference: xr.Dataset | None = None) -> tuple[Answer, ...]:
    """Answers for the recordings of class ``unknown`` of a feature table, in the order of their first record.

    Parameters
    ----------
    table
        A feature table.
    model
        A trained model.
    reference
        Feature table with healthy records that they are compared with, as in ``evaluate``.

    Raises
    ------
    CorpusError
        As ``evaluate``.
    """
    if reference is not None:
        table, reference, _ = choose_reference(table, reference, model.features)
    unknown = table.isel(record=table["fault"].values == UNKNOWN_CODE)
    if not unknown.sizes["record"]:
        return ()
    predictions = predict(unknown, model, reference)
    whole, numbers = predictions.by_recording or predictions, predictions.recording
    _, first = np.unique(numbers, return_index=True)
    return tuple(_answer(unknown, whole, numbers, row) for row in sorted(first))


def _answer(table: xr.Dataset, whole: Predictions, numbers: np.ndarray, row: int) -> Answer:
    number = numbers[row]
    recording = table["recording"].values[row]
    name = str(table["source"].values[row]).partition("#")[0] if "source" in table else f"recording {recording}"
    return Answer(
        source=name,
        records=int((numbers == number).sum()),
        answer=whole.answers[number],
        probabilities=dict(zip(whole.classes, whole.probabilities[number].tolist(), strict=True)),
    )
