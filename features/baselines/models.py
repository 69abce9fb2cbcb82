"""A trained baseline with the names of its features, its classes and a description of its training.

Model files contain no pickle, and loading one runs no code from it. `load_model` checks the whole content before it creates any object:
see `features.baselines.model_file` and `features.baselines.model_check`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pandas import DataFrame, Index
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, field_validator

from features.band import HIGHEST, Band, band_of
from features.baselines.calibration import Calibration
from features.baselines.cross_calibration import FOLDS, fit_and_calibrate
from features.baselines.estimators import (
    DEFAULT_ESTIMATOR,
    ESTIMATORS,
    RELATIVE_ESTIMATORS,
    UNTRAINED,
    Estimator,
    relative_name,
)
from features.baselines.fitting import FitProgress
from features.baselines.model_check import check_estimator
from features.baselines.model_file import pack, read_state, unpack
from features.baselines.model_rules import brief, refuse
from features.baselines.model_states import Known, State, plain
from features.baselines.own import Maker, maker_name
from features.baselines.predictions import class_names, estimator_probabilities, predict
from features.baselines.records import (
    DEFAULT_GROUPS,
    check_classes,
    features_of,
    labelled_records,
    record_digests,
    seen_records,
)
from features.baselines.reference_choice import check_durations, compared
from features.baselines.references import RELATIVE, paired_table, relative_names, with_energies
from features.baselines.scores import Scores, score
from features.baselines.severities import Covered, covered_widths, uncovered_widths
from features.indicators import GROUPS
from gen.corpus import FAULTS, UNKNOWN_CODE, write_durably
from gen.errors import CorpusError
from gen.limits import check_limit
from gen.progress import Progress

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
    steps = FitProgress(progress, (1 + FOLDS) * (1 + compares))
    model = _train(table, estimator, groups, seed, workers, steps.done)
    paired = paired_table(table, model.features, seed) if compares else None
    if paired is not None:
        relative = _train(paired, relative_name(str(estimator)), (RELATIVE,), seed, workers, steps.done)
        model = replace(model, relative=relative)
    steps.end()
    return model


def _train(
    table: xr.Dataset,
    estimator: str | Maker,
    groups: Sequence[str],
    seed: int,
    workers: int,
    done: Callable[[], None],
) -> Model:
    names = features_of(table, groups)
    records, band = labelled_records(table, names), band_of(table.attrs)
    check_classes(records)
    fitted, calibration = fit_and_calibrate(records, estimator, seed, workers=workers, done=done)
    return Model(
        estimator=fitted,
        name=estimator if isinstance(estimator, str) else maker_name(estimator),
        classes=class_names(fitted.classes_),
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
        A feature table, or the folder of a corpus to compute features of.
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
    chosen = compared(table, reference, model.features)
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
            f"{corpus}: the model takes features of the group {brief(unknown[0])!r}, and the groups are "
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
        If the disk refuses the file, or the model is not one of the baselines: only those can be read without running code.
    """
    if model.name not in ESTIMATORS:
        raise CorpusError(
            f"{path}: {model.name} is no baseline; a model file holds only one of {', '.join(ESTIMATORS)}."
        )
    content = _content(model) | {"relative": None if model.relative is None else _content(model.relative)}
    write_durably(pack({"raceway_model": FORMAT, **content}), Path(path))


def _content(model: Model) -> dict[str, Any]:
    """Fields of a model without its relative part."""
    return {name: getattr(model, name) for name in _OWN} | {"calibration": model.calibration.model_dump()}


def load_model(path: Path | str, *, relative: bool = True) -> Model:
    """Read a model file; every part of it is checked before any object is created from that part.

    Parameters
    ----------
    path
        The file.
    relative
        Whether to create the part for records with a healthy reference too.

    Raises
    ------
    CorpusError
        If the file is missing, damaged, larger than the limits, or not as this version writes it.
    """
    path, known = Path(path), Known()
    held = _contents(path, read_state(path, known))
    about = _checked(str(path), held, known)
    inner, part = held["relative"], None
    if not relative:
        return _created(str(path), held, about)
    if inner.kind[2] != "JsonNode" or plain(inner) is not None:
        part = inner.parts["content"] if inner.kind[2] == "DictNode" else {}
        if set(part) != set(_OWN):
            raise CorpusError(f"{path}: not a complete model; train it again with raceway train.")
        its = _checked(f"{path}: relative", part, known)
        own = {"records": its.records, "widths": its.widths, "calibration": its.calibration}
        named = {"name": relative_name(about.name), "features": relative_names(about.features), "groups": (RELATIVE,)}
        if its != about.model_copy(update=own | named):
            refuse(f"{path}: relative:", "is not of the same estimator, seed, classes, features and corpus")
        part = _created(f"{path}: relative", part, its)
    return replace(_created(str(path), held, about), relative=part)


