"""Is ``detectable`` what it says? Alarms on healthy records, and the agreement with an envelope analysis that is not ours.

``python -m benchmarks.detectable`` makes records of ``domain_randomised``, each before and after its damage and with all else the same. It
prints two tables. The first has the alarms of the rule on healthy records: each is compared with another recording of itself, which
differs in its noise alone, and, for comparison, tested against noise without knowledge of the machine. The second has by class the share
of the records in which the fault can be seen, and how often an envelope analysis of the stored signals, written with SciPy alone, agrees.
"""

import argparse
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, hilbert, sosfiltfilt

from gen.drawing import Level
from gen.generation.undetected import make_records
from gen.measurement.judging import FALSE_ALARM, judges_of
from gen.measurement.measure import Measured, counts_per_unit, measure
from gen.measurement.mixing import Parts
from gen.measurement.rig import rig_filters
from gen.mechanisms.background.background import MACHINE_SOURCES
from gen.recipe import Recipe, read_recipe
from gen.scenarios import Scenario
from gen.simulation.truth import lines_of_faults

FloatArray = NDArray[np.float64]


class Case(NamedTuple):
    """A record with a fault and its twin; signals have the shape (time,) [m s-2]."""

    fault: str
    detectable: bool
    record: FloatArray
    twin: FloatArray
    again: FloatArray
    """Another recording of the twin."""
    impulses: NDArray[np.float32]
    """Lines of the impulses of the machine, as for the judge."""
    orders: tuple[float, ...]
    shaft_rate: float
    """[Hz]."""


_BACKGROUND = {"noise", *(source.place for source in MACHINE_SOURCES)}


class OtherNoise(Scenario):
    """The same record with another noise of the machine, and other impulses and bursts."""

    def stream(self, name: str, level: Level = "record") -> np.random.Generator:
        """Random stream by name; those of the background of the record are others."""
        return super().stream(f"other {name}" if name in _BACKGROUND and level == "record" else name, level)


def cases(recipe: Recipe, pairs: int) -> list[Case]:
    """Records of a recipe with a fault whose parts have lines, each with its twin."""
    corpus = recipe.corpus.model_copy(update={"rungs": (0.0, 1.0)})
    truth = recipe.truth.model_copy(update={"twins": True, "undetected": "keep"})
    faults = tuple(fault for fault in recipe.faults if fault.kind != "healthy")
    changes = {"corpus": corpus, "truth": truth, "faults": faults, "records": 2 * pairs}
    simulated = make_records(recipe.model_copy(update=changes), range(2 * pairs))
    cases = []
    for healthy, faulty in zip(simulated[::2], simulated[1::2], strict=True):
        if isinstance(healthy, Measured) and isinstance(faulty, Measured) and (orders := lines_of_faults(faulty.run)):
            (other,) = measure([replace(healthy.run, scenario=OtherNoise(healthy.scenario.recipe))])
            per_unit = counts_per_unit(recipe) or 1.0
            record, twin, again = (response.signal[0] / per_unit for response in (faulty, healthy, other))
            cases.append(
                Case(
                    faulty.scenario.fault,
                    bool(faulty.detectable),
                    record,
                    twin,
                    again,
                    _impulses(faulty.scenario),
                    orders,
                    faulty.run.motion.means[0],
                )
            )
    return cases


def _impulses(scenario: Scenario) -> NDArray[np.float32]:
    """Lines of the impulses of a machine behind the gain of its record."""
    level = scenario.recipe.level.si()
    return np.float32((level["gain"] * level["background"]) ** 2) * rig_filters(scenario).impulse_lines


def rule_alarms(case: Case, fs: float) -> bool:
    """Whether the rule takes the noise of another recording of a healthy machine for a fault."""
    angles = 2 * np.pi * case.shaft_rate / fs * np.arange(len(case.twin))
    twin, again = (signal[None].astype(np.float32) for signal in (case.twin, case.again))
    signals = np.stack([twin, np.zeros_like(twin), again - twin])
    products = (0.0,) * 6  # not needed for lines
    (sees,) = judges_of([Parts(signals, products, case.impulses, case.orders, angles, steady=True)])
    return sees((1.0, 1.0))


