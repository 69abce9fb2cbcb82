"""Mutated files of each kind are refused with a sentence or read: none crashes, hangs or ends in another error."""

import json
import subprocess
import sys

import pytest

from tests.paths import ROOT
from tests.thorough.fuzz.__main__ import TARGETS

COUNTS = dict.fromkeys(TARGETS, 600) | {"corpora": 250}  # a corpus takes 50 ms; make thorough tries more


@pytest.mark.parametrize("target", TARGETS)
def test_no_mutated_file_gets_past_its_reader(target, tmp_path):
    command = [sys.executable, "-m", "tests.thorough.fuzz", target, "--count", str(COUNTS[target]), "--keep", tmp_path]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert json.loads(run.stdout) == [], run.stderr
