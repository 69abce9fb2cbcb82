"""Mechanisms of ``domain_randomised``, each tried alone and in the whole: scores on recordings of real machines.

``python -m benchmarks.ablation REAL`` with REAL a folder that holds ``cwru``, ``mfpt`` and ``uestc`` as their providers publish them.
ablation.yaml beside this file lists the mechanisms: the keys that take one out of the recipe (``without``), or that bring in one that the
recipe does not have (``with``). Each variant of the recipe is generated, and a classifier trained on it, once per seed. docs/transfer.md
has some of its figures.
"""

import argparse
import copy
import json
import os
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from ruamel.yaml import YAML

from benchmarks.realism import UESTC
from features import feature_table
from features.baselines import DEFAULT_ESTIMATOR, Model, Scores
from gen import generate
from gen.recipe import find_recipe
from gen.recipe.fault_entries import fault_entries
from raceway.importing import import_generic, import_set

MECHANISMS = Path(__file__).with_suffix(".yaml")
GROUPS = ("lines", "shape")
FIRST_SEED = 20260
SMALL = {"corpus.rigs": 60, "corpus.records_per_specimen": 1}
"""480 specimens with a record each: scores change little beyond 300 specimens, and hardly with the records of a specimen."""

Changes = Mapping[str, Any]
"""New values by key, with dots between sections; None removes a key.

``faults.KIND.KEY`` changes every entry of that kind, ``faults.+`` adds a list of entries.
"""


class Mechanism(NamedTuple):
    """One part of the recipe, or one that was tried and left out."""

    name: str
    changes: Changes
    is_kept: bool
    """Whether the recipe has it, so that ``changes`` take it out; otherwise they bring it in."""


def read_mechanisms(path: Path = MECHANISMS) -> list[Mechanism]:
    """Mechanisms of a file, in its order."""
    listed = YAML(typ="safe").load(path)
    return [Mechanism(entry["name"], entry.get("without") or entry["with"], "without" in entry) for entry in listed]


def variants(mechanisms: Sequence[Mechanism]) -> dict[str, Changes]:
    """Changes of the recipe by the name of the variant: none of the mechanisms, each alone, all that are kept, all but one."""
    kept = [mechanism for mechanism in mechanisms if mechanism.is_kept]
    none = {key: value for mechanism in kept for key, value in mechanism.changes.items()}
    changes: dict[str, Changes] = {"none of these": none}
    for mechanism in mechanisms:
        others = {key: value for other in kept if other != mechanism for key, value in other.changes.items()}
        changes[f"only {mechanism.name}"] = others if mechanism.is_kept else {**none, **mechanism.changes}
    changes["the recipe"] = {}
    for mechanism in mechanisms:
        changes[f"{'without' if mechanism.is_kept else 'with'} {mechanism.name}"] = mechanism.changes
    return changes


def changed(recipe: Mapping[str, Any], changes: Changes) -> dict[str, Any]:
    """Copy of a recipe with some changes."""
    altered = copy.deepcopy(dict(recipe))
    if any(path.startswith("faults.") for path in changes):
        altered["faults"] = fault_entries(altered["faults"])
    for path, value in changes.items():
        section, *keys = path.split(".")
        if path == "faults.+":
            altered["faults"] += copy.deepcopy(value)
        elif section == "faults":
            kind, *below = keys
            for entry in altered["faults"]:
                if entry["kind"] == kind:
                    _set(entry, below, value)
        else:
            _set(altered, [section, *keys], value)
    return altered


def _set(section: dict[str, Any], keys: list[str], value: Any) -> None:
    for key in keys[:-1]:
        section = section.setdefault(key, {})
    if value is None:
        section.pop(keys[-1], None)
    else:
        section[keys[-1]] = copy.deepcopy(value)


