"""Predicted classes of records and of whole recordings, with calibrated probabilities.

``probabilities -> calibrated -> combined by recording -> answers``
"""

from dataclasses import dataclass

import numpy as np

from features.baselines.calibration import Calibration, calibrate, combine
from features.baselines.records import FloatArray, IntArray
from gen.corpus import FAULTS

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


def predictions(
    probabilities: FloatArray, classes: tuple[str, ...], recording: IntArray, calibration: Calibration
) -> Predictions:
    """Predictions from the probabilities of an estimator, shape (record, class), which are calibrated here."""
    records = calibrate(probabilities, calibration.temperature)
    whole = combine(records, recording, calibration.dependence)
    return Predictions(
        classes=classes,
        probabilities=records,
        threshold=calibration.threshold,
        recording=recording,
        by_recording=Predictions(classes, whole, calibration.recording_threshold, np.arange(len(whole))),
    )


def fault_names(codes: IntArray) -> tuple[str, ...]:
    """Names of some classes, given as indices into ``gen.corpus.FAULTS``."""
    return tuple(FAULTS[code] for code in codes)
