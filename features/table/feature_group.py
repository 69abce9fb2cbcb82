"""The form of a feature group, built-in or of a plug-in: its features, and the function that computes them.

A group has no name of its own: it is the key in `features.table.definitions.BUILT_IN`, or the name of an entry point.
"""

from collections.abc import Callable
from math import inf
from typing import NamedTuple

import numpy as np

from features.table.band import Band
from features.table.record_batch import RecordBatch


class Feature(NamedTuple):
    """Definition of a feature; its values lie between ``least`` and ``most``, or are NaN."""

    name: str
    meaning: str
    formula: str
    group: str = ""
    unit: str = "1"
    parameters: str = ""
    source: str = ""
    least: float = -inf
    most: float = inf

    @property
    def range(self) -> str:
        """Range as text."""
        if self.most < inf:
            return f"{self.least:g} to {self.most:g}"
        return f">= {self.least:g}" if self.least > -inf else "any"


class FeatureGroup(NamedTuple):
    """Features that are computed and named together."""

    features: tuple[Feature, ...] | Callable[[Band], tuple[Feature, ...]]
    """In the order of the values; a function of the band if their number depends on it."""
    compute: Callable[[RecordBatch], np.ndarray]
    """Values of the records of a batch, shape (record, feature)."""

    def features_in(self, band: Band) -> tuple[Feature, ...]:
        """The features, with a band."""
        return self.features(band) if callable(self.features) else self.features
