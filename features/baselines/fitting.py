"""Fits of one classifier to several selections of records, some of them at a time.

Trees and Fourier transforms run without the interpreter lock, so the fits share the features in threads of this process. A fit draws from
its own seed and predicts in one thread, so its result does not depend on the number of workers.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from threadpoolctl import threadpool_limits

from features.baselines.estimators import Estimator, class_probabilities, make_estimator
from features.baselines.own import Maker
from features.baselines.records import FloatArray, IntArray
from features.baselines.tracks import Split
from gen.support.workers import MOST_THREADS, run

if TYPE_CHECKING:
    from pandas import DataFrame


def fits(
    features: "DataFrame",
    labels: IntArray,
    estimator: str | Maker,
    splits: Sequence[Split],
    seed: int,
    *,
    workers: int = 1,
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
        Number of fits at a time; each needs its own copy of the training records. At most ``MOST_THREADS`` are used.
    done
        Called with 1 after each fit.

    Returns
    -------
    Fitted estimator of each split, and its probabilities of the tested records, shape (record, class); empty if none is tested.
    """
    workers = min(workers, MOST_THREADS, len(splits)) if isinstance(estimator, str) else 1
    by_number: dict[int, tuple[Estimator, FloatArray]] = {}
    fit_one = partial(_fit, features, labels, estimator, seed)
    # matrices of some thousand rows: the threads of BLAS take three times the processor time and no less of the clock
    with threadpool_limits(1 if isinstance(estimator, str) else None, "blas"):
        for number, fit in run(fit_one, enumerate(splits), workers=max(workers, 1)):
            by_number[number] = fit
            done(1)
    return [by_number[number] for number in range(len(splits))]


def _fit(
    features: "DataFrame", labels: IntArray, estimator: str | Maker, seed: int, numbered: tuple[int, Split]
) -> Iterator[tuple[int, tuple[Estimator, FloatArray]]]:
    number, (train, test) = numbered
    # a classifier of the user may write into its rows, so it gets a copy
    rows = features if len(train) == len(labels) and isinstance(estimator, str) else features.take(train)
    fitted = make_estimator(estimator, seed).fit(rows, labels[train])
    del rows
    none = np.zeros((0, len(fitted.classes_)))
    yield number, (fitted, class_probabilities(fitted, features.take(test)) if len(test) else none)
