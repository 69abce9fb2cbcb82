"""Faults of the measuring chain: sensor mount, cable, amplifier and data transfer. All are off unless a recipe asks for them.

A fault that lasts as long as an installation belongs to the rig; a fault that comes and goes belongs to the record. Accelerations are
those of the stored signal, after ``level``: a cable and an amplifier know nothing of the vibration of the machine.
"""

from gen.drawing.distributions import Distribution, within
from gen.drawing.section import Probability, Section


class LooseMount(Section):
    """A sensor that is not held firmly: mount and sensor resonate, and the sensor lifts off and strikes the machine (rattle)."""

    probability: Probability
    """Share of the sensors that are mounted loosely; drawn per rig for each channel."""
    frequency_hz: Distribution = within(50, 20_000)
    """Resonance of the sensor on its mount: the looser the mount, the lower it is."""
    damping_percent: Distribution = within(0.1, 50)
    """Damping ratio of that resonance."""
    holding_m_s2: Distribution = within(0, 1e6, open_low=True)
    """Force that holds the sensor over its mass; the sensor lifts off where it would have to follow with more than this acceleration."""


class Saturation(Section):
    """An amplifier whose range ends below the full scale of the converter, so that no clipped count reveals the overload."""

    probability: Probability
    """Share of the rigs with such an amplifier."""
    limit_m_s2: Distribution = within(0, 1e6, open_low=True)
    """Largest output of the amplifier, as acceleration; the same for all channels."""
    knee_percent: Distribution = within(0, 100, default=0.0)
    """Upper part of the range in which the gain falls smoothly to 0; 0 limits the signal at once."""
    recovery_s: Distribution = within(0, 10, default=0.0)
    """Time constant in which an overload charges the amplifier and it discharges again: a shifted baseline; 0 for no shift."""


class MainsHum(Section):
    """Hum of the power supply, common to all channels."""

    probability: Probability
    """Share of the rigs with hum."""
    frequency_hz: Distribution = within(10, 500, default=50.0)
    """Nominal frequency of the mains: 50 or 60 in most countries."""
    deviation_percent: Distribution = within(-10, 10, default=0.0)
    """Deviation of the mains from its nominal frequency, drawn for each record."""
    rms_m_s2: Distribution = within(0, 1e4, open_low=True)
    """Rms of the hum at the mains frequency."""
    count: Distribution = within(0, 40, default=3.0)
    """Number of odd multiples (3x, 5x, ...) beside the mains frequency, rounded to a whole number."""
    third_db: Distribution = within(-80, 20, default=-10.0)
    """Level of the third multiple relative to the mains frequency; the others fall as one over their order."""


class Drift(Section):
    """A baseline that moves slowly: warming of the sensor, and settling after it was switched on or struck."""

    probability: Probability
    """Share of the records with drift; each channel drifts by itself."""
    wander_m_s2: Distribution = within(0, 1e4, default=0.0)
    """Rms of a random baseline."""
    wander_corner_hz: Distribution = within(1e-4, 100, default=0.2)
    """Frequency above which the power spectral density of the random baseline falls with the square of the frequency."""
    settling_m_s2: Distribution = within(-1e4, 1e4, default=0.0)
    """Baseline at the start of the record that decays exponentially."""
    settling_time_s: Distribution = within(1e-3, 1e3, default=1.0)
    """Time constant of that decay."""


class DroppedSamples(Section):
    """Gaps in the data transfer, at the same times in all channels."""

    probability: Probability
    """Share of the records with gaps."""
    count: Distribution = within(1, 1000)
    """Number of gaps in a record, rounded to a whole number; gaps may overlap."""
    gap_s: Distribution = within(0, 60, open_low=True)
    """Length of each gap of a record, such as the time of one packet; at least one sample."""
    held_percent: Distribution = within(0, 100, default=50.0)
    """Share of the gaps filled with the last sample before them; the others are filled with 0."""


class GainSteps(Section):
    """Sudden changes of the sensitivity: a range that switches, a contact that fails; the same for all channels."""

    probability: Probability
    """Share of the records with such steps."""
    count: Distribution = within(1, 20)
    """Number of steps in a record, rounded to a whole number; their times are random."""
    step_db: Distribution = within(-60, 60)
    """Change of the gain at a step, drawn for each; the gain is 0 dB before the first."""


class EmiBursts(Section):
    """Short oscillations that a switching contact or converter induces in the cables, the same in all channels."""

    probability: Probability
    """Share of the records near such a source."""
    rate_hz: Distribution = within(0.1, 1000)
    """Mean number of bursts per second, at random times."""
    frequency_hz: Distribution = within(10, 100_000)
    """Frequency of the oscillation; above half the sample rate it aliases."""
    decay_s: Distribution = within(1e-5, 1)
    """Time in which a burst decays to 37 %."""
    peak_m_s2: Distribution = within(0, 1e5, open_low=True)
    """Rms of the peaks of the bursts."""


class SensorFaultsSection(Section):
    """Faults of the measuring chain, each with a variable in the corpus; a fault that is left out does not occur."""

    loose_mount: LooseMount | None = None
    """Sensor that resonates and rattles on its mount; none if left out."""
    saturation: Saturation | None = None
    """Amplifier that limits the signal; none if left out."""
    mains_hum: MainsHum | None = None
    """Lines of the power supply; none if left out."""
    drift: Drift | None = None
    """Slow movement of the baseline; none if left out."""
    dropped_samples: DroppedSamples | None = None
    """Gaps in the transferred data; none if left out."""
    gain_steps: GainSteps | None = None
    """Sudden changes of the sensitivity; none if left out."""
    emi_bursts: EmiBursts | None = None
    """Induced oscillations of switching devices; none if left out."""


def sensor_fault_problem(faults: SensorFaultsSection, full_scale: float | None, duration: float) -> str | None:
    """Sentence about a sensor fault that can have no effect or no place in a record; None if there is none.

    Parameters
    ----------
    faults : SensorFaultsSection
    full_scale : float or None
        Of the converter, None without one [m s-2].
    duration : float
        Of a record [s].
    """
    saturation, dropped = faults.saturation, faults.dropped_samples
    if saturation is not None and full_scale is not None and saturation.limit_m_s2.support()[0] >= full_scale:
        return (
            f"sensor_faults.saturation.limit_m_s2: {saturation.limit_m_s2.support()[0]:g} is not below "
            f"recording.converter.full_scale_m_s2 {full_scale:g}, so the converter clips first; lower the limit."
        )
    if dropped is not None and dropped.gap_s.support()[1] >= duration:
        return (
            f"sensor_faults.dropped_samples.gap_s: {dropped.gap_s.support()[1]:g} s leaves nothing of a record; "
            f"keep it below recording.duration_s {duration:g}."
        )
    return None
