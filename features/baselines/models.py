"""A trained baseline: fitted, calibrated, applied to feature tables, scored, saved and loaded.

Model files contain no pickle, and loading one runs no code from it: see `features.baselines.model_file`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from features.band import Band, band_of
from features.baselines.calibration import Calibration
from features.baselines.cross_calibration import FOLDS, fit_and_calibrate
from features.baselines.estimators import (
    DEFAULT_ESTIMATOR,
    ESTIMATORS,
    UNTRAINED,
    Estimator,
    class_probabilities,
    relative_name,
)
from features.baselines.model_file import read_model_file, write_model_file
from features.baselines.own import Maker, maker_name
from features.baselines.predictions import Predictions, fault_names, predictions
from features.baselines.records import (
    DEFAULT_GROUPS,
    FloatArray,
    check_classes,
    feature_rows,
    features_of,
    labelled_records,
    record_digests,
    seen_records,
    title_of,
)
from features.baselines.reference_choice import check_durations, choose_reference
from features.baselines.references import RELATIVE, paired_table, relative_to, with_energies
from features.baselines.scores import Scores, score
from features.baselines.severities import Covered, covered_widths, uncovered_widths
from features.indicators import GROUPS
from features.recording_speeds import recording_numbers
from gen.corpus import UNKNOWN_CODE, check_result
from gen.support.errors import CorpusError
from gen.support.progress import Progress, counter

if TYPE_CHECKING:
    from pandas import DataFrame

FORMAT = 4
_LIBRARIES = ("raceway", "scikit-learn", "skops", "numpy")


@dataclass(frozen=True, eq=False)
class Model:
    """A fitted baseline.

    Attributes
    ----------
    estimator
        The fitted scikit-learn estimator, from features to indices into ``gen.corpus.FAULTS``.
    name
        Its name in ``ESTIMATORS``.
    classes
        The classes it can predict.
    features, groups, band
        The features it takes, their groups, and the band that they are computed from.
    corpus, records, seed
        Title and number of records of the training corpus, and the seed.
    widths
        Intervals of fault width [m] that the training covered, by class, as in `features.baselines.severities`.
    digests
        One 64-bit digest per training record, shape (record,), to detect a test on training records.
    versions
        Of the libraries it was trained with.
    calibration
        Temperature of its probabilities and thresholds of its answers.
    relative
        The same for records relative to healthy records of their rig, as in `features.baselines.references`; None if the
        training corpus has no virtual references.
    """

    estimator: Estimator
    name: str
    classes: tuple[str, ...]
    features: tuple[str, ...]
    groups: tuple[str, ...]
    band: tuple[float, float]
    corpus: str
    records: int
    seed: int
    widths: Covered
    digests: NDArray[np.uint64]
    versions: Mapping[str, str]
    calibration: Calibration
    relative: "Model | None" = None


_OWN = tuple(field.name for field in fields(Model) if field.name != "relative")


def train(
    table: xr.Dataset,
    estimator: str | Maker = DEFAULT_ESTIMATOR,
    *,
    groups: Sequence[str] = DEFAULT_GROUPS,
    seed: int = 0,
    workers: int = 1,
    progress: Progress | None = None,
) -> Model:
    """Fit a baseline or a classifier of the user to all records of a feature table, and calibrate it on records outside the training.

    It is calibrated by a cross-validation that keeps each rig together, or each specimen if there are too few rigs. If there are too few
    specimens too, or if the baseline is untrained, the probabilities stay as they are and every record is answered.

    If each class has records on rigs with two healthy recordings, and the table has shaft rates and the group ``bands``, a second baseline
    is fitted to the records relative to another healthy recording of their rig: see `features.baselines.references`.

    Parameters
    ----------
    table
        A feature table.
    estimator
        Name of a baseline, or a classifier of the user.
    groups
        Groups of features.
    seed
        Of the estimator, of the splits and of the references.
    workers
        Number of fits at a time, in threads of this process; the model does not depend on it.
    progress
        Called after each fit with the number of fits done and of all that may be needed: four, and again as many for a second baseline.

    Raises
    ------
    CorpusError
        If the table has only one class, or lacks a group of features.
    ValueError
        For an unknown estimator.
    """
    compares = isinstance(estimator, str) and estimator not in UNTRAINED
    fits = (1 + FOLDS) * (1 + compares)
    done = counter(progress, fits)
    model = _train(table, estimator, groups, seed, workers, done)
    paired = paired_table(table, model.features, seed) if compares else None
    if paired is not None:
        relative = _train(paired, relative_name(str(estimator)), (RELATIVE,), seed, workers, done)
        model = replace(model, relative=relative)
    done(fits)
    return model


def _train(
    table: xr.Dataset,
    estimator: str | Maker,
    groups: Sequence[str],
    seed: int,
    workers: int,
    done: Callable[[int], None],
) -> Model:
    names = features_of(table, groups)
    records, band = labelled_records(table, names), band_of(table.attrs)
    check_classes(records)
    fitted, calibration = fit_and_calibrate(records, estimator, seed, workers=workers, done=done)
    return Model(
        estimator=fitted,
        name=estimator if isinstance(estimator, str) else maker_name(estimator),
        classes=fault_names(fitted.classes_),
        features=names,
        groups=tuple(groups),
        band=(band.low, band.high),
        corpus=records.title,
        records=len(records.fault),
        seed=seed,
        widths=covered_widths(records),
        digests=record_digests(records.features.to_numpy()),
        versions={library: version(library) for library in _LIBRARIES},
        calibration=calibration,
    )


def predict(table: xr.Dataset, model: Model, reference: xr.Dataset | None = None) -> Predictions:
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
    probabilities = estimator_probabilities(model, rows, title_of(table))
    return predictions(probabilities, model.classes, recording_numbers(table), model.calibration)


def estimator_probabilities(model: Model, features: "DataFrame", where: str) -> FloatArray:
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


def evaluate(
    data: xr.Dataset | Path | str,
    model: Model | Path | str,
    *,
    reference: xr.Dataset | Path | str | None = None,
    seed: int = 0,
) -> Scores:
    """Scores of a model on all records of a feature table or corpus, over the classes present there.

    Parameters
    ----------
    data
        A feature table, or the folder or file of a corpus to compute features of.
    model
        A model, or the path of a model file.
    reference
        A feature table or corpus with healthy records of the tested rigs, which records are compared with. Records whose class is unknown
        count as healthy if there are no others. If it holds the records of ``data``, the first healthy recording of each rig is the
        reference. Tested records that belong to the reference are left out.
    seed
        Of the bootstrap.

    Raises
    ------
    CorpusError
        If corpus or model cannot be read, the table lacks a feature of the model, or the reference cannot be used.
    """
    model = model if isinstance(model, Model) else load_model(model)
    table = data if isinstance(data, xr.Dataset) else _features_for(model, data, reference)
    if reference is None:
        return _evaluate(table, model, None, seed)
    if not isinstance(reference, xr.Dataset):
        if not isinstance(data, xr.Dataset):
            check_durations(data, reference)
        reference = _features_for(model, reference, reference)
    chosen = choose_reference(table, reference, model.features)
    return replace(_evaluate(chosen.table, model, chosen.reference, seed), reference=chosen.sentence)


def _evaluate(table: xr.Dataset, model: Model, reference: xr.Dataset | None, seed: int) -> Scores:
    records = labelled_records(table, model.features)
    table = table.isel(record=table["fault"].values != UNKNOWN_CODE)
    scores = score(records, predict(table, model, reference), seed)
    seen = seen_records(records.features.to_numpy(), model.digests)
    return replace(scores, seen=seen, uncovered_widths=uncovered_widths(model.widths, records))


def _features_for(model: Model, corpus: Path | str, reference: object) -> xr.Dataset:
    """Feature table of a corpus with the groups of a model, and with ``bands`` if there is a reference."""
    unknown = [group for group in model.groups if group not in GROUPS]
    if unknown:
        message = (
            f"{corpus}: the model takes features of the group {unknown[0]!r}, and the groups are "
            f"{', '.join(GROUPS)}; train the model again."
        )
        raise CorpusError(message)
    from features.table import feature_table  # not at the top: dask takes a sixth of the time of a diagnosis

    groups = model.groups if reference is None else with_energies(model.groups)
    return feature_table(corpus, groups, band=Band(*model.band))


def save_model(model: Model, path: Path | str) -> None:
    """Write a model file, whole or not at all; equal models give equal bytes.

    Raises
    ------
    CorpusError
        If the disk refuses the file, it lies in a corpus or is no model, or the model is not one of the baselines: only those can be read
        without running code.
    """
    if model.name not in ESTIMATORS:
        raise CorpusError(
            f"{path}: {model.name} is no baseline; a model file holds only one of {', '.join(ESTIMATORS)}."
        )
    check_result(Path(path), "model")
    relative = None if model.relative is None else _content(model.relative)
    write_model_file({"raceway_model": FORMAT, **_content(model), "relative": relative}, Path(path))


def _content(model: Model) -> dict[str, Any]:
    """Fields of a model without its relative part."""
    return {name: getattr(model, name) for name in _OWN} | {"calibration": model.calibration.model_dump()}


def load_model(path: Path | str) -> Model:
    """Read a model file; no code of the file runs, but load only models of people you trust.

    Raises
    ------
    CorpusError
        If the file is missing, damaged, larger than the limit, or no model of this version.
    """
    content = read_model_file(Path(path))
    if not isinstance(content, dict) or content.pop("raceway_model", None) != FORMAT:
        raise CorpusError(f"{path}: not a model of this version of raceway; train it again with raceway train.")
    relative = content.pop("relative", None)
    model = _model(path, content)
    return model if relative is None else replace(model, relative=_model(path, relative))


def _model(path: Path | str, content: Mapping[str, Any]) -> Model:
    """Model of the fields in a model file."""
    if set(content) != set(_OWN):
        raise CorpusError(f"{path}: not a complete model; train it again with raceway train.")
    return Model(**{**content, "calibration": Calibration(**content["calibration"])})
