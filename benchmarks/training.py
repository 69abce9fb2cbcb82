"""Records per second for training, compared with NumPy and h5py on the same counts.

``numpy`` reads an uncompressed array of the counts that is mapped into memory, ``h5py`` the parts of the corpus. All of them give the
same shuffled batches in single precision. Times are CPU times, and the files are in the page cache.
"""

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

import h5py
import numpy as np

import gen
from benchmarks.features import PER_PART, noise_corpus
from benchmarks.pairs import Line, cpu_seconds, interleaved, row
from gen.corpus import SIGNAL, corpus_files, stored_records
from gen.corpus.items import LabelledRecords

SCALE = np.float32(1e-3)  # of the counts of a noise corpus
Places = np.ndarray


def rows(pairs: int = 3, *, parts: int = 8, samples: int = 12_800, batch: int = 64) -> Iterator[Line]:
    """Lines of the table."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = noise_corpus(Path(temporary) / "zlib", parts * PER_PART, samples)
        yield from loading_rows(pairs, folder, batch)


def loading_rows(pairs: int, folder: Path, batch: int) -> Iterator[Line]:
    """Shuffled records from a corpus, compared with other ways to read them."""
    paths, items = corpus_files(folder, "size"), gen.torch_dataset(folder, check="size")
    records = len(items)
    order = np.random.default_rng(0).permutation(records)
    batches = [order[start : start + batch] for start in range(0, records, batch)]
    with tempfile.TemporaryDirectory() as temporary, ExitStack() as stack:
        np.save(f"{temporary}/counts.npy", np.concatenate([stored_records([path])[SIGNAL].values for path in paths]))
        counts = np.load(f"{temporary}/counts.npy", mmap_mode="r")
        zstd = noise_corpus(Path(temporary) / "zstd", records, counts.shape[2], "zstd")
        fast = gen.torch_dataset(zstd, check="size")
        files = [stack.enter_context(h5py.File(path, locking=False)) for path in paths]

        def by_h5py(places: Places) -> np.ndarray:
            return np.stack([files[place // PER_PART][SIGNAL][place % PER_PART] for place in places]) * SCALE

        seconds_of = interleaved(
            pairs,
            ours=lambda: rate(lambda places: joined(items, places), batches),
            zstd=lambda: rate(lambda places: joined(fast, places), batches),
            numpy=lambda: rate(lambda places: counts[places] * SCALE, batches),
            h5py=lambda: rate(by_h5py, batches),
            single=lambda: rate(lambda places: items[places[0]], order[:, None]),
        )
    what, ours = f"shuffled batches of {batch}", "batches, zlib"
    yield row("training numpy", f"{what}, zlib", "1/s", seconds_of["ours"], "numpy, uncompressed", seconds_of["numpy"])
    yield row("training h5py", f"{what}, zlib", "1/s", seconds_of["ours"], "h5py on the parts", seconds_of["h5py"])
    yield row("training zstd", f"{what}, zstd", "1/s", seconds_of["zstd"], ours, seconds_of["ours"])
    yield row(
        "training one by one",
        "shuffled records one by one, zlib",
        "1/s",
        seconds_of["single"],
        ours,
        seconds_of["ours"],
    )


def joined(items: LabelledRecords, places: Places) -> np.ndarray:
    """Signals of some records, shape (record, channel, elapsed_time) [m s-2]."""
    return np.stack([signal for signal, _ in items.__getitems__(places)])


def rate(read: Callable[[Places], object], batches: Sequence[Places] | np.ndarray) -> float:
    """Records read in a second of CPU time [1/s]."""

    def read_all() -> None:
        for places in batches:
            read(places)

    return sum(map(len, batches)) / cpu_seconds(read_all)
