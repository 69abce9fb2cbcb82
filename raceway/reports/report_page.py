"""A corpus and its benchmark on one self-contained page.

``corpus -> contents, an example of each class`` and ``Results -> scores and controls``, both into one HTML file that
includes every picture. Corpora come from unknown sources: their text is escaped and shortened, and never drawn.
"""

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from features.baselines import Results, Scores, behind_text, interval_text, leaky_text, no_width_text, percent_text
from features.baselines.names import UNTRAINED
from features.baselines.tracks import NOVELTY
from gen.corpus import (
    SPLITS,
    UNITS,
    Manifest,
    by_class,
    make_result_folder,
    open_corpus,
    read_manifest,
    unit_counts,
    write_numbers,
)
from gen.corpus.fault_classes import HEALTHY
from raceway.console.corpus_counts import split_counts
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.curves import draw_detection, draw_reliability, draw_roc
from raceway.reports.examples import examples_of
from raceway.reports.pictures import draw_record, picture
from raceway.reports.summaries import draw_content, draw_scores
from raceway.reports.templates import short_text, write_page

BARS, LEAST_IMPORTANCE = 15, 5e-4  # of the drawn quantities


def write_report(corpus: Path | str, results: Results, output: Path | str) -> Path:
    """Write ``report.html`` and ``results.json`` into a folder, which is created if it does not exist.

    Parameters
    ----------
    corpus
        The folder of the benchmarked corpus.
    results
        Of ``features.baselines.benchmark``.
    output
        The folder to write to.

    Returns
    -------
    The path of the page.

    Raises
    ------
    CorpusError
        If the corpus cannot be read, or the disk refuses.
    """
    corpus, output = Path(corpus), Path(output)
    with open_corpus(corpus) as opened:
        content = _content(opened)
    make_result_folder(output)
    write_numbers(asdict(results), output / "results.json")
    facts = _facts(read_manifest(corpus), results)
    return write_page(output / "report.html", "report.html.jinja", **content, **_scores(results), facts=facts)


def _content(corpus: xr.Dataset) -> dict[str, Any]:
    """Variables of the template that describe the records."""
    duration = corpus.sizes["elapsed_time"] / float(corpus["sample_rate"][0])
    return {
        "title": short_text(corpus.attrs.get("title", "untitled corpus")),
        "origin": short_text(corpus.attrs.get("source", "")),
        "units": unit_counts(corpus),
        "duration": duration,
        "fs": float(corpus["sample_rate"][0]),
        "classes": [
            (fault, FAULT_COLOURS[fault], unit_counts(columns), split_counts(columns["split"]))
            for fault, columns in by_class(corpus, (*UNITS, "split")).items()
        ],
        "splits": SPLITS,
        "examples": [
            (fault, caption, b"" if shown is None else picture(draw_record(shown), "svg"))
            for fault, (shown, caption) in examples_of(corpus).items()
        ],
        "content": picture(draw_content(corpus), "svg"),
    }


def _scores(results: Results) -> dict[str, Any]:
    """Variables of the template that describe the baselines, and further tracks."""
    leading, unseen = results.leading, NOVELTY[results.track]
    chance = 1 / len(results.corpus.classes)
    quality = _quality(results)
    # other corpora are tested on no further track
    led = {results.track: replace(results.baselines[leading], tests=())}
    led |= {track: of_track.baselines[leading] for track, of_track in results.further.items()}
    leads = [(title, rows[leading]) for title, rows in quality if "by recording" not in title]
    return {
        "results": results,
        "chance": chance,
        "unseen": unseen,
        "scores": picture(draw_scores(results.baselines, chance, unseen), "svg"),
        "spreads": {name: float(np.std(baseline.grouped.folds)) for name, baseline in results.baselines.items()},
        "quality": quality,
        "panels": [(title, scores, _panels(scores)) for title, scores in leads],
        # without those that round to none
        "importance": [row for row in results.importance.items() if row[1] >= LEAST_IMPORTANCE][:BARS],
        "false_alarm_text": _false_alarm_text,
        "findings": _findings(results, chance),
        "test_titles": _test_titles(results),
        "untrained": UNTRAINED,
        "tracks": picture(draw_scores(led, chance, "groups"), "svg") if results.further else None,
        "behind_text": behind_text,
        "interval_text": interval_text,
        "novelty": NOVELTY,
    }


def _panels(scores: Scores) -> dict[str, bytes | None]:
    """Small pictures of what is known: corpora without widths or without healthy records lack some."""
    return {
        "detection": picture(draw_detection(scores.detection, scores.false_alarms), "svg")
        if scores.detection
        else None,
        "roc": None if scores.roc is None else picture(draw_roc(scores.roc), "svg"),
        "reliability": picture(draw_reliability(scores), "svg"),
    }


