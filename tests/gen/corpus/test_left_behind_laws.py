"""Laws of temporary files: those of killed processes are removed, those of running processes and of other names are kept."""

import os
import subprocess
import sys

import pytest

from gen.corpus import new_corpus_folder, remove_left_behind_of, temporary_beside
from gen.errors import CorpusError


@pytest.fixture
def ended():
    """Number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def test_only_files_of_ended_processes_are_removed(tmp_path, ended):
    (tmp_path / f".corpus.{ended}.1.tmp").mkdir()
    (tmp_path / f".corpus.{os.getpid()}.1.tmp").mkdir()  # of an earlier process with the number of this one
    kept = [f".corpus.{os.getppid()}.1.tmp", f".corpus.nc.{ended}.1.tmp", ".corpus.tmp", ".other.1.1.tmp"]
    for name in kept:
        (tmp_path / name).touch()
    with temporary_beside(tmp_path / "corpus") as own:
        own.mkdir()
        remove_left_behind_of(tmp_path / "corpus")
        assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*kept, own.name])


def test_a_link_in_place_of_a_new_corpus_is_refused_before_the_work(tmp_path):
    (tmp_path / "link").symlink_to(tmp_path / "nowhere")
    with pytest.raises(CorpusError, match="exists and is not an empty folder"), new_corpus_folder(tmp_path / "link"):
        pytest.fail("the work began")
