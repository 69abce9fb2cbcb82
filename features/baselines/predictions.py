"""Predicted classes of records and of whole recordings, with calibrated probabilities.

``probabilities of each channel -> calibrated -> combined by record and by recording -> answers``

A record far from its healthy reference in colour is never answered healthy: many faults change the colour of a machine and show no
line. Its probabilities stay, because states of the machine change the colour too, and tell of no fault.
"""

from dataclasses import dataclass

import numpy as np

from features.baselines.calibration import Calibration, calibrate, combine
from features.baselines.colour_distance import Colour
from features.signal.rows import FloatArray, IntArray
from gen.corpus import FAULTS
from gen.corpus.fault_classes import HEALTHY

UNSURE, DAMAGED = "unsure", "damaged"


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
    distance
        Of the colour from that of the healthy reference, in scatters of healthy recordings, shape (record,); 0 without a reference.
    by_recording
        The same by recording, with the records of each combined; None in itself.
    """

    classes: tuple[str, ...]
    probabilities: FloatArray
    threshold: float
    recording: IntArray
    distance: FloatArray
    by_recording: "Predictions | None" = None

    @property
    def predicted(self) -> tuple[str, ...]:
        """The class with the largest probability, for each record."""
        return tuple(self.classes[column] for column in self.probabilities.argmax(axis=1))

    @property
    def answered(self) -> np.ndarray:
        """Whether the largest probability is at least the threshold, and no "healthy" has a strange colour, shape (record,)."""
        strange = (self.distance > 1) & (np.array(self.predicted) == HEALTHY)
        return (self.probabilities.max(axis=1) >= self.threshold) & ~strange

    @property
    def answers(self) -> tuple[str, ...]:
        """The predicted class of each record, or "unsure" if it is not answered."""
        return tuple(name if answered else UNSURE for name, answered in zip(self.predicted, self.answered, strict=True))


def predictions(
    probabilities: FloatArray,
    classes: tuple[str, ...],
    recording: IntArray,
    calibration: Calibration,
    *,
    of_recordings: FloatArray | None = None,
    colour: Colour | None = None,
) -> Predictions:
    """Predictions from the probabilities of an estimator, which are calibrated and combined here.

    Those of the channels of a record are averaged as logarithms, since a machine moves all of them.

    Parameters
    ----------
    probabilities
        Shape (record, class), or (channel, record, class) of the channels of one housing.
    classes
        Of the columns.
    recording
        Number of the recording of each record, from 0 and without a gap, shape (record,).
    calibration
        Of the model.
    of_recordings
        Probabilities of the recordings, shape (recording, class) or (channel, recording, class); by default the geometric means over
        their records.
    colour
        Change of each record from its healthy reference; None without one.
    """
    every = np.arange(len(recording))
    records = _over_channels(probabilities, calibration)
    # without features of recordings, their records vote
    whole = combine(records, recording) if of_recordings is None else _over_channels(of_recordings, calibration)
    far, far_whole = np.zeros(len(records)), np.zeros(len(whole))
    if colour is not None:
        far, far_whole = colour.distances(every), colour.distances(recording)
    least = calibration.threshold
    recordings = Predictions(classes, whole, least, np.arange(len(whole)), far_whole)
    return Predictions(classes, records, least, recording, far, recordings)


def _over_channels(probabilities: FloatArray, calibration: Calibration) -> FloatArray:
    """Calibrated probabilities, geometric means over the channels, ([channel,] record, class) to (record, class)."""
    records, classes = probabilities.shape[-2:]
    rows = calibrate(probabilities.reshape(-1, classes), calibration.temperature)
    return combine(rows, np.tile(np.arange(records), len(rows) // records))


def fault_names(codes: IntArray) -> tuple[str, ...]:
    """Names of some classes, given as indices into ``gen.corpus.FAULTS``."""
    return tuple(FAULTS[code] for code in codes)
