"""Diagnoses of the 64 CWRU recordings of the drive end at 12 kHz, by how visible Smith and Randall found each fault.

``python -m benchmarks.strata REAL`` with REAL a folder that holds ``cwru`` as its provider publishes it; the model is the reference model,
speed and bearing are right. Source: W. A. Smith, R. B. Randall, Rolling element bearing diagnostics using the Case Western Reserve
University data: a benchmark study, Mechanical Systems and Signal Processing 64-65 (2015) 100-131, table B2: the best grade of a recording
over three methods. The last column is another open program on the same recordings, predictive-maintenance-mcp 0.12: how often the fault
that it ranks first is the true one, or none is named for a healthy bearing, by the results in its repository.
"""

import argparse
import re
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

from benchmarks.speed import recordings
from benchmarks.verdicts import ANSWERS, answer
from features.table.indicators import Orders
from raceway.diagnosis import Given, diagnose_recording
from raceway.importing import import_set
from raceway.importing.recorded import Recorded
from raceway.kept_models import reference_model

GRADES = {
    "Y1": ((130, 131, 132, 133, 156, 209, 210, 211, 212), 9),
    "Y2": (
        (
            *(105, 106, 107, 108, 121, 144, 145, 146, 147, 158, 159, 160, 169, 170, 171, 172, 197),
            *(222, 223, 234, 235, 236, 237, 246, 247, 248, 249, 258, 259, 260, 261, 3005, 3006, 3007, 3008),
        ),
        25,
    ),
    "P1 and P2": ((185, 186, 187, 188, 198, 199), 0),
    "N1": ((118, 119, 120, 200, 224, 225, 3001, 3002, 3003, 3004), 2),
    "healthy": ((97, 98, 99, 100), 2),
}
"""Numbers of the recordings of each grade, and how many of them the other program tells right."""
MEANINGS = {
    "Y1": "plain, as in textbooks",
    "Y2": "plain, in other ways",
    "P1 and P2": "in part",
    "N1": "by none of their methods",
    "healthy": "",
}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    real, model = parser.parse_args().real, reference_model()
    answers: dict[int, str] = {}
    with tempfile.TemporaryDirectory() as name:
        for recording in recordings(import_set("cwru", real / "cwru", Path(name) / "cwru").path):
            facts = Given({"own": Orders(*map(np.asarray, recording.orders))}, (recording.label, recording.label))
            verdict = diagnose_recording(Recorded({"": recording.x.ravel()}, recording.fs), facts, model).verdict
            answers[int(re.split("[_@]", recording.source.stem)[0])] = answer(verdict, recording.fault)
    print(f"| grade | the fault shows | recordings | {' | '.join(ANSWERS)} | other program right |")
    print(f"|---|---|{'---:|' * (len(ANSWERS) + 2)}")
    for grade, (numbers, others) in GRADES.items():
        counts = Counter(answers[number] for number in numbers)
        cells = " | ".join(f"{counts[name]}" for name in ANSWERS)
        print(f"| {grade} | {MEANINGS[grade]} | {len(numbers)} | {cells} | {others} |")


if __name__ == "__main__":
    main()
