"""Counts of the faults that can be seen, as the data card and ``raceway info`` give them."""

import numpy as np
import xarray as xr

from gen.corpus import FAULTS, FaultCounts, fault_counts

INNER, HEALTHY = FAULTS.index("inner"), FAULTS.index("healthy")
COLUMNS = {
    "fault": [INNER, INNER, INNER, INNER, HEALTHY, HEALTHY],
    "detectable": [1, 1, 0, 2, 0, 0],
    "specimen": [0, 0, 1, 2, 3, 3],
    "fault_tries": [2, 2, 0, 1, 0, 0],
    "level_tries": [0, 3, 0, 0, 0, 0],
}


def corpus_of(columns):
    return xr.Dataset({name: ("record", np.array(values)) for name, values in columns.items()})


def test_faults_are_counted_by_record_and_redrawn_faults_by_specimen():
    assert fault_counts(corpus_of(COLUMNS)) == FaultCounts(4, 2, 1, 2, 1)


def test_a_corpus_without_faults_or_of_recordings_has_no_counts():
    healthy = COLUMNS | {"fault": [HEALTHY] * 6}
    assert fault_counts(corpus_of(healthy)) is None
    assert fault_counts(corpus_of({"fault": [INNER], "specimen": [0]})) is None
