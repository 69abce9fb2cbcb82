"""Answers to recordings with and without a healthy recording of their machine: alarms on healthy bearings, and faults that are missed.

``python -m benchmarks.alarms REAL`` with REAL a folder that holds ``limerick/healthy.nc``, healthy bearings in machines that are well and
not well, and ``cwru``, ``mfpt`` and ``uestc`` as their providers publish them; the model is the reference model. The first table counts the
verdicts on the healthy bearings by axis: alone, by the condition of the machine, and compared with one other recording, whose condition and
speed are the same or others. The second has the other sets, alone and compared with each healthy recording of their set, with balanced
accuracy and log-loss of the probabilities. An alarm is a healthy bearing that is called anything but healthy and unsure.
"""

import argparse
import json
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from benchmarks.speed import real_corpora, recordings
from features.baselines import Model
from features.baselines.predictions import UNSURE
from features.table.indicators import Orders
from gen.corpus import FAULTS
from gen.corpus.fault_classes import HEALTHY
from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from gen.support.units import STANDARD_GRAVITY, rpm_to_hertz
from raceway.diagnosis import Given, diagnose_recording
from raceway.importing.recorded import Recorded
from raceway.kept_models import reference_model

BEARING = "ER-12K"  # of the machine of limerick
ALONE, ALL = "none", "all"  # kind of reference, and condition
AXES = ("x", "y", "z")
OUTCOMES = ("right", UNSURE, "called healthy", "wrong fault", "alarm")
LEAST = 1e-9  # of a probability in the log-loss


class Answered(NamedTuple):
    """Answer to one recording; ``title`` names its set and axis, ``reference`` the kind of healthy recording it is compared with."""

    title: str
    reference: str
    condition: str
    fault: str
    verdict: str
    probabilities: Mapping[str, float]


class HealthyRecording(NamedTuple):
    """Recording of a healthy bearing, as `diagnose_recording` takes it, and the condition of its machine."""

    recorded: Recorded
    facts: Given
    condition: str

    def compared_with(self, other: "HealthyRecording") -> str:
        """Kind of reference that another recording is."""
        condition, speed = (
            "same" if same else "other"
            for same in (self.condition == other.condition, self.facts.rates == other.facts.rates)
        )
        return f"{condition} condition, {speed} speed"


def healthy_recordings(file: Path, axes: Iterable[str]) -> list[HealthyRecording]:
    """Recordings of some axes of ``limerick``."""
    bearings = {BEARING: Orders(*map(np.asarray, orders(CATALOGUE[BEARING])))}
    recordings = []
    with xr.open_dataset(file) as opened:
        for place in range(opened.sizes["recording"]):
            recording = opened.isel(recording=place)
            signals = {axis: STANDARD_GRAVITY * recording["acceleration"].values[AXES.index(axis)] for axis in axes}
            rate = rpm_to_hertz(float(recording["shaft_rpm"]))
            recorded = Recorded(signals, float(opened.attrs["sample_rate_hz"]), f"recording {place}")
            recordings.append(
                HealthyRecording(recorded, Given(bearings, (rate, rate)), str(recording["condition"].values))
            )
    return recordings


def of_machines(title: str, each: list[HealthyRecording], model: Model, references: int) -> Iterator[Answered]:
    """Answers to healthy recordings: alone, and with ``references`` others of each kind, drawn at random."""
    rng = np.random.default_rng(0)
    for tested in each:
        kinds: dict[str, list[HealthyRecording]] = {}
        for other in each:
            if other is not tested:
                kinds.setdefault(tested.compared_with(other), []).append(other)
        diagnosis = diagnose_recording(tested.recorded, tested.facts, model)
        yield Answered(title, ALONE, tested.condition, HEALTHY, diagnosis.verdict, diagnosis.probabilities)
        for kind, others in sorted(kinds.items()):
            for chosen in rng.choice(len(others), min(references, len(others)), replace=False):
                diagnosis = diagnose_recording(tested.recorded, tested.facts, model, healthy=[others[chosen].recorded])
                yield Answered(title, kind, tested.condition, HEALTHY, diagnosis.verdict, diagnosis.probabilities)


