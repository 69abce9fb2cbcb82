"""Verdicts on recordings of three real machines, with the right speed and bearing, with wrong ones, and with ones to be searched.

``python -m benchmarks.verdicts REAL`` with REAL a folder that holds ``cwru``, ``mfpt`` and ``uestc`` as their providers publish them; the
model is the reference model. "Damaged" is the share of faulty recordings whose part is not named, "wrong" that of recordings with another
fault than the true one, or any on a healthy machine, "damaged" included, and "called healthy" that of faulty ones among all.
``--missed`` prints instead how many faulty recordings are called healthy by their length, which is `MISSED` of
`raceway.diagnosis.wording`.
"""

import argparse
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from benchmarks.speed import Recording, real_corpora, recordings
from features.baselines import Model
from features.baselines.predictions import DAMAGED, UNSURE
from features.table.indicators import Orders
from gen.corpus.fault_classes import HEALTHY
from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from raceway.diagnosis import ANY_RATE, Diagnosis, Given, diagnose_recording
from raceway.importing.recorded import Recorded
from raceway.kept_models import reference_model

RIGHT = "right speed and bearing"
ERRORS = tuple(sign * percent / 100 for percent in range(4, 41, 4) for sign in (-1, 1))
NEAR = 0.08  # error of a speed that is searched by default
OTHERS = ("6203", "6205", "6303", "6210", "6006")
"""Wrong bearings: the first four whose number of balls differs from the true one."""
SEARCHED = (0.6, 1.4)  # range of speeds over the label
WITHOUT_FAULT = ("noise", "tones", "shaft", "modulated", "gears")
ANSWERS = ("right", DAMAGED, UNSURE, "wrong", "called healthy")

LENGTHS = (0.5, 2.0, 10.0)  # s, of the recordings of `missed`
FS, SECONDS = 12_000.0, 3.0  # of the signals without a fault
SEEDS = 20

_NOMINAL = {name: Orders(*map(np.asarray, orders(bearing))) for name, bearing in CATALOGUE.items()}


def conditions(recording: Recording) -> Iterator[tuple[str, Given]]:
    """Bearings and speeds to diagnose a recording with, and the name of the condition."""
    own = {"own": Orders(*map(np.asarray, recording.orders))}
    label = recording.label
    yield RIGHT, Given(own, (label, label))
    for error in ERRORS:
        wrong = label * (1 + error)
        yield f"speed wrong by {'at most' if abs(error) <= NEAR else 'more than'} 8 %", Given(own, (wrong, wrong))
    balls = round(recording.orders[1] + recording.orders[2])
    others = [name for name in OTHERS if CATALOGUE[name].n_balls != balls]
    for name in others[:4]:
        yield "wrong bearing", Given({name: _NOMINAL[name]}, (label, label))
    yield "speed within 40 %", Given(own, (SEARCHED[0] * label, SEARCHED[1] * label))
    yield "speed not given", Given(own, ANY_RATE)
    yield "bearing not given", Given({**own, **_NOMINAL}, (label, label))


def without_fault(kind: str, seed: int) -> tuple[Recorded, Given]:
    """Signal without a bearing fault: ``noise``, ``tones``, ``shaft`` harmonics, noise ``modulated`` by the shaft, or ``gears``."""
    rng = np.random.default_rng(seed)
    name, rate = str(rng.choice(OTHERS)), rng.uniform(12, 45)
    t = np.arange(round(SECONDS * FS)) / FS

    def waves(*frequencies: float) -> np.ndarray:
        each = [
            rng.uniform(0.2, 2) * np.cos(2 * np.pi * frequency * t + rng.uniform(0, 6)) for frequency in frequencies
        ]
        return np.sum(each, axis=0)

    x = rng.standard_normal(t.size)
    if kind == "tones":
        x += waves(*rng.uniform(40, 4800, rng.integers(1, 9)))
    if kind == "modulated":
        x *= 1 + rng.uniform(0, 0.5) * np.cos(2 * np.pi * rate * t) + 0.3 * np.cos(4 * np.pi * rate * t)
    if kind != "noise":
        x += waves(*(rate * np.arange(1, rng.integers(3, 15))))
    if kind == "gears":
        mesh, other = rng.integers(15, 50) * rate, rate * rng.uniform(0.3, 3)
        x += waves(mesh, 2 * mesh, 3 * mesh) * (1 + 0.2 * waves(rate, other, 2 * other))
    return Recorded({"": x}, FS), Given({name: _NOMINAL[name]}, (rate, rate))


