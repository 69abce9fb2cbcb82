"""Records of a corpus as pictures: one record by its number, or an example of each class."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from features.band import DEFAULT_BAND, LEAST_WIDTH, checked_band
from features.channels import channel_number
from features.faults import COMBS, LOOKS
from features.indicators import Orders, feature_names, indicators
from features.report.pictures import Shown, check_picture, draw_record, picture, write_picture
from gen.corpus import FAULT_NAMES, SIGNAL, open_corpus
from gen.support.errors import CorpusError

CANDIDATES = 15  # records of a class among which its example is chosen


class Example(NamedTuple):
    """A drawn record of one class with its caption; the image is empty if no record can be drawn."""

    fault: str
    caption: str
    image: bytes


def plot_record(
    corpus: Path | str,
    record: int,
    path: Path | str,
    *,
    channel: int | str = 0,
    band: tuple[float, float] = DEFAULT_BAND,
) -> None:
    """Draw waveform, power spectral density and envelope spectrum of a record, with the fault lines.

    Parameters
    ----------
    corpus
        Folder or file of the corpus.
    record
        Its number, from 0.
    path
        A .png, .svg or .pdf file, written whole or not at all.
    channel
        Name or number of the channel.
    band
        Band of the envelope spectrum [Hz].

    Raises
    ------
    CorpusError
        If the corpus cannot be read or has no such record or channel, the suffix is another, the signal, shaft rate or
        orders of the record are not positive finite numbers, or the disk refuses the file.
    ValueError
        If the band is too narrow or an edge is out of range.
    """
    band = checked_band(*band)
    path = Path(path)
    check_picture(path)
    with open_corpus(corpus) as opened:
        if not 0 <= record < opened.sizes["record"]:
            raise CorpusError(f"{corpus}: no record {record}; give one of 0 to {opened.sizes['record'] - 1}.")
        number = channel_number(opened, channel, corpus)
        several = opened.sizes["channel"] > 1
        shown = _shown(opened.isel(record=record), record, number, named=several)._replace(band=band)
    if 2 * band.low + LEAST_WIDTH > shown.fs:
        raise CorpusError(
            f"{corpus}: the band {band.low:g}-{band.high:g} Hz lies above half the sample rate of {shown.fs:g} Hz; give a lower one."
        )
    if not _can_be_drawn(shown):
        message = (
            f"{corpus}: record {record} cannot be drawn, because its signal, shaft rate or a fault order is not a "
            f"finite number or not positive; choose another record."
        )
        raise CorpusError(message)
    write_picture(draw_record(shown), path)


def draw_examples(corpus: xr.Dataset) -> list[Example]:
    """Example of each class that the corpus contains."""
    return [_example(corpus, code) for code in np.unique(corpus["fault"].values)]


def _example(corpus: xr.Dataset, code: int) -> Example:
    shown, caption = chosen_example(corpus, code)
    return Example(FAULT_NAMES[code], caption, b"" if shown is None else picture(draw_record(shown), "svg"))


def chosen_example(corpus: xr.Dataset, code: int) -> tuple[Shown | None, str]:
    """Record whose level at the fault lines is the median over some records of the class, and its caption; None if none can be drawn."""
    numbers = np.flatnonzero(corpus["fault"].values == code)
    numbers = numbers[np.linspace(0, len(numbers) - 1, min(CANDIDATES, len(numbers))).astype(int)]
    several = corpus.sizes["channel"] > 1
    shown = {int(n): _shown(corpus.isel(record=n), int(n), 0, named=several) for n in numbers}
    levels = {n: _line_level(record) for n, record in shown.items() if _can_be_drawn(record)}
    if not levels:
        return None, "No record of this class has a signal, a shaft rate and fault orders to draw."
    number = sorted(levels, key=lambda n: levels[n])[len(levels) // 2]
    conditions = _conditions(corpus.isel(record=number))
    return shown[number], f"{conditions}; the median of {len(levels)} records by the level of the fault lines."


def _conditions(record: xr.Dataset) -> str:
    """Specimen, speed, load if known, and width of the spall if there is one."""
    known = [
        f"Specimen {int(record['specimen'])} of rig {int(record['rig'])}",
        f"{60 * float(record['shaft_rate']):.0f} rpm",
    ]
    if np.isfinite(record["load"]):
        known.append(f"{float(record['load']):.0f} N")
    if float(record["width"]) > 0:
        known.append(f"fault {1e3 * float(record['width']):.2g} mm wide")
    return ", ".join(known)


def _shown(record: xr.Dataset, number: int, channel: int, *, named: bool = False) -> Shown:
    fault, shaft_rate = FAULT_NAMES[int(record["fault"])], float(record["shaft_rate"])
    sensor = f", {record['channel'].values[channel]}" if named else ""
    return Shown(
        title=f"Record {number}{sensor}: {fault}, {60 * shaft_rate:.0f} rpm",
        signal=record[SIGNAL].isel(channel=channel).values.astype(float),
        fs=float(record["sample_rate"]),
        shaft_rate=shaft_rate,
        orders=Orders(*(np.asarray(record[name].values, dtype=float) for name in Orders._fields)),
        fault=fault,
    )


def _can_be_drawn(shown: Shown) -> bool:
    numbers = np.array([shown.fs, shown.shaft_rate, *shown.orders])
    return bool(np.isfinite(numbers).all() and (numbers > 0).all() and np.isfinite(shown.signal).all())


def _line_level(shown: Shown) -> float:
    """Highest level among the features that tell the class, or among all combs for a class without such features.

    -inf if the record is too short to have features.
    """
    names = feature_names(("lines",))
    orders = Orders(*(order.reshape(1) for order in shown.orders))
    values, _ = indicators(shown.signal[None], shown.fs, np.array([shown.shaft_rate]), orders, ("lines",))
    columns = [names.index(name) for name in LOOKS[shown.fault].evidence or COMBS.values()]
    return float(np.nan_to_num(values[0, columns], nan=-np.inf).max())
