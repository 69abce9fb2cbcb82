"""A corpus and its benchmark on one page that needs nothing else, and pictures of single records.

``corpus -> what it holds, an example of each class`` and ``Results -> scores beside their controls``, both into one HTML
file with every picture inside. Corpora come from strangers: their text is escaped and cut short, and none is drawn.
"""

import base64
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import jinja2
import numpy as np
import xarray as xr

from features.baselines import DEFAULT_ESTIMATOR, Results
from features.baselines.benchmark import write_results
from features.baselines.estimators import UNTRAINED
from features.faults import CLASSES, COMBS, HEALTHY
from features.indicators import Orders, feature_names, indicators
from features.report.pictures import (
    PictureFormat,
    Quantity,
    Shown,
    draw_content,
    draw_record,
    draw_scores,
    picture,
)
from gen.corpus import FAULTS, SIGNAL, SPLITS, Manifest, open_corpus, read_manifest, write_durably, write_text_durably
from gen.errors import CorpusError

CANDIDATES = 15  # records of a class among which an example is chosen
LONGEST_TEXT = 300
QUANTITIES = (
    ("shaft_rate", "shaft rate [Hz]", 1.0),
    ("load", "load [N]", 1.0),
    ("width", "width of the fault [mm]", 1e3),
    ("depth", "depth of the fault [µm]", 1e6),
    ("angle", "angle of the fault [°]", 180 / np.pi),
    ("snr", "signal over background [dB]", 1.0),
)


class Example(NamedTuple):
    """A drawn record of one class, as the page shows it."""

    fault: str
    caption: str
    image: bytes


class ClassCount(NamedTuple):
    """Row of the table of contents: a class and how much of it there is."""

    fault: str
    colour: str
    records: int
    specimens: int
    rigs: int
    splits: dict[str, int]


