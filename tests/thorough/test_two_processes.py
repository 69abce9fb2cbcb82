"""Two processes with other hashes of strings train the same models to the byte."""

import os
import subprocess
import sys

from features.baselines import ESTIMATORS
from tests.paths import ROOT

TRAINING = """
import sys
from pathlib import Path
from tests.model_files import write_models
from tests.paths import ROOT
write_models(Path(sys.argv[1]), 3, seed=5)
"""


def test_two_trainings_in_two_processes_give_the_same_bytes(tmp_path):
    for number in ("1", "2"):
        (tmp_path / number).mkdir()
        subprocess.run(
            [sys.executable, "-c", TRAINING, tmp_path / number],
            cwd=ROOT,
            env=os.environ | {"PYTHONHASHSEED": number},
            check=True,
        )
    for name in ESTIMATORS:
        one, other = (tmp_path / number / f"{name}_3.skops" for number in ("1", "2"))
        assert one.read_bytes() == other.read_bytes(), name
