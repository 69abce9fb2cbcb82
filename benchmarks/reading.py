"""Time to read and to hash a corpus in a folder and in a single file, compared with xarray on the single file.

The files are in the page cache. Processes are forked, like those of a data loader.
"""

import multiprocessing
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import xarray as xr

from benchmarks.pairs import Line, interleaved, row, seconds
from benchmarks.pipeline import SHORT, variant
from gen.corpus import SIGNAL, corpus_files, files, open_corpus
from gen.generation.corpus import generate

BLOCK = 64  # records read at a time
PROCESSES = 4
ALTERNATIVE = "xarray on the single file"

Opened = Callable[[], xr.Dataset]


def rows(pairs: int = 5, *, parts: int = 40, records_per_part: int = 64, seconds_each: float = 1.0) -> Iterator[Line]:
    """Lines of the table."""
    with tempfile.TemporaryDirectory() as folder:
        recipe = variant(
            SHORT,
            Path(folder) / "parts.yaml",
            storage={"records_per_part": records_per_part},
            recording={"sample_rate_hz": 12800, "duration_s": seconds_each},
        )
        records = parts * records_per_part
        corpus, file = (generate(recipe, Path(folder) / name, records=records).path for name in ("c", "c.nc"))
        ways = {
            "in order": in_order,
            "at random": at_random,
            "through dask": through_dask,
            "in processes": in_processes,
        }
        for name, read in ways.items():
            found = interleaved(
                pairs,
                ours=lambda read=read: records / seconds(read, lambda: open_corpus(corpus, "size"), records),
                single=lambda read=read: records / seconds(read, lambda: open_corpus(file, "size"), records),
                theirs=lambda read=read: records / seconds(read, lambda: plain(file), records),
            )
            for form, what in (
                ("ours", f"{records} records of {parts} parts"),
                ("single", f"{records} records of one file"),
            ):
                named = f"reading {name}" + (" from a file" if form == "single" else "")
                yield row(named, what, "1/s", found[form], ALTERNATIVE, found["theirs"])
        found = interleaved(
            pairs,
            hashing=lambda: seconds(hashed, corpus),
            reading=lambda: seconds(in_order, lambda: open_corpus(corpus, "size"), records),
        )
        yield row("reading hashes", "hash every file", "s", found["hashing"], "reading in order", found["reading"])


def plain(file: Path) -> xr.Dataset:
    """The corpus as xarray opens it by itself."""
    return xr.open_dataset(file, engine="netcdf4", decode_times=False)


def hashed(corpus: Path) -> None:
    """Hash every file of a corpus, as a process does when it first opens it."""
    files.forget_hashes()
    corpus_files(corpus, "sha256")


def in_order(opened: Opened, records: int) -> None:
    """Every record, in blocks."""
    with opened() as corpus:
        for first in range(0, records, BLOCK):
            corpus[SIGNAL].variable[first : first + BLOCK].load()


def at_random(opened: Opened, records: int) -> None:
    """As many records as the corpus has, one at a time, drawn at random."""
    with opened() as corpus:
        for record in np.random.default_rng(0).integers(0, records, records):
            corpus[SIGNAL].variable[int(record)].load()


def through_dask(opened: Opened, records: int) -> None:
    """Every record, as chunks of a dask array, in two threads."""
    with opened() as corpus:
        corpus[[SIGNAL]].chunk({"record": BLOCK})[SIGNAL].mean().compute(scheduler="threads", num_workers=2)
        assert corpus.sizes["record"] == records


def in_processes(opened: Opened, records: int) -> None:
    """Every record once, one at a time in random order, shared among processes."""
    order = np.random.default_rng(0).permutation(records)
    with opened() as corpus, multiprocessing.get_context("fork").Pool(PROCESSES) as pool:
        signal = corpus[SIGNAL].variable
        pool.starmap(_load, [(signal, share) for share in np.array_split(order, PROCESSES)])


def _load(signal: xr.Variable, records: np.ndarray) -> None:
    for record in records:
        signal[int(record)].load()
