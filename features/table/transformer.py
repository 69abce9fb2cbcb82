"""The features of this package as a scikit-learn transformer, for signals outside a corpus.

The transformer is stateless: ``fit`` only stores the number of samples, and ``transform`` does not need it. All signals
have the same sample rate and bearing. They have the same shaft rate, or each its own as metadata: with
``sklearn.set_config(enable_metadata_routing=True)`` and ``transformer.set_transform_request(shaft_rate=True)`` a pipeline
or a cross-validation passes ``shaft_rate`` on.
"""

from collections.abc import Sequence
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import ArrayLike
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.utils import Tags
from sklearn.utils.validation import check_is_fitted, validate_data

from features.signal.rows import FloatArray
from features.table.band import DEFAULT_BAND, checked_band
from features.table.definitions import GROUPS
from features.table.indicators import Orders, feature_names, indicators
from features.table.speed_search import shaft_speed

_FLOATS = (np.float64, np.float32)  # types of signals that are not converted


class IndicatorTransformer(TransformerMixin, BaseEstimator):
    """Signals, shape (record, time), to features, shape (record, feature).

    Features are NaN as in `features.table.indicators.indicators`: all of them for a signal that is constant or not finite,
    lines and shape for a signal that is too short. If your signals can be so, add an imputer after this transformer.

    Parameters
    ----------
    fs
        Sample rate [Hz].
    shaft_rate
        Shaft rate [Hz].
    ftf, bpfo, bpfi, bsf
        Nominal fault orders, by default those of a 6205; ``bsf`` is the ball spin frequency.
    groups
        Some of ``features.table.definitions.GROUPS``.
    band
        Lowest and highest frequency that lines and shape are computed from [Hz].
    speed
        ``off``, or ``correct``: estimate the shaft speed of each signal by itself (`features.shaft_speed`), and use it
        where it is clear. Signals of one recording are not joined, because a transformer treats each row alone.
    """

    def __init__(
        self,
        fs: float = 12_000.0,
        shaft_rate: float = 30.0,
        ftf: float = 0.3983,
        bpfo: float = 3.5848,
        bpfi: float = 5.4152,
        bsf: float = 2.3567,
        groups: Sequence[str] = GROUPS,
        band: tuple[float, float] = (DEFAULT_BAND.low, DEFAULT_BAND.high),
        speed: Literal["off", "correct"] = "off",
    ) -> None:
        self.fs = fs
        self.shaft_rate = shaft_rate
        self.ftf = ftf
        self.bpfo = bpfo
        self.bpfi = bpfi
        self.bsf = bsf
        self.groups = groups
        self.band = band
        self.speed = speed

    def fit(self, X: ArrayLike, y: object = None) -> Self:
        """Store the number of samples of X, shape (record, time)."""
        self._signals(X, reset=True)
        return self

    def fit_transform(  # type: ignore[override]
        self, X: ArrayLike, y: object = None, shaft_rate: ArrayLike | None = None
    ) -> FloatArray:
        """As `fit` and `transform`."""
        return self.fit(X, y).transform(X, shaft_rate)

    def transform(self, X: ArrayLike, shaft_rate: ArrayLike | None = None) -> FloatArray:
        """Features of X, shape (record, time) to (record, feature).

        ``shaft_rate``, shape (record,) [Hz], replaces that of the transformer.
        """
        x = self._signals(X, reset=False)
        records = np.ones(len(x))
        orders = Orders(*(order * records for order in (self.ftf, self.bpfo, self.bpfi, self.bsf)))
        rates = self._shaft_rates(x, self.shaft_rate if shaft_rate is None else shaft_rate)
        values, _ = indicators(x, self.fs, rates, orders, self.groups, checked_band(*self.band))
        return values

    def _shaft_rates(self, x: FloatArray, labelled: ArrayLike) -> FloatArray:
        """Shaft rate of each signal [Hz], shape (record,)."""
        rates = np.broadcast_to(np.asarray(labelled, dtype=float), len(x))
        if self.speed == "off":
            return rates
        if self.speed != "correct":
            message = f"speed: {self.speed!r} is no treatment of shaft speeds; choose off or correct."
            raise ValueError(message)
        orders = (self.ftf, self.bpfo, self.bpfi, self.bsf)
        estimates = [shaft_speed(signal, self.fs, rate, orders) for signal, rate in zip(x, rates, strict=True)]
        return np.where([speed.clear for speed in estimates], [speed.rate for speed in estimates], rates)

    def _signals(self, X: ArrayLike, *, reset: bool) -> FloatArray:
        x: Any = X
        return np.asarray(validate_data(self, x, dtype=_FLOATS, ensure_all_finite=False, reset=reset))

    def get_feature_names_out(self, input_features: object = None) -> np.ndarray:
        """Names of the features, shape (feature,)."""
        check_is_fitted(self, "n_features_in_")
        return np.array(feature_names(self.groups, checked_band(*self.band)), dtype=object)

    def __sklearn_tags__(self) -> Tags:
        tags = super().__sklearn_tags__()
        tags.requires_fit = False
        tags.input_tags.allow_nan = True
        return tags
