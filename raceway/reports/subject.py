"""What is drawn: a record of a corpus, or a recording of the user, with the angle of its shaft where the speed varies."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from features.signal.orders import angles_from_speed
from features.signal.rows import FloatArray
from features.signal.tracking import track_speed
from features.table.band import LEAST_WIDTH, Band
from features.table.channels import channel_number
from features.table.indicators import Orders
from gen.corpus import FAULT_NAMES, SIGNAL, corpus_name, open_corpus
from gen.corpus.fault_classes import UNKNOWN, fault_class
from gen.physics.catalogue import CATALOGUE
from gen.support.errors import CorpusError
from gen.support.units import from_si
from raceway.reports.pictures import DrawnRecord

CONSTANT = 1.02  # largest ratio of two speeds that count as one
MARGIN = 1.05  # by which a tracked speed may leave the labelled range


def shown_record(corpus: Path | str | xr.Dataset, record: int | None, channel: int | str, band: Band) -> DrawnRecord:
    """A record of a corpus; None is the one record of a Dataset.

    Raises
    ------
    CorpusError
        If the corpus cannot be read or has no such record or channel, the band lies above half the sample rate, or the
        signal, shaft rate or orders of the record are not positive finite numbers.
    """
    where = corpus_name(corpus)
    with open_corpus(corpus) as opened:
        if record is None and opened.sizes["record"] > 1:
            raise CorpusError(f"{where}: has {opened.sizes['record']} records; give one, such as isel(record=0).")
        if not 0 <= (record or 0) < opened.sizes["record"]:
            raise CorpusError(f"{where}: no record {record}; give one of 0 to {opened.sizes['record'] - 1}.")
        number = channel_number(opened, channel, where)
        several = opened.sizes["channel"] > 1
        shown = shown_of(opened.isel(record=record or 0), record, number, named=several)._replace(band=band)
    return _checked(shown, where if record is None else f"{where}: record {record}")


def shown_recording(
    name: str, signal: FloatArray, fs: float, shaft_rates: tuple[float, float], orders: Sequence[float], band: Band
) -> DrawnRecord:
    """A recording of the user, shape (time,) [m s-2], at a shaft rate between two [Hz].

    Raises
    ------
    CorpusError
        If the band lies above half the sample rate, a sample is not a finite number, or the speed varies and cannot be
        tracked in the signal.
    """
    signal = np.asarray(signal, dtype=float)
    nominal = Orders(*(np.asarray(order, dtype=float) for order in orders))
    shown = DrawnRecord(name, signal, fs, float(np.mean(shaft_rates)), nominal, UNKNOWN, band)
    turning = _turning(_checked(shown, name), *shaft_rates)
    if turning.angle is None and _varies(*shaft_rates):
        low, high = (from_si(rate, "rpm") for rate in shaft_rates)
        raise CorpusError(
            f"{name}: the speed between {low:.0f} and {high:.0f} rpm cannot be tracked in the signal, in which harmonics of the "
            f"shaft do not stand above the noise all the time, or which is too short; give one speed for a part of constant speed."
        )
    return turning


def shown_of(record: xr.Dataset, number: int | None, channel: int, *, named: bool = False) -> DrawnRecord:
    """Record of an opened corpus, or without a number one alone; ``named`` puts the channel into the title."""
    fault = FAULT_NAMES[int(record["fault"])]
    words = fault_class(fault).words
    sensor = f", {record['channel'].values[channel]}" if named else ""
    start = f"{words}{sensor}" if number is None else f"Record {number}{sensor}: {words[0].lower()}{words[1:]}"
    # a bearing that the catalogue lacks is a stranger's text, which pictures do not have
    bearing = str(record["bearing"].item())
    shown = DrawnRecord(
        title=f"{start}, {bearing}" if bearing in CATALOGUE else start,
        signal=record[SIGNAL].isel(channel=channel).values.astype(float),
        fs=float(record["sample_rate"]),
        shaft_rate=float(record["shaft_rate"]),
        orders=Orders(*(np.asarray(record[name].values, dtype=float) for name in Orders._fields)),
        fault=fault,
    )
    # at a varying speed the angle of the shaft is tracked in the signal
    ends = [float(record[name]) for name in ("first_shaft_rate", "last_shaft_rate") if name in record]
    return _turning(shown, *(sorted(ends) if len(ends) == 2 else [shown.shaft_rate] * 2))


def can_be_drawn(shown: DrawnRecord) -> bool:
    """Whether signal, rates and orders are finite, and the latter positive."""
    numbers = np.array([shown.fs, shown.shaft_rate, *shown.orders])
    return bool(np.isfinite(numbers).all() and (numbers > 0).all() and np.isfinite(shown.signal).all())


def check_band(band: Band, fs: float, where: str) -> None:
    """Refuse a band that lies above half the sample rate [Hz] with a CorpusError."""
    low, high = band
    if 2 * low + LEAST_WIDTH > fs:
        raise CorpusError(
            f"{where}: the band {low:g}-{high:g} Hz lies above half the sample rate of {fs:g} Hz; give a lower one."
        )


def _varies(slowest: float, fastest: float) -> bool:
    return fastest > CONSTANT * slowest


def _turning(shown: DrawnRecord, slowest: float, fastest: float) -> DrawnRecord:
    """The same with its speed in the title, and with the angle of the shaft if the speed varies and can be tracked in the signal."""
    if not (can_be_drawn(shown) and _varies(slowest, fastest)):
        return shown._replace(title=f"{shown.title}, {from_si(shown.shaft_rate, 'rpm'):,.0f} rpm")
    title = f"{shown.title}, {from_si(slowest, 'rpm'):,.0f}-{from_si(fastest, 'rpm'):,.0f} rpm"
    try:
        rate = track_speed(shown.signal, shown.fs, slowest / MARGIN, fastest * MARGIN).rate
    except ValueError:  # too short, or sampled too slowly, for a course
        rate = np.full(1, np.nan)
    if not np.isfinite(rate).all():
        return shown._replace(title=f"{title} (taken as constant)")
    return shown._replace(title=title, angle=angles_from_speed(rate, shown.fs), shaft_rate=float(rate.mean()))


def _checked(shown: DrawnRecord, where: str) -> DrawnRecord:
    check_band(shown.band, shown.fs, where)
    if not can_be_drawn(shown):
        raise CorpusError(
            f"{where}: cannot be drawn, because its signal, shaft rate or a fault order is not a finite number or not "
            f"positive; choose another record."
        )
    return shown
