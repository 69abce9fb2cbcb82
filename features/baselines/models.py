"""A trained baseline with the names of its features, its classes and a description of its training.

Model files contain no pickle, and loading one runs no code from it. `load_model` checks the whole content before it creates any object:
see `features.baselines.model_file` and `features.baselines.model_check`.
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pandas import DataFrame, Index
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, field_validator

from features.baselines.calibration import Calibration
from features.baselines.cross_calibration import cross_calibration
from features.baselines.estimators import (
    DEFAULT_ESTIMATOR,
    ESTIMATORS,
    Estimator,
    make_estimator,
)
from features.baselines.model_check import check_estimator
from features.baselines.model_file import pack, read_state, unpack
from features.baselines.model_rules import brief, refuse
from features.baselines.model_states import Known, State, plain
from features.baselines.predictions import class_names, estimator_probabilities, predict
from features.baselines.records import DEFAULT_GROUPS, FloatArray, check_classes, features_of, labelled_records
from features.baselines.scores import Scores, score
from features.baselines.severities import Covered, covered_widths, uncovered_widths
from features.indicators import GROUPS
from features.table import feature_table
from gen.corpus import FAULTS, write_durably
from gen.errors import CorpusError
from gen.limits import check_limit

FORMAT = 3
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
    features, groups
        The features it takes, and their groups.
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
    """

    estimator: Estimator
    name: str
    classes: tuple[str, ...]
    features: tuple[str, ...]
    groups: tuple[str, ...]
    corpus: str
    records: int
    seed: int
    widths: Covered
    digests: NDArray[np.uint64]
    versions: Mapping[str, str]
    calibration: Calibration


def train(
    table: xr.Dataset,
    estimator: str = DEFAULT_ESTIMATOR,
    *,
    groups: Sequence[str] = DEFAULT_GROUPS,
    seed: int = 0,
) -> Model:
    """Fit a baseline to all records of a feature table, and calibrate it on records outside the training.

    It is calibrated by a cross-validation that keeps each rig together, or each specimen if there are too few rigs. If there are too few
    specimens too, or if the baseline is untrained, the probabilities stay as they are and every record is answered.

    Raises
    ------
    CorpusError
        If the table has only one class, or lacks a group of features.
    ValueError
        For an unknown estimator.
    """
    names = features_of(table, groups)
    records = labelled_records(table, names)
    check_classes(records)
    fitted = make_estimator(estimator, seed).fit(records.features, records.fault)
    return Model(
        estimator=fitted,
        name=estimator,
        classes=class_names(fitted.classes_),
        features=names,
        groups=tuple(groups),
        corpus=records.title,
        records=len(records.fault),
        seed=seed,
        widths=covered_widths(records),
        digests=record_digests(records.features.to_numpy()),
        versions={library: version(library) for library in _LIBRARIES},
        calibration=cross_calibration(records, estimator, seed),
    )


def evaluate(data: xr.Dataset | Path | str, model: Model | Path | str, *, seed: int = 0) -> Scores:
    """Scores of a model on all records of a feature table or corpus, over the classes present there.

    Parameters
    ----------
    data
        A feature table, or the folder of a corpus to compute features of.
    model
        A model, or the path of a model file.
    seed
        Of the bootstrap.

    Raises
    ------
    CorpusError
        If corpus or model cannot be read, or the table lacks a feature of the model.
    """
    model = model if isinstance(model, Model) else load_model(model)
    table = data if isinstance(data, xr.Dataset) else _features_for(model, data)
    records = labelled_records(table, model.features)
    scores = score(records, predict(table, model), seed)
    seen = seen_records(records.features.to_numpy(), model.digests)
    return replace(scores, seen=seen, uncovered_widths=uncovered_widths(model.widths, records))


def _features_for(model: Model, corpus: Path | str) -> xr.Dataset:
    unknown = [group for group in model.groups if group not in GROUPS]
    if unknown:
        message = (
            f"{corpus}: the model takes features of the group {brief(unknown[0])!r}, and the groups are "
            f"{', '.join(GROUPS)}; train the model again."
        )
        raise CorpusError(message)
    return feature_table(corpus, model.groups)


