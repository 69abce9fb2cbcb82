"""Laws of temporary files: those of killed processes are removed, those of running processes and of other names are kept."""

import os
import subprocess
import sys

import pytest

from gen.corpus import new_corpus, remove_left_behind_of, temporary_beside
from gen.corpus.disk import _HOST
from gen.support.errors import CorpusError


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
