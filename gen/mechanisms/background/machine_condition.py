"""One condition of a machine that is not well: lines at orders of its shaft, and bursts of noise that come and go with it.

Loose, rubbing or crooked parts repeat every turn, or every second one, and show in a hundred multiples of the shaft rate, up to some
kilohertz. Where many of them stand close together, the envelope has lines at every order, those of healthy bearings among them.
A burst is noise times ``exp(k (cos(n angle + start) - 1))``, a bell of the shaft angle whose width follows from ``k`` [1]_.

.. [1] N. I. Fisher, Statistical Analysis of Circular Data, Cambridge University Press, 1993, section 3.3.6.
"""

import math
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, StrictInt

from gen.drawing import Distribution, Draws, Section, Weight, within
from gen.mechanisms.background.source import FloatArray
from gen.support.units import decibel_to_ratio

_PERIOD = 2**15  # samples of a table of one period: the 400th line is in it to 1e-3 of its amplitude


class Bursts(Section):
    """Bursts of noise that come and go with the shaft, as parts that strike or rub make them."""

    level_db: Distribution = within(-80, 40)
    """Rms of the bursts relative to that of the background noise."""
    order: Distribution = within(0.05, 50, default=1.0)
    """Number of bursts in a turn of the shaft."""
    length_deg: Distribution = within(1, 180, default=30.0)
    """Length of a burst, in degrees from burst to burst: a short one gives many harmonics."""


class MachineCondition(Section):
    """What one condition adds to the background: lines at multiples of an order of the shaft, and bursts of noise locked to it."""

    kind: Literal["unbalance", "bent_shaft", "misalignment", "looseness", "rub", "belt"]
    """Name of the condition in `machine_condition`, the label of the machine; the keys below say what it adds."""
    weight: Weight = 1.0
    """Share of the machines with this condition, relative to the other entries."""
    order: Distribution = within(0.05, 50, default=1.0)
    """Order of the shaft whose multiples it shows: 1 for the shaft, 0.5 for looseness and rub, that of the belt for a belt."""
    count: Distribution = within(0, 400, default=0.0)
    """Number of lines, at 1, 2, ... times `order`, rounded to a whole number; those beyond half the sample rate are left out."""
    level_db: Distribution = within(-80, 40, each=True, default=-20.0)
    """Rms of a line relative to that of the background noise, drawn for each."""
    strongest: Annotated[StrictInt, Field(ge=1, le=400)] | None = None
    """Number of the line that gets the largest of the drawn levels: 1 for unbalance, 2 for misalignment; any if left out."""
    bursts: Bursts | None = None
    """Bursts of noise locked to the shaft; none if left out."""

    def draw(self, of: Draws) -> Any:
        """The condition, with its largest level at the place of the strongest line."""
        drawn = super().draw(of)
        levels = [*drawn.level_db]
        if levels and self.strongest is not None:
            place, largest = min(self.strongest, len(levels)) - 1, int(np.argmax(levels))
            levels[place], levels[largest] = levels[largest], levels[place]
        return drawn.model_copy(update={"level_db": tuple(levels)})


def lines_of(condition: MachineCondition, angles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Lines of a drawn condition with random phases, shape (time,) [1].

    A line that passes half the sample rate anywhere in the record, where the anti-alias filter would remove it, is left out.
    """
    from scipy.fft import irfft  # loads for half a second, and few recipes need it

    drawn = condition.si()
    order, levels = drawn["order"], decibel_to_ratio(drawn["level"])
    fastest = float(np.abs(np.diff(angles)).max()) * order
    lines = levels * np.exp(2j * math.pi * rng.random(len(levels)))
    lines = lines[: math.ceil(math.pi / fastest) - 1] if fastest > 0 else lines
    if not len(lines):
        return np.zeros(len(angles))
    period = irfft(np.concatenate([[0.0], lines]), _PERIOD) * (_PERIOD / math.sqrt(2))
    turn = np.arange(_PERIOD + 1) * (2 * math.pi / _PERIOD)
    return np.interp(order * angles % (2 * math.pi), turn, np.append(period, period[0]))


def bursts_of(bursts: Bursts, angles: FloatArray, start: float, rng: np.random.Generator) -> FloatArray:
    """Bursts of a condition from a phase ``start`` on [rad], shape (time,) [1]."""
    drawn = bursts.si()
    sharpness = 1 / drawn["length"] ** 2
    bells = np.exp(sharpness * (np.cos(drawn["order"] * angles + start) - 1))
    return decibel_to_ratio(drawn["level"]) * bells / math.sqrt(np.mean(bells**2)) * rng.standard_normal(len(angles))
