"""Laws of reading: the same records for any number of open files and any environment, in threads and in other processes."""

import multiprocessing
import resource
import shutil
import threading
import time
import tomllib
from functools import lru_cache
from importlib.metadata import EntryPoint
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

from gen.corpus import (
    CODECS,
    SIGNAL,
    blocks_of,
    corpus_files,
    lazy,
    open_corpus,
    open_records,
    part_name,
    read_manifest,
    validate_corpus,
)
from gen.corpus.xarray_engine import CorpusEngine
from gen.support.errors import CorpusError
from tests.corpora import physical, write_corpus
from tests.paths import ROOT

MOST_OPEN, MANY = 8, (3,) * 24
"""Files that are open at a time here, and records of parts; more of them than a process may open."""


@pytest.fixture(scope="module", autouse=True)
def few_open():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lazy, "_open_file", lru_cache(MOST_OPEN)(lazy._File))
        yield
        lazy.close_files()


def open_handles():
    return len(list(Path("/proc/self/fd").iterdir()))


@pytest.fixture(scope="module", params=["c", "c.nc"])
def many(request, tmp_path_factory):
    """A corpus of more parts than are open at a time, as a folder and as a single file, and its signal."""
    path = tmp_path_factory.mktemp("many") / request.param
    parts = write_corpus(path, MANY)
    return path, np.concatenate([physical(part) for part in parts])


@pytest.fixture
def few_files():
    """Let this process open few more files than it has open."""
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (open_handles() + MOST_OPEN + 12, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, before)


@pytest.mark.usefixtures("few_files")
def test_more_parts_than_a_process_may_open_are_read_whole(many):
    folder, signal = many
    with open_corpus(folder) as corpus:
        np.testing.assert_allclose(corpus[SIGNAL], signal)
    assert validate_corpus(folder) == []


def test_a_few_files_are_open_at_a_time_and_none_when_the_corpus_is_closed(many):
    folder, _ = many
    before = open_handles()
    with open_corpus(folder) as corpus:
        for record in range(sum(MANY)):
            corpus[SIGNAL][record].load()
        assert open_handles() <= before + MOST_OPEN
    assert open_handles() <= before


def test_no_file_stays_open_after_a_look_at_it(many):
    path, _ = many
    before = open_handles()
    read_manifest(path)
    assert validate_corpus(path) == []
    files = corpus_files(path)
    for file in files:
        with open_records([file]) as part:
            part.load()
    assert open_handles() <= before
    with h5py.File(files[0], "r"):  # HDF5 refuses a file that is open with another kind of lock
        pass


def test_a_missing_part_is_never_taken_from_the_current_folder(nine, copied_folder, monkeypatch):
    with open_corpus(copied_folder) as corpus:
        (copied_folder / "parts" / part_name(1)).unlink()
        monkeypatch.chdir(nine / "c")
        with pytest.raises(CorpusError, match=r"part-00001\.nc: not a readable file of a corpus"):
            corpus[SIGNAL][3].load()


def test_a_part_that_changes_after_the_corpus_was_opened_is_refused(copied_folder):
    with open_corpus(copied_folder) as corpus:
        corpus[SIGNAL][0].load()
        shutil.copyfile(copied_folder / "parts" / part_name(1), copied_folder / "parts" / part_name(0))
        with pytest.raises(
            CorpusError, match=r"part-00000\.nc: changed since the corpus was opened; open the corpus again"
        ):
            corpus[SIGNAL][1].load()


KEYS = (
    np.s_[5], np.s_[-1], np.s_[2:7], np.s_[::-4], np.s_[[7, 0, 7, 68]], np.s_[3, 1], np.s_[3, 1, 10], np.s_[:4, :, 10:20:3],
    np.s_[:2, [1, 0, 1], ::-1], np.s_[:0], np.s_[[1, 60], 0, [5, 1]], np.s_[..., 3], np.s_[:, :, -5:],
)  # fmt: skip


@pytest.mark.parametrize("key", KEYS, ids=str)
def test_any_piece_of_the_signal_is_that_piece_of_the_whole(many, key):
    folder, signal = many
    whole = xr.DataArray(signal, dims=("record", "channel", "elapsed_time"))
    with open_corpus(folder) as corpus:
        np.testing.assert_allclose(corpus[SIGNAL][key], whole[key])