def _quality(results: Results) -> list[tuple[str, dict[str, Scores]]]:
    """Scores by baseline under a title each: of the cross-validation, and of the other corpora by record and recording."""
    tables = {
        f"Unseen {NOVELTY[results.track]}": {name: baseline.grouped for name, baseline in results.baselines.items()}
    }
    for number in range(len(results.tests)):
        title = f"Other corpus {number + 1}"
        tested = {name: baseline.tests[number] for name, baseline in results.baselines.items()}
        whole = {name: scored.by_recording for name, scored in tested.items() if scored.by_recording is not None}
        tables |= {f"{title}, by record": tested, f"{title}, by recording": whole}
    return list(tables.items())


def _test_titles(results: Results) -> list[str]:
    """Names of the other corpora on the page."""
    return [f"{number}: {short_text(test.title)}" for number, test in enumerate(results.tests, start=1)]


def _findings(results: Results, chance: float) -> list[str]:
    """Findings on the leading classifier, one sentence each."""
    baseline, rule = results.baselines[results.leading], results.baselines["envelope_rule"]
    name = f"the {results.leading.replace('_', ' ')}"
    grouped = (
        f"On {NOVELTY[results.track]} outside its training, {name} reaches a balanced accuracy of "
        f"{_with_interval(baseline.grouped)}; chance is {chance:.3f}, and the untrained envelope rule reaches "
        f"{rule.grouped.balanced_accuracy:.3f}."
    )
    # each score stands beside chance, a leaking split and permuted labels
    sentences = [
        grouped,
        _false_alarms(baseline.grouped),
        f"With a random split of records, which leaks, it reaches {baseline.leaky.balanced_accuracy:.3f}.",
        f"With labels permuted among specimens it reaches {_with_interval(baseline.null)}{_verdict(baseline.null, chance)}.",
    ]
    if results.corpus.unknown:
        sentences.append(f"{results.corpus.unknown} records whose class is not known are left out of all scores.")
    # then what it is worth on other corpora
    for title, test, of_rule in zip(_test_titles(results), baseline.tests, rule.tests, strict=True):
        whole = "" if test.by_recording is None else f", {test.by_recording.balanced_accuracy:.3f} by recording"
        sentences.append(
            f"On the other corpus {title}, it reaches {_with_interval(test)} by record{whole}; "
            f"the envelope rule reaches {of_rule.balanced_accuracy:.3f}."
        )
    # and what scores may be misread for
    return [*sentences, *filter(None, (leaky_text([baseline]), no_width_text([baseline.grouped, *baseline.tests])))]


def _false_alarms(scores: Scores) -> str:
    """Sentence on false alarms and on the answers of a baseline."""
    alarms = (
        "" if scores.false_alarms is None else f"It predicts a fault for {_false_alarm_text(scores)} healthy records. "
    )
    accuracy = scores.answered_accuracy
    right = "" if accuracy is None else f", and {percent_text(accuracy)} of these answers are right"
    return f"{alarms}It answers {percent_text(scores.coverage)} of all records{right}; for the others it is unsure."


def _false_alarm_text(scores: Scores) -> str:
    """Number of healthy records with a false alarm, of all healthy records; a dash without any."""
    if scores.false_alarms is None:
        return "–"
    healthy = sum(scores.confusion[scores.classes.index(HEALTHY)])
    return f"{round(scores.false_alarms * healthy)} of {healthy}"


def _with_interval(scores: Scores) -> str:
    return f"{scores.balanced_accuracy:.3f} (95 % interval {interval_text(scores.interval)})"


def _verdict(null: Scores, chance: float) -> str:
    """Whether the score with permuted labels is at chance, for the end of a sentence; empty without an interval."""
    if null.interval is None:
        return ""
    low, _ = null.interval
    return ": at chance, as expected" if low <= chance else ": above chance; look for a leak, or try another seed"


def _facts(manifest: Manifest, results: Results) -> list[tuple[str, str]]:
    """Origin of the numbers: the manifest without its parts, and the settings of the benchmark."""
    left_out = {"parts", "parts_sha256", "signals", "complete", "records", "title", "publication"}
    facts = manifest.model_dump(exclude=left_out, exclude_unset=True)
    if license_name := manifest.publication.get("license"):
        facts["licence"] = license_name
    benchmark = {
        "cross-validation": f"{results.folds} folds by {results.track}",
        "features": f"{results.features} ({', '.join(results.groups)})",
        "benchmark seed": results.seed,
        "benchmark versions": results.versions,
    }
    return [(short_text(key.replace("_", " ")), _fact_text(value)) for key, value in (facts | benchmark).items()]


def _fact_text(value: object) -> str:
    if isinstance(value, Mapping):
        return short_text(", ".join(f"{key} {item}" for key, item in value.items()))
    if isinstance(value, list | tuple):
        return f"{len(value)}"
    return short_text(value)
