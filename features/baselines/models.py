"""A classifier with the names of its features, its classes and a description of its training.

Model files contain no pickle, and loading one runs no code from it: see `features.baselines.model_file`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any, Self, TypeGuard, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from sklearn.exceptions import NotFittedError

from features.baselines.calibration import UNCALIBRATED, Calibration
from features.baselines.classifying import predict, suited, suited_to
from features.baselines.cross_calibration import FOLDS, fit_and_calibrate
from features.baselines.estimators import MAKERS, Estimator, check_baseline, relative_name
from features.baselines.model_parts import Packed, Part
from features.baselines.names import BASELINES, DEFAULT_ESTIMATOR, UNTRAINED
from features.baselines.own import Maker, maker_name
from features.baselines.predictions import fault_names
from features.baselines.records import (
    DEFAULT_GROUPS,
    FloatArray,
    check_classes,
    features_of,
    labelled_records,
    record_digests,
    records_of,
    seen_records,
    title_of,
)
from features.baselines.reference_choice import check_durations, choose_reference
from features.baselines.references import RELATIVE, paired_table, with_energies
from features.baselines.scores import Scores, score
from features.table.band import DEFAULT_BAND, Band, band_of
from features.table.channels import channels_of
from features.table.corpus_features import feature_table
from features.table.definitions import ALL_GROUPS, GROUPS
from features.table.durations import durations_of
from features.table.waveforms import Waveforms
from gen.corpus import FAULTS, UNKNOWN_CODE, check_result, corpus_name
from gen.support.display import Shown
from gen.support.errors import CorpusError
from gen.support.executor import Workers, connected
from gen.support.plugins import missing_distributions, plugin_versions
from gen.support.progress import Progress, counter

FORMAT = 10
_LIBRARIES = ("raceway", "scikit-learn", "skops", "numpy")
_TRAINING = ("corpus", "records", "seed", "digests", "versions")
_STORED = ("estimator", "name", "classes", "features", "groups", "band", "durations", *_TRAINING, "calibration")
_PARTS = ("relative", "shorter", "wide")
"""Fields in a model file, and those that are models."""

Data = xr.Dataset | Waveforms | Path | str
"""A feature table, the folder or file of a corpus, or records in memory; for classifiers of the user also waveforms."""


@dataclass(eq=False, repr=False)
class Model(Shown):
    """A classifier of bearing faults, fitted to a corpus and calibrated on records outside the training.

    ``Model("random_forest").fit("corpus").predict("other")`` reads as an estimator of scikit-learn; data are feature tables or corpora.

    Attributes
    ----------
    classifier
        Name of a baseline, or a classifier of the user; ValueError for another name.
    groups
        Groups of features.
    seed
        Of the classifier, of the splits and of the references.
    estimator
        After the fit: the scikit-learn estimator, from features to indices into ``gen.corpus.FAULTS``.
    classes
        The classes it can predict.
    features, band
        The features it takes, and the band that they are computed from.
    corpus, records
        Title and number of records of the training corpus.
    durations
        Shortest and longest of these records [s]; empty if they are not known.
    digests
        One 64-bit digest per training record, shape (record,), to detect a test on training records.
    versions
        Of the libraries and plug-ins it was trained with.
    calibration
        Temperature of its probabilities and thresholds of its answers.
    relative
        The same for records relative to healthy records of their rig, as in `features.baselines.references`; None if the
        training corpus has no virtual references.
    shorter
        The same for records that are shorter than those of the training; None if there is none.
    wide
        The same for records whose sample rate allows a wider band; None if there is none.
    """

    classifier: str | Maker = DEFAULT_ESTIMATOR
    _: KW_ONLY
    groups: Sequence[str] = DEFAULT_GROUPS
    seed: int = 0
    estimator: Estimator = None
    classes: tuple[str, ...] = ()
    features: tuple[str, ...] = ()
    band: tuple[float, float] = DEFAULT_BAND
    corpus: str = ""
    records: int = 0
    durations: tuple[float, ...] = ()
    digests: NDArray[np.uint64] = field(default_factory=lambda: np.empty(0, np.uint64))
    versions: Mapping[str, str] = field(default_factory=dict)
    calibration: Calibration = UNCALIBRATED
    relative: Part[Model] = Part()  # noqa: RUF009
    shorter: Part[Model] = Part()  # noqa: RUF009
    wide: Part[Model] = Part()  # noqa: RUF009

    def __post_init__(self) -> None:
        if isinstance(self.classifier, str):
            check_baseline(self.classifier)

    @property
    def name(self) -> str:
        """Name of the classifier."""
        return self.classifier if isinstance(self.classifier, str) else maker_name(self.classifier)

    @property
    def window(self) -> float | None:
        """Longest of its training records, which longer records are cut into [s]; None if they are not known."""
        return max(self.durations, default=None)

    def _heading(self) -> str:
        trained = "not fitted" if self.estimator is None else f"fitted to {self.records:,} records of {self.corpus}"
        return f"Model {self.name}: {trained}"

    def _facts(self) -> Mapping[str, object]:
        if self.estimator is None:
            return {"groups": ", ".join(self.groups), "next": "model.fit(table)"}
        return {
            "classes": ", ".join(self.classes),
            "features": f"{len(self.features)} of {', '.join(self.groups)}",
            "next": 'model.score(table), model.predict(table), model.save("model.skops")',
        }

    def fit(self, data: Data, *, workers: int = 1, progress: Progress | None = None) -> Self:
        """Fit the classifier to all labelled records, and calibrate it.

        It is calibrated by a cross-validation that keeps each rig together, or each specimen if there are too few rigs. If there are too
        few specimens too, or if the baseline is untrained, the probabilities stay as they are and every record is answered.

        If each class has records on rigs with two healthy recordings, and the table has shaft rates and the group ``bands``, a second
        baseline is fitted to the records relative to another healthy recording of their rig: see `features.baselines.references`.

        Parameters
        ----------
        data
            A feature table, a corpus to compute features of, or waveforms for a classifier of the user.
        workers
            Number of processes that fit; 1 is this one. The model does not depend on it.
        progress
            Called after each fit with the number of fits done and of all that may be needed: four, and again as many for a second baseline.

        Raises
        ------
        CorpusError
            If the table has only one class or several channels, or lacks a group of features, or a baseline is given waveforms.
        """
        table = (
            _feature_table(data, [*dict.fromkeys((*GROUPS, *self.groups))])
            if _holds_signals(data)
            else cast("xr.Dataset | Waveforms", data)
        )
        if isinstance(table, xr.Dataset) and len(channels_of(table)) > 1:
            raise CorpusError(f"{title_of(table)}: a model is trained on one channel; give the feature table of one.")
        if isinstance(table, Waveforms) and isinstance(self.classifier, str):
            raise CorpusError(
                f"{title_of(table.labels)}: {self.name} learns from features; give a feature table or a corpus."
            )
        # estimators of the user and untrained rules take no reference
        compares = isinstance(self.classifier, str) and self.classifier not in UNTRAINED
        # one fit of all records and the folds of the calibration, twice with a reference
        fits = (1 + FOLDS) * (1 + compares)
        done = counter(progress, fits)
        with connected(workers, __name__) as place:
            _fit(self, table, place, done)
            paired = (
                paired_table(table, self.features, self.seed) if compares and isinstance(table, xr.Dataset) else None
            )
            self.relative = None
            if paired is not None:
                relative = self.relative = Model(relative_name(self.name), groups=(RELATIVE,), seed=self.seed)
                _fit(relative, paired, place, done)
        done(fits)
        return self

    def predict(self, data: Data, *, reference: Data | None = None) -> NDArray[np.str_]:
        """Most probable class of each record, shape (record,); the parameters are those of `score`."""
        table, healthy = self._tables(data, reference)
        return np.array(predict(table, self, healthy).predicted)

    def predict_proba(self, data: Data, *, reference: Data | None = None) -> FloatArray:
        """Calibrated probability of each of ``classes``, shape (record, class); the parameters are those of `score`."""
        table, healthy = self._tables(data, reference)
        return predict(table, self, healthy).probabilities

    def score(self, data: Data, *, reference: Data | None = None, seed: int = 0) -> Scores:
        """Scores on all labelled records, over the classes present there.

        Parameters
        ----------
        data
            A feature table, or a corpus to compute features of: of records longer than those of the training, by windows of that length.
        reference
            A feature table or corpus with healthy records of the tested rigs, which records are compared with. Records whose class is
            unknown count as healthy if there are no others. If it holds the records of ``data``, the first healthy recording of each rig
            is the reference. Tested records that belong to the reference are left out.
        seed
            Of the bootstrap.

        Raises
        ------
        CorpusError
            If a corpus cannot be read, the table lacks a feature of the model, or the reference cannot be used.
        """
        table, healthy = self._tables(data, reference)
        if healthy is None:
            return self._scores(table, None, seed)
        tested, healthy, sentence = choose_reference(table, healthy, self.features)
        return self._scores(tested, healthy, seed, reference=sentence)

    def _scores(
        self, data: xr.Dataset | Waveforms, healthy: xr.Dataset | None, seed: int, reference: str = ""
    ) -> Scores:
        if isinstance(data, Waveforms):
            records = records_of(data, ())
            tested, seen = records.features, int(np.isin(record_digests(records.features), self.digests).sum())
        else:
            model = suited(self, durations_of(data), band_of(data.attrs).high)
            records = labelled_records(data, model.features)
            tested = data.isel(record=data["fault"].values != UNKNOWN_CODE)
            seen = seen_records(records.features.to_numpy()[:, : len(model.features)], model.digests)
        return score(records, predict(tested, self, healthy), seed, seen=seen, reference=reference)[0]

    def _tables(self, data: Data, reference: Data | None) -> tuple[Any, xr.Dataset | None]:
        """Feature tables of the data and of its reference, with ``bands`` if there is one; waveforms as they are."""
        self._check_fitted()
        if _holds_signals(data) and reference is not None and _holds_signals(reference):
            check_durations(data, reference)
        groups = self.groups if reference is None else with_energies(tuple(self.groups))
        sources = [source for source in (data, reference) if source is not None]
        corpora = [source for source in sources if _holds_signals(source)]
        tables = [source for source in sources if isinstance(source, xr.Dataset) and not _holds_signals(source)]
        model = suited_to(self, *corpora) if corpora else self
        # a corpus is compared with a table in the band of the table
        if tables:
            model = suited(self, durations_of(tables[0]), band_of(tables[0].attrs).high)
        # records longer than those of the training are cut, as recordings that are diagnosed
        computed = partial(_feature_table, groups=groups, band=Band(*model.band), window=model.window)
        table, healthy = (
            computed(source) if source is not None and _holds_signals(source) else source
            for source in (data, reference)
        )
        return table, cast("xr.Dataset | None", healthy)

    def _check_fitted(self) -> None:
        if self.estimator is None:
            raise NotFittedError("the model is not fitted; call fit first.")

    def save(self, path: Path | str) -> None:
        """Write a model file, whole or not at all.

        Raises
        ------
        CorpusError
            If the disk refuses the file, it lies in a corpus or is no model, or the model is not one of the baselines: only those can be
            read without running code.
        NotFittedError
            If it is not fitted.
        """
        self._check_fitted()
        if self.name not in BASELINES:
            raise CorpusError(
                f"{path}: {self.name} is no baseline; a model file holds only one of {', '.join(BASELINES)}."
            )
        from features.baselines.model_file import write_model_file  # skops takes a second to load

        check_result(Path(path), "model")
        write_model_file({"raceway_model": FORMAT, **_content(self)}, Path(path))

    @classmethod
    def load(cls, path: Path | str) -> Self:
        """Read a model file; no code of the file runs, but load only models of people you trust.

        Raises
        ------
        CorpusError
            If the file is missing, damaged, larger than the limit, or no model of this version, or a plug-in that it needs is missing.
        """
        from features.baselines.model_file import read_model_file

        content = read_model_file(Path(path))
        if not isinstance(content, dict) or content.pop("raceway_model", None) != FORMAT:
            raise CorpusError(f"{path}: not a model of this version of raceway; train it again with raceway train.")
        return cls.of_content(path, content)

    @classmethod
    def of_content(cls, path: Path | str, content: Mapping[str, Any]) -> Self:
        """Model of the fields in a model file; CorpusError if they are none."""
        stored = isinstance(content, Mapping) and set(content) == {*_STORED, *_PARTS}
        if (
            not stored
            or content["name"] not in [*MAKERS]
            or any(not isinstance(content[name], bytes | None) for name in _PARTS)
        ):
            raise CorpusError(f"{path}: not a complete model; train it again with raceway train.")
        missing = missing_distributions(content["versions"]) or [c for c in content["classes"] if c not in FAULTS]
        if missing:
            raise CorpusError(
                f"{path}: was trained with {', '.join(missing)}, which is not here; install the plug-in, or train it again."
            )
        own = {name: value for name, value in content.items() if name != "name"}
        parts: Any = {name: own[name] and Packed(own[name], path) for name in _PARTS}
        return cls(content["name"], **{**own, **parts, "calibration": Calibration(**content["calibration"])})


def _fit(model: Model, data: xr.Dataset | Waveforms, workers: Workers, done: Callable[[int], None]) -> None:
    records = records_of(data, model.groups)
    if isinstance(data, xr.Dataset):
        model.features, band = features_of(data, model.groups), band_of(data.attrs)
    else:
        model.features, band = (), DEFAULT_BAND
    # refused before the fits, which take minutes
    check_classes(records)
    model.groups, model.band, model.corpus, model.records = (
        tuple(model.groups),
        (band.low, band.high),
        records.title,
        len(records.fault),
    )
    model.estimator, model.calibration = fit_and_calibrate(
        records, model.classifier, model.seed, workers=workers, done=done
    )
    model.classes = fault_names(model.estimator.classes_)
    model.durations = durations_of(data) if isinstance(data, xr.Dataset) else ()
    # a later test tells which records the model has seen
    model.digests = record_digests(records.features.to_numpy() if model.features else records.features)
    model.versions = {library: version(library) for library in _LIBRARIES}
    model.versions |= plugin_versions("features", model.groups) | plugin_versions("classes", model.classes)


def _content(model: Model) -> dict[str, Any]:
    """Fields of a model file; its parts are archives of their own."""
    from features.baselines.model_file import pack

    parts = {name: None if (part := getattr(model, name)) is None else pack(_content(part)) for name in _PARTS}
    return {name: getattr(model, name) for name in _STORED} | {"calibration": model.calibration._asdict()} | parts


def _holds_signals(data: Data) -> TypeGuard[Path | str | xr.Dataset]:
    """Whether features are computed of data first; CorpusError if this is nothing that a model takes."""
    if isinstance(data, Waveforms) or (isinstance(data, xr.Dataset) and "features" in data):
        return False
    if isinstance(data, Path | str | xr.Dataset):
        return True
    raise CorpusError(f"{type(data).__name__} given in place of data; give a feature table, a corpus or waveforms.")


def _feature_table(
    corpus: Path | str | xr.Dataset,
    groups: Sequence[str],
    band: tuple[float, float] = DEFAULT_BAND,
    window: float | None = None,
) -> xr.Dataset:
    """Feature table of a corpus."""
    unknown = [group for group in groups if group not in ALL_GROUPS]
    if unknown:
        raise CorpusError(
            f"{corpus_name(corpus)}: the model takes features of the group {unknown[0]!r}, and the groups are "
            f"{', '.join(ALL_GROUPS)}; train the model again."
        )
    return feature_table(corpus, groups, band=band, window=window)
