"""Laws of the executor: the results in the order of the items, the first error, little taken in advance, no process left."""

import itertools
import os
import signal
import subprocess
import sys
import textwrap
import time
from functools import partial
from pathlib import Path

import psutil
import pytest
from distributed import LocalCluster

from gen.support.errors import ClusterError, RecipeError
from gen.support.executor import run
from tests.worker_processes import worker_processes


@pytest.fixture(autouse=True)
def no_process_is_left():
    yield
    assert worker_processes() == []


def halved(item):
    return item / 2


def process(_item):
    return os.getpid()


def refused(item):
    if item == 3:
        raise RecipeError("no such thing.")
    return item


def killed(marker, item):
    """Kill the process of item 5, every time or, with a marker, once."""
    if item == 5 and (marker is None or not marker.exists()):
        if marker is not None:
            marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return item


def test_every_item_has_its_result_in_order(two_processes):
    for workers in (1, two_processes):
        assert list(run(halved, iter(range(40)), workers)) == [item / 2 for item in range(40)]
        assert list(run(halved, [], workers)) == []


def test_processes_and_schedulers_work_elsewhere_and_one_worker_here():
    assert set(run(process, range(3))) == {os.getpid()}
    assert os.getpid() not in set(run(process, range(3), 2))
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0") as cluster:
        assert set(run(process, range(3), cluster.scheduler_address)) == {os.getpid()}


def uneven(item):
    time.sleep(1.0 if item == 0 else 0.02)
    return item


def test_a_long_item_does_not_hold_up_the_others():
    taken = []
    results = run(uneven, (taken.append(item) or item for item in range(40)), 2)
    assert next(results) == 0
    assert len(taken) == 8  # as many as are held
    assert list(results) == [*range(1, 40)]


def test_few_items_are_taken_in_advance(two_processes):
    for workers, held in ((1, 4), (two_processes, 8)):
        taken = []
        results = run(halved, (taken.append(item) or item for item in itertools.count()), workers)
        for _ in range(5):
            next(results)
        results.close()
        assert 5 <= len(taken) <= 5 + held


@pytest.mark.parametrize("workers", [1, 2])
def test_an_error_is_raised_where_its_result_would_come(workers):
    results = run(refused, range(10), workers)
    assert [next(results) for _ in range(3)] == [0, 1, 2]
    with pytest.raises(RecipeError, match="no such thing"):
        next(results)


def test_what_a_killed_process_was_doing_is_done_again(tmp_path):
    assert list(run(partial(killed, tmp_path / "once"), range(20), 2)) == [*range(20)]


def test_killed_processes_are_one_sentence():
    with pytest.raises(ClusterError, match="all worker processes have ended, with code 9; use fewer workers") as raised:
        list(run(partial(killed, None), range(20), 2))
    assert "\n" not in str(raised.value)


def test_a_script_without_a_main_guard_uses_processes_and_sends_what_it_defines(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        textwrap.dedent("""
            from gen.support.executor import run

            def squared(item):
                return item**2

            print(list(run(squared, range(5), 2)))
            """)
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60, cwd=Path.cwd())
    assert (done.stdout, done.stderr) == ("[0, 1, 4, 9, 16]\n", "")


def test_processes_end_with_the_one_that_started_them():
    code = "import time; from gen.support.executor import run; list(run(time.sleep, [60, 60], 2))"
    driver = psutil.Popen([sys.executable, "-c", code])
    while len(started := driver.children(recursive=True)) < 3:  # a program, and its two copies
        time.sleep(0.05)
    driver.kill()
    driver.wait(timeout=5)
    _, left = psutil.wait_procs(started, timeout=5)
    assert left == []


def test_less_than_one_worker_is_refused():
    with pytest.raises(ClusterError, match="workers: 0 is not allowed; use 1 or more"):
        list(run(halved, [1], 0))
