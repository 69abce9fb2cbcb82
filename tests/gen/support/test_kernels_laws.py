"""Laws of kernels on disk: compiled once by several processes, and again if a file is damaged or of other sources."""

import errno
import os
import subprocess
import sys

import pytest
from numba import float32, float64, njit
from numba.core import event

from gen.support.kernels import keep_on_disk

ENVIRONMENT = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
# loads a small function, and says when it compiles it
LOAD = """
import sys, time, numba
sys.path.insert(0, sys.argv[1])
from kernel_of_a_test import twice
from numba.core import event
from gen.support.kernels import keep_on_disk
class Said(event.Listener):
    def on_start(self, event):
        print("compiling", flush=True)
        time.sleep(0.5)
    def on_end(self, event): pass
event.register("numba:compile", Said())
kernel = keep_on_disk(numba.njit(twice), "sources")
kernel._cache.load((numba.float64,))
print("loaded", kernel(1.5))
"""


def python(code, *arguments, **environment):
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=ENVIRONMENT | environment)


@pytest.fixture
def twice(tmp_path, monkeypatch):
    """A small function that is not compiled yet, as a new process makes it."""
    (tmp_path / "kernel_of_a_test.py").write_text("def twice(x):\n    return 2 * x\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "kernel_of_a_test", raising=False)
    monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path / "cache"))
    return lambda sources="sources": keep_on_disk(njit(__import__("kernel_of_a_test").twice), sources)


def test_of_two_processes_one_compiles_and_the_other_waits_and_loads(tmp_path, twice):
    cache = str(tmp_path / "cache")
    first = python(LOAD, tmp_path, NUMBA_CACHE_DIR=cache)
    assert first.stdout.readline() == "compiling\n"
    second = python(LOAD, tmp_path, NUMBA_CACHE_DIR=cache)
    assert [process.communicate(timeout=60)[0] for process in (first, second)] == ["loaded 3.0\n", "loaded 3.0\n"]
    assert twice()._cache.has((float64,))
    assert not twice()._cache.has((float32,))


def test_a_function_that_cannot_be_saved_is_compiled_all_the_same(twice, monkeypatch):
    function = twice()

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(function._cache._cache_file, "save", full)
    function._cache.load((float64,))
    assert function(1.5) == 3.0
    assert not function._cache.has((float64,))


def test_nothing_is_locked_where_no_file_can_be_made(twice):
    function = twice()
    function._cache._cache_path = os.devnull
    with function._cache._lock("kernel"):
        pass


def flip(content, place):
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


DAMAGE = {
    "cut in half": lambda content: content[: len(content) // 2],
    "cut in the hash": lambda content: content[:10],
    "empty": lambda _: b"",
    "text": lambda _: b"no kernel\n" * 50,
    "as numba writes it": lambda content: content[32:],
    "one bit at the start": lambda content: flip(content, 0),
    "one bit in the middle": lambda content: flip(content, len(content) // 2),
    "one bit at the end": lambda content: flip(content, len(content) - 1),
}


@pytest.mark.parametrize("kind", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_a_damaged_file_is_compiled_again_once(twice, tmp_path, kind, damage):
    twice()(1.5)
    (file,) = (tmp_path / "cache").rglob(f"*.{kind}")
    file.write_bytes(damage(file.read_bytes()))
    for compiled in (1, 0):
        function = twice()
        with event.install_recorder("numba:compile") as recorder:
            assert function(1.5) == 3.0
        assert sum(one.is_start for _, one in recorder.buffer) == compiled


def test_a_kernel_of_other_sources_or_another_function_is_compiled_again(twice, tmp_path):
    function = twice()
    function(1.5)
    assert twice()._cache.has((float64,))
    assert not twice("other")._cache.has((float64,))
    function(1)
    first, second = sorted((tmp_path / "cache").rglob("*.nbc"))
    first.write_bytes(second.read_bytes())
    assert twice()(1.5) == 3.0
