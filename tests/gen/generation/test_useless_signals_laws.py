"""Laws of corpora with unusable signals: the counts per part are the same for any number of workers and interruptions."""

import numpy as np
import pytest

from gen.corpus import read_manifest
from gen.generation.corpus import generate
from gen.physics.catalogue import CATALOGUE
from raceway.console.summary import corpus_facts
from raceway.importing.assemble import Collection, import_recordings
from raceway.importing.recordings import Candidate, Recording
from raceway.sharing.card.card_page import data_card

# of three machines the second exceeds the range of the converter by far
ONE_LOUD_RIG = {"level": {"kind": "physical", "gain": "grid(1, 1000, 1)"}}


def part_counts(folder):
    return [row.signals for row in read_manifest(folder).parts]


@pytest.fixture(scope="module")
def loud(write_recipe, tmp_path_factory):
    """A recipe one of whose three parts is clipped, and its corpus."""
    folder = tmp_path_factory.mktemp("loud")
    recipe = write_recipe(folder / "r.yaml", ONE_LOUD_RIG)
    return recipe, generate(recipe, folder / "corpus")


def test_each_part_has_its_own_count(loud):
    _, generated = loud
    assert part_counts(generated.path) == [{}, {"clipped": 8}, {}]
    assert generated.signals == {"clipped": 8}


def test_recordings_that_cannot_be_used_are_counted_when_they_are_imported(tmp_path):
    """Five records of a second: noise, cut off noise, zeros, one value, and noise."""
    rng = np.random.default_rng(0)
    cut_off = np.clip(rng.normal(size=1000), -1, 1)
    signal = np.concatenate([rng.normal(size=1000), cut_off, np.zeros(1000), np.full(1000, 0.5), rng.normal(size=1000)])
    recording = Recording(0, 0, 0, CATALOGUE["6205"], 25.0, "inner", signal)
    import_recordings(
        Collection("test", "A set", "Mine.", 1000.0, ("housing",)),
        [Candidate("a", lambda: recording)],
        tmp_path / "c",
        window=1.0,
    )
    expected = {"clipped": 1, "dead": 1, "constant": 1}
    assert part_counts(tmp_path / "c") == [expected]
    assert corpus_facts(tmp_path / "c")["signals"] == expected
    assert "cannot be used: 1 clipped, 1 dead, 1 constant." in data_card(tmp_path / "c")
