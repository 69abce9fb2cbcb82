"""Laws of kernels on disk: processes that compile at once do not harm each other, and damaged or foreign files are compiled again."""

import errno
import sys

import pytest
from numba import float32, float64, int64, njit
from numba.core import event

from gen.support.kernel_cache import is_on_disk, keep_on_disk


@pytest.fixture
def twice(tmp_path, monkeypatch):
    """A small function that is not compiled yet, as a new process makes it."""
    (tmp_path / "kernel_of_a_test.py").write_text("def twice(x):\n    return 2 * x\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "kernel_of_a_test", raising=False)
    monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path / "cache"))
    return lambda sources="sources": keep_on_disk(njit(__import__("kernel_of_a_test").twice), sources)


def test_nothing_is_kept_beside_the_source_where_the_user_has_a_cache(twice, monkeypatch, tmp_path):
    monkeypatch.setattr("numba.core.config.CACHE_DIR", "")
    monkeypatch.setattr("gen.support.kernel_cache.user_cache_dir", lambda name: str(tmp_path / "of_user" / name))
    assert twice()(1.5) == 3.0
    assert list((tmp_path / "of_user" / "raceway").rglob("*.nbc"))
    assert not (tmp_path / "__pycache__").is_dir() or not list((tmp_path / "__pycache__").glob("*.nbc"))


def test_of_two_processes_that_compile_at_once_each_keeps_its_variant(twice, monkeypatch):
    first, second = twice(), twice()
    files = first._cache._cache_file
    dump = files._dump
    monkeypatch.setattr(files, "_dump", lambda content: (second(1), second(1.5), dump(content))[-1])
    assert first(1.5) == 3.0  # the second compiles while the first writes
    assert [is_on_disk(twice(), (kind,)) for kind in (float64, int64, float32)] == [True, True, False]
    assert (twice()(1.5), twice()(1)) == (3.0, 2)


@pytest.mark.parametrize("step", ["_cache_file._open_for_write", "_impl.locator.ensure_cache_path"])
def test_a_function_that_cannot_be_saved_is_compiled_all_the_same(twice, monkeypatch, step):
    function = twice()

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    of = function._cache
    *places, name = step.split(".")
    for place in places:
        of = getattr(of, place)
    monkeypatch.setattr(of, name, full)
    assert function(1.5) == 3.0
    assert not is_on_disk(function, (float64,))


def flip(content, place):
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


DAMAGE = {
    "cut in half": lambda content: content[: len(content) // 2],
    "empty": lambda _: b"",
    "as numba writes it": lambda content: content[32:],
    "one bit in the middle": lambda content: flip(content, len(content) // 2),
}


@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_a_damaged_file_is_compiled_again_once(twice, tmp_path, damage):
    twice()(1.5)
    (file,) = (tmp_path / "cache").rglob("*.nbc")
    file.write_bytes(damage(file.read_bytes()))
    for compiled in (1, 0):
        function = twice()
        with event.install_recorder("numba:compile") as recorder:
            assert function(1.5) == 3.0
        assert sum(compilation.is_start for _, compilation in recorder.buffer) == compiled
