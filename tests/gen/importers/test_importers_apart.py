"""Reading in a separate process: the caller survives every failure there, and reports it."""

import os
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from gen.importers import apart
from gen.importers.apart import read_apart
from gen.importers.files import UnusableError

VALUES = {
    "doubles": np.random.default_rng(0).normal(size=(3, 70_000)),
    "big_endian": np.arange(5, dtype=">i2"),
    "one": np.float64(3.5),
    "none": np.empty((0, 4)),
    "transposed": np.arange(12.0).reshape(3, 4).T,
}


@pytest.mark.parametrize("values", VALUES.values(), ids=VALUES)
def test_values_come_back_as_they_were_read(values):
    found = read_apart(lambda: values, 0)
    np.testing.assert_array_equal(found, values)
    assert found.shape == np.shape(values)


def crash():
    os.kill(os.getpid(), signal.SIGSEGV)


def turn_in_circles():
    while True:
        pass


@pytest.mark.parametrize("read", [crash, turn_in_circles])
def test_a_crash_and_an_endless_loop_are_told_as_damage(monkeypatch, read):
    """Golden: for an HDF5 file with one changed byte in its layout, H5Dopen never returned."""
    monkeypatch.setattr(apart, "CPU_SECONDS", 1)
    start = time.monotonic()
    with pytest.raises(UnusableError, match="is damaged: the HDF5 library crashes on it or does not finish"):
        read_apart(read, 0)
    assert time.monotonic() - start < 30


def refuse():
    raise UnusableError("holds y, not x")


def test_what_is_raised_there_is_raised_here():
    with pytest.raises(UnusableError, match=r"^holds y, not x$"):
        read_apart(refuse, 0)
    with pytest.raises(ValueError, match="division by zero"):
        read_apart(lambda: 1 / 0, 0)


def test_no_process_and_no_open_file_is_left_behind():
    def held():
        task = Path("/proc/self/task") / str(threading.get_native_id())
        return len(list(Path("/proc/self/fd").iterdir())), (task / "children").read_text()

    before = held()
    for _ in range(5):
        read_apart(lambda: np.zeros(3), 0)
    assert held() == before
