"""A stored corpus compared with the stream: as many gradient steps of a network, or trees, on more and more fresh records.

``python -m benchmarks.streamed REAL DIR`` with REAL a folder that holds ``cwru`` and ``uestc`` as their providers publish them, and DIR a
folder that keeps the features of the streams. The current folder must hold ``cnn.py``, the network of docs/classifiers.md, which needs
PyTorch; without it only the ensemble is trained. Prints means over three seeds, and the range, after twenty minutes of one core.
"""

import argparse
import importlib
import itertools
import tempfile
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numpy as np
import xarray as xr

import gen
from features import Model, envelope_orders, feature_table, open_waveforms
from features.baselines import DEFAULT_GROUPS
from features.baselines.calibration import UNCALIBRATED
from features.baselines.predictions import predictions
from features.baselines.records import labelled_records
from features.baselines.scores import Scores, score
from features.table.table_files import read_table, write_table
from raceway.importing import import_set

RECIPE, SEEDS, UNSEEN = "domain_randomised", (20260, 20261), 20299
WINDOWS = {3000: 4500, 6000: 3000, 12_000: 0}  # records: distance of the windows of two seeds in both streams
CLASSES = ("healthy", "inner", "outer", "ball")
BATCH = 750
EPOCHS = 8  # of 3,000 records; with more of them fewer epochs, and as many steps


class Known(NamedTuple):
    table: xr.Dataset  # of features
    levels: np.ndarray  # the input of the network


def known(records: xr.Dataset | Path) -> Known:
    waveforms = open_waveforms(records)
    return Known(feature_table(records, DEFAULT_GROUPS), envelope_orders(waveforms, waveforms.operating))


def joined(parts: Sequence[Known]) -> Known:
    tables, levels = zip(*parts, strict=True)
    return Known(xr.concat(tables, "record", combine_attrs="drop_conflicts"), np.concatenate(levels))


def streamed(seed: int, records: int, folder: Path) -> Known:
    """The first records of a stream; a folder of it goes on where it ended."""
    folder.mkdir(parents=True, exist_ok=True)
    parts = [Known(read_table(path), np.load(path.with_suffix(".npy"))) for path in sorted(folder.glob("*.nc"))]
    start = int(parts[-1].table["recording"].values[-1]) + 1 if parts else 0
    with gen.stream(RECIPE, batch=BATCH, seed=seed, start=start) as fresh:
        while sum(len(part.levels) for part in parts) < records:
            parts.append(known(next(fresh)))
            path = folder / f"{len(parts):03}.nc"
            np.save(path.with_suffix(".npy"), parts[-1].levels)
            write_table(parts[-1].table, path)
    return part(joined(parts), 0, records)


def part(whole: Known, start: int, records: int) -> Known:
    rows = slice(start, start + records)
    return Known(whole.table.isel(record=rows), whole.levels[rows])


def network_scores(cnn: ModuleType, taught: Known, seed: int, tests: dict[str, Known]) -> list[float]:
    cnn.EPOCHS = round(EPOCHS * 3000 / len(taught.levels))
    network = cnn.train(taught.levels, taught.table["fault"].values, seed)
    values: list[float] = []
    for table, levels in tests.values():
        with cnn.torch.no_grad():
            parts = [network(part).softmax(1).numpy() for part in cnn.torch.from_numpy(levels).split(256)]
        rows = labelled_records(table, ())
        values += figures(score(rows, predictions(np.concatenate(parts), CLASSES, rows.recording, UNCALIBRATED))[0])
    return values


def ensemble_scores(taught: Known, seed: int, tests: dict[str, Known]) -> list[float]:
    model = Model("ensemble", seed=seed).fit(taught.table)
    return [value for test in tests.values() for value in figures(model.score(test.table))]


def figures(scores: Scores) -> list[float]:
    """Balanced accuracies by window and by recording."""
    return [scores.balanced_accuracy, (scores.by_recording or scores).balanced_accuracy]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    parser.add_argument("folder", type=Path)
    real, folder = vars(parser.parse_args()).values()
    teach = {"ensemble": ensemble_scores}
    try:
        teach["network"] = partial(network_scores, importlib.import_module("cnn"))
    except ModuleNotFoundError as error:
        print(f"No module {error.name}: the network is left out; it is in docs/classifiers.md and needs PyTorch.")
    with tempfile.TemporaryDirectory() as name:
        cwru = import_set("cwru", real / "cwru", Path(name) / "cwru").path
        uestc = import_set("uestc", real / "uestc", Path(name) / "uestc").path
        tests = {path.name: known(path) for path in (cwru, uestc)}
    tests["unseen rigs"] = streamed(UNSEEN, 3000, folder / str(UNSEEN))
    streams = [streamed(seed, 6000, folder / str(seed)) for seed in SEEDS]
    streams[1].table["rig"] += 10_000  # more than the first stream has
    whole = joined(streams)
    print(f"| trained on | {' | '.join(f'{name} | by recording' for name in tests)} |\n|---|{'---:|' * 2 * len(tests)}")
    for name, (records, step) in itertools.product(teach, WINDOWS.items()):
        of_parts = [teach[name](part(whole, k * step, records), k, tests) for k in range(3)]
        cells = [
            f"{np.mean(seeds):.3f} ({min(seeds):.3f} to {max(seeds):.3f})" for seeds in zip(*of_parts, strict=True)
        ]
        print(f"| {name}, {records:,} records | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