def of_corpus(title: str, corpus: Path, model: Model) -> Iterator[Answered]:
    """Answers to all recordings of a set, alone and with each other recording of it that is healthy."""
    each = list(recordings(corpus))
    recorded = [Recorded({"": recording.x.ravel()}, recording.fs) for recording in each]
    healthy = [place for place, recording in enumerate(each) if recording.fault == HEALTHY]
    for place, recording in enumerate(each):
        facts = Given({"own": Orders(*map(np.asarray, recording.orders))}, (recording.label, recording.label))
        for reference in (None, *healthy):
            if reference != place:
                references = [] if reference is None else [recorded[reference]]
                diagnosis = diagnose_recording(recorded[place], facts, model, healthy=references)
                kind = ALONE if reference is None else "one healthy recording"
                yield Answered(title, kind, "", recording.fault, diagnosis.verdict, diagnosis.probabilities)


def outcome(answer: Answered) -> str:
    """One of ``OUTCOMES``, or the verdict itself if it is that of a fault in no part."""
    if answer.verdict in (answer.fault, UNSURE):
        return "right" if answer.verdict == answer.fault else UNSURE
    if HEALTHY in (answer.fault, answer.verdict):
        return "alarm" if answer.fault == HEALTHY else "called healthy"
    return "wrong fault" if answer.verdict in FAULTS else answer.verdict


def scores(answers: Iterable[Answered]) -> dict[str, float]:
    """Balanced accuracy and log-loss of the probabilities."""
    right: dict[str, list[bool]] = {}
    losses = []
    for answer in answers:
        right.setdefault(answer.fault, []).append(
            max(answer.probabilities, key=lambda name: answer.probabilities[name]) == answer.fault
        )
        losses.append(-np.log(max(answer.probabilities.get(answer.fault, 0.0), LEAST)))
    balanced = np.mean([np.mean(hits) for hits in right.values()])
    return {"balanced accuracy": round(float(balanced), 3), "log-loss": round(float(np.mean(losses)), 3)}


def counted(answers: Iterable[Answered]) -> list[dict[str, Any]]:
    """One row for each set, axis and kind of reference; and, of machines without a reference, for each condition."""
    groups: dict[tuple[str, str, str], list[Answered]] = {}
    for answer in answers:
        groups.setdefault((answer.title, answer.reference, ALL), []).append(answer)
        if answer.condition and answer.reference == ALONE:
            groups.setdefault((answer.title, answer.reference, answer.condition), []).append(answer)
    titles = list(dict.fromkeys(title for title, _, _ in groups))

    def place(key: tuple[str, str, str]) -> tuple[int, bool, str, bool, str]:
        title, reference, condition = key
        return titles.index(title), reference != ALONE, reference, condition != ALL, condition

    rows = []
    for title, reference, condition in sorted(groups, key=place):
        held = groups[title, reference, condition]
        machines = bool(held[0].condition)
        counts = Counter(answer.verdict if machines else outcome(answer) for answer in held)
        row = {
            "set": title,
            "reference": reference,
            "condition": condition,
            "answers": len(held),
            "counts": dict(counts),
        }
        rows.append(row if machines else row | scores(held))
    return rows


def table(rows: list[dict[str, Any]], first: Iterable[str]) -> Iterator[str]:
    """Lines of a table; the counts that ``first`` names stand before the others that occur."""
    counts = list(dict.fromkeys([*first, *sorted({name for row in rows for name in row["counts"]})]))
    scored = [name for name in ("balanced accuracy", "log-loss") if name in rows[0]]
    yield f"| set | healthy reference | condition | answers | {' | '.join([*counts, *scored])} |"
    yield f"|---|---|---|{'---:|' * (1 + len(counts) + len(scored))}"
    for row in rows:
        cells = [row["answers"], *(row["counts"].get(name, 0) for name in counts), *(row[name] for name in scored)]
        yield f"| {row['set']} | {row['reference']} | {row['condition']} | {' | '.join(map(str, cells))} |"


def main() -> None:
    """Print both tables, or their rows as JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    parser.add_argument("--references", type=int, default=2, help="per kind and recording of limerick; 24 are all")
    parser.add_argument("--json", action="store_true", help="print the rows as JSON")
    options = parser.parse_args()
    model = reference_model()
    machines: list[Answered] = []
    for axes in (*AXES, "".join(AXES)):
        each = healthy_recordings(options.real / "limerick" / "healthy.nc", axes)
        machines += of_machines(f"limerick {axes}", each, model, options.references)
    sets: list[Answered] = []
    with tempfile.TemporaryDirectory() as name:
        for title, corpus in real_corpora(options.real, Path(name)).items():
            sets += of_corpus(title, corpus, model)
    if options.json:
        print(json.dumps(counted(machines) + counted(sets), indent=1))
        return
    print(*table(counted(machines), (HEALTHY, UNSURE)), "", *table(counted(sets), OUTCOMES), sep="\n")


if __name__ == "__main__":
    main()
