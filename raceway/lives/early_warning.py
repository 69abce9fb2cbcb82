"""Early warning: how soon after a spall can first be seen a detector gives alarm, at a fixed rate of false alarms.

A detector gives each snapshot a number. Its threshold is set on bearings of the training, so that their snapshots before the spall begins
exceed it at the wanted rate, and is tried on other bearings. The delay counts from the first snapshot in which the spall can be seen, which
is known by the twin of the record, the same machine without the spall: nothing can be earlier but by chance.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from sklearn.model_selection import GroupKFold

from features.baselines import DEFAULT_ESTIMATOR
from features.baselines.estimators import class_probabilities, make_estimator
from features.baselines.own import Maker, maker_name
from features.baselines.records import IntArray
from gen.corpus import FAULTS
from gen.corpus.fault_classes import HEALTHY
from gen.support.errors import CorpusError
from gen.support.units import from_si
from raceway.lives.prognosis import in_order, specimens_of
from raceway.lives.survival import BoolArray, FloatArray

FEATURES = ("raw_kurtosis", "whitened_highest_line")
"""Detectors without training: impulsiveness, and the highest fault line of the envelope."""


class Watched(NamedTuple):
    """Snapshots of some bearings in rising age for each, shape (snapshot,) each."""

    features: pd.DataFrame
    """Shape (snapshot, feature)."""
    fault: IntArray
    """Code of the class that can be seen."""
    bearing: IntArray
    age: FloatArray
    intact: BoolArray
    seen_from: FloatArray
    """Age at which the spall of the bearing can first be seen, NaN if never [s]."""

    def some(self, places: IntArray) -> "Watched":
        """Some of the snapshots."""
        columns = {name: values[places] for name, values in self._asdict().items() if name != "features"}
        return self._replace(features=self.features.iloc[places], **columns)


Detector = Callable[[Watched, Watched], tuple[FloatArray, FloatArray]]
"""Numbers of the snapshots of the training and of the test, shape (snapshot,) each."""


def warn_early(
    table: xr.Dataset,
    tested: xr.Dataset | None = None,
    *,
    estimator: str | Maker = DEFAULT_ESTIMATOR,
    alarms_per_1000_h: float = 1.0,
    folds: int = 5,
    seed: int = 0,
) -> pd.DataFrame:
    """Alarms and delays of detectors on bearings that they were not trained on.

    Parameters
    ----------
    table
        Feature table of a corpus of lives that were simulated with twins.
    tested
        Feature table of other bearings; by default the bearings of ``table`` are tested in folds.
    estimator
        Name of a baseline, or a classifier of your own; its number is the probability of a fault.
    alarms_per_1000_h
        Wanted number of snapshots above the threshold in 1,000 h of bearings without a spall.
    folds, seed
        Number of splits, none of which parts the snapshots of a bearing, and seed of the estimator.

    Returns
    -------
    DataFrame
        One row for each detector. ``alarms_per_1000_h`` of the tested bearings before their spalls begin; ``missed``, the share of bearings
        with a visible spall that get no alarm; ``delay`` beyond the first snapshot in which it can be seen, the median [s]; and
        ``time_left``, the share that is left then of the time from there to the last snapshot, the median.

    Raises
    ------
    CorpusError
        If a table has no lives, or it is not known when a spall can be seen.
    """
    watched = _watched(table)
    detectors: dict[str, Detector] = {name: _of_feature(name) for name in FEATURES if name in watched.features}
    detectors[estimator if isinstance(estimator, str) else maker_name(estimator)] = _of_classifier(estimator, seed)
    if tested is not None:
        pairs = [(watched, _watched(tested))]
    else:
        splits = GroupKFold(folds, shuffle=True, random_state=0).split(watched.age, groups=watched.bearing)
        pairs = [(watched.some(train), watched.some(test)) for train, test in splits]
    rows = {}
    for name, detector in detectors.items():
        hours, false, delays = 0.0, 0, list[tuple[float, float]]()
        for train, test in pairs:
            numbers, tried = detector(train, test)
            above = tried > _threshold(numbers[train.intact], alarms_per_1000_h * _hours(train) / 1000)
            hours, false = hours + _hours(test), false + int(above[test.intact].sum())
            delays += _delays(test, above)
        late, left = np.array(delays).T
        found = np.isfinite(late)
        rows[name] = {
            "alarms_per_1000_h": 1000 * false / hours if hours else np.nan,
            "missed": float(np.mean(~found)),
            "delay": float(np.median(late[found])) if found.any() else np.nan,
            "time_left": float(np.median(left[found])) if found.any() else np.nan,
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def knows_what_is_seen(table: xr.Dataset) -> bool:
    """Whether a feature table knows of any bearing when its spall can first be seen."""
    return "first_detectable_time" in table and bool(np.isfinite(table["first_detectable_time"].values).any())


def _watched(table: xr.Dataset) -> Watched:
    of = in_order(table, "the feature table")
    if not knows_what_is_seen(of):
        raise CorpusError(
            "the feature table does not know when spalls can first be seen; early warning needs simulated lives with truth.twins: true."
        )
    age, seen_from = of["age"].values, of["first_detectable_time"].values
    # a spall that cannot be seen yet is nothing to learn from
    fault = np.where(age >= seen_from, of["fault"].values, FAULTS.index(HEALTHY))
    names = [str(name) for name in of["feature"].values]
    features = pd.DataFrame(of["features"].transpose("record", "feature").values, columns=names)
    return Watched(features, fault, specimens_of(of), age, of["stage"].values == 0, seen_from)


def _of_feature(name: str) -> Detector:
    return lambda train, test: (train.features[name].to_numpy(), test.features[name].to_numpy())


def _of_classifier(estimator: str | Maker, seed: int) -> Detector:
    def detect(train: Watched, test: Watched) -> tuple[FloatArray, FloatArray]:
        fitted = make_estimator(estimator, seed).fit(train.features, train.fault)
        sound = fitted.classes_ == FAULTS.index(HEALTHY)
        of_train, of_test = (
            1 - class_probabilities(fitted, some.features)[:, sound].sum(axis=1) for some in (train, test)
        )
        return of_train, of_test

    return detect


def _threshold(numbers: FloatArray, exceedances: float) -> float:
    """Number that so many of some are above, rounded down."""
    return float(np.sort(numbers)[max(len(numbers) - 1 - int(exceedances), 0)])


def _hours(watched: Watched) -> float:
    """Time that bearings run before their spalls begin [h]."""
    steps = np.diff(watched.age)
    together = (np.diff(watched.bearing) == 0) & watched.intact[1:]
    return float(from_si(steps[together].sum(), "h"))


def _delays(watched: Watched, above: BoolArray) -> list[tuple[float, float]]:
    """Delay of the alarm of each bearing whose spall can be seen, infinite without one [s], and the share of the time that is left then."""
    delays = []
    for bearing in np.unique(watched.bearing[np.isfinite(watched.seen_from)]):
        own = (watched.bearing == bearing) & (watched.age >= watched.seen_from)
        age = watched.age[own]
        if len(age):
            alarm = age[above[own]].min(initial=np.inf)
            span = max(age[-1] - age[0], 1e-9)
            delays.append((alarm - age[0], max(1 - (alarm - age[0]) / span, 0.0)))
    return delays
