"""How far the colour of recordings is from that of a healthy recording of their machine.

``python -m benchmarks.colour REAL`` with REAL a folder that holds ``cwru``, ``mfpt`` and ``uestc`` as their providers publish them. Every
recording is compared with the healthy one that is nearest in speed, a healthy one with another. The table has the least, the median and the
largest distance of each class, without gain and without frequencies below 200 Hz.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.speed import real_corpora
from features import feature_table
from features.baselines.colour_distance import COUNTED, distance
from features.baselines.records import feature_rows
from features.signal.rows import group_means
from features.table.recording_speeds import recording_numbers
from gen.corpus import FAULTS

HEALTHY = FAULTS.index("healthy")


def distances(corpus: Path) -> dict[str, list[float]]:
    """Distances of the recordings of a corpus [dB], by class."""
    table = feature_table(corpus, ("bands",))
    number = recording_numbers(table)
    _, first = np.unique(number, return_index=True)
    energies = group_means(feature_rows(table, COUNTED).to_numpy(), number)
    fault, speed = table["fault"].values[first], np.log(table["shaft_rate"].values[first])
    of_class: dict[str, list[float]] = {}
    for tested in range(len(fault)):
        healthy = np.flatnonzero((fault == HEALTHY) & (np.arange(len(fault)) != tested))
        if healthy.size:
            nearest = healthy[np.abs(speed[healthy] - speed[tested]).argmin()]
            of_class.setdefault(FAULTS[fault[tested]], []).append(float(distance(energies[tested] - energies[nearest])))
    return of_class


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    options = parser.parse_args()
    print("| set | class | recordings | least, dB | median, dB | largest, dB |")
    print("|---|---|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as name:
        for title, corpus in real_corpora(options.real, Path(name)).items():
            for fault, of_class in distances(corpus).items():
                values = " | ".join(f"{value:.1f}" for value in np.quantile(of_class, [0, 0.5, 1]))
                print(f"| {title} | {fault} | {len(of_class)} | {values} |")


if __name__ == "__main__":
    main()
