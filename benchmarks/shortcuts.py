"""How well features that no analyst would use tell faulty records of a corpus from healthy ones: shortcuts that a network could learn.

``python -m benchmarks.shortcuts [CORPUS or RECIPE]``; a recipe, by default ``domain_randomised``, is generated into a temporary folder.
Each shortcut of one to four numbers is scored by the AUC of extra trees, cross-validated by rig. The null is the same with the labels
permuted between the bearings of each rig, so that a rig keeps its share of faults and the records of a bearing have one label.

An impulsive record has small samples beside its rms nearly everywhere, so the first and last samples are to be compared with four from the
middle. Tries are provenance, which neither features nor estimators nor data loaders get as input.
"""

import argparse
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import rfft
from scipy.stats import kurtosis
from sklearn.ensemble import ExtraTreesClassifier
from sklearn.metrics import roc_auc_score
from sklearn.model_selection import GroupKFold, cross_val_predict

from features import open_waveforms
from gen import generate, read_recipe
from gen.corpus import FAULTS, UNKNOWN_CODE, is_single_file, specimen_numbers

FloatArray = NDArray[np.float64]

STORED = {"tries": ("fault_tries", "level_tries"), "clipped samples": ("clipped",)}
"""Shortcuts that are variables of simulated corpora."""
KURTOSIS = "kurtosis, balls against healthy"
"""Impulsiveness alone, scored on healthy records and those with a fault of a ball: recorded balls are hardly impulsive."""
LOWEST_HZ, HIGHEST = 20.0, 0.9  # bounds of the shares of power: the upper one over half the sample rate
FOLDS = 5
TINY = 1e-30


def in_signal(x: FloatArray, fs: float) -> dict[str, FloatArray]:
    """Shortcuts in a signal of shape (time,), by name."""
    rms, mean, middle = x.std() + TINY, x.mean(), len(x) // 2
    power = np.square(np.abs(rfft(x - mean)))
    share = power / (power.sum() + TINY)
    frequency = np.arange(len(share)) * fs / len(x)
    low, high = (np.log(share[place].sum() + TINY) for place in (frequency < LOWEST_HZ, frequency > HIGHEST * fs / 2))
    return {
        "mean over rms": np.array([abs(mean) / rms]),
        "first and last samples over rms": np.abs(x[[0, 1, -2, -1]]) / rms,
        "middle samples over rms": np.abs(x[middle - 2 : middle + 2]) / rms,
        f"power above {HIGHEST:g} of half the sample rate": np.array([high]),
        f"power below {LOWEST_HZ:g} Hz": np.array([low]),
        "rms": np.array([rms]),
        KURTOSIS: np.array([kurtosis(x, fisher=False)]),
    }


class Shortcuts(NamedTuple):
    """Records with a known class: shortcuts of shape (record, number), by name; whether faulty, machine and bearing, shape (record,)."""

    shortcuts: dict[str, FloatArray]
    faulty: NDArray[np.bool_]
    rig: NDArray[np.int_]
    specimen: NDArray[np.int_]
    ball: NDArray[np.bool_]
    """Whether the fault is that of a ball."""

    def some(self, where: NDArray[np.bool_]) -> "Shortcuts":
        """Some of the records."""
        shortcuts, *columns = self
        return Shortcuts(
            {name: values[where] for name, values in shortcuts.items()}, *(values[where] for values in columns)
        )


def read_records(corpus: Path | str) -> Shortcuts:
    """Shortcuts in the first channel of all records with a known class, and in the variables that the corpus has."""
    waveforms = open_waveforms(corpus)
    waveforms = waveforms.take(np.flatnonzero(waveforms.labels["fault"].values != UNKNOWN_CODE))
    labels, fs = waveforms.labels, waveforms.labels["sample_rate"].values
    each = [in_signal(x.astype(float), fs) for x, fs in zip(waveforms, fs, strict=True)]
    shortcuts = {name: np.stack([of_record[name] for of_record in each]) for name in each[0]}
    for name, variables in STORED.items():
        if all(variable in labels for variable in variables):
            shortcuts[name] = np.stack([labels[variable].values for variable in variables], axis=1)
    fault = labels["fault"].values
    faulty, ball = fault != FAULTS.index("healthy"), fault == FAULTS.index("ball")
    return Shortcuts(shortcuts, faulty, labels["rig"].values, specimen_numbers(labels), ball)


def permuted(records: Shortcuts, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Labels after those of the specimens of each rig changed places, shape (record,)."""
    _, first, own = np.unique(records.specimen, return_index=True, return_inverse=True)
    label, rig = records.faulty[first], records.rig[first]
    for each in np.unique(rig):
        label[rig == each] = rng.permutation(label[rig == each])
    return label[own]


def score(values: FloatArray, faulty: NDArray[np.bool_], rig: NDArray[np.int_], seed: int) -> float:
    """AUC of extra trees on ``values`` of shape (record, number), with the records of a rig in one fold."""
    trees = ExtraTreesClassifier(100, min_samples_leaf=10, random_state=seed)
    scores = np.asarray(
        cross_val_predict(trees, values, faulty, groups=rig, cv=GroupKFold(FOLDS), method="predict_proba")
    )
    return float(roc_auc_score(faulty, scores[:, 1]))


def scores(records: Shortcuts, seed: int, permutations: int) -> Iterator[tuple[str, float, list[float]]]:
    """Name of each shortcut, its AUC, and those with permuted labels."""
    balls = records.some(~records.faulty | records.ball)
    for name in records.shortcuts:
        of, rng = (balls if name == KURTOSIS else records), np.random.default_rng(seed)
        labels = [permuted(of, rng) for _ in range(permutations)]
        values = of.shortcuts[name]
        null = [score(values, label, of.rig, seed) for label in labels]
        yield name, score(values, of.faulty, of.rig, seed), null


def read_source(source: str, seeds: int, records: int) -> Iterator[Shortcuts]:
    """Records of a corpus, for each seed; or of a corpus that is made from a recipe with each seed."""
    if Path(source).is_dir() or is_single_file(Path(source)):
        yield from [read_records(source)] * seeds
        return
    recipe = read_recipe(source, records=records)
    for seed in range(seeds):
        with tempfile.TemporaryDirectory() as folder:
            generated = generate(recipe, Path(folder) / "corpus", workers=2, seed=recipe.seed + seed)
            yield read_records(generated.path)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", nargs="?", default="domain_randomised", help="corpus or recipe")
    parser.add_argument("--records", type=int, default=3000, help="of a recipe")
    parser.add_argument("--seeds", type=int, default=1, help="number of seeds, of a recipe and of the trees")
    parser.add_argument("--permutations", type=int, default=5, help="of the labels, per seed")
    options = parser.parse_args()
    by_shortcut: dict[str, tuple[list[float], list[float]]] = {}
    for seed, records in enumerate(read_source(options.source, options.seeds, options.records)):
        for name, auc, null in scores(records, seed, options.permutations):
            aucs, nulls = by_shortcut.setdefault(name, ([], []))
            aucs.append(auc)
            nulls += null
    print("| shortcut | AUC | permuted labels |\n|---|---:|---:|")
    for name, (aucs, nulls) in by_shortcut.items():
        print(f"| {name} | {spread(aucs)} | {spread(nulls)} |")


def spread(values: list[float]) -> str:
    """Mean, and standard deviation of several values."""
    deviation = f" +- {np.std(values, ddof=1):.3f}" if len(values) > 1 else ""
    return f"{np.mean(values):.3f}{deviation}"


if __name__ == "__main__":
    main()
