"""The benchmark of verdicts: its conditions and tables, and signals without a fault, which no lines can make a fault."""

from collections import Counter

import numpy as np
import pytest

from benchmarks.speed import recordings
from benchmarks.verdicts import ERRORS, RIGHT, SEEDS, WITHOUT_FAULT, conditions, without_fault
from features.baselines.predictions import UNSURE
from raceway.diagnosis.evidence import find_evidence
from raceway.diagnosis.search import find_pairs, mean_spectra
from raceway.diagnosis.spectrum import band_spectra
from raceway.diagnosis.verdict import judge
from tests.features.table.test_recording_speeds import write_machines


def test_every_recording_is_diagnosed_at_right_wrong_and_unknown_speeds_and_bearings(tmp_path):
    recording = next(recordings(write_machines(tmp_path / "machines")))
    every = list(conditions(recording))
    counts = Counter(name for name, _ in every)
    assert len(ERRORS) == 20
    assert counts[RIGHT] == counts["speed not given"] == counts["bearing not given"] == 1
    assert counts["wrong bearing"] == 4
    assert counts["speed wrong by at most 8 %"] + counts["speed wrong by more than 8 %"] == 20


@pytest.mark.parametrize("kind", WITHOUT_FAULT)
def test_noise_tones_shafts_and_gears_are_no_race_fault_however_sure_the_classifier_is(kind):
    for seed in range(SEEDS):
        recorded, given = without_fault(kind, seed)
        x = recorded.signals[""]
        (pair,), _ = find_pairs(mean_spectra([x], recorded.fs, given), given)
        lines = find_evidence(band_spectra(x, recorded.fs, pair.rate), pair.rate, pair.orders)
        for fault in ("inner", "outer"):
            assert judge({fault: 0.99, "healthy": 0.01}, 0.5, lines)[0] == UNSURE
        assert np.isfinite(x).all()
