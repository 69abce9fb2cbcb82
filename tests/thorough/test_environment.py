"""A disk that is full, memory that is short, and a scheduler or worker that cannot be used end a command in one sentence."""

import threading
from http.server import BaseHTTPRequestHandler, HTTPServer

import numpy as np
import pytest
from distributed import LocalCluster


@pytest.mark.parametrize("target", ["out", "out.nc", "out.parquet"])
def test_a_full_disk_ends_a_copy_in_one_sentence_and_leaves_nothing(start, tiny_corpus, tmp_path, target):
    process = start("copy", tiny_corpus, "-o", tmp_path / target, LARGEST_FILE="40000")
    error = process.communicate()[1]
    assert process.returncode == 2, error
    assert "could not be written" in error
    assert not list(tmp_path.glob("*out*"))


def test_a_recording_that_does_not_fit_in_memory_is_refused_in_one_sentence(start, tmp_path):
    """300 MB of bytes are 2.4 GB of numbers."""
    path = tmp_path / "large.npy"
    np.lib.format.open_memmap(path, mode="w+", dtype="i1", shape=(300_000_000,))
    machine = ("--bearing", "6205", "--rpm", "1500", "--rate", "20000")
    process = start("diagnose", path, *machine, LARGEST_MEMORY="2400000000")
    _, errors = process.communicate(timeout=60)
    assert errors == f"{path}: holds more values than fit in memory; cut it into shorter files.\n"
    assert process.returncode == 2


@pytest.mark.parametrize(
    ("address", "sentence"),
    [
        ("tls://127.0.0.1:8786", "needs certificates; name them in the configuration of dask"),
        ("127.0.0.1:1", "does not answer (Timed out trying to connect to 127.0.0.1:1 after 3 s)"),
        ("garbage", "does not answer (missing port number in address 'garbage')"),
    ],
)
def test_a_scheduler_that_cannot_be_used_is_told_in_one_line_and_soon(start, tiny_recipe, tmp_path, address, sentence):
    process = start("generate", tiny_recipe, "-o", tmp_path / "new", "--scheduler", address)
    _, errors = process.communicate(timeout=20)  # a client of dask without a scheduler takes 20 s to end
    assert (process.returncode, errors.count("\n")) == (2, 1)
    assert errors.startswith(f"scheduler {address}: {sentence}")


def test_another_server_than_a_scheduler_is_refused(run, tiny_corpus, tmp_path):
    with HTTPServer(("127.0.0.1", 0), BaseHTTPRequestHandler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"127.0.0.1:{server.server_port}"
        result = run("features", tiny_corpus, "-o", tmp_path / "new.nc", "--scheduler", address)
        server.shutdown()
    assert result.exit_code == 2
    assert f"scheduler {address}: does not answer (" in result.stderr


WITHOUT_RACEWAY = """
import sys
class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("gen", "features", "raceway"):
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, Missing())
"""


def test_a_worker_without_raceway_is_named_before_anything_is_written(run, tiny_recipe, tmp_path, monkeypatch):
    (tmp_path / "sitecustomize.py").write_text(WITHOUT_RACEWAY)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address="127.0.0.1:0") as cluster:
        worker = cluster.workers[0].worker_address
        result = run("generate", tiny_recipe, "-o", tmp_path / "new", "--scheduler", cluster.scheduler_address)
    assert result.exit_code == 2
    assert f"its worker {worker} has no Raceway; install it there" in result.stderr
    assert not (tmp_path / "new").exists()
