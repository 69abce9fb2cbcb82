"""Predictions of a fitted model for feature tables and waveforms, alone or compared with healthy records."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import numpy as np
import xarray as xr

from features.baselines.calibration import Calibration
from features.baselines.colour_distance import Colour
from features.baselines.estimators import class_probabilities
from features.baselines.predictions import Predictions, predictions
from features.baselines.records import FloatArray, feature_rows, title_of
from features.baselines.references import colour_of, relative_to
from features.signal.rows import group_means
from features.table.band import band_of
from features.table.channels import channels_of
from features.table.durations import durations_of
from features.table.recording_speeds import recording_numbers
from features.table.waveforms import Waveforms
from gen.corpus import open_corpus
from gen.support.errors import CorpusError

if TYPE_CHECKING:
    from pandas import DataFrame

SAME_DURATION = 1.01  # ratio
RECORDED = 0.45  # of the sample rate: frequencies below the anti-alias filter of a recording


class Fitted(Protocol):
    """What predictions need of a `Model`; see there."""

    estimator: Any
    classes: tuple[str, ...]
    features: tuple[str, ...]
    band: tuple[float, float]
    corpus: str
    calibration: Calibration
    relative: Any
    durations: tuple[float, ...]
    shorter: Any
    wide: Any

    @property
    def name(self) -> str:
        """Name of the classifier."""
        ...


Model = TypeVar("Model", bound=Fitted)


def suited(model: Model, durations: Sequence[float], highest: float) -> Model:
    """The model, or its model for other records.

    That for shorter records is taken if the shortest of these ``durations`` is below that of the training [s], and else that for a wider
    band if the ``highest`` frequency of the records reaches the end of the band [Hz].
    """
    # models are asked for last: each is read from its file then
    if durations and SAME_DURATION * min(durations) < min(model.durations, default=0.0) and model.shorter:
        return model.shorter
    return model.wide if highest > model.band[1] and model.wide and highest >= model.wide.band[1] else model


def suited_to(model: Model, *corpora: Path | str | xr.Dataset) -> Model:
    """The model whose features are computed of the signals of some corpora, by their durations and sample rates.

    Raises
    ------
    CorpusError
        If one cannot be read.
    """
    durations, rates = list[float](), list[float]()
    for corpus in corpora:
        with open_corpus(corpus) as opened:
            rates.append(float(opened["sample_rate"].max()))
            durations.append(opened.sizes["elapsed_time"] / rates[-1])
    return suited(model, durations, RECORDED * min(rates))


def check_takes_reference(model: Fitted, reference: str) -> None:
    """Refuse a reference, with whose name the sentence begins, if the model has no part for it."""
    if model.relative is None:
        raise CorpusError(
            f"{reference}: the model takes no reference, because {model.corpus} has no rig with two healthy "
            "recordings and records of each other class; leave the reference out, or train on another corpus."
        )


def predict(data: xr.Dataset | Waveforms, model: Fitted, reference: xr.Dataset | None = None) -> Predictions:
    """Predictions of a model for all records of a feature table or waveforms, labelled or not.

    Those of a recording are made from the mean features of its records, in which noise counts less; from waveforms they are the
    geometric means of the probabilities of its records.

    Parameters
    ----------
    data
        A feature table, or waveforms for a classifier of waveforms.
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
    if isinstance(data, Waveforms):
        return _of_waveforms(data, model)
    return _of_table(data, model, reference)


def _of_waveforms(data: Waveforms, model: Fitted) -> Predictions:
    title = title_of(data.labels)
    if model.features:
        raise CorpusError(f"{title}: {model.name} was trained on features; give features.")
    each = estimator_probabilities(model, data, title)
    return predictions(each, model.classes, recording_numbers(data.labels), model.calibration)


def _of_table(table: xr.Dataset, model: Fitted, reference: xr.Dataset | None) -> Predictions:
    if not model.features:
        raise CorpusError(f"{title_of(table)}: {model.name} was trained on waveforms; give waveforms.")
    model = suited(model, durations_of(table), band_of(table.attrs).high)
    tables, used, colour = channels_of(table), model, None
    # a reference has a model of its own, of features relative to healthy records
    if reference is not None:
        check_takes_reference(model, title_of(reference))
        if band_of(reference.attrs) != band_of(table.attrs):
            raise CorpusError(
                f"{title_of(reference)}: the features of the reference are computed from another band than those of the records; compute "
                "both with one band."
            )
        references = channels_of(reference)
        if len(references) != len(tables):
            raise CorpusError(
                f"{title_of(reference)}: the reference has {len(references)} channels and the records have {len(tables)}; give "
                "a corpus with the same channels."
            )
        # channels are paired by their place
        pairs = list(zip(tables, references, strict=True))
        used, tables = model.relative, [relative_to(*pair, model.features) for pair in pairs]
        colours = [colour_of(*pair) for pair in pairs]
        colour = Colour(*map(np.concatenate, zip(*colours, strict=True)))
    # a recording is predicted from the mean features of its records, not from the mean of their answers
    recording = recording_numbers(table)
    rows = [_rows(table_of_channel, used) for table_of_channel in tables]
    means = [type(frame)(group_means(frame.to_numpy(), recording), columns=frame.columns) for frame in rows]
    each, whole = (
        np.stack([estimator_probabilities(used, some, title_of(table)) for some in values]) for values in (rows, means)
    )
    return predictions(
        each,
        used.classes,
        recording,
        used.calibration,
        of_recordings=whole,
        colour=colour,
    )


def _rows(table: xr.Dataset, model: Fitted) -> "DataFrame":
    """Features that a model takes of the records of a feature table of one channel."""
    band = band_of(table.attrs)
    if band != model.band:
        low, high = model.band
        raise CorpusError(
            f"{title_of(table)}: its features are computed from {band.low:g}-{band.high:g} Hz, and the model was trained on "
            f"{low:g}-{high:g} Hz; compute them with the band ({low:g}, {high:g})."
        )
    return feature_rows(table, model.features)


def estimator_probabilities(model: Fitted, features: "DataFrame | Waveforms", where: str) -> FloatArray:
    """Probability of each class as the estimator of a model gives it, shape (record, class).

    Raises
    ------
    CorpusError
        If features or model contain numbers too large to compute with.
    """
    try:
        with np.errstate(all="ignore"):
            probabilities = class_probabilities(model.estimator, features)
    except ValueError as error:  # scikit-learn refuses numbers that are infinite, or too large for single precision
        reason = str(error).splitlines()[0]
        raise CorpusError(
            f"{where}: {model.name} cannot classify these records ({reason}); train the model again."
        ) from error
    if not np.isfinite(probabilities).all():
        raise CorpusError(f"{where}: {model.name} gives probabilities that are not finite; train the model again.")
    return probabilities
