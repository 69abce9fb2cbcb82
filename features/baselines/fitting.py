"""Fits of one classifier to several selections of records.

A fit draws from its own seed, so its result does not depend on the number of workers.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from threadpoolctl import threadpool_limits

from features.baselines.estimators import Estimator, class_probabilities, make_estimator
from features.baselines.own import Maker
from features.baselines.records import FloatArray, IntArray
from features.baselines.tracks import Split
from gen.support.executor import Workers, run

if TYPE_CHECKING:
    from pandas import DataFrame


def fits(
    features: "DataFrame",
    labels: IntArray,
    estimator: str | Maker,
    splits: Sequence[Split],
    seed: int,
    *,
    workers: Workers = 1,
    done: Callable[[int], None] = lambda _: None,
) -> list[tuple[Estimator, FloatArray]]:
    """Fit a classifier to the training records of each split, and predict the tested ones.

    Parameters
    ----------
    features
        A row per record: a data frame, or waveforms.
    labels
        Indices into ``gen.corpus.FAULTS``, shape (record,).
    estimator
        Name of a baseline, or a classifier of the user, which is fitted once at a time.
    splits
        Numbers of the training records and of the tested ones, ascending.
    seed
        Of the estimator.
    workers
        Where baselines are fitted, as for `gen.support.executor.run`; a classifier of the user is fitted in this process.
    done
        Called with 1 after each fit.

    Returns
    -------
    Fitted estimator of each split, and its probabilities of the tested records, shape (record, class); empty if none is tested.
    """
    fitted, fit_one = list[tuple[Estimator, FloatArray]](), partial(_fit, features, labels, estimator, seed)
    for fit in run(fit_one, splits, workers if isinstance(estimator, str) else 1):
        fitted.append(fit)
        done(1)
    return fitted


def _fit(
    features: "DataFrame", labels: IntArray, estimator: str | Maker, seed: int, split: Split
) -> tuple[Estimator, FloatArray]:
    train, test = split
    # a classifier of the user may write into its rows, so it gets a copy
    rows = features if len(train) == len(labels) and isinstance(estimator, str) else features.take(train)
    # matrices of some thousand rows: the threads of BLAS take three times the processor time and no less of the clock
    with threadpool_limits(1 if isinstance(estimator, str) else None, "blas"):
        fitted = make_estimator(estimator, seed).fit(rows, labels[train])
        del rows
        none = np.zeros((0, len(fitted.classes_)))
        return fitted, class_probabilities(fitted, features.take(test)) if len(test) else none
