"""Early warning: how soon after a spall can first be seen a detector gives alarm, at a fixed rate of false alarms.

A detector gives each snapshot a number. Its threshold is set on bearings of the training, so that their snapshots before the spall begins
exceed it at the wanted rate, and is tried on other bearings. A classifier is too sure of the bearings that it was fitted to, so each
bearing of the training gets its numbers from a fit to others. The delay counts from the first snapshot in which the spall can be seen,
which is known by the twin of the record, the same machine without the spall: nothing can be earlier but by chance.
"""

from collections.abc import Callable
from numbers import Real
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from features.baselines import DEFAULT_ESTIMATOR
from features.baselines.estimators import class_probabilities, make_estimator
from features.baselines.own import Maker, maker_name
from features.baselines.records import IntArray
from gen.corpus import FAULTS, specimen_numbers
from gen.corpus.fault_classes import HEALTHY, UNKNOWN_CODE
from gen.support.errors import CorpusError
from gen.support.units import from_si
from raceway.lives.prognosis import bearing_folds, check_others, in_order
from raceway.lives.survival import BoolArray, FloatArray

FEATURES = ("raw_kurtosis", "whitened_highest_line")
"""Detectors without training: impulsiveness, and the highest fault line of the envelope."""

_HELD_OUT = 5  # splits of a training for the threshold of a classifier, at most


class Watched(NamedTuple):
    """Snapshots of some bearings in rising age for each, shape (snapshot,) each."""

    features: pd.DataFrame
    """Shape (snapshot, feature)."""
    fault: IntArray
    """Code of the class that can be seen; that of unknown where the stage of the damage is not known."""
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
"""Numbers of the snapshots of the training, for the threshold, and of the test, shape (snapshot,) each; NaN where there is none."""


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
        with a visible spall that get no alarm; ``delay`` beyond the first snapshot in which it can be seen, the median [s], and
        ``delay_90``, which nine of ten alarms do not exceed; ``time_left``, the share that is left then of the time from there to the last
        snapshot, the median; and ``allowed``, the alarms by which the threshold was set, in the shortest training: below 1 it is the
        highest number before any spall, and the rate may be higher than wanted.

    Raises
    ------
    CorpusError
        If a table has no lives, it is not known when a spall can be seen, the tables have a bearing in common or other features, a
        training has one bearing, or no snapshot before spalls or of visible ones is there to train or test on.
    """
    if not isinstance(alarms_per_1000_h, Real) or not 0 <= alarms_per_1000_h < np.inf:
        raise CorpusError(f"alarms_per_1000_h: {alarms_per_1000_h!s:.60} is not a finite number from 0; use 1 or so.")
    watched = _watched(table, "the feature table")
    detectors: dict[str, Detector] = {name: _of_feature(name) for name in FEATURES if name in watched.features}
    name_of_estimator = estimator if isinstance(estimator, str) else maker_name(estimator)
    detectors[name_of_estimator] = _of_classifier(estimator, seed)
    if tested is not None:
        pairs = [(watched, _watched(tested, "the table of the tested bearings"))]
        check_others(table, tested)
    else:
        splits = bearing_folds(watched.bearing, folds)
        pairs = [(watched.some(train), watched.some(test)) for train, test in splits]
    # each bearing of a training gets its numbers from a fit to others
    if min(len(np.unique(train.bearing)) for train, _ in pairs) < 2:
        raise CorpusError("a training has one bearing; use more bearings.")
    if not all(train.intact.any() for train, _ in pairs):
        raise CorpusError("a training has no snapshot before spalls begin; use more bearings.")
    if not any((test.age >= test.seen_from).any() for _, test in pairs):
        raise CorpusError("no tested bearing has a spall that can be seen; test more bearings.")
    allowed = [alarms_per_1000_h * _hours(train) / 1000 for train, _ in pairs]
    rows = {}
    for name, detector in detectors.items():
        hours, false, delays = 0.0, 0, list[tuple[float, float]]()
        for (train, test), exceedances in zip(pairs, allowed, strict=True):
            numbers, tried = detector(train, test)
            above = tried > _threshold(numbers[train.intact], exceedances)
            hours, false = hours + _hours(test), false + int(above[test.intact].sum())
            delays += _delays(test, above)
        late, left = np.array(delays).T
        warned = np.isfinite(late)
        rows[name] = {
            "alarms_per_1000_h": 1000 * false / hours if hours else np.nan,
            "missed": float(np.mean(~warned)),
            "delay": float(np.median(late[warned])) if warned.any() else np.nan,
            "delay_90": float(np.quantile(late[warned], 0.9)) if warned.any() else np.nan,
            "time_left": float(np.median(left[warned])) if warned.any() else np.nan,
            "allowed": min(allowed),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def check_seen(records: xr.Dataset, name: str) -> None:
    """Refuse lives, or their table, of which it is not known when a spall can first be seen, with a ``name`` for the sentence.

    Raises
    ------
    CorpusError
        If it is known of no bearing.
    """
    if "first_detectable_time" not in records or not np.isfinite(records["first_detectable_time"].values).any():
        raise CorpusError(
            f"{name}: knows of no spall when it can first be seen; early warning needs simulated lives with truth.twins: true."
        )


def _watched(table: xr.Dataset, name: str) -> Watched:
    of = in_order(table, name)
    check_seen(of, name)
    age, seen_from = of["age"].values, of["first_detectable_time"].values
    # a spall that cannot be seen yet is nothing to learn from
    fault = np.where(age >= seen_from, of["fault"].values, FAULTS.index(HEALTHY))
    fault[~np.isin(of["stage"].values, (0, 1, 2))] = UNKNOWN_CODE
    names = [str(feature) for feature in of["feature"].values]
    features = pd.DataFrame(of["features"].transpose("record", "feature").values, columns=names)
    return Watched(features, fault, specimen_numbers(of), age, of["stage"].values == 0, seen_from)


def _of_feature(name: str) -> Detector:
    return lambda train, test: (train.features[name].to_numpy(), test.features[name].to_numpy())


def _of_classifier(estimator: str | Maker, seed: int) -> Detector:
    def numbers_of(fitted_to: Watched, others: Watched) -> FloatArray:
        """Probability of a fault in snapshots of others."""
        lives = fitted_to.some(np.flatnonzero(fitted_to.fault != UNKNOWN_CODE))
        if len(np.unique(lives.fault)) < 2:
            raise CorpusError("a training has no two classes to tell apart; use more bearings.")
        fitted = make_estimator(estimator, seed).fit(lives.features, lives.fault)
        sound = fitted.classes_ == FAULTS.index(HEALTHY)
        return 1 - class_probabilities(fitted, others.features)[:, sound].sum(axis=1)

    def detect(train: Watched, test: Watched) -> tuple[FloatArray, FloatArray]:
        # no bearing of the training has numbers from a fit to itself
        held_out = np.empty(len(train.age))
        for rest, own in bearing_folds(train.bearing, min(_HELD_OUT, len(np.unique(train.bearing)))):
            held_out[own] = numbers_of(train.some(rest), train.some(own))
        return held_out, numbers_of(train, test)

    return detect


def _threshold(numbers: FloatArray, exceedances: float) -> float:
    """Number that so many of some are above, rounded down; infinite if there are none."""
    known = np.sort(numbers[~np.isnan(numbers)])
    return float(known[max(len(known) - 1 - int(exceedances), 0)]) if len(known) else np.inf


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
