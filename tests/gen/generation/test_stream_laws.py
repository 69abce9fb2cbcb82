"""Laws of the stream: the records of the recipe in their order and then further ones, none twice, whoever makes them."""

import itertools
import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

import gen
from gen.generation.stream import endless, records_from
from gen.recipe import Recipe
from gen.support.errors import ClusterError, RecipeError
from gen.support.executor import run
from tests.conftest import small_with


@pytest.fixture(scope="module")
def recipe():
    return Recipe(small_with({}))


def numbers_of(batches):
    return [number for batch in batches for number in batch["recording"].values.tolist()]


def test_the_stream_has_the_records_of_a_corpus_and_goes_on(recipe, tmp_path):
    with gen.stream(recipe, batch=16) as fresh:
        batches = list(itertools.islice(fresh, 3))
    assert [batch.sizes["record"] for batch in batches] == [16] * 3
    assert numbers_of(batches) == list(range(48))
    corpus = gen.open_corpus(gen.generate(recipe, tmp_path / "c", records=40).path)
    for name in ("acceleration", "fault", "rig", "identity", "width", "snr"):
        streamed = np.concatenate([batch[name].values for batch in batches])[:40]
        np.testing.assert_array_equal(streamed, corpus[name].values)


def test_a_stream_goes_on_behind_the_last_record_of_another(recipe):
    with gen.stream(recipe, batch=7) as fresh:
        next(fresh)
        start = fresh.next_record
        expected = next(fresh)
    with gen.stream(recipe, batch=7, start=start) as other:
        batch = next(other)
    assert numbers_of([batch]) == list(range(7, 14))
    np.testing.assert_array_equal(batch["acceleration"].values, expected["acceleration"].values)


def test_a_stream_goes_on_where_it_was_after_its_processes_were_lost(recipe, monkeypatch):
    """After processes are killed: tests/thorough/test_lost_cluster.py."""

    def lost_after_two(*arguments):
        yield from itertools.islice(run(*arguments), 2)
        raise ClusterError("all worker processes have ended.")

    with gen.stream(recipe, batch=12) as fresh, monkeypatch.context() as patch:
        patch.setattr("gen.generation.stream.run", lost_after_two)
        batches = [next(fresh)]
        with pytest.raises(ClusterError, match="all worker processes have ended"):
            next(fresh)
        patch.undo()
        batches.append(next(fresh))
    assert numbers_of(batches) == list(range(24))


@pytest.mark.usefixtures("started_processes")
def test_several_processes_give_the_same_batches(recipe, monkeypatch):
    monkeypatch.setattr("gen.support.executor.cores", lambda: 2)
    with gen.stream(recipe, batch=20, workers=2) as by_two, gen.stream(recipe, batch=20) as by_one:
        for alone, two in itertools.islice(zip(by_one, by_two, strict=True), 2):
            np.testing.assert_array_equal(alone["acceleration"].values, two["acceleration"].values)
            assert alone["identity"].values.tolist() == two["identity"].values.tolist()


def test_shards_share_all_records_out_and_have_none_in_common(recipe):
    shares = [next(records_from(endless(recipe), 0, shard=shard, shards=3))["recording"].values for shard in range(3)]
    assert [share[0] for share in shares] == [0, 8, 16]
    assert sorted(np.concatenate(shares)) == list(range(24))


FINITE = {
    "a grid": ({"operation.load_n": "grid(500, 600)"}, "operation.load_n: a grid is finite, and a stream has no end"),
    "a grid of a fault": ({"faults": [{"kind": "inner", "width_mm": "grid(0.5, 1)"}]}, r"faults\[0\].width_mm: a grid is finite"),
    "points": ({"corpus.sampling": "sobol"}, "corpus.sampling: sobol covers a number of records"),
}  # fmt: skip


@pytest.mark.parametrize("name", FINITE)
def test_a_recipe_with_an_end_by_nature_is_refused(name):
    changes, sentence = FINITE[name]
    with pytest.raises(RecipeError, match=sentence):
        gen.stream(Recipe(small_with(changes)))


@pytest.mark.parametrize(
    "wrong", [{"batch": 0}, {"batch": 2.5}, {"workers": 0}, {"start": -1}, {"start": True}], ids=str
)
def test_a_wrong_number_is_refused(recipe, wrong):
    with pytest.raises(RecipeError, match=f"{min(wrong)}: .* is not allowed; give a whole number"):
        gen.stream(recipe, **wrong)


def test_without_pytorch_its_stream_says_so(recipe, monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    monkeypatch.delitem(sys.modules, "gen.generation.torch_items", raising=False)
    with pytest.raises(RecipeError, match="needs PyTorch, which is not installed"):
        gen.torch_stream(recipe)


def test_workers_of_a_data_loader_and_ranks_have_no_record_in_common(recipe, monkeypatch):
    """With the part of PyTorch that the stream uses in place of PyTorch, which the tests do not install."""
    here = SimpleNamespace(id=1, num_workers=2)
    torch, utils, data = (ModuleType(name) for name in ("torch", "torch.utils", "torch.utils.data"))
    ranks = {
        "is_available": lambda: True,
        "is_initialized": lambda: True,
        "get_rank": lambda: 1,
        "get_world_size": lambda: 3,
    }
    torch.distributed = SimpleNamespace(**ranks)
    data.IterableDataset = type("IterableDataset", (), {"__class_getitem__": classmethod(lambda cls, _: cls)})
    data.get_worker_info = lambda: here
    for module in (torch, utils, data):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.delitem(sys.modules, "gen.generation.torch_items", raising=False)
    signal, label = next(iter(gen.torch_stream(recipe, transform=np.negative)))
    (expected,) = itertools.islice(
        records_from(endless(recipe), 0, shard=3, shards=6), 1
    )  # worker 1 of 2 on rank 1 of 3
    np.testing.assert_array_equal(signal, -expected["acceleration"].values[0])
    assert label == expected["fault"].values[0]
    fresh = gen.torch_stream(
        recipe, operating=True, transform=lambda signal, operating: signal / operating["shaft_rate"]
    )
    signal, operating, _ = next(iter(fresh))
    first = expected.isel(record=0)
    assert operating["bpfo"] == np.float32(first["bpfo"])
    np.testing.assert_array_equal(signal, first["acceleration"].values / np.float32(first["shaft_rate"]))
    with pytest.raises(RecipeError, match="there is no variable faut; the nearest is fault"):
        next(iter(gen.torch_stream(recipe, label="faut")))
