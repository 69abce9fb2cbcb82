"""From the unit of a file to m/s^2, and signs that a stated unit is wrong.

A sensor with a voltage output has a sensitivity; in data sheets it is given in mV per g or in mV per m/s^2.
"""

from typing import Literal, NamedTuple, get_args

import numpy as np

from gen.support.units import STANDARD_GRAVITY
from raceway.importing.refused_files import FloatArray

Unit = Literal["g", "mg", "m/s2", "mm/s2", "V", "mV"]
UNITS: dict[str, Unit] = {**{unit: unit for unit in get_args(Unit)}, "ms-2": "m/s2", "m/s/s": "m/s2"}
"""Units as headers write them, without blanks, ``^`` and ``*``."""
VOLTAGES = ("V", "mV")
QUIETEST, LOUDEST = 1e-3, 1e4  # m s-2, rms: noise of good accelerometers, and far above any bearing
_MILLIVOLTS = {"V": 1000.0, "mV": 1.0}
_ACCELERATIONS = {"m/s2": 1.0, "mm/s2": 1e-3, "g": STANDARD_GRAVITY, "mg": 1e-3 * STANDARD_GRAVITY}


class Scale(NamedTuple):
    """Unit of the values in a file, None for the one that it states, and the sensitivity of a voltage [V per m s-2]."""

    unit: Unit | None = "m/s2"
    sensitivity: float | None = None

    def __str__(self) -> str:
        """Words for the data card."""
        if self.unit is None:
            return "stated in the files"
        if self.unit in VOLTAGES:
            return f"{self.unit}, {1000 * (self.sensitivity or np.nan):g} mV per m/s^2"
        gravity = f", 1 g = {STANDARD_GRAVITY} m/s^2" if self.unit in ("g", "mg") else ""
        return f"{self.unit.replace('2', '^2')}{gravity}"


def volts_per_acceleration(per_g: float | None, per_m_s2: float | None) -> float | None:
    """Sensitivity [V per m s-2] of a sensor given in mV per g or in mV per m/s^2; None if neither is.

    >>> volts_per_acceleration(98.0665, None), volts_per_acceleration(None, 10.0)
    (0.01, 0.01)
    """
    if per_m_s2 is not None:
        return per_m_s2 / 1000
    return None if per_g is None else per_g / (1000 * STANDARD_GRAVITY)


def unit_problem(unit: str | None, sensitivity: float | None) -> str | None:
    """Reason why unit and sensitivity do not belong together; None if they do."""
    if unit in VOLTAGES and sensitivity is None:
        return (
            f"the unit is {unit} and the sensitivity of the sensor is missing; give it in mV per g or in mV per m/s^2"
        )
    if unit not in (*VOLTAGES, None) and sensitivity is not None:
        return f"a sensitivity is given and the unit is {unit}, not V or mV; leave one of the two out"
    return None


def accelerations(values: FloatArray, scale: Scale) -> FloatArray:
    """Values of a file in m s-2, of the same shape."""
    if scale.unit in _MILLIVOLTS and scale.sensitivity is not None:
        return values / (scale.sensitivity * 1000 / _MILLIVOLTS[scale.unit])
    return values if scale.unit == "m/s2" else values * _ACCELERATIONS[scale.unit or "m/s2"]


def doubts(values: FloatArray, signal: FloatArray, scale: Scale, *, absolute: bool) -> list[str]:
    """Signs that the unit is wrong, a sentence without its end for each; none for values that are not finite.

    Parameters
    ----------
    values, signal
        Of the file and in m s-2, shape (time,).
    scale
        The stated unit.
    absolute
        False if the values are shares of the full scale of a converter.
    """
    if not absolute:
        return ["it holds integers, whose full scale is taken as 1, so that its level is not absolute"]
    with np.errstate(all="ignore"):
        rms = float(np.std(signal)) if signal.size else 0.0
    if not np.isfinite(rms) or rms == 0:
        return []
    reasons = []
    if not QUIETEST <= rms <= LOUDEST:
        reasons.append(
            f"its rms is {rms:.2g} m/s^2, and machines show {QUIETEST:g} to {LOUDEST:g} m/s^2; check the unit, which "
            f"is taken as {scale.unit}"
        )
    if np.ptp(values) >= 100 and np.array_equal(values, np.round(values)):
        reasons.append(
            f"it holds whole numbers, as the counts of a converter are, and the unit is taken as {scale.unit}; check the unit"
        )
    return reasons
