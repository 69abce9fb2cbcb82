"""Splits of real recordings that can leak: copies under two names are found, and different recordings of one machine are not."""

import json

import numpy as np
import pytest
import scipy.signal
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from features import audit_splits
from features.auditing import block_hashes
from raceway.cli import cli
from tests.labels import import_labelled

FS = 2000
COMMON = {"bearing": "6205", "unit": "g", "sample_rate_hz": FS, "shaft_rpm": 1500}


def machine(seed, size=8 * FS):
    """A recording of one machine: the same shaft harmonics and resonance every time, other noise."""
    noise = scipy.signal.lfilter([1.0], [1.0, -1.2, 0.8], np.random.default_rng(seed).normal(size=size))
    turns = 25 * np.arange(size) / FS
    return noise + sum(3.0 * np.sin(2 * np.pi * k * turns + seed) for k in (1, 2, 3))


def corpus(tmp_path, recordings):
    """Corpus of recordings as (file, signal, fault, specimen)."""
    files = []
    for name, signal, fault, specimen in recordings:
        np.save(tmp_path / f"{name}.npy", signal)
        files.append({"path": f"{name}.npy", "fault": fault, "specimen": specimen})
    return import_labelled(tmp_path, files, **COMMON).path


def sound_set():
    """Two specimens a class with two recordings each."""
    return [
        (f"{fault}{n}{again}", machine(4 * (fault == "inner") + 2 * n + again), fault, f"{fault}{n}")
        for fault in ("healthy", "inner")
        for n in range(2)
        for again in range(2)
    ]


def test_a_set_with_two_bearings_a_class_and_no_copy_raises_no_doubt(tmp_path):
    assert audit_splits(corpus(tmp_path, sound_set())) == []


COPIES = {
    "same": lambda x: x,
    "cut at other places": lambda x: x[FS + 77 : 7 * FS],
    "with a gap": lambda x: np.where(np.abs(np.arange(x.size) - 3 * FS) < 9, 0.0, x),
    "a second of it": lambda x: np.concatenate([machine(50, 3 * FS), x[:FS], machine(51, 4 * FS)]),
}


@pytest.mark.parametrize("change", COPIES.values(), ids=COPIES)
def test_a_copy_of_a_recording_under_another_specimen_is_named(tmp_path, change):
    recordings = [*sound_set(), ("copy", change(sound_set()[0][1]), "healthy", "another")]
    (sentence,) = audit_splits(corpus(tmp_path, recordings))
    assert "healthy00.npy and copy.npy have the same samples, and are of different specimens; " in sentence
    assert sentence.endswith("remove one of the two, or give both the same specimen.")


def test_a_copy_under_the_same_specimen_is_no_leak(tmp_path):
    assert audit_splits(corpus(tmp_path, [*sound_set(), ("copy", sound_set()[0][1], "healthy", "healthy0")])) == []


@pytest.mark.parametrize("step", [1e-6, 0.5, 2.0])
def test_different_recordings_of_one_machine_have_no_block_in_common(step):
    """Also in the steps of a coarse converter."""
    hashes = [block_hashes(np.round(machine(seed) / step)) for seed in range(60)]
    assert min(map(len, hashes)) > 1
    assert sum(map(len, hashes)) == len(set.union(*hashes))


@given(first=st.integers(0, 2000), length=st.integers(300, 2000))
def test_blocks_depend_on_the_samples_alone(first, length):
    """Some of the smallest hashes of two overlapping records are the same, wherever they begin."""
    x = machine(3, 4000)
    assert block_hashes(x[first : first + length]) & block_hashes(x[first + 100 : first + length + 100])


def test_a_class_of_one_specimen_and_one_specimen_per_file_are_told(tmp_path):
    found = audit_splits(corpus(tmp_path, [*sound_set()[:6], ("o", machine(77), "outer", "x")]))
    assert len(found) == 1
    assert "all 32 inner and all 16 outer records are of one specimen each" in found[0]
    (tmp_path / "b").mkdir()
    found = audit_splits(corpus(tmp_path / "b", [(n, x, fault, n) for n, x, fault, _ in sound_set()]))
    assert len(found) == 1
    assert (
        "each of the 8 recordings is a specimen of its own; if some are of one bearing, a split by specimen leaks"
        in found[0]
    )


def test_two_sensors_of_one_file_are_not_two_specimens(tmp_path):
    for name, signal, *_ in sound_set():
        np.save(tmp_path / f"{name}.npy", signal)
    np.save(tmp_path / "two.npy", np.stack([machine(95), machine(96)]))
    files = [{"path": f"{name}.npy", "fault": fault, "specimen": specimen} for name, _, fault, specimen in sound_set()]
    files += [{"path": "two.npy", "column": n, "fault": "inner", "specimen": f"sensor{n}"} for n in (0, 1)]
    (sentence,) = audit_splits(import_labelled(tmp_path, files, **COMMON).path)
    assert "two.npy holds recordings of more than one specimen; if these are sensors of one machine" in sentence


def test_validate_warns_of_an_imported_corpus_and_still_finds_it_sound(tmp_path):
    folder = corpus(tmp_path, [*sound_set(), ("copy", sound_set()[0][1], "healthy", "another")])
    done = CliRunner().invoke(cli, ["validate", str(folder), "--json"], prog_name="raceway")
    assert done.exit_code == 0, done.output
    facts = json.loads(done.stdout)
    assert facts["valid"]
    assert len(facts["warnings"]) == 1
    assert "warning:" in done.stderr
