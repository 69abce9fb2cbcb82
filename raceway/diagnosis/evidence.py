"""Evidence of a fault: the lines of fault families that stand above the floor of an envelope spectrum.

``band spectra -> the highest line of each family -> its harmonics and sidebands -> lines that another family explains removed``

The first line of a family must exceed a level that noise exceeds anywhere in the search of a recording with a
probability of 1 %. Further lines are searched only at multiples of the frequency of the first one, and beside them, and
again noise adds one with 1 %. A line is told at its peak, also if the peak is among the bins left out. Four rules leave out
lines that are real but caused by no fault:

- Multiples of the shaft rate are never counted, since imbalance and gears make them too. So a fault line is found only
  if its flank stands out where that of a multiple has ended.
- The first line must be ten times as high as the floor, because long recordings of healthy bearings show faint lines
  at many fault frequencies.
- Lines of a race that are lower than the line at half its frequency are harmonics of another part.
- The family with the largest sum of levels comes first, and its lines explain no other family. The others must come
  within 10 dB of it: beside its harmonics shaft and cage make lines everywhere.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from features.signal.rows import FloatArray
from features.table.class_features import COMBS
from features.table.indicators import Orders
from gen.corpus.fault_classes import SHAFT, FaultClass, families
from raceway.diagnosis.spectrum import TOP_ORDER, BandSpectrum

FALSE_ALARM = 0.01  # probability that noise has a first line in a recording, and that it adds a further line to one
TOLERANCE = 0.02  # of an order: slip, contact angle and the remaining error of the speed
DRIFT = 0.002  # by which harmonics of one family may differ from multiples of each other
SHAFT_DRIFT = 0.004  # error of the shaft rate, by which its multiples are left out more widely
LEAST_LEVEL = 10.0  # dB, of a first line
SPREAD = 10.0  # dB, between the first lines of the strongest and the weakest family
FIRST_HARMONICS = 2  # harmonics among which the first line is searched
HARMONICS = 5  # of a fault line that are searched
SIDEBANDS = 4  # on each side of a harmonic that belong to its family
CAGE_LINES = 2  # a slow fluctuation has one line at the rate of the cage by chance
TRIALS_PER_BIN = 0.5  # independent trials per bin of spectra that are padded to four times their length


class Line(NamedTuple):
    """A line found.

    Attributes
    ----------
    fault
        Class of the format that the line tells.
    name
        Such as ``2 BPFI`` or ``BPFI + shaft``.
    harmonic
        Number of the harmonic, from 1, that the line is or lies beside.
    order, frequency
        As measured, in multiples of the shaft rate and in Hz.
    level
        Power over the floor [dB].
    band
        Of the envelope [Hz].
    side
        Rate at whose distance it lies beside a harmonic, ``shaft`` or ``ftf``; empty for the harmonic itself.
    channel
        Of the recording.
    """

    fault: str
    name: str
    harmonic: int
    order: float
    frequency: float
    level: float
    band: tuple[float, float]
    side: str = ""
    channel: str = ""


def find_evidence(spectra: Sequence[BandSpectrum], shaft_rate: float, orders: Orders) -> list[Line]:
    """Lines of all fault families, strongest family first, each by harmonic.

    Parameters
    ----------
    spectra
        Of `raceway.diagnosis.spectrum.band_spectra`.
    shaft_rate
        [Hz]
    orders
        Nominal fault orders, as numbers.
    """
    # the ratio in the bins that no line explains yet; lines of the shaft are in every machine
    left = [np.where(_near_shaft(spectrum, shaft_rate), 0.0, spectrum.ratio) for spectrum in spectra]
    sought = [*families()]
    trials = TRIALS_PER_BIN * sum(
        np.count_nonzero(ratio[slice(*place)])
        for row in sought
        for spectrum, ratio in zip(spectra, left, strict=True)
        for place in _search_bins(row, spectrum, shaft_rate, orders)
    )
    lines: list[Line] = []
    least = LEAST_LEVEL
    while sought and trials:
        first_lines = [_first_line(row, spectra, left, shaft_rate, orders, FALSE_ALARM / trials) for row in sought]
        held = [
            _family(row, spectra[number], left[number], fundamental, shaft_rate, orders)
            if highest and not _higher_at_half(row, spectra[number], left[number], fundamental, highest)
            else []
            for row, (highest, number, fundamental) in zip(sought, first_lines, strict=True)
        ]
        sums = [
            sum(line.level for line in family if line.side in ("", row.side))
            for row, family in zip(sought, held, strict=True)
        ]
        strongest = int(np.argmax(sums))
        highest, _, fundamental = first_lines[strongest]
        row, family = sought.pop(strongest), held[strongest]
        level = 10 * float(np.log10(max(highest, 1.0)))
        if (
            not family
            or level < least
            or (row.name not in COMBS and sum(not line.side for line in family) < CAGE_LINES)
        ):
            continue
        lines += family
        least = max(least, level - SPREAD)
        for spectrum, ratio in zip(spectra, left, strict=True):
            _remove(spectrum, ratio, row, fundamental, shaft_rate, orders)
    return lines


def line_facts(line: Line) -> dict[str, object]:
    """Line as plain values, for JSON."""
    return {
        "line": line.name,
        "fault": line.fault,
        "harmonic": line.harmonic,
        "order": round(line.order, 4),
        "frequency_hz": round(line.frequency, 3),
        "level_db": round(line.level, 2),
        "band": [round(edge, 1) for edge in line.band],
        "sideband": bool(line.side),
        "channel": line.channel,
    }


def side_of(row: FaultClass, orders: Orders) -> float:
    """Distance of the sidebands of a class, in orders."""
    return 1.0 if row.side == SHAFT.base else float(getattr(orders, row.side))


def _search_bins(
    row: FaultClass, spectrum: BandSpectrum, shaft_rate: float, orders: Orders
) -> Iterator[tuple[int, int]]:
    """Bins in which the first line of a family is searched, harmonic by harmonic."""
    for harmonic in range(1, FIRST_HARMONICS + 1):
        frequency = harmonic * float(row.lines[0].order(orders)) * shaft_rate
        yield spectrum.bins(frequency, TOLERANCE * frequency)


def _near_shaft(spectrum: BandSpectrum, shaft_rate: float) -> np.ndarray:
    """Whether a bin cannot be resolved from a multiple of the shaft rate, zero included, shape (frequency,)."""
    frequency = np.arange(len(spectrum.ratio)) * spectrum.resolution
    multiple = np.rint(frequency / shaft_rate)
    return np.abs(frequency - multiple * shaft_rate) < spectrum.width + SHAFT_DRIFT * multiple * shaft_rate


def _peak(spectrum: BandSpectrum, place: int) -> int:
    """Bin of the peak on whose flank a bin lies."""
    ratio, before = spectrum.ratio, -1
    while place != before:
        before, first = place, max(place - 1, 0)
        place = first + int(ratio[first : place + 2].argmax())
    return place


def _first_line(
    row: FaultClass,
    spectra: Sequence[BandSpectrum],
    left: Sequence[FloatArray],
    shaft_rate: float,
    orders: Orders,
    probability: float,
) -> tuple[float, int, float]:
    """Ratio of the highest line above the threshold, 0 without one; number of its spectrum; its fundamental [Hz]."""
    best = 0.0, 0, 0.0
    for number, (spectrum, of_spectrum) in enumerate(zip(spectra, left, strict=True)):
        threshold = spectrum.threshold(probability)
        for harmonic, (first, last) in enumerate(_search_bins(row, spectrum, shaft_rate, orders), start=1):
            ratio = of_spectrum[first:last]
            if ratio.size and ratio.max() > max(threshold, best[0]):
                best = float(ratio.max()), number, (first + int(ratio.argmax())) * spectrum.resolution / harmonic
    return best


def _higher_at_half(
    row: FaultClass, spectrum: BandSpectrum, left: FloatArray, fundamental: float, ratio: float
) -> bool:
    """Whether a line at half the fundamental [Hz] of a race exceeds a ratio; a ball may strike one race alone, at BSF."""
    half = left[slice(*spectrum.bins(0.5 * fundamental, 0.5 * spectrum.width + DRIFT * fundamental))]
    return bool(row.name in COMBS and row.lines[0].multiple == 1 and half.max(initial=0.0) > ratio)


def _family(
    row: FaultClass, spectrum: BandSpectrum, left: FloatArray, fundamental: float, shaft_rate: float, orders: Orders
) -> list[Line]:
    """Harmonics of a fundamental [Hz], and the sidebands of those found at the rate of the family and of the shaft."""
    rates = {"": 0.0, row.side: side_of(row, orders) * shaft_rate, SHAFT.base: shaft_rate}
    base = row.lines[0].multiple
    places = [(harmonic, "", 0) for harmonic in range(1, (HARMONICS if row.name in COMBS else len(row.lines)) + 1)]
    # of balls and races also sidebands, at the rate of the cage and of the shaft
    if row.name in COMBS:
        places += [(harmonic, side, sign) for harmonic in (1, 2) for side in rates if side for sign in (-1, 1)]
    searches = {}
    for harmonic, side, sign in places:
        frequency = harmonic * fundamental + sign * rates[side]
        searches[harmonic, side, sign] = spectrum.bins(frequency, 0.5 * spectrum.width + DRIFT * frequency)
    # one bound for all harmonics and sidebands of the family
    trials = max(1.0, TRIALS_PER_BIN * sum(last - first for first, last in searches.values()))
    threshold = spectrum.threshold(FALSE_ALARM / trials)
    lines: dict[tuple[int, str, int], Line] = {}
    for (harmonic, side, sign), (first, last) in searches.items():
        ratio = left[first:last]
        # a sideband counts only beside its harmonic
        if not ratio.size or ratio.max() <= threshold or (sign and (harmonic, "", 0) not in lines):
            continue
        peak = _peak(spectrum, first + int(ratio.argmax()))
        frequency = peak * spectrum.resolution
        name = row.lines[0].label if harmonic == 1 else f"{base * harmonic} {row.lines[0].base.upper()}"
        if sign:
            name += f" {'-+'[sign > 0]} {side if side == SHAFT.base else side.upper()}"
        level = 10 * float(np.log10(spectrum.ratio[peak]))
        lines[harmonic, side, sign] = Line(
            row.name, name, harmonic, frequency / shaft_rate, frequency, level, spectrum.band, side, spectrum.channel
        )
    return [lines[key] for key in sorted(lines, key=lambda key: (key[2] != 0, *key))]


def _remove(
    spectrum: BandSpectrum, left: FloatArray, row: FaultClass, fundamental: float, shaft_rate: float, orders: Orders
) -> None:
    """Set to zero the bins that a family explains: harmonics, and sidebands at the rates of shaft and cage."""
    sides = {0.0, *(n * shaft_rate for n in range(-SIDEBANDS, SIDEBANDS + 1))}
    sides |= {n * side_of(row, orders) * shaft_rate for n in range(-SIDEBANDS, SIDEBANDS + 1)}
    last = int(TOP_ORDER * shaft_rate / fundamental) + 1
    for harmonic in range(last + 1):  # 0: the sidebands of the mean are lines at the rates themselves
        for side in sides:
            frequency = abs(harmonic * fundamental + side)
            left[slice(*spectrum.bins(frequency, spectrum.width + DRIFT * frequency))] = 0.0