class Line(NamedTuple):
    """Largest line of a squared envelope spectrum in a searched place."""

    size: float
    """Over the mean of the squared envelope [1]."""
    searched: int
    """Number of lines."""
    samples: float
    """Independent complex samples of the band."""


def envelope_lines(signal: FloatArray, fs: float, frequency: float) -> list[Line]:
    """Lines at a frequency [Hz] and twice and three times it, in all frequencies and in each quarter of them, by Hilbert transforms."""
    duration, lines = len(signal) / fs, []
    for low, high in ((0.01, 0.99), (0.01, 0.25), (0.25, 0.5), (0.5, 0.75), (0.75, 0.99)):
        band = butter(4, (low, high), "bandpass", output="sos")
        envelope = np.abs(hilbert(sosfiltfilt(band, signal))) ** 2
        spectrum = np.abs(np.fft.rfft(envelope)) / np.sum(envelope)
        for middle in frequency * duration * np.arange(1, 4):
            places = np.arange(math.ceil(0.99 * middle - 1), math.floor(1.01 * middle + 1) + 1)
            places = places[(places > 0) & (places < (high - low) * len(signal) / 4)]
            if len(places):
                lines.append(Line(float(spectrum[places].max()), len(places), (high - low) * len(signal) / 2))
    return lines


def noise_alarms(signal: FloatArray, fs: float, frequency: float) -> list[bool]:
    """Of each line whether it would be a false alarm of Gaussian noise with a probability below ``FALSE_ALARM`` in all of them."""
    lines = envelope_lines(signal, fs, frequency)
    chance = math.log(sum(line.searched for line in lines) / FALSE_ALARM)
    return [line.samples * line.size**2 > chance for line in lines]


def analyst_sees(case: Case, fs: float) -> bool:
    """Whether an analyst who has both recordings finds, for each damaged part, a line of the record that noise does not make and that is
    twice as large as that of the twin.
    """
    return all(_finds_line(case, fs, order * case.shaft_rate) for order in case.orders)


def _finds_line(case: Case, fs: float, frequency: float) -> bool:
    record, twin = (envelope_lines(signal, fs, frequency) for signal in (case.record, case.twin))
    louder = np.mean(case.record**2) / np.mean(case.twin**2)
    clear = noise_alarms(case.record, fs, frequency)
    return any(
        is_clear and own.size * louder > 2 * other.size
        for is_clear, own, other in zip(clear, record, twin, strict=True)
    )


def report(cases: Sequence[Case], fs: float) -> Iterator[str]:
    """Lines of both tables."""
    alarms = sum(rule_alarms(case, fs) for case in cases)
    of_noise = sum(any(noise_alarms(case.twin, fs, case.orders[0] * case.shaft_rate)) for case in cases)
    yield "| healthy records | alarms of the rule | alarms of a test against noise alone |"
    yield "|---:|---:|---:|"
    yield f"| {len(cases)} | {alarms} | {of_noise} |"
    yield ""
    yield "| class | records | fault can be seen | analyst sees it | agreement |"
    yield "|---|---:|---:|---:|---:|"
    for fault in (*dict.fromkeys(case.fault for case in cases), "all"):
        some = [case for case in cases if fault in (case.fault, "all")]
        told = np.array([(case.detectable, analyst_sees(case, fs)) for case in some])
        shares = f"{told[:, 0].mean():.2f} | {told[:, 1].mean():.2f} | {np.mean(told[:, 0] == told[:, 1]):.2f}"
        yield f"| {fault} | {len(some)} | {shares} |"


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.detectable",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--recipe", default="domain_randomised")
    parser.add_argument("--pairs", type=int, default=1000, help="records to make, each with its twin")
    options = parser.parse_args()
    recipe = read_recipe(options.recipe)
    print("\n".join(report(cases(recipe, options.pairs), recipe.recording.sample_rate_hz)))


if __name__ == "__main__":
    main()
