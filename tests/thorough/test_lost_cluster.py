"""A cluster that is lost for good ends the work in one sentence, and one that gets workers again completes it."""

import threading
import time

import pytest
from distributed import Client

import gen
from gen.recipe import Recipe
from gen.support import cluster, executor
from gen.support.errors import ClusterError
from gen.support.executor import run
from tests.conftest import small_with
from tests.gen.support.test_cluster_laws import threaded
from tests.worker_processes import worker_processes

__all__ = ["threaded"]


def _slow(number):
    time.sleep(0.2)
    return number


@pytest.mark.parametrize(
    ("lose", "sentence"),
    [
        (lambda c: c.scale(0), r"has had no worker for 1 s; start workers and run the same command again"),
        (lambda c: c.sync(c.scheduler.close), r"is gone; start it and run the same command again"),
    ],
    ids=["all workers", "the scheduler"],
)
def test_a_lost_cluster_ends_the_work_with_a_sentence(threaded, monkeypatch, lose, sentence):
    monkeypatch.setattr(executor, "PATIENCE_S", 0.2)
    monkeypatch.setattr(cluster, "COUNT_AGAIN_S", 0.2)
    monkeypatch.setattr(cluster, "PATIENCE_S", 1.0)
    with Client(threaded, set_as_default=False) as client:
        tasks = run(_slow, range(10_000), client)
        assert next(tasks) < 10_000
        loser = threading.Timer(0.5, lose, [threaded])
        loser.start()
        with pytest.raises(ClusterError, match=sentence):
            list(tasks)
        loser.join()


def test_a_cluster_that_gets_workers_again_completes_the_work(threaded, monkeypatch):
    monkeypatch.setattr(executor, "PATIENCE_S", 0.1)
    with Client(threaded, set_as_default=False) as client:
        tasks = run(_slow, range(40), client)
        found = [next(tasks)]
        threaded.scale(0)
        while client.nthreads():
            time.sleep(0.05)
        later = threading.Timer(1.0, threaded.scale, [2])
        later.start()
        found += list(tasks)
        later.join()
    assert set(found) == set(range(40))


def batches_after_kills(fresh):
    while True:
        for worker in worker_processes():
            worker.kill()
        yield next(fresh)


def test_a_stream_goes_on_where_it_was_after_its_processes_were_killed(monkeypatch):
    monkeypatch.setattr("gen.support.executor.cores", lambda: 2)
    with gen.stream(Recipe(small_with({})), batch=8, workers=2) as fresh:
        found = [next(fresh)]
        with pytest.raises(ClusterError, match="all worker processes have ended"):
            found.extend(batches_after_kills(fresh))
        found.append(next(fresh))
    numbers = [number for batch in found for number in batch["recording"].values.tolist()]
    assert numbers == list(range(8 * len(found)))
