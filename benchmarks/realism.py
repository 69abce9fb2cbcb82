"""Compare ``domain_randomised`` with recordings of three real machines: AUC by class and measure, yardstick and targets.

``python -m benchmarks.realism REAL`` with REAL a folder that holds ``cwru``, ``mfpt`` and ``uestc`` as their providers publish them;
without it, the folder that the environment variable ``RACEWAY_REAL`` names. ``--against CORPUS`` compares another corpus too, such as one
of an earlier recipe, and prints its values first. docs/comparing.md explains the measures and targets.
"""

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from gen import generate
from raceway.comparing import Comparison, compare
from raceway.comparing.measures import MEASURES
from raceway.importing import import_generic, import_set

UESTC = Path(__file__).with_name("uestc.csv")
"""Labels of the recordings, with speeds as measured on the first three harmonics of the line of the fault."""

RACES = ("inner", "outer")
COLOUR = ("energy_above_3500_hz", "roll_off", "centroid")
TARGETS = (
    ("colour and roll-off", COLOUR, ("healthy", *RACES, "ball"), 0.0, 0.70),
    ("impulsiveness of races", ("kurtosis", "crest_factor", "spectral_kurtosis"), RACES, 0.0, 0.70),
    ("line width of races", ("line_width",), RACES, 0.30, 0.70),
    ("cage line of balls", ("cage_line",), ("ball",), 0.35, 1.0),
)
"""Name, measures, classes, and lowest and highest AUC that is wanted."""


def real_corpora(real: Path, folder: Path) -> list[Path]:
    """Import the sets that are in ``real``."""
    folders = []
    if (real / "cwru").is_dir():
        folders.append(import_set("cwru", real / "cwru", folder / "cwru").path)
    if (real / "mfpt").is_dir():
        folders.append(import_set("mfpt", real / "mfpt", folder / "mfpt").path)
    if (real / "uestc").is_dir():
        folders.append(import_generic(UESTC, folder / "uestc", folder=real / "uestc").path)
    return folders


def table(comparison: Comparison, before: Comparison | None = None) -> Iterator[str]:
    """Markdown table of AUCs: each cell has the value before, the value, and in brackets the range of the real sets."""
    classes = list(comparison.auc)
    yield f"| measure | unit | {' | '.join(classes)} |"
    yield "|---|---|" + "---:|" * len(classes)
    for measure in MEASURES:
        cells = [_cell(comparison, before, fault, measure.name) for fault in classes]
        yield f"| {measure.name} | {measure.unit} | {' | '.join(cells)} |"


def _cell(comparison: Comparison, before: Comparison | None, fault: str, measure: str) -> str:
    value = comparison.auc[fault].get(measure)
    if value is None:
        return ""
    earlier = None if before is None else before.auc.get(fault, {}).get(measure)
    held = [
        table[fault][measure]
        for table in comparison.yardstick.values()
        if table.get(fault, {}).get(measure) is not None
    ]
    spread = f" ({min(held):.2f}-{max(held):.2f})" if held else ""
    return f"{'' if earlier is None else f'{earlier:.2f} → '}{value:.2f}{spread}"


def medians(comparison: Comparison) -> Iterator[str]:
    """Markdown table of the medians of the synthetic, the pooled real, and each real set, with the numbers of windows."""
    sets = ["synthetic", "real", *(windows.name for windows in comparison.real)]
    yield f"| class | measure | {' | '.join(sets)} | windows |"
    yield "|---|---|" + "---:|" * len(sets) + "---|"
    for fault, measures in comparison.quantiles.items():
        for name, quantiles in measures.items():
            cells = [f"{quantiles[key][1]:.3g}" if key in quantiles else "" for key in sets]
            counts = ", ".join(str(comparison.counts[fault][name].get(key, 0)) for key in sets if key != "real")
            yield f"| {fault} | {name} | {' | '.join(cells)} | {counts} |"


def verdicts(comparison: Comparison) -> Iterator[str]:
    """One sentence per target: the range that is wanted, and the values outside it."""
    for what, measures, classes, lowest, highest in TARGETS:
        values = {
            f"{measure} of {fault}": value
            for fault in classes
            for measure in measures
            if (value := comparison.auc.get(fault, {}).get(measure)) is not None
        }
        missed = [f"{name} {value:.2f}" for name, value in values.items() if not lowest <= value <= highest]
        state = f"missed by {', '.join(missed)}" if missed else "met" if values else "not measured"
        yield f"{what}: AUC of {lowest:.2f} to {highest:.2f} wanted; {state}."


def main() -> None:
    """Print the tables and the targets."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.realism", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("real", type=Path, nargs="?", default=os.environ.get("RACEWAY_REAL"))
    parser.add_argument("--records", type=int, default=1500, help="records to generate")
    parser.add_argument("--seed", type=int, help="replaces the seed of the recipe")
    parser.add_argument("--recipe", default="domain_randomised")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--against", type=Path, metavar="CORPUS", help="another corpus, whose values are printed first")
    parser.add_argument("--json", type=Path, help="also write every number to this file")
    options = parser.parse_args()
    if options.real is None:
        parser.error("give the folder that holds cwru, mfpt and uestc, or name it in RACEWAY_REAL.")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        real = real_corpora(options.real, folder)
        if not real:
            parser.error(f"{options.real}: holds none of cwru, mfpt and uestc; give the folder that holds them.")
        synthetic = folder / "synthetic"
        generate(options.recipe, synthetic, workers=options.workers, records=options.records, seed=options.seed)
        print("generated", file=sys.stderr, flush=True)
        comparison = compare(synthetic, real)
        before = None if options.against is None else compare(options.against, real)
    print("\n".join(table(comparison, before)), end="\n\n")
    print("\n".join(medians(comparison)), end="\n\n")
    print("\n".join(verdicts(comparison)))
    if options.json:
        options.json.write_text(json.dumps(comparison.plain(), indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
