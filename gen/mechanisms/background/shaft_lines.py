"""Lines at multiples of an order of the shaft: those of every machine, and of an unbalance, a bent shaft, misalignment and a belt.

The machine moves on an ellipse at each line [1]_. The lines fall with their order, and those of an unbalance grow with the square of the
speed [2]_.

.. [1] A. Muszynska, Rotordynamics, CRC Press, 2005.
.. [2] R. B. Randall, Vibration-based Condition Monitoring, 2nd edition, Wiley, 2021.
"""

import math
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.source import FloatArray, MachineCondition, MachineSource, Streams, Vibration
from gen.physics.elementary import power
from gen.support.units import decibel_to_ratio

_FLATTEST = 0.8  # the machine never moves along a straight line
_SAMPLES = 80  # of the highest line in a table of one period, between which it is read to 1e-3 of its amplitude


class ShaftLines(MachineSource):
    """Lines at multiples of an order of the shaft."""

    strongest: ClassVar[int] = 1
    """Number of the line from which on the others fall."""
    of_unbalance: ClassVar[bool] = False
    """Whether the first line is in phase with the unbalance of the model, which points along the mark of the shaft."""

    probability: Probability
    """Share of the rigs that have these lines."""
    order: Distribution = within(0.05, 50, default=1.0)
    """Order of the shaft whose multiples it shows: 1 for the shaft, that of the belt for a belt."""
    count: Distribution = within(1, 400, default=1.0)
    """Number of lines, at 1, 2, ... times `order`, rounded to a whole number; those beyond half the sample rate are left out."""
    level_db: Distribution = within(-80, 40, each=True)
    """Rms of a line relative to that of the background noise, ahead of its slope and of the paths, whose resonances shift power among the
    lines; drawn for each, the mean over all directions."""
    slope_db_per_octave: Distribution = within(-40, 0, default=0.0)
    """How lines fall for each doubling or halving of their order away from the strongest line: the second of a misaligned shaft, else
    the first."""
    growth: Distribution = within(0, 4, default=0.0)
    """Power of the speed with which the lines grow; 2 is that of an unbalance."""
    at_rpm: Distribution = within(0.1, 1_000_000, default=1800.0)
    """Speed at which the lines have these levels, if they grow with it."""

    def vibrations(self, angles: FloatArray, fs: float, stream: Streams) -> list[Vibration]:
        """Lines on their ellipses, whose phases belong to the rig."""
        moved = self._lines(angles, stream(level="rig"))
        if (growth := self.si()["growth"]) > 0:
            rate = np.abs(np.gradient(angles)) * fs / (2 * math.pi)
            moved *= power(np.maximum(rate, 1e-9) / self.si()["at_rate"], growth)
        return [moved]

    def _lines(self, angles: FloatArray, of_rig: np.random.Generator) -> NDArray[np.complexfloating]:
        """Lines with random phases, shape (time,) [1].

        A line that passes half the sample rate anywhere in the record, where the anti-alias filter would remove it, is left out.
        """
        from scipy.fft import ifft  # loads for half a second: a recipe is read without it

        drawn = self.si()
        numbers = np.arange(1, len(drawn["level"]) + 1)
        fall = drawn["slope_db_per_octave"] * np.abs(np.log2(numbers / self.strongest))
        flatness, *phases = of_rig.random((3, len(numbers)))
        flatness *= _FLATTEST
        forward, backward = np.exp(2j * math.pi * np.array(phases))
        if self.of_unbalance:
            forward[0] = 1.0
        # mean over all directions, of which each has the forward and the backward part
        lengths = math.sqrt(2) * decibel_to_ratio(drawn["level"] + fall) / np.sqrt(1 + flatness**2)
        fastest = float(np.abs(np.diff(angles)).max()) * drawn["order"]
        kept = math.ceil(math.pi / fastest) - 1 if fastest > 0 else len(numbers)
        size = _SAMPLES * len(numbers)
        spectrum = np.zeros(size, complex)
        spectrum[numbers[:kept]] = (lengths * forward)[:kept]
        spectrum[-numbers[:kept]] = (lengths * flatness * backward)[:kept]
        period = ifft(spectrum, norm="forward")
        turn = np.arange(size + 1) * (2 * math.pi / size)
        return np.interp(drawn["order"] * angles % (2 * math.pi), turn, np.append(period, period[0]))


class Harmonics(ShaftLines):
    """Lines at multiples of the shaft rate, which sound machines have too."""

    place, of_unbalance = "harmonics", True


class Unbalance(ShaftLines, MachineCondition):
    """A rotor that is out of balance: a line at the shaft rate, and few more."""

    place, of_unbalance = "unbalance", True

    growth: Distribution = within(0, 4, default=2.0)
    """Power of the speed with which the lines grow; 2 is that of an unbalance."""


class BentShaft(ShaftLines, MachineCondition):
    """A shaft that is not straight: lines at multiples of the shaft rate."""

    place = "bent_shaft"


class Misalignment(ShaftLines, MachineCondition):
    """Shafts that are out of line: lines at multiples of the shaft rate, with the second as the strongest."""

    place, strongest = "misalignment", 2


class Belt(ShaftLines, MachineCondition):
    """A belt, which turns slower than the shaft: lines at multiples of its rate."""

    place = "belt"
