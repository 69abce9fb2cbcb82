"""Train on ``domain_randomised`` alone and test on recordings of real machines.

``python -m benchmarks.transfer REAL`` with REAL a folder that holds ``cwru`` and ``mfpt`` as their providers publish them. Each seed gives
another corpus. Scores are balanced accuracies over the classes present, by half-second window and by recording.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

import numpy as np
import xarray as xr

from features import feature_table
from features.baselines import Scores, cross_validate, evaluate, train
from gen import generate
from gen.importers import import_cwru, import_mfpt

ESTIMATORS = ("envelope_rule", "logistic_regression", "random_forest", "extra_trees", "ensemble")
GROUPS = ("lines", "shape")


def real_tables(real: Path, folder: Path) -> dict[str, xr.Dataset]:
    """Feature tables of the recordings: the subset of Wang, Taal and Fink (2021), all of CWRU, and MFPT."""
    import_cwru(real / "cwru", folder / "wang", subset="wang")
    import_cwru(real / "cwru", folder / "cwru")
    import_mfpt(real / "mfpt", folder / "mfpt")
    return {name: feature_table(folder / name, groups=GROUPS) for name in ("wang", "cwru", "mfpt")}


def main() -> None:
    """Print one row per estimator and test set, and the confusion of the best on Wang's subset."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--recipe", default="domain_randomised")
    parser.add_argument("--json", type=Path, help="also write every score to this file")
    options = parser.parse_args()
    scores: dict[str, dict[str, list[Scores]]] = {name: {} for name in ESTIMATORS}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tests = real_tables(options.real, folder)
        for seed in range(options.seeds):
            corpus = folder / f"seed-{seed}"
            generate(options.recipe, corpus, workers=options.workers, seed=20260 + seed)
            table = feature_table(corpus, groups=GROUPS)
            for estimator, found in scores.items():
                model = train(table, estimator, seed=seed)
                for test, other in tests.items():
                    found.setdefault(test, []).append(evaluate(other, model))
                if seed == 0:
                    found["own"] = [cross_validate(table, estimator, track="rig", seed=seed)]
            print(f"seed {seed} done", file=sys.stderr, flush=True)
    print(
        f"| {options.seeds} seeds, mean (lowest) | "
        + " | ".join(f"{t} window | {t} recording" for t in tests)
        + " | own rigs, CV, first seed |"
    )
    print("|---|" + "---:|" * (2 * len(tests) + 1))
    for estimator, found in scores.items():
        cells = [
            cell
            for test in tests
            for cell in (_spread(found[test]), _spread([s.by_recording or s for s in found[test]]))
        ]
        print(f"| {estimator} | " + " | ".join(cells) + f" | {_spread(found['own'])} |")
    total = np.sum([s.confusion for s in scores["ensemble"]["wang"]], axis=0)
    print("\nensemble on wang, windows of all seeds:", scores["ensemble"]["wang"][0].classes, total.tolist())
    if options.json:
        plain = {e: {t: [s.balanced_accuracy for s in found[t]] for t in found} for e, found in scores.items()}
        options.json.write_text(json.dumps(plain, indent=1))


def _spread(scores: list[Scores]) -> str:
    values = [score.balanced_accuracy for score in scores]
    return f"{np.mean(values):.3f} ({min(values):.3f})"


if __name__ == "__main__":
    main()
