"""Classes that a model predicts for the records of a feature table and for whole recordings, with calibrated probabilities.

``feature table -> relative to a reference, if any -> probabilities -> calibrated -> combined by recording -> answers``
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from features.band import band_of
from features.baselines.calibration import Calibration, calibrated, combined
from features.baselines.estimators import class_probabilities
from features.baselines.records import FloatArray, IntArray, feature_rows, title_of
from features.baselines.references import relative_to
from features.recording_speeds import recording_numbers
from gen.corpus import FAULTS
from gen.support.errors import CorpusError

if TYPE_CHECKING:
    from pandas import DataFrame

    from features.baselines.models import Model

UNSURE = "unsure"


@dataclass(frozen=True, eq=False)
class Predictions:
    """Calibrated probabilities of some records, or of some recordings.

    Attributes
    ----------
    classes
        The classes that the model can predict.
    probabilities
        Shape (record, class) or (recording, class).
    threshold
        A record is answered if its largest probability is at least this.
    recording
        Number of the recording of each record, from 0 and without a gap; in ``by_recording``, 0, 1, 2, ....
    by_recording
        The same by recording, with the records of each combined; None in itself.
    """

    classes: tuple[str, ...]
    probabilities: FloatArray
    threshold: float
    recording: IntArray
    by_recording: "Predictions | None" = None

    @property
    def predicted(self) -> tuple[str, ...]:
        """The class with the largest probability, for each record."""
        return tuple(self.classes[column] for column in self.probabilities.argmax(axis=1))

    @property
    def answered(self) -> np.ndarray:
        """Whether the largest probability is at least the threshold, shape (record,)."""
        return self.probabilities.max(axis=1) >= self.threshold

    @property
    def answers(self) -> tuple[str, ...]:
        """The predicted class of each record, or "unsure" if it is not answered."""
        return tuple(name if answered else UNSURE for name, answered in zip(self.predicted, self.answered, strict=True))


def predict(table: xr.Dataset, model: "Model", reference: xr.Dataset | None = None) -> Predictions:
    """Predictions of a model for all records of a feature table, labelled or not.

    Parameters
    ----------
    table
        A feature table.
    model
        A trained model.
    reference
        Feature table with healthy records of the same rigs, which the records are compared with: see `relative_to`. Its records of
        other classes are not used.

    Raises
    ------
    CorpusError
        If the table lacks a feature of the model or is computed from another band, features or model contain numbers too large to
        compute with, or the model or the records cannot be used with the reference.
    """
    if reference is not None:
        if model.relative is None:
            message = (
                f"{title_of(reference)}: the model takes no reference, because {model.corpus} has no rig with two healthy "
                "recordings and records of each other class; leave the reference out, or train on another corpus."
            )
            raise CorpusError(message)
        return predict(relative_to(table, reference, model.features), model.relative)
    band = band_of(table.attrs)
    if band != model.band:
        low, high = model.band
        raise CorpusError(
            f"{title_of(table)}: its features are computed from {band.low:g}-{band.high:g} Hz, and the model was trained on "
            f"{low:g}-{high:g} Hz; compute them with --band {low:g} {high:g}."
        )
    rows = feature_rows(table, model.features)
    found = estimator_probabilities(model, rows, title_of(table))
    return predictions(found, model.classes, recording_numbers(table), model.calibration)


def predictions(
    probabilities: FloatArray, classes: tuple[str, ...], recording: IntArray, calibration: Calibration
) -> Predictions:
    """Predictions from the probabilities of an estimator, shape (record, class), which are calibrated here."""
    records = calibrated(probabilities, calibration.temperature)
    whole = combined(records, recording, calibration.dependence)
    return Predictions(
        classes=classes,
        probabilities=records,
        threshold=calibration.threshold,
        recording=recording,
        by_recording=Predictions(classes, whole, calibration.recording_threshold, np.arange(len(whole))),
    )


def class_names(codes: IntArray) -> tuple[str, ...]:
    """Names of some classes, given as indices into ``gen.corpus.FAULTS``."""
    return tuple(FAULTS[code] for code in codes)


def estimator_probabilities(model: "Model", features: "DataFrame", where: str) -> FloatArray:
    """Probability of each class as the estimator of a model gives it, shape (record, class).

    Raises
    ------
    CorpusError
        If features or model contain numbers too large to compute with.
    """
    try:
        with np.errstate(all="ignore"):
            found = class_probabilities(model.estimator, features)
    except ValueError as error:  # scikit-learn refuses numbers that are infinite, or too large for single precision
        reason = str(error).splitlines()[0]
        raise CorpusError(
            f"{where}: {model.name} cannot classify these records ({reason}); train the model again."
        ) from error
    if not np.isfinite(found).all():
        raise CorpusError(f"{where}: {model.name} gives probabilities that are not finite; train the model again.")
    return found
