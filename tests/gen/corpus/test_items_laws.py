"""Laws of the records for training: those of the corpus, whatever is chosen, in any process, with and without PyTorch."""

import importlib.util
import multiprocessing
import pickle
from pathlib import Path

import numpy as np
import pytest

import gen
from gen.corpus import SIGNAL, SPLITS, open_corpus, part_name
from gen.support.errors import CorpusError
from tests.corpora import write_corpus

HAS_TORCH = importlib.util.find_spec("torch") is not None
needs_torch = pytest.mark.skipif(not HAS_TORCH, reason="PyTorch is not installed; raceway does not need it")
SIZES = (3, 4, 2, 5)


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    """Folder of a corpus, and its records in memory."""
    folder = tmp_path_factory.mktemp("items") / "c"
    write_corpus(folder, SIZES)
    with open_corpus(folder) as opened:
        return folder, opened.load()


def rms(signal):
    """A transform that can be sent to another process."""
    return np.sqrt(np.mean(signal**2, axis=1))


def test_every_item_is_the_signal_of_its_record_in_single_precision_and_its_class(corpus):
    folder, records = corpus
    items = gen.torch_dataset(folder)
    assert len(items) == sum(SIZES)
    for place, (signal, fault) in enumerate(items):
        assert (signal.dtype, signal.flags.writeable, type(fault)) == (np.float32, True, int)
        np.testing.assert_array_equal(signal, records[SIGNAL][place])
        assert fault == records["fault"][place]
    assert place == len(items) - 1
    assert [items.names[code] for code in range(3)] == ["healthy", "inner", "outer"]
    assert items.channels == ("a", "b")


def test_split_condition_and_channels_choose_records_and_channels(corpus):
    folder, records = corpus
    items = gen.torch_dataset(folder, split="test", where="shaft_rate > 5", channels=["b"])
    chosen = np.flatnonzero((records["split"] == SPLITS.index("test")) & (records["shaft_rate"] > 5))
    assert items.records.tolist() == chosen.tolist() != []
    assert items.channels == ("b",)
    for record, (signal, _) in zip(chosen, items, strict=True):
        np.testing.assert_array_equal(signal, records[SIGNAL][record, 1:])


def test_several_items_in_any_order_are_those_one_by_one(corpus):
    items = gen.torch_dataset(corpus[0], where="specimen != 3")
    places = [7, 0, 12, 7, -1, 3]
    for (signal, fault), place in zip(items.__getitems__(places), places, strict=True):
        np.testing.assert_array_equal(signal, items[place][0])
        assert fault == items[place][1]
    for beyond in (13, -14):
        with pytest.raises(IndexError, match="is not one of 13"):
            items[beyond]


def test_batches_hold_every_record_once_and_a_seed_shuffles_them(corpus):
    folder, records = corpus
    items = gen.torch_dataset(folder, label="specimen")
    in_order = list(items.batches(4))
    assert [len(labels) for _, labels in in_order] == [4, 4, 4, 2]
    np.testing.assert_array_equal(np.concatenate([signals for signals, _ in in_order]), records[SIGNAL])
    order = np.concatenate([labels for _, labels in items.batches(4, seed=1)])
    assert sorted(order) == list(range(14)) != order.tolist()
    for signals, labels in items.batches(5, seed=1):
        np.testing.assert_array_equal(signals, records[SIGNAL][labels])
    with pytest.raises(ValueError, match="size: 0"):
        next(items.batches(0))


def test_labels_are_codes_whole_numbers_numbers_in_single_precision_or_texts(corpus):
    folder, records = corpus
    kinds = {"split": int, "rig": int, "width": np.float32, "bearing": str}
    for label, kind in kinds.items():
        items = gen.torch_dataset(folder, label=label)
        assert type(items[3][1]) is kind
        assert items[3][1] == records[label].values[3]
        assert bool(items.names) == (label == "split")


def test_the_transform_is_called_with_the_signal_of_each_record(corpus):
    items = gen.torch_dataset(corpus[0], transform=rms)
    plain = gen.torch_dataset(corpus[0])
    np.testing.assert_array_equal(items[5][0], rms(plain[5][0]))
    signals, _ = next(items.batches(3))
    np.testing.assert_array_equal(signals, [rms(plain[place][0]) for place in range(3)])


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ({"label": "falt"}, "label: there is no variable falt; the nearest is fault."),
        ({"where": "fault == 'cage' and shaft_rate < 0"}, "none of 14 records is chosen"),
    ],
)
def test_a_wrong_choice_is_one_sentence(corpus, asked, sentence):
    with pytest.raises(CorpusError) as error:
        gen.torch_dataset(corpus[0], **asked)
    assert sentence in str(error.value)


def open_parts(folder):
    """Parts of the corpus that this process has open."""
    links = [link for link in Path("/proc/self/fd").iterdir() if link.is_symlink()]
    return sorted(path.name for path in (link.readlink() for link in links) if path.parent == folder / "parts")


def read_alone(items, place, folder):
    """One item, and the parts that were open before and after it was read."""
    before = open_parts(folder)
    signal, fault = items[place]
    return signal, fault, before, open_parts(folder)


def test_a_worker_opens_its_own_files_and_reads_the_same(corpus):
    """A forked process inherits the open files of its parent; it closes them at once."""
    items = pickle.loads(pickle.dumps(gen.torch_dataset(corpus[0])))  # noqa: S301 - of this process
    expected = [items[place] for place in range(len(items))]
    if not Path("/proc/self/fd").exists():
        pytest.skip("this system does not list the open files of a process")
    assert len(open_parts(corpus[0])) == len(SIZES)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        signal, fault, before, after = pool.apply(read_alone, (items, 8, corpus[0]))
    assert before == []
    assert after == [part_name(2)]
    np.testing.assert_array_equal(signal, expected[8][0])
    assert fault == expected[8][1]
    np.testing.assert_array_equal(items[8][0], expected[8][0])


@needs_torch
@pytest.mark.parametrize("workers", [0, 2])
def test_a_data_loader_of_torch_gives_tensors_of_every_record(corpus, workers):
    import torch
    from torch.utils.data import DataLoader

    folder, records = corpus
    items = gen.torch_dataset(folder, label="specimen")
    seen = []
    for signals, specimens in DataLoader(items, batch_size=4, shuffle=True, num_workers=workers):
        assert (signals.dtype, specimens.dtype) == (torch.float32, torch.int64)
        np.testing.assert_array_equal(signals, records[SIGNAL][specimens.numpy()])
        seen += specimens.tolist()
    assert sorted(seen) == list(range(14))
    width = next(iter(DataLoader(gen.torch_dataset(folder, label="width"), batch_size=4)))[1]
    assert width.dtype == torch.float32
