"""Feature table of one recording that lies in no corpus.

The recording is cut into windows, which become the records of the table.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from features.signal.rows import FloatArray
from features.table.band import DEFAULT_BAND, Band, band_attributes
from features.table.definitions import GROUPS, feature_coordinates
from features.table.durations import DURATION
from features.table.indicators import Orders, indicators

if TYPE_CHECKING:
    import xarray as xr


def recording_table(
    windows: FloatArray,
    fs: float,
    shaft_rate: float,
    orders: Orders,
    fault: int,
    groups: Sequence[str] = GROUPS,
    band: Band = DEFAULT_BAND,
) -> "xr.Dataset":
    """Features of the windows of one recording.

    Parameters
    ----------
    windows
        Shape (window, time).
    fs, shaft_rate
        [Hz]
    orders
        Nominal fault orders, as numbers.
    fault
        Code of the class of all windows.
    groups
        Some of ``features.table.definitions.GROUPS``.
    band
        Band that lines and shape are computed from.

    Returns
    -------
    A table as of `features.table.corpus_features.feature_table`, with the variables that a prediction needs.

    Raises
    ------
    ValueError
        For a group that does not exist.
    """
    import xarray as xr  # not at the top: it takes long to load

    values, _ = indicators(windows, fs, shaft_rate, orders, groups, band)
    # all windows are of one recording of one bearing
    same = dict.fromkeys(("rig", "specimen", "recording"), np.int32(0)) | {"fault": np.int8(fault)}
    same |= {DURATION: windows.shape[1] / fs, "sample_rate": fs, "shaft_rate": shaft_rate, **orders._asdict()}
    return xr.Dataset(
        {"features": (("record", "feature"), values)}
        | {name: ("record", np.full(len(windows), value)) for name, value in same.items()},
        feature_coordinates(groups, band),
        {"title": "recording", **band_attributes(band)},
    )
