"""Train on ``domain_randomised`` alone, test on recordings of real machines, and renew the numbers in the docs.

``python -m benchmarks.transfer REAL`` with REAL a folder that holds ``cwru``, ``mfpt`` and ``uestc`` as their providers publish them. Each
seed gives another corpus, once with records of 2 s and once of half a second, and is tested on windows of the same length. Sets that are
sampled fast enough are tested at 2 s in a wider band, by models of a corpus made for it: as in the reference model. The scores are written
to ``benchmarks/transfer.json``, and the tables of README.md and docs/transfer.md are made from that file. ``--pages`` only makes these.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator, Mapping
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from benchmarks.reference_table import WIDE_BAND, lasting, wide_recipe
from benchmarks.results import machine
from benchmarks.transfer_pages import RESULTS, write_pages
from features import feature_table
from features.baselines import Model, Scores, cross_validate
from features.baselines.classifying import RECORDED
from features.table.band import DEFAULT_BAND
from gen import generate
from gen.corpus import FAULTS, open_corpus
from gen.recipe import Recipe, read_recipe
from raceway.importing import import_set
from raceway.kept_models import LONG

RECIPE = "domain_randomised"
ESTIMATORS = ("envelope_rule", "logistic_regression", "random_forest", "extra_trees", "ensemble")
BEST = "ensemble"
WINDOWS = (LONG, 0.5)  # s
GROUPS = ("lines", "shape", "bands")
TEACHERS = {
    "uestc": (("synthetic",), ("cwru",), ("cwru", "mfpt"), ("synthetic", "cwru", "mfpt")),
    "cwru": (("synthetic",), ("uestc",), ("uestc", "mfpt"), ("synthetic", "uestc", "mfpt")),
}
"""For each test set the sets that teach, alone or together."""
TAUGHT = ("features", "fault", "rig", "specimen", "recording", "width")
"""Variables that training reads."""

Tables = dict[str, xr.Dataset]
Figures = dict[str, float | None]


def real_tables(real: Path, folder: Path, window: float) -> tuple[Tables, Tables, Tables]:
    """Feature tables of windows of the recordings as the reference model takes them, the same at the speeds found in them, and in one band.

    ``wang`` is the subset of CWRU of Wang, Taal and Fink (2021).
    """
    import_set("cwru", real / "cwru", folder / "wang", subset="wang", window=window)
    import_set("cwru", real / "cwru", folder / "cwru", window=window)
    import_set("mfpt", real / "mfpt", folder / "mfpt", window=window)
    import_set("uestc", real / "uestc", folder / "uestc", window=window)
    names = ("wang", "cwru", "mfpt", "uestc")
    bands = {name: WIDE_BAND if window == LONG and _is_wide(folder / name) else DEFAULT_BAND for name in names}
    tested = {name: feature_table(folder / name, GROUPS, band=bands[name]) for name in names}
    corrected = {name: feature_table(folder / name, GROUPS, band=bands[name], speed="correct") for name in names}
    return tested, corrected, {name: feature_table(folder / name, GROUPS) for name in names}


def _is_wide(corpus: Path) -> bool:
    """Whether all records of a corpus are sampled fast enough for the wider band."""
    with open_corpus(corpus) as opened:
        return float(opened["sample_rate"].min()) * RECORDED >= WIDE_BAND.high


def figures(scores: Scores) -> Figures:
    """Figures of merit by window, and by recording where their name says so."""
    whole = scores.by_recording or scores
    return {
        "window": scores.balanced_accuracy,
        "recording": whole.balanced_accuracy,
        "false_alarms": scores.false_alarms,
        "recording_false_alarms": whole.false_alarms,
        "auc": scores.auc,
        "log_loss": scores.log_loss,
        "ece": scores.ece,
        "coverage": scores.coverage,
        "answered_accuracy": scores.answered_accuracy,
    }


def with_reference(table: xr.Dataset, model: Model) -> Figures | None:
    """Mean figures with each healthy recording in turn as the reference; None for a set without one."""
    healthy = table["fault"].values == FAULTS.index("healthy")
    recordings = np.unique(table["recording"].values[healthy])
    if not len(recordings):
        return None
    chosen = (healthy & (table["recording"].values == number) for number in recordings)
    of_references = [figures(model.score(table, reference=table.isel(record=rows))) for rows in chosen]
    return {name: _mean([each[name] for each in of_references]) for name in of_references[0]}


def pooled(tables: list[xr.Dataset]) -> xr.Dataset:
    """One table of several, with what training needs; the rigs of each keep numbers of their own."""
    first, parts = 0, []
    for table in tables:
        kept = table[[*TAUGHT]].reset_coords(drop=True)
        parts.append(kept.assign(rig=kept["rig"] + first).assign_coords(group=table["group"]))
        first += int(kept["rig"].max()) + 1
    return xr.concat(parts, "record", combine_attrs="drop_conflicts", join="exact")


def measure(real: Path, seeds: int, window: float, workers: int) -> dict[str, Any]:
    """All figures of records and windows of one length [s], one value per seed."""
    zero_shot: dict[str, dict[str, list[Figures]]] = {name: {} for name in ESTIMATORS}
    corrected: dict[str, list[Figures]] = {}
    reference: dict[str, list[Figures]] = {}
    teachers: dict[str, dict[str, list[Figures]]] = {test: {} for test in TEACHERS}
    confusion: dict[str, Any] = {}
    own: dict[str, Figures] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tested, at_corrected_speeds, in_one_band = real_tables(real, folder, window)
        corpora = corpora_of(lasting(read_recipe(RECIPE), window), seeds, folder / "synthetic", workers)
        wide_corpora = corpora_of(wide_recipe(), seeds if window == LONG else 0, folder / "wide", workers)
        for seed, (corpus, wide_corpus) in enumerate(zip_longest(corpora, wide_corpora)):
            table = feature_table(corpus, GROUPS)
            models = {estimator: Model(estimator, seed=seed).fit(table) for estimator in ESTIMATORS}
            if wide_corpus is not None:
                wide = feature_table(wide_corpus, GROUPS, band=WIDE_BAND)
                for estimator, model in models.items():
                    model.wide = Model(estimator, seed=seed).fit(wide)
            for test, other in tested.items():
                for estimator, model in models.items():
                    scores = model.score(other)
                    zero_shot[estimator].setdefault(test, []).append(figures(scores))
                    if estimator == BEST:
                        held = confusion.setdefault(test, {"true": scores.classes, "predicted": scores.model_classes})
                        held["windows"] = np.add(held.get("windows", 0), scores.confusion).tolist()
                corrected.setdefault(test, []).append(figures(models[BEST].score(at_corrected_speeds[test])))
                if (referred := with_reference(other, models[BEST])) is not None:
                    reference.setdefault(test, []).append(referred)
            for test, sets in TEACHERS.items():
                for teaching in sets:
                    if "synthetic" not in teaching and seed > 0:
                        continue
                    taught = pooled([in_one_band.get(name, table) for name in teaching])
                    scores = Model(BEST, seed=seed).fit(taught).score(in_one_band[test])
                    teachers[test].setdefault(" + ".join(teaching), []).append(figures(scores))
            if seed == 0:
                own = {name: figures(cross_validate(table, name, track="rig", seed=seed)) for name in ESTIMATORS}
            print(f"{window:g} s, seed {seed} done", file=sys.stderr, flush=True)
    return {
        "zero_shot": zero_shot,
        "speed_corrected": corrected,
        "reference": reference,
        "teachers": teachers,
        "confusion": confusion,
        "own_rigs": own,
    }


def corpora_of(recipe: Recipe, seeds: int, folder: Path, workers: int) -> Iterator[Path]:
    """Generate a corpus of a recipe for each seed."""
    for seed in range(seeds):
        yield generate(recipe, folder / f"seed-{seed}", workers=workers, seed=20260 + seed).path


def _mean(values: list[float | None]) -> float | None:
    numbers = [value for value in values if value is not None]
    return float(np.mean(numbers)) if numbers else None


def _plain(value: Any) -> Any:
    """The same with numbers rounded to four decimals, so that the file is easy to read."""
    match value:
        case Mapping():
            return {key: _plain(item) for key, item in value.items()}
        case list() | tuple():
            return [_plain(item) for item in value]
        case float():
            return round(value, 4)
        case _:
            return value


def main() -> None:
    """Measure, write the file of results, and renew the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path, nargs="?", help="folder of the recordings; not needed with --pages")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--pages", action="store_true", help="only renew the tables from benchmarks/transfer.json")
    options = parser.parse_args()
    if not options.pages:
        if options.real is None:
            parser.error("give the folder of the recordings, or --pages.")
        each = {f"{window:g}": measure(options.real, options.seeds, window, options.workers) for window in WINDOWS}
        results = {"machine": machine(), "recipe": RECIPE, "seeds": options.seeds, "windows": _plain(each)}
        lines = ",\n".join(f" {json.dumps(key)}: {json.dumps(value)}" for key, value in results.items())
        RESULTS.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")
    write_pages()


if __name__ == "__main__":
    main()
