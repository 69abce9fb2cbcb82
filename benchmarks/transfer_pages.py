"""Tables of README.md and docs/transfer.md, made from ``benchmarks/transfer.json``.

A test compares the pages with the file.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.page_tables import RIGHT, filled, markdown

RESULTS = Path(__file__).with_name("transfer.json")
ROOT = RESULTS.parent.parent
PAGES = ("README.md", "docs/transfer.md")

Results = Mapping[str, Any]
NAMES = {
    "envelope_rule": "untrained envelope rule",
    "logistic_regression": "logistic regression",
    "random_forest": "random forest",
    "extra_trees": "ExtraTrees",
    "ensemble": "ensemble (the default)",
}


def spread(seeds: Sequence[Mapping[str, float | None]], figure: str) -> str:
    """Mean over the seeds and, in brackets, the lowest; a dash if the figure is not known.

    >>> spread([{"window": 0.5}, {"window": 0.75}], "window")
    '0.625 (0.500)'
    """
    values = [value for each in seeds if (value := each[figure]) is not None]
    return f"{sum(values) / len(values):.3f} ({min(values):.3f})" if values else "-"


def mean(seeds: Sequence[Mapping[str, float | None]], figure: str) -> str:
    """Mean over the seeds; a dash if the figure is not known."""
    return spread(seeds, figure).partition(" ")[0]


def _longest(results: Results) -> Mapping[str, Any]:
    """Figures of the longest windows."""
    return next(iter(results["windows"].values()))


def _summary(results: Results) -> str:
    """The four sets in short: zero-shot, and with one healthy recording."""
    heads = {"wang": "CWRU, Wang's subset", "cwru": "CWRU, all 64", "mfpt": "MFPT, 2 classes", "uestc": "UESTC"}
    rows: list[list[str]] = []
    for window, scores in results["windows"].items():
        zero, reference = scores["zero_shot"], scores["reference"]
        rows += [
            [f"{NAMES[name]}, {window} s", *(spread(zero[name][test], "window") for test in heads)]
            for name in ("envelope_rule", "ensemble")
        ]
        of_reference = [spread(reference[test], "window") if test in reference else "-" for test in heads]
        rows.append([f"ensemble, with one healthy recording of the machine, {window} s", *of_reference])
    return markdown(["", *heads.values()], rows, RIGHT)


def _zero_shot(results: Results) -> str:
    tests = list(_longest(results)["zero_shot"]["ensemble"])
    header = ["", *(f"{test} {unit}" for test in tests for unit in ("window", "recording")), "own rigs, CV"]
    rows = [
        [
            f"{NAMES[name]}, {window} s",
            *(spread(scores[test], unit) for test in tests for unit in ("window", "recording")),
            mean([its["own_rigs"][name]], "window"),
        ]
        for window, its in results["windows"].items()
        for name, scores in its["zero_shot"].items()
    ]
    return markdown(header, rows, RIGHT)


def _details(results: Results) -> str:
    """Every figure of the default estimator; ``wang`` is a part of ``cwru``."""
    ways = {
        f"{way}, {window} s": scores
        for window, its in results["windows"].items()
        for way, scores in {
            "zero-shot": its["zero_shot"]["ensemble"],
            "one healthy recording": its["reference"],
        }.items()
    }
    header = [
        *("set", "way", "window", "recording", "false alarms", "of recordings"),
        *("AUC", "log-loss", "ECE", "answered", "accuracy of answers"),
    ]
    rows = [
        [
            *(test, way, spread(scores[test], "window"), spread(scores[test], "recording")),
            *(
                mean(scores[test], name)
                for name in ("false_alarms", "recording_false_alarms", "auc", "log_loss", "ece")
            ),
            *(mean(scores[test], name) for name in ("coverage", "answered_accuracy")),
        ]
        for test in ("cwru", "mfpt", "uestc")
        for way, scores in ways.items()
        if test in scores
    ]
    return markdown(header, rows, RIGHT)


def _teachers(results: Results) -> str:
    rows = [
        [
            teaching.replace("synthetic", f"`{results['recipe']}`"),
            f"{test}, {window} s",
            *(spread(scores, name) for name in ("window", "recording")),
            *(mean(scores, name) for name in ("false_alarms", "auc", "log_loss")),
        ]
        for window, its in results["windows"].items()
        for test, teachers in its["teachers"].items()
        for teaching, scores in teachers.items()
    ]
    return markdown(["trained on", "tested on", "window", "recording", "false alarms", "AUC", "log-loss"], rows, RIGHT)


def _confusion(results: Results, test: str) -> str:
    confusion = _longest(results)["confusion"][test]
    rows = [[name, *map(str, row)] for name, row in zip(confusion["true"], confusion["windows"], strict=True)]
    return markdown(["true", *confusion["predicted"]], rows, RIGHT)


TABLES: Mapping[str, Callable[[Results], str]] = {
    "summary": _summary,
    "zero-shot": _zero_shot,
    "details": _details,
    "teachers": _teachers,
    "confusion-wang": lambda results: _confusion(results, "wang"),
}


def with_tables(page: str, results: Results) -> str:
    """A page with its tables made again."""
    return filled(page, lambda name: TABLES[name](results))


def read_results() -> Results:
    """The results that the pages show."""
    return json.loads(RESULTS.read_text(encoding="utf-8"))


def write_pages() -> None:
    """Make the tables of all pages again."""
    results = read_results()
    for name in PAGES:
        page = ROOT / name
        page.write_text(with_tables(page.read_text(encoding="utf-8"), results), encoding="utf-8")
