"""A plug-in of Raceway with one of each: fault class, fault, source, machine condition, sensor fault, feature group, importer, command."""

from pathlib import Path
from typing import Any, ClassVar, Literal

import click
import numpy as np

from features.table.feature_group import Feature, FeatureGroup
from features.table.record_batch import RecordBatch
from gen.corpus.fault_classes import BPFO, FaultClass
from gen.corpus.schema import Variable
from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.impulses import add_strikes
from gen.mechanisms.background.source import MachineCondition, MachineSource
from gen.mechanisms.chain.sensor_fault import SensorFault
from gen.mechanisms.faults.race_spalls import Spalls
from gen.physics.bearing_text import bearing_from_text
from raceway.importing.assemble import Collection, Import, Importer, import_recordings
from raceway.importing.recordings import Candidate, Recording, files_below

# a class: its lines, its words, and the class whose lines do not speak against it
BRINELLED = FaultClass("brinelled", BPFO, words="Brinelled outer race", companion="outer", n_spalls=1)


# a fault of this class: the docstring below a key is its meaning
class Brinelled(Spalls):
    """Dents that balls pressed into the outer race at rest."""

    kind: Literal["brinelled"]
    """Puts dents on the outer race, as far apart as the balls."""
    site: ClassVar = "outer"

    def draw(self, of: Any) -> Any:
        """Dents of a bearing."""
        dents = super().draw(of)
        angles = tuple(360 / of.bearing.n_balls * number for number in range(len(dents.width_mm)))
        return dents.model_copy(update={"angle_deg": angles})


# a source that the shaft does not drive
class Hiss(MachineSource):
    """Noise of a leak in the machine."""

    place = "hiss"

    probability: Probability
    """Share of the rigs with a leak."""
    level_db: Distribution = within(-80, 40)
    """Rms of the noise relative to that of the background noise."""

    def vibrations(self, angles: np.ndarray, fs: float, stream: Any) -> list[np.ndarray]:
        """Noise of the record."""
        return [10 ** (self.si()["level"] / 20) * stream().standard_normal(len(angles))]


# a condition of the machine, whatever its bearings
class WornChain(MachineCondition):
    """A chain that jerks at each link."""

    place = "worn_chain"

    probability: Probability
    """Share of the rigs with a worn chain."""
    links: Distribution = within(1, 50)
    """Links that pass in a turn of the shaft."""
    level_db: Distribution = within(-80, 60)
    """Mean of the peaks behind the path, relative to the rms of the background noise."""

    def add_impulses(self, hits: np.ndarray, angles: np.ndarray, fs: float, stream: Any) -> None:
        """A jerk at each link."""
        add_strikes(hits, self.si()["links"] * angles, self.si()["level"], stream())


# a fault of the measuring chain, with a label
class StuckBits(SensorFault):
    """A converter whose lowest bits do not change."""

    place, drawn_per = "stuck_bits", "rig"
    labels = (Variable("stuck_step", "f8", "m s-2", "latent", "step of a converter with stuck bits, 0 if it has none"),)

    probability: Probability
    """Share of the rigs with such a converter."""
    step_m_s2: Distribution = within(0, 1000, open_low=True)
    """Distance of the values that are left."""

    def disturb(self, signal: np.ndarray, fs: float, rng: np.random.Generator) -> tuple[np.ndarray, float]:
        """Signal in steps, then the value of the label."""
        step = self.si()["step"]
        return np.round(signal / step) * step, step


# a group of features
def crossings(batch: RecordBatch) -> np.ndarray:
    """Values, shape (record, feature), of signals of shape (record, time)."""
    changes = np.diff(np.signbit(batch.x), axis=-1).mean(axis=-1)
    return np.stack([changes, changes * batch.fs / batch.shaft_rate], axis=-1)


CROSSINGS = FeatureGroup(
    (
        Feature("crossings", "share of samples at which the sign changes", "mean |s(i+1) - s(i)|", least=0, most=1),
        Feature("crossings_per_turn", "changes of the sign in a turn", "crossings fs / fr", least=0),
    ),
    crossings,
)


# an importer of CLASS-BEARING-RPM.npy: accelerations [m/s2] at 12 kHz
def _read(path: Path, number: int) -> Recording:
    fault, bearing, rpm = path.stem.split("-")
    return Recording(number, number, 0, bearing_from_text(bearing), float(rpm) / 60, fault, np.load(path))


def import_plain(source: Path, output: Path, *, window: float = 0.5, progress: Any = None) -> Import:
    """Records of a folder."""
    facts = Collection("plain", "Plain recordings", "someone", 12_000.0, ("sensor",))
    files = [
        Candidate(path.name, lambda path=path, number=number: _read(path, number))
        for number, path in enumerate(files_below(source, "*.npy"))
    ]
    return import_recordings(facts, files, output, window=window, progress=progress)


PLAIN = Importer("Recordings CLASS-BEARING-RPM.npy at 12 kHz.", import_plain)


# a command
@click.command()
@click.argument("corpus", type=click.Path(path_type=Path))
def peaks(corpus: Path) -> None:
    """Print the highest acceleration of each class."""
    from gen import open_corpus  # not at the top: help loads this module

    with open_corpus(corpus) as records:
        for fault, highest in records["acceleration"].groupby(records["fault_name"]):
            click.echo(f"{fault} {float(abs(highest).max()):.0f} m/s2")
