"""Laws of replay: every record of a folder or a single file is made again bit for bit, and a record that was changed is told apart."""

import pytest

from gen import generate, open_corpus, replay
from gen.corpus import SIGNAL, part_name
from tests.tampering import edited, seal


@pytest.fixture(scope="module", params=["corpus", "corpus.nc"])
def whole(request, write_recipe, tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole")
    return generate(write_recipe(folder / "small.yaml"), folder / request.param)


@pytest.mark.parametrize("record", [0, 7, 8, 23])
def test_any_record_can_be_made_again_bit_for_bit(whole, record):
    replayed = replay(whole.path, record)
    assert replayed.identical
    assert replayed.dataset["recording"].values.tolist() == [record]
    with open_corpus(whole.path) as corpus:
        for name in ("draws", "fault", "shaft_rate", "snr", "true_bpfo"):
            assert replayed.dataset[name].values[0] == corpus[name].values[record]


def test_seed_and_size_given_in_the_call_do_not_matter(write_recipe, tmp_path):
    made = generate(write_recipe(tmp_path / "r.yaml"), tmp_path / "c", seed=11, records=5)
    assert replay(made.path, 4).identical


def test_a_record_that_was_tampered_with_is_not_what_replay_makes(write_recipe, tmp_path):
    floating = {"recording.converter": {"kind": "float32"}, "storage.codec": "none", "records": 8}
    made = generate(write_recipe(tmp_path / "r.yaml", floating), tmp_path / "c")
    with edited(made.path / "parts" / part_name(0)) as part:
        part[SIGNAL][3, 0, 100] += 1e-4
    seal(made.path)
    assert [replay(made.path, record).identical for record in range(2, 5)] == [True, False, True]
