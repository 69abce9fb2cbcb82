"""A corpus on one page to browse: its records by class and range, and each one with its pictures and labels.

``records, 64 at a time -> small arrays of each record -> one deflated text -> a page that inflates the block it shows``

The page is one file without a server or a network. Corpora come from unknown sources: their text is stored as deflated
JSON and put into the page as text alone, and the only script that may run is the one whose digest the page names.
"""

import base64
import hashlib
import json
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from features.signal.rows import FloatArray
from features.signal.spectra import psd
from features.table.band import DEFAULT_BAND, Band, checked_band
from features.table.channels import channel_number, channels_of
from features.table.class_features import COMBS
from features.table.indicators import Orders
from features.table.table_files import read_table
from gen.corpus import (
    DRAWS,
    IDENTITY,
    ROLES,
    SIGNAL,
    check_result,
    class_names,
    corpus_name,
    open_corpus,
)
from gen.corpus.choice import per_record
from gen.corpus.contents import extent
from gen.corpus.fault_classes import FAULT_NAMES, SHAFT, fault_class, fundamentals
from gen.support.errors import CorpusError
from gen.support.executor import run
from gen.support.progress import Progress, counter
from gen.support.units import keys_of, range_text, shown_unit
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.maps import BRIGHTEST_DB
from raceway.reports.pictures import (
    SEGMENT,
    TOLERANCE,
    TURNS,
    DrawnRecord,
    fault_lines,
    highest_drawn_order,
    squared_envelope,
)
from raceway.reports.subject import can_be_drawn, check_band, shown_of
from raceway.reports.templates import short_text, write_page
from raceway.reports.views import envelope_map

if TYPE_CHECKING:
    from distributed import Client