def test_a_missing_sample_is_nan_and_no_other_is(copied_folder):
    path = copied_folder / "parts" / part_name(2)
    with h5py.File(path, "r+") as part:
        values = part[SIGNAL][:]
        values[1, 0, 7] = -32768
        part[SIGNAL][...] = values
    found = open_records([path])[SIGNAL].values[:, 0]
    assert np.argwhere(np.isnan(found)).tolist() == [[1, 7]]
    np.testing.assert_allclose(np.delete(found, 7, 1), np.delete(values[:, 0] / 65.534, 7, 1), rtol=1e-6)


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.parametrize("kind", ["counts", "float32"])
def test_xarray_alone_decodes_a_part_to_the_same_bits(tmp_path, kind, codec):
    write_corpus(tmp_path / "c", kind=kind, codec=codec)
    path = tmp_path / "c" / "parts" / part_name(1)
    with open_records([path]) as ours, xr.open_dataset(path, engine="netcdf4", decode_times=False) as plain:
        assert set(ours.variables) == set(plain.variables)
        for name in plain.variables:
            assert ours[name].variable.identical(plain[name].variable)


def test_dask_reads_the_same_in_threads(many):
    folder, signal = many
    with open_corpus(folder) as corpus:
        chunked = corpus.chunk({"record": 7})
        assert chunked[SIGNAL].chunks[0][0] == 7
        np.testing.assert_allclose(chunked[SIGNAL].compute(scheduler="threads", num_workers=8), signal)
        np.testing.assert_allclose(corpus.chunk("auto").compute()[SIGNAL], signal)


def _sum(corpus, records):
    return float(corpus[SIGNAL].isel(record=records).sum(dtype=float))


@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_processes_of_a_data_loader_read_the_same_while_the_parent_reads_too(many):
    folder, signal = many
    with open_corpus(folder) as corpus:
        corpus[SIGNAL][:40].load()
        stop = threading.Event()

        def keep_reading():
            while not stop.is_set():
                corpus[SIGNAL][13].load()

        reader = threading.Thread(target=keep_reading)
        reader.start()
        try:
            with multiprocessing.get_context("fork").Pool(2) as pool:
                blocks = [slice(start, start + 7) for start in range(0, 70, 7)]
                sums = pool.starmap(_sum, [(corpus, block) for block in blocks])
        finally:
            stop.set()
            reader.join()
    np.testing.assert_allclose(sums, [signal[block].sum(dtype=float) for block in blocks])


def test_threads_write_and_read_at_once(tmp_path):
    wrong = []

    def work(number):
        try:
            for turn in range(2):
                folder = tmp_path / f"{number}-{turn}"
                signal = np.concatenate([physical(part) for part in write_corpus(folder, (3, 2, 2))])
                with open_corpus(folder) as corpus:
                    np.testing.assert_allclose(corpus[SIGNAL], signal)
                    corpus.drop_vars(SIGNAL).load()
        except Exception as error:  # noqa: BLE001 - of a thread, told below
            wrong.append(error)

    threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_the_same_parts_give_the_same_bytes(tmp_path):
    for place in ("one", "two"):
        write_corpus(tmp_path / place / "c")
        write_corpus(tmp_path / place / "c.nc")
        time.sleep(1.1 if place == "one" else 0)  # HDF5 stores times in whole seconds
    one, two = ({path.name: path.read_bytes() for path in (tmp_path / place).rglob("*.nc")} for place in ("one", "two"))
    assert one == two


def test_blocks_hold_every_record_once_and_few_at_a_time(tmp_path):
    write_corpus(tmp_path / "c.nc", (300, 270))
    with open_corpus(tmp_path / "c.nc") as corpus:
        assert blocks_of(corpus) == [slice(0, 256), slice(256, 512), slice(512, 570)]
        long = xr.Dataset({SIGNAL: corpus[SIGNAL].variable[:5].pad(elapsed_time=(0, 2_000_000))})
        assert blocks_of(long) == [slice(0, 2), slice(2, 4), slice(4, 5)]


def test_xarray_opens_a_corpus_by_the_name_of_its_engine_and_only_then(many):
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]["xarray.backends"]
    engine = EntryPoint("raceway", declared["raceway"], "xarray.backends").load()
    path, signals = many
    with xr.open_dataset(path, engine=engine, drop_variables="draws") as opened, open_corpus(path) as corpus:
        xr.testing.assert_identical(opened, corpus.drop_vars("draws"))
        np.testing.assert_array_equal(opened[SIGNAL].values, signals)
    # a file that a stranger sends is opened as before
    assert not engine().guess_can_open(path)


def test_xarray_refuses_an_altered_corpus_by_the_name_of_its_engine(copied_folder):
    part = copied_folder / "parts" / part_name(0)
    part.write_bytes(part.read_bytes()[:-1] + b"x")
    with pytest.raises(CorpusError, match=r"part-00000.nc"):
        xr.open_dataset(copied_folder, engine=CorpusEngine)
