"""Mutated files of each kind are refused with a sentence or read: none crashes, hangs or ends in another error."""

import json
import subprocess
import sys

import pytest

from raceway.importing import read_signal
from tests.paths import ROOT
from tests.thorough.fuzz import recordings
from tests.thorough.fuzz.__main__ import TARGETS

COUNTS = dict.fromkeys(TARGETS, 600) | {"corpora": 250}  # a corpus takes 50 ms; make thorough tries more


@pytest.mark.parametrize("target", TARGETS)
def test_no_mutated_file_gets_past_its_reader(target, tmp_path):
    command = [sys.executable, "-m", "tests.thorough.fuzz", target, "--count", str(COUNTS[target]), "--keep", tmp_path]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert json.loads(run.stdout) == [], run.stderr


@pytest.mark.parametrize("keys", [keys for keys in recordings.CHOICES if "speed_column" in keys])
def test_a_seed_with_a_measured_speed_is_read_at_equal_angles(keys, tmp_path):
    (tmp_path / "a.csv").write_text(recordings.RUN_UP)
    assert "sampled again at equal angles" in read_signal(tmp_path / "a.csv", **keys).warnings[-1]
