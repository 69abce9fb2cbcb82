"""Checks of a recording before its diagnosis: signals that tell nothing, and signals to be read with care. Pure."""

import math
from typing import NamedTuple

import numpy as np

from features.signal.rows import FloatArray
from features.table.band import DEFAULT_BAND
from features.table.indicators import Orders
from features.table.record_batch import LOWEST_RATE, SHORTEST
from gen.support.units import from_si
from raceway.importing.recorded import LONGEST

CLIPPED_SHARE = 1e-3  # of the samples at the highest or lowest value, from which a signal counts as clipped
CLIPPED_SAMPLES = 5  # at least so many of them
PLAUSIBLE_RMS = (0.03, 1000.0)  # m s-2, of machines that turn
FLATTEST = 1e-7  # spread of a constant signal, relative to its largest value
POSSIBLE = (
    1e-12,
    1e9,
)  # m s-2, spread of a signal in whatever unit; fourth powers of more leave the range of single precision
ENOUGH = 10.0  # s, duration to be recorded
GOOD_RATE = "20 kHz"  # sample rate to be recorded
KILO = 1000.0  # Hz; lower sample rates may be meant in kHz
TURNS = 20  # shaft revolutions to be recorded
FEWEST_TURNS = 8  # shaft revolutions below which no verdict is given: a speed in Hz given as rpm leaves so few, too


class Quality(NamedTuple):
    """Reason why a signal tells nothing, empty if there is none; what would help; and warnings."""

    useless: str
    advice: str
    warnings: tuple[str, ...]


def quality_of(x: FloatArray, fs: float, shaft_rate: float, orders: Orders) -> Quality:
    """Quality of a signal [m s-2], shape (time,), all finite, at a sample rate and a shaft rate [Hz], with nominal orders as numbers."""
    reason, advice = _useless(x, fs, shaft_rate, orders)
    return Quality(reason, advice, () if reason else tuple(_warnings(x, fs, len(x) / fs, shaft_rate)))


def enough(shaft_rate: float) -> float:
    """Duration to be recorded at a shaft rate [Hz], in s, of which no more than is used."""
    return min(max(ENOUGH, math.ceil(TURNS / shaft_rate)), LONGEST)


def _useless(x: FloatArray, fs: float, shaft_rate: float, orders: Orders) -> tuple[str, str]:
    """Reason why a signal tells nothing, and what would help; both empty if it tells something."""
    duration, (_, seconds) = len(x) / fs, SHORTEST
    least = max(seconds, FEWEST_TURNS / shaft_rate)
    if least > LONGEST:
        speed = f"{from_si(shaft_rate, 'rpm'):,.3g} rpm"
        reason = f"at {speed} the shaft turns fewer than {FEWEST_TURNS} times in the {LONGEST:g} s that are used"
        return reason, "check the speed; slower shafts cannot be diagnosed"
    if duration < least:
        reason = (
            f"the recording lasts {duration:.3g} s, in which the shaft turns {duration * shaft_rate:.2g} times at "
            f"{from_si(shaft_rate, 'rpm'):,.4g} rpm, and {least:.3g} s are the least ({FEWEST_TURNS} turns and {seconds:g} s)"
        )
        return reason, f"record {enough(shaft_rate):,.0f} s, and check speed and sample rate"
    spread, largest = np.ptp(x), np.abs(x).max()
    # constant up to rounding
    if spread <= FLATTEST * largest:
        reason = "the signal is constant, as of a sensor or cable that is not connected"
        return reason, "check sensor, cable and channel, and record again"
    if not POSSIBLE[0] <= spread <= POSSIBLE[1]:
        return f"the values spread over {spread:.2g} m/s², which is no vibration", "check unit, column and export"
    steps = np.diff(x)
    # a column of times, or a counter
    if np.all(steps >= 0) or np.all(steps <= 0):
        return "the values only rise or only fall, as in a column of times", "choose another column"
    if fs < LOWEST_RATE:
        reason = f"the sample rate of {fs:,.0f} Hz is below {LOWEST_RATE:,.0f} Hz, so no band with the impacts of a bearing is left"
        in_kilohertz = f"; if it is {fs:g} kHz, give {1000 * fs:g} Hz" if fs < KILO else ""
        return reason, f"record at {GOOD_RATE} or more{in_kilohertz}"
    # the lines of every part must lie in the band that is used
    highest, top = shaft_rate * max(orders.bpfo, orders.bpfi, 2 * orders.bsf), min(DEFAULT_BAND.high, fs / 2)
    if highest > top:
        speed = from_si(shaft_rate, "rpm")
        reason = (
            f"at {speed:,.0f} rpm a fault line lies at {highest:,.0f} Hz, and the signal is used up to {top:,.0f} Hz"
        )
        return reason, "check speed and sample rate"
    return "", ""


def _warnings(x: FloatArray, fs: float, duration: float, shaft_rate: float) -> list[str]:
    warnings = []
    share = clipped_share(x)
    # clipped impacts make lines that the machine does not have
    if share:
        warnings.append(
            f"{100 * share:.{1 if share < 0.1 else 0}f} % of the samples are at the highest or lowest value, so the "
            "signal is clipped; levels are not those of the machine: record again with a larger range."
        )
    if fs < 2 * DEFAULT_BAND.high:
        warnings.append(
            f"The sample rate of {fs:,.0f} Hz leaves out part of the band up to {DEFAULT_BAND.high:,.0f} Hz that the classifier was "
            f"trained on; record at {GOOD_RATE} or more."
        )
    if duration < 1.0 or duration * shaft_rate < TURNS:
        warnings.append(
            f"The recording is short ({duration:.2g} s, {duration * shaft_rate:.0f} shaft revolutions), so that faint lines cannot be "
            f"told from noise; {enough(shaft_rate):,.0f} s are better."
        )
    # a wrong unit is seen by a level that machines do not have
    rms = float(np.std(x))
    if not PLAUSIBLE_RMS[0] <= rms <= PLAUSIBLE_RMS[1]:
        warnings.append(
            f"The rms of {rms:.2g} m/s² is implausible for a machine that turns ({PLAUSIBLE_RMS[0]:g} to {PLAUSIBLE_RMS[1]:,.0f} m/s²); "
            "check the unit and the sensitivity. The verdict does not depend on them."
        )
    return warnings


def clipped_share(x: FloatArray) -> float:
    """Share of the samples that are at the highest or the lowest value, 0 if they are too few to be clipped."""
    at_end = (x == x.max()) | (x == x.min())
    repeated = at_end[1:] & at_end[:-1]  # clipped samples follow one another
    count = int(at_end.sum())
    return count / len(x) if count >= max(CLIPPED_SAMPLES, CLIPPED_SHARE * len(x)) and repeated.any() else 0.0