def _checked(where: str, held: Mapping[str, State], known: Known) -> "_About":
    """Plain values of a model, or of its relative part, after a check of all its content."""
    about = _about(where, {name: plain(held[name]) for name in _About.model_fields})
    theirs, mine = about.versions.get("scikit-learn", "of another version"), version("scikit-learn")
    if theirs != mine:
        refuse(f"{where}:", f"was trained with scikit-learn {brief(theirs)}, and {mine} is installed")
    check_limit("model_features", len(about.features), f"{where}: has", CorpusError)
    digests = held["digests"].array
    if digests is None or digests.dtype != np.uint64 or digests.shape != (about.records,):
        refuse(f"{where}: digests", f"must be {about.records} of 64 bits, one per record")
    expected = {"name": about.name, "seed": about.seed, "classes": about.classes, "features": about.features}
    check_estimator(where, held["estimator"], known, **expected)
    return about


def _created(where: str, held: Mapping[str, State], about: "_About") -> Model:
    """Create a model from checked content, and try it."""
    digests: Any = held["digests"].array
    model = Model(estimator=unpack(held["estimator"]), digests=digests, **dict(about))
    if class_names(model.estimator.classes_) != model.classes:
        refuse(f"{where}: classes", "are not those of the estimator")
    trial = _trial_records(len(model.features)).set_axis(Index(model.features), axis=1)
    estimator_probabilities(model, trial, where)
    return model


def _encodable(text: str) -> str:
    text.encode()  # raises ValueError for half of a surrogate pair, which JSON can contain and a terminal cannot show
    return text


def _fault_class(name: str) -> str:
    if name not in FAULTS:
        raise ValueError(f"{brief(name)!r} is no fault class; the classes are {', '.join(FAULTS)}")
    return name


Text = Annotated[str, AfterValidator(_encodable)]
FaultName = Annotated[str, AfterValidator(_fault_class)]
Width = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Edge = Annotated[float, Field(ge=0, le=HIGHEST)]


class _About(BaseModel):
    """Fields of `Model` that are plain values, as a model file must contain them."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    name: Text
    classes: tuple[FaultName, ...] = Field(min_length=2)
    features: tuple[Text, ...] = Field(min_length=1)
    groups: tuple[Text, ...]
    band: tuple[Edge, Edge]
    corpus: Text
    records: Annotated[int, Field(ge=1)]
    seed: Annotated[int, Field(ge=0, lt=2**32)]
    widths: dict[FaultName, Annotated[tuple[tuple[Width, Width], ...], Field(min_length=1)]]
    versions: dict[Text, Text]
    calibration: Calibration

    @field_validator("name")
    @classmethod
    def _is_a_baseline(cls, name: str) -> str:
        if name not in ESTIMATORS | RELATIVE_ESTIMATORS:
            raise ValueError(f"{brief(name)!r} is no baseline; the baselines are {', '.join(ESTIMATORS)}")
        return name

    @field_validator("classes", "features", "groups")
    @classmethod
    def _names_are_distinct(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        if len(set(names)) < len(names):
            raise ValueError("two names are the same")
        return names


def _about(where: str, values: dict[str, Any]) -> _About:
    try:
        return _About.model_validate(values)
    except ValidationError as error:
        first = error.errors()[0]
        place = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in first["loc"]).removeprefix(".")
        refuse(f"{where}: {place}:", f"{first['msg'].removeprefix('Value error, ')}")


def _contents(path: Path, root: State) -> Mapping[str, State]:
    """Fields of a model file by name."""
    held = root.parts["content"] if root.kind[2] == "DictNode" else {}
    if "raceway_model" not in held or plain(held["raceway_model"]) != FORMAT:
        raise CorpusError(f"{path}: not a model of this version of raceway; train it again with raceway train.")
    if set(held) != {"raceway_model", *(field.name for field in fields(Model))}:
        raise CorpusError(f"{path}: not a complete model; train it again with raceway train.")
    return held


def _trial_records(features: int) -> DataFrame:
    """Records that a loaded model must be able to classify: constants, and one without any feature."""
    return DataFrame(np.repeat([[0.0], [1.0], [-1.0], [np.nan]], features, axis=1))
