"""A trained baseline with all it needs to be used again: its features by name, its classes, and its training.

Model files are written by skops and hold no pickle: loading one runs no code from it, and makes only the types
named in ``TRUSTED`` and those skops knows.
"""

import hashlib
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from importlib.metadata import version
from pathlib import Path

import numpy as np
import skops.io
import xarray as xr
from numpy.typing import NDArray

from features.baselines.estimators import DEFAULT_ESTIMATOR, Estimator, class_probabilities, make_estimator
from features.baselines.records import DEFAULT_GROUPS, FloatArray, check_classes, features_of, labelled_records
from features.baselines.scores import Scores, score
from features.table import feature_table
from gen.corpus import FAULTS, write_durably
from gen.errors import CorpusError

FORMAT = 1
TRUSTED = (
    "features.baselines.estimators.EnvelopeRule",
    "numpy.dtype",
    "sklearn.ensemble._hist_gradient_boosting.predictor.TreePredictor",
    "sklearn.tree._tree.Tree",
    "sklearn.utils._bunch.Bunch",
)
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
        The classes it can name.
    features, groups
        The features it wants, and the groups they are of.
    corpus, records, seed
        Title and number of records of the training corpus, and the seed.
    digests
        One 64-bit digest per training record, shape (record,), to notice a test on training records.
    versions
        Of the libraries it was made with.
    """

    estimator: Estimator
    name: str
    classes: tuple[str, ...]
    features: tuple[str, ...]
    groups: tuple[str, ...]
    corpus: str
    records: int
    seed: int
    digests: NDArray[np.uint64]
    versions: Mapping[str, str]


def train(
    table: xr.Dataset,
    estimator: str = DEFAULT_ESTIMATOR,
    *,
    groups: Sequence[str] = DEFAULT_GROUPS,
    seed: int = 0,
) -> Model:
    """Fit a baseline to all records of a feature table.

    Raises
    ------
    CorpusError
        If the table has a single class, or lacks a group of features.
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
        classes=tuple(FAULTS[c] for c in fitted.classes_),
        features=names,
        groups=tuple(groups),
        corpus=records.title,
        records=len(records.fault),
        seed=seed,
        digests=record_digests(records.features.to_numpy()),
        versions={library: version(library) for library in _LIBRARIES},
    )


def evaluate(data: xr.Dataset | Path | str, model: Model | Path | str, *, seed: int = 0) -> Scores:
    """Scores of a model on all records of a feature table or corpus, whatever classes it holds.

    Parameters
    ----------
    data
        A feature table, or the folder of a corpus, whose features are then computed.
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
    table = data if isinstance(data, xr.Dataset) else feature_table(data, model.groups)
    records = labelled_records(table, model.features)
    scores = score(records, class_probabilities(model.estimator, records.features), model.estimator.classes_, seed)
    return replace(scores, seen=seen_records(records.features.to_numpy(), model.digests))


def record_digests(features: FloatArray) -> NDArray[np.uint64]:
    """Digest each row of features to 64 bits, shape (record, feature) to (record,)."""
    rows = (np.ascontiguousarray(row, dtype="<f8").tobytes() for row in features)
    digests = (int.from_bytes(hashlib.blake2b(row, digest_size=8).digest(), "little") for row in rows)
    return np.fromiter(digests, dtype=np.uint64, count=len(features))


def seen_records(features: FloatArray, digests: NDArray[np.uint64]) -> int:
    """Count the records of which the digest is known; those without any feature are no evidence."""
    known = np.isfinite(features).any(axis=1)
    return int(np.isin(record_digests(features[known]), digests).sum())


def save_model(model: Model, path: Path | str) -> None:
    """Write a model file, whole or not at all.

    Raises
    ------
    CorpusError
        If the disk refuses the file.
    """
    path = Path(path)
    content = {field.name: getattr(model, field.name) for field in fields(model)}
    write_durably(skops.io.dumps({"raceway_model": FORMAT, **content}), path)


def load_model(path: Path | str) -> Model:
    """Read a model file.

    Raises
    ------
    CorpusError
        If the file is missing, damaged, holds types that are not trusted, or is no model of this package.
    """
    path = Path(path)
    try:
        with zipfile.ZipFile(path) as archive:
            damaged = archive.testzip()
        foreign = [] if damaged else sorted(set(skops.io.get_untrusted_types(file=path)) - set(TRUSTED))
        content = None if damaged or foreign else skops.io.load(path, trusted=list(TRUSTED))
    except FileNotFoundError:
        message = f"{path}: no such file; give a model made with raceway train."
        raise CorpusError(message) from None
    except Exception as error:
        # a foreign file can trip the readers of zip, JSON, NumPy and scikit-learn in any way
        message = f"{path}: not a readable model ({_first_line(error)}); train it again."
        raise CorpusError(message) from error
    if foreign:
        message = f"{path}: holds {foreign[0]}, which no model of raceway holds; use only models you trust."
        raise CorpusError(message)
    if not isinstance(content, dict) or content.pop("raceway_model", None) != FORMAT:
        message = f"{path}: not a model of this version of raceway; make one with raceway train."
        raise CorpusError(message)
    if set(content) != {field.name for field in fields(Model)}:
        message = f"{path}: not a complete model; make it again with raceway train."
        raise CorpusError(message)
    return Model(**content)


def _first_line(error: Exception) -> str:
    return (str(error) or type(error).__name__).splitlines()[0]
