"""Vibration of a machine on a loose support: the shaft lifts it off the ground, and it strikes the ground when it lands.

A force that turns with the shaft lifts a machine that nothing but its weight holds, with ``lift`` as the ratio of the two::

    x'' = g (lift cos(angle - phase) - 1)                 off the ground
    x'' = -omega^2 x - 2 zeta omega x'                    on the ground, against its slow deflection

It lands once a turn as long as a flight is shorter than a turn. Longer flights end every second turn and give half orders of the shaft,
and in between the landings follow no order at all [1]_.

.. [1] A. Muszynska, P. Goldman, "Chaotic responses of unbalanced rotor/bearing/stator systems with looseness or rubs", Chaos, Solitons
       and Fractals 5(9), 1995, pp. 1683-1704.
"""

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.source import FloatArray, MachineCondition, Streams
from gen.support.units import STANDARD_GRAVITY, decibel_to_ratio


class Looseness(MachineCondition):
    """A support that the shaft lifts off the ground once a turn, or every second turn: harmonics, half orders and impacts."""

    place = "looseness"
    labels = (
        Variable("looseness", "f8", "1", "latent", "force that lifts a loose machine over its weight, 0 on a firm support",
            lambda machine: machine.si()["lift"]),
    )  # fmt: skip

    probability: Probability
    """Share of the rigs that stand loosely."""
    lift: Distribution = within(1, 20, open_low=True)
    """Largest force of the shaft over the weight of the machine. With the damping of 70 % it lands once a turn up to about 3, every second
    turn at 5."""
    frequency_hz: Distribution = within(20, 20_000)
    """Resonance of the machine on the ground, which the impacts excite."""
    damping_percent: Distribution = within(1, 95, default=70.0)
    """Damping ratio of that resonance: the higher it is, the less the machine bounces."""
    level_db: Distribution = within(-80, 40)
    """Rms of this vibration relative to that of the background noise."""

    def vibrations(self, angles: FloatArray, fs: float, stream: Streams) -> list[FloatArray]:
        """Acceleration of the machine beside that on firm ground; the angle at which the shaft lifts most belongs to the rig."""
        from gen.physics.rattle import rattling  # compiled: a recipe is read without numba

        drawn = self.si()
        lifting = drawn["lift"] * STANDARD_GRAVITY * np.cos(angles - 2 * np.pi * stream(level="rig").random())
        ground, _ = rattling(-lifting, drawn["frequency"], drawn["damping"], STANDARD_GRAVITY, fs)
        moved = ground + lifting
        rms = float(np.sqrt(np.mean(moved**2)))
        # there is no flight in less than a turn
        return [moved * (decibel_to_ratio(drawn["level"]) / rms)] if rms > 0 else []

    @staticmethod
    def compile() -> None:
        """Compile the flights."""
        from gen.physics.rattle import compile_rattling

        compile_rattling()
