"""Checks of a recording before its diagnosis: signals that tell nothing, and signals to be read with care. Pure."""

from typing import NamedTuple

import numpy as np

from features.indicators import LOWEST_RATE, SHORTEST, TOP
from features.signal.rows import FloatArray

CLIPPED_SHARE = 1e-3  # of the samples at the highest or lowest value, from which a signal counts as clipped
CLIPPED_SAMPLES = 5  # at least so many of them
PLAUSIBLE_RMS = (0.03, 1000.0)  # m s-2, of machines that turn
FLATTEST = 1e-7  # spread of a constant signal, relative to its largest value


class Quality(NamedTuple):
    """Reason why a signal tells nothing, empty if there is none; what would help; and warnings."""

    useless: str
    advice: str
    warnings: tuple[str, ...]


def quality_of(x: FloatArray, fs: float, shaft_rate: float) -> Quality:
    """Quality of a signal [m s-2], shape (time,), all finite, at a sample rate and a shaft rate [Hz]."""
    duration = len(x) / fs
    turns, seconds = SHORTEST
    if len(x) == 0 or np.ptp(x) <= FLATTEST * np.abs(x).max():
        return Quality(
            "the signal is constant, as of a sensor or cable that is not connected",
            "check sensor, cable and channel, and record again",
            (),
        )
    least = max(seconds, turns / shaft_rate)
    if duration < least:
        return Quality(
            f"the recording lasts {duration:.3g} s and {least:.3g} s are the least ({turns:g} shaft revolutions and {seconds:g} s)",
            "record 10 s",
            (),
        )
    if fs < LOWEST_RATE:
        return Quality(
            f"the sample rate of {fs:,.0f} Hz is below {LOWEST_RATE:,.0f} Hz, so no band with the impacts of a bearing is left",
            "record at 10,000 Hz or more",
            (),
        )
    return Quality("", "", tuple(_warnings(x, fs, duration, shaft_rate)))


def _warnings(x: FloatArray, fs: float, duration: float, shaft_rate: float) -> list[str]:
    found = []
    share = clipped_share(x)
    if share:
        found.append(
            f"{100 * share:.2g} % of the samples are at the highest or lowest value, so the signal is clipped; levels are not those of "
            "the machine: record again with a larger range."
        )
    if fs < 2 * TOP:
        found.append(
            f"The sample rate of {fs:,.0f} Hz leaves out part of the band up to {TOP:,.0f} Hz that the classifier was trained on; "
            f"record at {2 * TOP:,.0f} Hz or more."
        )
    if duration < 1.0 or duration * shaft_rate < 20:
        found.append(
            f"The recording is short ({duration:.2g} s, {duration * shaft_rate:.0f} shaft revolutions), so that faint lines cannot be "
            "told from noise; 10 s are better."
        )
    rms = float(np.std(x))
    if not PLAUSIBLE_RMS[0] <= rms <= PLAUSIBLE_RMS[1]:
        found.append(
            f"The rms of {rms:.2g} m/s² is implausible for a machine that turns ({PLAUSIBLE_RMS[0]:g} to {PLAUSIBLE_RMS[1]:,.0f} m/s²); "
            "check the unit and the sensitivity. The verdict does not depend on them."
        )
    return found


def clipped_share(x: FloatArray) -> float:
    """Share of the samples that are at the highest or the lowest value, 0 if they are too few to be clipped."""
    at_end = (x == x.max()) | (x == x.min())
    repeated = at_end[1:] & at_end[:-1]  # clipped samples follow one another
    count = int(at_end.sum())
    return count / len(x) if count >= max(CLIPPED_SAMPLES, CLIPPED_SHARE * len(x)) and repeated.any() else 0.0
