"""Laws of writing: errors name the final path and what helps, one call writes at a time, and nothing unfinished is left."""

import errno
import os
import subprocess
import sys

import pytest

from gen.corpus import (
    check_new,
    check_place,
    new_corpus,
    remove_left_behind_of,
    temporary_beside,
    whole_folder_or_none,
    whole_or_not_at_all,
    writing,
)
from gen.corpus.disk import _HOST
from gen.corpus.locking import lock
from gen.support.errors import CorpusError


def sentence(path, error: Exception) -> str:
    with pytest.raises(CorpusError) as caught, writing(path):
        raise error
    return str(caught.value)


@pytest.mark.parametrize(
    ("number", "advice"),
    [
        (errno.ENOSPC, "free some space or choose another folder"),
        (errno.EDQUOT, "free some space or choose another folder"),
        (errno.EACCES, "get permission to write there or choose another folder"),
        (errno.EPERM, "get permission to write there or choose another folder"),
        (errno.EROFS, "choose another folder"),
    ],
)
def test_the_advice_follows_from_the_reason(tmp_path, number, advice):
    path = tmp_path / "file.nc"
    expected = f"{path}: could not be written ({os.strerror(number)}); {advice}."
    assert sentence(path, OSError(number, "any words", "/a/path")) == expected
    hdf5 = f"write failed (file write failed: time = Mon,\n errno = {number}, error message = 'words', buf = 0x7f)"
    assert sentence(path, RuntimeError(hdf5)) == expected


@pytest.mark.parametrize("error", [RuntimeError("NetCDF: HDF error"), OSError(-101, "NetCDF: HDF error", "/a/path")])
def test_an_error_that_netcdf_gives_no_reason_for_is_that_of_a_full_disk(tmp_path, error):
    assert sentence(tmp_path / "file.nc", error).endswith("HDF error); free some space or choose another folder.")


def test_no_error_names_a_temporary_path(tmp_path):
    for whole, name in ((whole_or_not_at_all, "file.nc"), (whole_folder_or_none, "folder")):
        for kind in (OSError, RuntimeError, CorpusError):
            with pytest.raises(CorpusError, match=name) as caught, whole(tmp_path / name) as temporary:
                raise kind(f"{temporary / 'part.nc'}: damaged")
            assert ".tmp" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["a.h5", "a.HDF5", "a.zarr", "a.csv"])
def test_no_corpus_has_the_name_of_another_kind_of_file(tmp_path, name):
    for check in (check_new, check_place):
        with pytest.raises(
            CorpusError, match=f"{name}: no corpus is a .* file; name a folder, or a file that ends in .nc"
        ):
            check(tmp_path / name)
        check(tmp_path / "corpus_0.5.v2")


HOLD = (
    "import sys, time; from pathlib import Path; from gen.corpus.locking import lock\n"
    "with lock(Path(sys.argv[1])): print('held', flush=True); time.sleep(60)"
)


def test_a_folder_is_refused_while_another_process_holds_its_lock_and_free_once_that_is_killed(tmp_path):
    process = subprocess.Popen([sys.executable, "-c", HOLD, tmp_path], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "held\n"
    with (
        pytest.raises(CorpusError, match="another raceway command is writing into it; wait until it ends"),
        lock(tmp_path),
    ):
        pass
    process.kill()
    process.communicate()
    with lock(tmp_path):
        assert list(tmp_path.iterdir()) == []


@pytest.fixture
def ended():
    """Number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def test_only_files_of_ended_processes_of_this_machine_are_removed(tmp_path, ended):
    (tmp_path / f".corpus.{_HOST}.{ended}.1.tmp").mkdir()
    (tmp_path / f".corpus.{_HOST}.{os.getpid()}.1.tmp").mkdir()  # of an earlier process with the number of this one
    running = f".corpus.{_HOST}.{os.getppid()}.1.tmp"
    kept = [running, f".corpus.another-host.{ended}.1.tmp", f".corpus.nc.{_HOST}.{ended}.1.tmp", ".corpus.tmp"]
    for name in kept:
        (tmp_path / name).touch()
    with temporary_beside(tmp_path / "corpus") as own:
        own.mkdir()
        remove_left_behind_of(tmp_path / "corpus")
        assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*kept, own.name])


@pytest.mark.parametrize("name", ["link", "link.nc"])
def test_a_link_in_place_of_a_new_corpus_is_refused_before_the_work(tmp_path, name):
    (tmp_path / name).symlink_to(tmp_path / "nowhere")
    with pytest.raises(CorpusError, match="exists"), new_corpus(tmp_path / name):
        pytest.fail("the work began")


@pytest.mark.parametrize("name", ["c", "c.nc"])
def test_what_a_killed_call_left_of_a_new_corpus_is_removed_by_the_next(tmp_path, ended, name):
    for hidden in (f".{name}", f".{name}.parts")[: 2 if name.endswith(".nc") else 1]:
        (tmp_path / f"{hidden}.{_HOST}.{ended}.1.tmp" / "parts").mkdir(parents=True)
    with pytest.raises(CorpusError, match="no record was written"), new_corpus(tmp_path / name):
        pass
    assert list(tmp_path.iterdir()) == []