TINY = float(np.finfo(np.float32).tiny)  # keeps silent records finite
RECORDS = 10_000  # on a page, by default
SCRIPTS = ("plots.js", "explore.js")
BLOCK = 64  # records that are inflated together
STEP_DB = 0.5  # of the stored spectra
SHADES = 15  # of the stored waterfall, beside white
COLUMNS, DENSITIES, LEVELS, ROWS, CELLS = 256, 200, 400, 12, 128  # of waveform, PSD, envelope spectrum and waterfall
SCALES = ("peak", "seconds", "highest_db", "last_order", "first_time", "last_time", "rows")
FIELDS: Mapping[str, tuple[str, int]] = {
    "scales": ("float32", len(SCALES)),
    "lowest": ("int8", COLUMNS),
    "highest": ("int8", COLUMNS),
    "density": ("uint8", DENSITIES),
    "envelope": ("uint8", LEVELS),
    "waterfall": ("uint8", ROWS * CELLS // 2),
}
"""Arrays of a record by name, with their type and number of values. In a block, those of all its records follow each other."""
READ = ("fault", "sample_rate", "shaft_rate", "first_shaft_rate", "last_shaft_rate", *Orders._fields)


class Quantity(NamedTuple):
    """Quantity of the records for table, axes and conditions: facts for the page, and numbers or texts."""

    about: Mapping[str, Any]
    values: list[Any]


def write_explorer(
    corpus: Path | str | xr.Dataset,
    output: Path | str,
    *,
    table: Path | str | None = None,
    records: int = RECORDS,
    channel: int | str = 0,
    band: tuple[float, float] = DEFAULT_BAND,
    workers: int = 1,
    scheduler: "Client | str | None" = None,
    progress: Progress | None = None,
) -> tuple[int, int]:
    """Write a page to browse a corpus.

    Parameters
    ----------
    corpus
        Folder or file of the corpus, or records in memory.
    output
        The page, a file.
    table
        Feature table of the corpus, whose features become quantities of the page.
    records
        Largest number of records on the page; of more, an even choice is taken.
    channel, band
        Number or name of the channel, and band of the envelopes [Hz].
    workers, scheduler, progress
        As in `features.feature_table`; progress counts records.

    Returns
    -------
    Numbers of the records on the page and of those of the corpus.

    Raises
    ------
    CorpusError
        If the corpus or the table cannot be read, they have other records, the band lies above half the sample rate, or
        the disk refuses the page.
    """
    band, output = checked_band(*band), Path(output)
    check_result(output, "page")
    with open_corpus(corpus) as opened:
        number, count = channel_number(opened, channel, corpus_name(corpus)), opened.sizes["record"]
        check_band(band, float(opened["sample_rate"][0]), corpus_name(corpus))
        # a choice of a large corpus is spread evenly, so that all its machines are in it
        places = np.linspace(0, count - 1, min(count, records)).round().astype(int)
        quantities = [
            *_labels(opened, places),
            *_features(table, opened, places, str(opened["channel"].values[number])),
        ]
        # blocks go to workers without the labels that only the page needs
        kept = opened[[SIGNAL, *(name for name in READ if name in opened)]].isel(record=places, channel=[number])
        kept = kept.assign({name: kept[name].load() for name in kept.data_vars if name != SIGNAL})
        blocks = (kept.isel(record=slice(first, first + BLOCK)) for first in range(0, len(places), BLOCK))
        reduced, report = list[str](), counter(progress, len(places))
        task = partial(_reduced_block, band=band)
        # one block of records at a time, so that memory does not grow with their number
        with closing(run(task, blocks, workers if scheduler is None else scheduler)) as packed:
            for size, text in packed:
                reduced.append(text)
                report(size)
        sensor = str(opened["channel"].values[number]) if opened.sizes["channel"] > 1 else ""
        title = short_text(opened.attrs.get("title", "untitled corpus"))
        facts = {"band": [*band], "fs": float(opened["sample_rate"][0]), "axes": _axes(quantities)}
    folder = files("raceway.reports")
    script = "\n".join(folder.joinpath(name).read_text(encoding="utf-8") for name in SCRIPTS)
    write_page(
        output,
        "explore.html.jinja",
        title=title,
        channel=short_text(sensor),
        shown=len(places),
        records=count,
        script=script,
        # the page runs no script but this one, whatever texts a corpus holds
        digest=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
        parts=_parts(facts, quantities, reduced),
    )
    return len(places), count


def reduce_record(shown: DrawnRecord) -> dict[str, np.ndarray]:
    """Arrays of `FIELDS` of one record; without scales and levels if it cannot be drawn."""
    empty = {name: np.zeros(size, kind) for name, (kind, size) in FIELDS.items()}
    empty["scales"][:] = np.nan
    try:
        return _reduced(shown) if can_be_drawn(shown) else empty
    except ValueError:  # too short for one of the spectra
        return empty


def _reduced(shown: DrawnRecord) -> dict[str, np.ndarray]:
    visible = int(np.searchsorted(shown.turns, TURNS))
    x = shown.signal[: max(2, visible)] - np.mean(shown.signal)
    peak = max(float(np.abs(x).max()), TINY)
    # a waveform as its extremes in each column of the screen, in one byte each
    lowest, highest = (np.round(127 / peak * _thinned(edge, x, COLUMNS)) for edge in (np.minimum, np.maximum))
    # in dB below the highest level, in steps that fit one byte
    density = psd(shown.signal[None], shown.fs, SEGMENT)[1][0, 1:]  # the mean is removed
    density_db = 10 * np.log10(np.maximum(density, TINY))
    orders, spectrum = squared_envelope(shown)
    # no more orders than the pictures of raceway plot show
    last = min(highest_drawn_order(*fault_lines(shown.orders, shown.fault)), orders[-1])
    level = spectrum[(orders > 0) & (orders <= last)]
    level_db = 20 * np.log10(level / max(float(np.median(level)), TINY) + 1e-12)
    _, times, grid = envelope_map(shown, last)
    rows = min(ROWS, len(times))
    cells = np.zeros((ROWS, CELLS))
    # the highest of the values that share a cell, so that no line is lost
    cells[:rows] = _thinned(np.maximum, _thinned(np.maximum, grid, CELLS).T, rows).T
    shades = np.clip(np.round(SHADES / BRIGHTEST_DB * cells), 0, SHADES).astype(np.uint8).reshape(-1, 2)
    scales = (peak, x.size / shown.fs, density_db.max(), last, times[0], times[-1], rows)
    return {
        "scales": np.array(scales, np.float32),
        "lowest": lowest.astype(np.int8),
        "highest": highest.astype(np.int8),
        "density": _steps(density_db.max() - _thinned(np.maximum, density_db, DENSITIES)),
        "envelope": _steps(_thinned(np.maximum, level_db, LEVELS)),
        # two cells in a byte
        "waterfall": shades[:, 0] | shades[:, 1] << 4,
    }


def _thinned(edge: np.ufunc, values: FloatArray, count: int) -> FloatArray:
    """Highest or lowest value in each of ``count`` columns of the last axis; of fewer values, each several times."""
    starts = np.arange(count) * values.shape[-1] // count
    return edge.reduceat(values, starts, axis=-1)


def _steps(level_db: FloatArray) -> np.ndarray:
    return np.clip(np.round(level_db / STEP_DB), 0, 255).astype(np.uint8)


def _reduced_block(block: xr.Dataset, band: Band) -> tuple[int, str]:
    """Number of records of a block, and their arrays as a text."""
    records = block.load()
    shown = [shown_of(records.isel(record=k), k, 0)._replace(band=band) for k in range(records.sizes["record"])]
    arrays = [reduce_record(recording) for recording in shown]
    return len(shown), _packed(b"".join(array[name].tobytes() for name in FIELDS for array in arrays))


def _labels(corpus: xr.Dataset, places: np.ndarray) -> Iterator[Quantity]:
    """Number and variables of the chosen records, without scenario and identity."""
    yield _quantity("record", "", "number of the record in the corpus", "provenance", places.tolist())
    for name in per_record(corpus):
        variable = corpus[name].variable
        if name in (DRAWS, IDENTITY) or (role := variable.attrs["role"]) not in ROLES:
            continue
        values, words = variable[places].values.tolist(), class_names(variable.attrs)
        told = [words.get(value, str(value)) for value in values] if words else _plain(values)
        yield _quantity(name, variable.attrs.get("units", ""), variable.attrs.get("long_name", ""), role, told)


def _features(path: Path | str | None, corpus: xr.Dataset, places: np.ndarray, channel: str) -> Iterator[Quantity]:
    """Features of the chosen records; a table of several channels has this one among them."""
    if path is None:
        return
    table = read_table(path)
    # a table of other records would put wrong values beside each record
    if IDENTITY not in table or not np.array_equal(table[IDENTITY].values, corpus[IDENTITY].values):
        raise CorpusError(f"{path}: has other records than the corpus; compute it again with raceway features.")
    several = "channel" in table.coords
    of = {
        str(features["channel"].item() if several else table.attrs["channel"]): features
        for features in channels_of(table)
    }
    if channel not in of:
        raise CorpusError(f"{path}: has features of {', '.join(of)}, not of {channel}; choose one of them.")
    for feature in of[channel]["features"][places].transpose("feature", "record"):
        name, unit, meaning = (feature[key].item() for key in ("feature", "units", "long_name"))
        yield _quantity(str(name), unit, meaning, "feature", _plain(feature.values.tolist()))


def _quantity(name: str, unit: object, meaning: object, role: str, values: list[Any]) -> Quantity:
    stored = short_text("" if unit == "1" else unit)
    shown, factor = shown_unit(name, stored)
    numeric = not any(isinstance(value, str) for value in values)
    ends = extent(np.array(values, float)) if numeric and stored else None
    about = {
        "name": name,
        "unit": stored,
        "meaning": short_text(meaning),
        "role": role,
        "range": ends and range_text(name, ends[0], ends[-1], stored),
        "numeric": numeric,
        "shown_unit": shown,
        "factor": factor,
        "columns": {name: 1.0} | keys_of(name, stored),
    }
    return Quantity(about, values)


def _plain(values: Sequence[Any]) -> list[Any]:
    """Numbers with five digits, None for those that are not finite; texts shortened.

    >>> _plain([1234567.0, float("nan"), 3])
    [1234600.0, None, 3]
    """
    return [
        (float(f"{value:.5g}") if np.isfinite(value) else None)
        if isinstance(value, float)
        else value
        if isinstance(value, int)
        else short_text(value)
        for value in values
    ]


def _axes(quantities: Sequence[Quantity]) -> list[str]:
    """Names of the quantities on the axes at first: two combs of fault lines, or an operating condition and a severity."""
    varying = {each.about["name"]: each.about for each in quantities if len(set(each.values)) > 1}
    combs = [name for name in COMBS.values() if name in varying]
    operating, labels = (
        [name for name, about in varying.items() if about["role"] == role and about["unit"]]
        for role in ("operating", "label")
    )
    across, *others = [*operating, "record"]
    return combs[:2] if len(combs) > 1 else [across, [*labels, *others, "record"][0]]


def _parts(facts: Mapping[str, Any], quantities: Sequence[Quantity], blocks: Sequence[str]) -> dict[str, str]:
    """Deflated parts of the page by their names, in the order in which they are needed."""
    about = {
        **facts,
        "block": BLOCK,
        "scales": SCALES,
        "fields": [(name, *field) for name, field in FIELDS.items()],
        "step_db": STEP_DB,
        "shades": SHADES,
        "cells": CELLS,
        "tolerance": TOLERANCE,
        "compared": [SHAFT, *fundamentals()],
        "classes": {
            row.name: {
                "colour": FAULT_COLOURS[row.name],
                "lines": row.lines,
                "side": row.side if row.name in COMBS else None,
            }
            for row in map(fault_class, FAULT_NAMES.values())
        },
        "quantities": [each.about for each in quantities],
    }
    # each part is inflated by the page when it is needed
    parts = {"about": about} | {f"quantity{n}": quantity.values for n, quantity in enumerate(quantities)}
    parts = {name: _packed(json.dumps(part, allow_nan=False).encode()) for name, part in parts.items()}
    return parts | {f"block{n}": text for n, text in enumerate(blocks)}


def _packed(content: bytes) -> str:
    return base64.b64encode(zlib.compress(content, 9)).decode()
