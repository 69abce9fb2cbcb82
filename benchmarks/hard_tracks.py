"""What only a simulator has, as tracks for classifiers: unknown faults, several faults at once, nuisance, and labels of unseen faults.

``python -m benchmarks.hard_tracks [--estimator MODULE:NAME]`` trains on ``domain_randomised`` and changes of it, tests on other rigs of
another seed, and prints a row of figures for each classifier:

- **open set**: how well 1 less the highest probability tells faults of a kind without training (cage, worn race, several at once) from
  the four classes of the training, as an area under the ROC curve.
- **parts**: one classifier for each of inner race, outer race and balls, with several faults at once in training and test: the mean area
  under the ROC curve.
- **kept**: share of the faulty records whose answer stays if path and background of the machine are drawn anew and all else stays.
- **noisy labels**: balanced accuracy if the training has faults that cannot be seen, and without them.
"""

import argparse
import json
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from sklearn.metrics import balanced_accuracy_score, roc_auc_score

from benchmarks.ablation import changed
from features import feature_table
from features.baselines import Model
from features.baselines.estimators import class_probabilities, make_estimator
from features.baselines.names import BASELINES, UNTRAINED
from features.baselines.own import Maker, load_maker, maker_name
from features.baselines.records import DEFAULT_GROUPS, records_of
from gen import generate
from gen.corpus import DRAWS, FAULTS, open_corpus
from gen.corpus.fault_classes import HEALTHY
from gen.recipe import find_recipe
from gen.support.errors import RecipeError
from gen.support.executor import cores
from gen.support.yaml_files import read_yaml

RECIPE = "domain_randomised"
KNOWN = ("healthy", "inner", "outer", "ball")
PARTS = ("inner", "outer", "ball")
WORN = "distributed"
_SPALL = {"width_mm": "loguniform(0.1, 2)", "depth_um": "loguniform(5, 250)"}
_PLACES = {"inner": "uniform(0, 360)", "outer": "uniform(-75, 75)", "ball": "uniform(0, 360)"}
SEVERAL = [
    {"kind": "compound", "parts": [{"kind": part, **_SPALL, "angle_deg": _PLACES[part]} for part in both]}
    for both in combinations(PARTS, 2)
]
UNKNOWN = [
    *SEVERAL,
    {"kind": "cage", "weight": 2, "pitch_error_deg": "uniform(1, 6)", "knock_n": "loguniform(5, 60)"},
    *(
        {"kind": WORN, "site": site, "waviness_um": "loguniform(0.1, 1)", "order": order}
        for site, order in (("inner", 9), ("outer", 12))
    ),
]
NUISANCE = {
    "path.modes.frequency_hz": "uniform(700, 5500)",
    "background.slope": "uniform(-1, 1)",
    "background.modes.frequency_hz": "uniform(500, 5500)",
}
TRAINED, TESTED = 1, 2
"""Seeds."""
CORPORA: Mapping[str, tuple[int, Mapping[str, Any]]] = {
    "four classes": (TRAINED, {}),
    "with unseen faults": (TRAINED, {"truth.undetected": "keep"}),
    "with several faults": (TRAINED, {"faults.+": SEVERAL}),
    "all classes": (TESTED, {"faults.+": UNKNOWN}),
    "other paths": (TESTED, {"faults.+": UNKNOWN, **NUISANCE}),
}
"""Seed of each corpus and its changes of the recipe."""


class Tested:
    """Feature table of a corpus, with the kind of fault and the damaged parts of each record."""

    def __init__(self, corpus: Path) -> None:
        self.table = feature_table(corpus, workers=cores())
        with open_corpus(corpus) as opened:
            kinds = [_kinds(json.loads(text)["faults"]) for text in opened[DRAWS].values.astype(str)]
        # the class of a worn race is that of the race
        worn = [WORN in each for each in kinds]
        self.fault = np.where(worn, WORN, np.array(FAULTS)[self.table["fault"].values])
        self.parts = {part: np.array([part in each for each in kinds]) for part in PARTS}

    def some(self, rows: np.ndarray) -> xr.Dataset:
        """Rows of the table."""
        return self.table.isel(record=rows)