def answer(verdict: str, fault: str) -> str:
    """One of ``ANSWERS``."""
    if verdict in (fault, UNSURE):
        return "right" if verdict == fault else UNSURE
    if verdict == DAMAGED and fault != HEALTHY:
        return DAMAGED
    return "called healthy" if verdict == HEALTHY else "wrong"


def rows(title: str, answers: Mapping[str, Counter[str]]) -> Iterator[str]:
    """Rows of a set, or of all together."""
    for condition, counts in answers.items():
        total = counts.total()
        cells = " | ".join(f"{100 * counts[name] / total:.1f}" for name in ANSWERS)
        yield f"| {title} | {condition} | {total} | {cells} |"


def diagnosed(corpus: Path, model: Model) -> Iterator[tuple[str, str, Diagnosis]]:
    """Condition, true class and diagnosis of every recording under every condition."""
    for recording in recordings(corpus):
        for condition, facts in conditions(recording):
            yield (
                condition,
                recording.fault,
                diagnose_recording(Recorded({"": recording.x.ravel()}, recording.fs), facts, model),
            )


def missed(real: Path, model: Model) -> Iterator[str]:
    """Rows of faulty recordings called healthy: by length [s], without a reference and with each healthy recording of the set in turn."""
    called: dict[tuple[float, bool], list[bool]] = {}
    with tempfile.TemporaryDirectory() as name:
        for corpus in real_corpora(real, Path(name)).values():
            each = list(recordings(corpus))
            for seconds in LENGTHS:
                cut = [
                    Recorded({"": recording.x.ravel()[: round(seconds * recording.fs)]}, recording.fs)
                    for recording in each
                ]
                healthy = [x for x, recording in zip(cut, each, strict=True) if recording.fault == HEALTHY]
                for x, recording in zip(cut, each, strict=True):
                    facts = Given(
                        {"own": Orders(*map(np.asarray, recording.orders))}, (recording.label, recording.label)
                    )
                    for references in (
                        [(), *((reference,) for reference in healthy)] if recording.fault != HEALTHY else []
                    ):
                        verdict = diagnose_recording(x, facts, model, healthy=references).verdict
                        called.setdefault((seconds, bool(references)), []).append(verdict == HEALTHY)
    for seconds in LENGTHS:
        shares = [f"{sum(called[seconds, key])} of {len(called[seconds, key])}" for key in (False, True)]
        yield f"| {seconds:g} | {' | '.join(shares)} |"


def main() -> None:
    """Print the table, or that of the faults that are missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    parser.add_argument("--missed", action="store_true", help="faulty recordings called healthy, by their length")
    options = parser.parse_args()
    model = reference_model()
    if options.missed:
        print("| seconds | called healthy, no reference | with one healthy recording |\n|---:|---:|---:|")
        print(*missed(options.real, model), sep="\n")
        return
    together: dict[str, Counter[str]] = {}
    print(f"| set | given | diagnoses | {' | '.join(f'{name}, %' for name in ANSWERS)} |")
    print("|---|---|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as name:
        for title, corpus in real_corpora(options.real, Path(name)).items():
            answers: dict[str, Counter[str]] = {}
            for condition, fault, diagnosis in diagnosed(corpus, model):
                for counts in (answers, together):
                    counts.setdefault(condition, Counter())[answer(diagnosis.verdict, fault)] += 1
            print(*rows(title, answers), sep="\n", flush=True)
    print(*rows("all", together), sep="\n")
    for kind in WITHOUT_FAULT:
        verdicts = (diagnose_recording(*without_fault(kind, seed), model).verdict for seed in range(SEEDS))
        print(*rows("made up", {f"{kind} alone": Counter(answer(verdict, HEALTHY) for verdict in verdicts)}), sep="\n")


if __name__ == "__main__":
    main()