def write_report(corpus: Path | str, results: Results, output: Path | str) -> Path:
    """Write ``report.html`` and ``results.json`` into a folder, which is made if need be.

    Parameters
    ----------
    corpus
        The folder of the corpus the results are of.
    results
        Of ``features.baselines.benchmark``.
    output
        Where to write.

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
        page = _template().render(
            **_content(opened),
            examples=[_example(opened, fault) for fault in FAULTS if (opened["fault"] == FAULTS.index(fault)).any()],
            **_scores(results),
            facts=_facts(read_manifest(corpus), results),
        )
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        message = f"{output}: no folder can be made here ({error.strerror}); choose another one."
        raise CorpusError(message) from error
    write_results(results, output / "results.json")
    write_text_durably(page, output / "report.html")
    return output / "report.html"


def plot_record(corpus: Path | str, record: int, path: Path | str, *, channel: int = 0) -> None:
    """Draw waveform, power spectral density and envelope spectrum of a record, with the fault lines.

    Parameters
    ----------
    corpus
        The folder of the corpus.
    record, channel
        Numbers from 0.
    path
        A .png, .svg or .pdf file, written whole or not at all.

    Raises
    ------
    CorpusError
        If the corpus cannot be read or has no such record or channel, the suffix is another, the record has no
        positive shaft rate, or the disk refuses.
    """
    path = Path(path)
    formats: dict[str, PictureFormat] = {".png": "png", ".svg": "svg", ".pdf": "pdf"}
    suffix = path.suffix.lower()
    if suffix not in formats:
        message = f"{path}: {path.suffix or 'no suffix'} is no format of pictures; use .png, .svg or .pdf."
        raise CorpusError(message)
    with open_corpus(corpus) as opened:
        for dimension, number in (("record", record), ("channel", channel)):
            if not 0 <= number < opened.sizes[dimension]:
                last = opened.sizes[dimension] - 1
                message = f"{corpus}: no {dimension} {number}; give one of 0 to {last}."
                raise CorpusError(message)
        shown = _shown(opened.isel(record=record), record, channel)
    if not _can_be_drawn(shown):
        message = f"{corpus}: record {record} cannot be drawn: its signal, shaft rate or fault orders are not numbers."
        raise CorpusError(message)
    write_durably(picture(draw_record(shown), formats[suffix]), path)


def _template() -> jinja2.Template:
    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["image"] = lambda svg: f"data:image/svg+xml;base64,{base64.b64encode(svg).decode()}"
    return environment.from_string(files("features.report").joinpath("report.html.jinja").read_text(encoding="utf-8"))


def _content(corpus: xr.Dataset) -> dict[str, Any]:
    """What the page says of the records."""
    fault, rig, specimen, split = (corpus[name].values for name in ("fault", "rig", "specimen", "split"))
    counts = []
    for c in np.unique(fault):
        of_class = fault == c
        pairs = np.unique(np.stack([rig[of_class], specimen[of_class]]), axis=1)
        splits = np.bincount(split[of_class], minlength=len(SPLITS))
        counts.append(
            ClassCount(
                FAULTS[c],
                CLASSES[FAULTS[c]].colour,
                int(of_class.sum()),
                pairs.shape[1],
                len(np.unique(pairs[0])),
                dict(zip(SPLITS, splits.tolist(), strict=True)),
            )
        )
    quantities = [
        Quantity(label, _of_faults(name, corpus) * factor) for name, label, factor in QUANTITIES if name in corpus
    ]
    duration = corpus.sizes["elapsed_time"] / float(corpus["sample_rate"][0])
    return {
        "title": _text(corpus.attrs.get("title", "untitled corpus")),
        "origin": _text(corpus.attrs.get("source", "")),
        "records": corpus.sizes["record"],
        "specimens": np.unique(np.stack([rig, specimen]), axis=1).shape[1],
        "rigs": len(np.unique(rig)),
        "duration": duration,
        "fs": float(corpus["sample_rate"][0]),
        "counts": counts,
        "splits": SPLITS,
        "content": picture(draw_content(fault, rig, quantities), "svg"),
    }


def _of_faults(name: str, corpus: xr.Dataset) -> np.ndarray:
    """Values of a variable, those of records without a spall left out where they describe one."""
    values = corpus[name].values.astype(float)
    describes_spall = corpus[name].attrs.get("role") == "label"
    spalled = (corpus["fault"].values != FAULTS.index(HEALTHY)) & (corpus["width"].values != 0)
    return np.where(spalled | (not describes_spall), values, np.nan)


def _example(corpus: xr.Dataset, fault: str) -> Example:
    """The record whose fault line is the median of some records of the class: neither the clearest nor the faintest."""
    numbers = np.flatnonzero(corpus["fault"].values == FAULTS.index(fault))
    numbers = numbers[np.linspace(0, len(numbers) - 1, min(CANDIDATES, len(numbers))).astype(int)]
    shown = {int(n): _shown(corpus.isel(record=n), int(n), 0) for n in numbers}
    levels = {n: _level(record) for n, record in shown.items() if _can_be_drawn(record)}
    if not levels:
        return Example(fault, "No record of this class has a signal, a shaft rate and fault orders to draw.", b"")
    number = sorted(levels, key=lambda n: levels[n])[len(levels) // 2]
    record = corpus.isel(record=number)
    told = [
        f"specimen {int(record['specimen'])} of rig {int(record['rig'])}",
        f"{60 * shown[number].shaft_rate:.0f} rpm",
    ]
    if np.isfinite(record["load"]):
        told.append(f"{float(record['load']):.0f} N")
    if fault != HEALTHY and float(record["width"]) > 0:
        told.append(f"fault {1e3 * float(record['width']):.2g} mm wide")
    caption = f"{', '.join(told)}; the median of {len(levels)} records by the level of the fault line."
    return Example(fault, caption[0].upper() + caption[1:], picture(draw_record(shown[number]), "svg"))


def _shown(record: xr.Dataset, number: int, channel: int) -> Shown:
    fault, shaft_rate = FAULTS[int(record["fault"])], float(record["shaft_rate"])
    return Shown(
        title=f"Record {number}: {fault}, {60 * shaft_rate:.0f} rpm",
        signal=record[SIGNAL].isel(channel=channel).values.astype(float),
        fs=float(record["sample_rate"]),
        shaft_rate=shaft_rate,
        orders=Orders(*(np.asarray(record[name].values, dtype=float) for name in Orders._fields)),
        fault=fault,
    )


def _can_be_drawn(shown: Shown) -> bool:
    numbers = np.array([shown.fs, shown.shaft_rate, *shown.orders])
    return bool(np.isfinite(numbers).all() and (numbers > 0).all() and np.isfinite(shown.signal).all())


def _level(shown: Shown) -> float:
    """Level of the comb of the fault, of a cage its highest line, of a healthy or compound record the highest comb.

    -inf if it cannot be told.
    """
    names = feature_names(("lines",))
    orders = Orders(*(order.reshape(1) for order in shown.orders))
    values, _ = indicators(shown.signal[None], shown.fs, np.array([shown.shaft_rate]), orders, ("lines",))
    columns = [names.index(name) for name in CLASSES[shown.fault].evidence or COMBS.values()]
    return float(np.nan_to_num(values[0, columns], nan=-np.inf).max())


def _scores(results: Results) -> dict[str, Any]:
    """What the page says of the baselines."""
    chance = 1 / len(results.corpus.classes)
    return {
        "results": results,
        "chance": chance,
        "scores": picture(draw_scores(results.baselines, chance, results.by), "svg"),
        "spreads": {name: float(np.std(found.grouped.folds)) for name, found in results.baselines.items()},
        "findings": _findings(results, chance),
        "untrained": UNTRAINED,
        "unfolded": DEFAULT_ESTIMATOR,
    }


def _findings(results: Results, chance: float) -> list[str]:
    """What the numbers of the default baseline say, one sentence each."""
    found, rule = results.baselines[DEFAULT_ESTIMATOR], results.baselines["envelope_rule"]
    name = f"the {DEFAULT_ESTIMATOR.replace('_', ' ')}"
    low, high = found.grouped.interval
    grouped = (
        f"On {results.by}s it has not seen, {name} reaches a balanced accuracy of "
        f"{found.grouped.balanced_accuracy:.3f} (95 % interval {low:.3f} to {high:.3f}); chance is {chance:.3f}, and "
        f"the untrained envelope rule reaches {rule.grouped.balanced_accuracy:.3f}."
    )
    leaky = f"A random split of records would have said {found.leaky.balanced_accuracy:.3f}."
    low, high = found.null.interval
    verdict = "at chance, as it must be" if low <= chance else "above chance: look for a leak, or try another seed"
    null = (
        f"With labels permuted among specimens it reaches {found.null.balanced_accuracy:.3f} "
        f"({low:.3f} to {high:.3f}): {verdict}."
    )
    sentences = [grouped, leaky, null]
    if found.test is not None and results.test is not None and rule.test is not None:
        low, high = found.test.interval
        recordings = found.test.by_recording
        whole = "" if recordings is None else f", {recordings.balanced_accuracy:.3f} by recording"
        sentences.append(
            f"On the other corpus, {_text(results.test.title)}, it reaches {found.test.balanced_accuracy:.3f} by record "
            f"({low:.3f} to {high:.3f}){whole}; the envelope rule reaches {rule.test.balanced_accuracy:.3f}."
        )
    return sentences


def _facts(manifest: Manifest, results: Results) -> list[tuple[str, str]]:
    """Where the numbers come from: the manifest without its parts, and the settings of the benchmark."""
    facts = manifest.model_dump(exclude={"parts_", "index", "complete", "records", "title"}, exclude_unset=True)
    benchmark = {
        "cross-validation": f"{results.folds} folds by {results.by}",
        "features": f"{results.features} ({', '.join(results.groups)})",
        "benchmark seed": results.seed,
        "benchmark versions": results.versions,
    }
    return [(_text(key.replace("_", " ")), _told(value)) for key, value in (facts | benchmark).items()]


def _told(value: object) -> str:
    if isinstance(value, Mapping):
        return _text(", ".join(f"{key} {item}" for key, item in value.items()))
    if isinstance(value, list | tuple):
        return f"{len(value)}"
    return _text(value)


def _text(value: object) -> str:
    """Text of a corpus, cut short."""
    text = str(value)
    return text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]}..."
