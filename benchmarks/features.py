"""Time to compute the features of a record, compared with TSFEL, on signals of one second at 12.8 kHz, one core.

Our features are levels at fault orders in six envelope spectra; the spectral and statistical domains of TSFEL are not specific to
bearings. The row states the number of features of each.
"""

import importlib
import importlib.util
from collections.abc import Iterator

import numpy as np

from benchmarks.pairs import Line, Skipped, interleaved, row, seconds
from features.indicators import Orders, feature_names, indicators
from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE

FS, SAMPLES, SHAFT_RATE = 12_800.0, 12_800, 29.95


def rows(pairs: int = 5, *, records: int = 128, theirs: int = 16) -> Iterator[Line]:
    """Lines of the table; ``records`` per call for our features, ``theirs`` for TSFEL."""
    if not importlib.util.find_spec("tsfel"):
        yield Skipped("features tsfel", "tsfel is not installed; pip install 'raceway[bench]'.")
        return
    tsfel = importlib.import_module("tsfel")
    domains = tsfel.get_features_by_domain(["spectral", "statistical"])
    x = np.random.default_rng(0).standard_normal((records, SAMPLES))
    rates = np.full(records, SHAFT_RATE)
    nominal = Orders(*(np.full(records, order) for order in orders(CATALOGUE["6205"])))

    def extract(record: np.ndarray) -> int:
        return tsfel.time_series_features_extractor(domains, record, fs=FS, verbose=0).shape[1]

    found = interleaved(
        pairs,
        ours=lambda: records / seconds(indicators, x, FS, rates, nominal),
        tsfel=lambda: theirs / seconds(lambda: [extract(record) for record in x[:theirs]]),
    )
    alternative = f"TSFEL, spectral and statistical ({extract(x[0])})"
    yield row(
        "features tsfel",
        f"all groups ({len(feature_names())})",
        "records/s",
        found["ours"],
        alternative,
        found["tsfel"],
    )