def record_digests(features: FloatArray) -> NDArray[np.uint64]:
    """Digest each row of features to 64 bits, shape (record, feature) to (record,)."""
    rows = (np.ascontiguousarray(row, dtype="<f8").tobytes() for row in features)
    digests = (int.from_bytes(hashlib.blake2b(row, digest_size=8).digest(), "little") for row in rows)
    return np.fromiter(digests, dtype=np.uint64, count=len(features))


def seen_records(features: FloatArray, digests: NDArray[np.uint64]) -> int:
    """Number of records whose digest is known; records without any feature are not counted."""
    known = np.isfinite(features).any(axis=1)
    return int(np.isin(record_digests(features[known]), digests).sum())


def save_model(model: Model, path: Path | str) -> None:
    """Write a model file, whole or not at all; equal models give equal bytes.

    Raises
    ------
    CorpusError
        If the disk refuses the file.
    """
    content = {field.name: getattr(model, field.name) for field in fields(model)}
    content["calibration"] = model.calibration.model_dump()
    write_durably(pack({"raceway_model": FORMAT, **content}), Path(path))


def load_model(path: Path | str) -> Model:
    """Read a model file; its whole content is checked before any object is created from it.

    Raises
    ------
    CorpusError
        If the file is missing, damaged, larger than the limits, or not as this version writes it.
    """
    path, known = Path(path), Known()
    held = _contents(path, read_state(path, known))
    about = _about(path, {name: plain(held[name]) for name in _About.model_fields})
    theirs, mine = about.versions.get("scikit-learn", "of another version"), version("scikit-learn")
    if theirs != mine:
        refuse(f"{path}:", f"was trained with scikit-learn {brief(theirs)}, and {mine} is installed")
    check_limit("model_features", len(about.features), f"{path}: has", CorpusError)
    digests = held["digests"].array
    if digests is None or digests.dtype != np.uint64 or digests.shape != (about.records,):
        refuse(f"{path}: digests", f"must be {about.records} of 64 bits, one per record")
    expected = {"name": about.name, "seed": about.seed, "classes": about.classes, "features": about.features}
    check_estimator(str(path), held["estimator"], known, **expected)
    model = Model(estimator=unpack(held["estimator"]), digests=digests, **dict(about))
    if class_names(model.estimator.classes_) != model.classes:
        refuse(f"{path}: classes", "are not those of the estimator")
    estimator_probabilities(
        model, _trial_records(len(model.features)).set_axis(Index(model.features), axis=1), str(path)
    )
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


class _About(BaseModel):
    """Fields of `Model` that are plain values, as a model file must contain them."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    name: Text
    classes: tuple[FaultName, ...] = Field(min_length=2)
    features: tuple[Text, ...] = Field(min_length=1)
    groups: tuple[Text, ...]
    corpus: Text
    records: Annotated[int, Field(ge=1)]
    seed: Annotated[int, Field(ge=0, lt=2**32)]
    widths: dict[FaultName, Annotated[tuple[tuple[Width, Width], ...], Field(min_length=1)]]
    versions: dict[Text, Text]
    calibration: Calibration

    @field_validator("name")
    @classmethod
    def _is_a_baseline(cls, name: str) -> str:
        if name not in ESTIMATORS:
            raise ValueError(f"{brief(name)!r} is no baseline; the baselines are {', '.join(ESTIMATORS)}")
        return name

    @field_validator("classes", "features", "groups")
    @classmethod
    def _names_are_distinct(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        if len(set(names)) < len(names):
            raise ValueError("two names are the same")
        return names


def _about(path: Path, values: dict[str, Any]) -> _About:
    try:
        return _About.model_validate(values)
    except ValidationError as error:
        first = error.errors()[0]
        place = "".join(f"[{part}]" if isinstance(part, int) else str(part) for part in first["loc"])
        refuse(f"{path}: {place}:", f"{first['msg'].removeprefix('Value error, ')}")


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