def _kinds(faults: Any) -> set[str]:
    """Kinds of the faults of a stored recipe, those of several at once too."""
    each = [fault for entry in faults for fault in entry.get("parts") or [entry]]
    return {fault["kind"] for fault in each}


def open_set(model: Model, tested: Tested) -> dict[str, float]:
    """Area under the ROC curve for each kind of fault without training, and for all of them."""
    strange = 1 - model.predict_proba(tested.table).max(axis=1)
    known = np.isin(tested.fault, KNOWN)
    kinds = {kind: tested.fault == kind for kind in np.unique(tested.fault[~known])} | {"all": ~known}
    return {kind: float(roc_auc_score(of[of | known], strange[of | known])) for kind, of in kinds.items()}


def parts_found(estimator: str | Maker, trained: Tested, tested: Tested) -> float:
    """Mean area under the ROC curve of a classifier for each part."""
    learned, asked = (records_of(of.table, DEFAULT_GROUPS).features for of in (trained, tested))
    rows = ~np.isin(tested.fault, ("cage", WORN))
    areas = []
    for part in PARTS:
        # codes of two classes, so that classifiers of the user are taught by names too
        codes = np.where(trained.parts[part], FAULTS.index(part), FAULTS.index(HEALTHY))
        fitted = make_estimator(estimator, 0).fit(learned, codes)
        found = class_probabilities(fitted, asked[rows])[:, list(fitted.classes_).index(FAULTS.index(part))]
        areas.append(roc_auc_score(tested.parts[part][rows], found))
    return float(np.mean(areas))


def answers_kept(model: Model, tested: Tested, other: Tested) -> float:
    """Share of the faulty records of the known classes with the same answer in both corpora."""
    _, places, places_there = np.intersect1d(
        tested.table["recording"].values, other.table["recording"].values, return_indices=True
    )
    same = tested.table["width"].values[places] == other.table["width"].values[places_there]
    faulty = same & np.isin(tested.fault[places], PARTS)
    here, there = (model.predict(of.some(rows[faulty])) for of, rows in ((tested, places), (other, places_there)))
    return float(np.mean(here == there))


def accuracy(model: Model, tested: Tested) -> float:
    """Balanced accuracy on the known classes."""
    rows = np.isin(tested.fault, KNOWN)
    return float(balanced_accuracy_score(tested.fault[rows], model.predict(tested.some(rows))))


def rows(estimators: Sequence[str | Maker], corpora: Mapping[str, Path]) -> Iterator[str]:
    """A row of the table for each classifier."""
    of = {name: Tested(corpus) for name, corpus in corpora.items()}
    tested = of["all classes"]
    for estimator in estimators:
        model, noisy = (Model(estimator).fit(of[name].table) for name in ("four classes", "with unseen faults"))
        strange = open_set(model, tested)
        cells = (
            *(strange.get(kind, np.nan) for kind in ("cage", WORN, "compound", "all")),
            parts_found(estimator, of["with several faults"], tested),
            answers_kept(model, tested, of["other paths"]),
            accuracy(noisy, tested),
            accuracy(model, tested),
        )
        name = estimator.replace("_", " ") if isinstance(estimator, str) else maker_name(estimator)
        yield f"| {name} | {' | '.join(f'{cell:.3f}' for cell in cells)} |"


def made(rigs: int, folder: Path) -> dict[str, Path]:
    """The corpora of the tracks."""
    recipe = read_yaml(find_recipe(RECIPE), RecipeError)
    return {
        name: generate(
            changed(recipe, {"corpus.rigs": rigs, **changes}), folder / name, seed=seed, workers=cores()
        ).path
        for name, (seed, changes) in CORPORA.items()
    }


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rigs", type=int, default=125)
    parser.add_argument(
        "--estimator", action="append", metavar="MODULE:NAME", help="a classifier of your own; its code is run"
    )
    options = parser.parse_args()
    estimators = [*map(load_maker, options.estimator or ())] or [name for name in BASELINES if name not in UNTRAINED]
    print("| classifier | cage | worn race | several | all | parts | kept | noisy labels | clean labels |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for row in rows(estimators, made(options.rigs, Path(folder))):
            print(row, flush=True)


if __name__ == "__main__":
    main()
