"""Memory of the computation of a feature table."""

import os
import tracemalloc

import numpy as np

from features import feature_table
from gen.corpus import SIGNAL, new_corpus
from tests.features.table.test_corpora import part_dataset


def test_memory_beside_the_table_does_not_grow_with_the_parts(tmp_path):
    """What Python and NumPy allocate at the same time is the table and the signals of some parts, not of all."""
    dataset = part_dataset(0, np.random.default_rng(0))
    peaks = []
    for parts in (48, 96):
        folder = tmp_path / f"{parts}"
        with new_corpus(folder, title="many") as corpus:
            for _ in range(parts):
                corpus.write(dataset)
        for part in folder.rglob("*.nc"):
            os.utime(part, (0, 0))  # hashes of files that have just changed are computed each time
        feature_table(folder)
        tracemalloc.start()
        held = feature_table(folder).nbytes
        peaks.append(tracemalloc.get_traced_memory()[1] - held)
        tracemalloc.stop()
    assert peaks[1] - peaks[0] < 48 * dataset[SIGNAL].nbytes / 10