def real_tables(real: Path, folder: Path) -> dict[str, xr.Dataset]:
    """Feature tables of the sets in ``real``; UESTC with its labelled speeds and with the true ones."""
    folders = {}
    if (real / "cwru").is_dir():
        folders["wang"] = import_set("cwru", real / "cwru", folder / "wang", subset="wang").path
        folders["cwru"] = import_set("cwru", real / "cwru", folder / "cwru").path
    if (real / "mfpt").is_dir():
        folders["mfpt"] = import_set("mfpt", real / "mfpt", folder / "mfpt").path
    if (real / "uestc").is_dir():
        folders["uestc"] = import_set("uestc", real / "uestc", folder / "uestc").path
        folders["uestc, true speeds"] = import_generic(UESTC, folder / "true", folder=real / "uestc").path
    return {name: feature_table(path, groups=GROUPS) for name, path in folders.items()}


def scores_of(recipe: Mapping[str, Any], seed: int, tests: Mapping[str, xr.Dataset], workers: int) -> dict[str, Scores]:
    """Scores on each test of a classifier that is trained on a corpus of a recipe."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "recipe.yaml"
        YAML().dump(dict(recipe), path)
        corpus = generate(path, Path(name) / "corpus", workers=workers, seed=seed).path
        model = Model(DEFAULT_ESTIMATOR, seed=seed).fit(feature_table(corpus, groups=GROUPS))
    return {test: model.score(table) for test, table in tests.items()}


def plain(scores: Scores) -> dict[str, float]:
    """Figures of one test that the table and the JSON file hold."""
    recalls = {
        f"recall of {name}": dict(zip(scores.model_classes, row, strict=True)).get(name, 0) / sum(row)
        for name, row in zip(scores.classes, scores.confusion, strict=True)
    }
    whole = scores.by_recording or scores
    figures = {
        "balanced accuracy": scores.balanced_accuracy,
        "by recording": whole.balanced_accuracy,
        "AUC": scores.auc,
        "log-loss": scores.log_loss,
        "false alarms": scores.false_alarms,
    }
    return {name: float(value) for name, value in figures.items() if value is not None} | recalls


COLUMNS = {"balanced accuracy": "BA", "AUC": "AUC", "log-loss": "log-loss", "false alarms": "false alarms"}


def table(figures_of: Mapping[str, Mapping[str, Sequence[Mapping[str, float]]]]) -> Iterator[str]:
    """Markdown table of means over the seeds, one row per variant.

    ``figures_of`` has the figures by variant and test, one mapping per seed.
    """
    columns = [
        (test, figure)
        for test, figures in next(iter(figures_of.values())).items()
        for figure in COLUMNS
        if figure in figures[0]
    ]
    yield "| variant | " + " | ".join(f"{test} {COLUMNS[figure]}" for test, figure in columns) + " |"
    yield "|---|" + "---:|" * len(columns)
    for variant, tests in figures_of.items():
        cells = [f"{np.mean([figures[figure] for figures in tests[test]]):.3f}" for test, figure in columns]
        yield f"| {variant} | " + " | ".join(cells) + " |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.ablation", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("real", type=Path, nargs="?", default=os.environ.get("RACEWAY_REAL"))
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--full", action="store_true", help="as many records as the recipe has, in place of 480")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--only", metavar="TEXT", help="the variants whose name has this text")
    parser.add_argument("--json", type=Path, help="also write every figure to this file")
    options = parser.parse_args()
    shipped = YAML(typ="safe").load(Path(find_recipe("domain_randomised")))
    if options.real is None:
        parser.error("give the folder that holds cwru, mfpt and uestc, or name it in RACEWAY_REAL.")
    recipe = changed(shipped, {} if options.full else SMALL)
    figures_of = {}
    with tempfile.TemporaryDirectory() as name:
        tests = real_tables(options.real, Path(name))
        if not tests:
            parser.error(f"{options.real}: holds none of cwru, mfpt and uestc; give the folder that holds them.")
        for variant, changes in variants(read_mechanisms()).items():
            if options.only and options.only not in variant:
                continue
            scores_of_seeds = [
                scores_of(changed(recipe, changes), seed, tests, options.workers)
                for seed in range(FIRST_SEED, FIRST_SEED + options.seeds)
            ]
            figures_of[variant] = {test: [plain(scores[test]) for scores in scores_of_seeds] for test in tests}
            print(f"{variant} done", file=sys.stderr, flush=True)
            if options.json:
                options.json.write_text(json.dumps(figures_of, indent=1), encoding="utf-8")
    print("\n".join(table(figures_of)))


if __name__ == "__main__":
    main()
