"""Laws of clusters: workers with threads write the same bytes, and every item is worked on once."""

import time

import dask
import pytest
from distributed import Client, LocalCluster

from gen import generate
from gen.support import cluster
from gen.support.executor import run
from tests.same_corpora import assert_the_same_corpus


@pytest.fixture
def threaded():
    """A cluster whose workers are threads of this process, four each."""
    cluster_of_threads = LocalCluster(
        n_workers=2, threads_per_worker=4, processes=False, dashboard_address="127.0.0.1:0"
    )
    with dask.config.set({"distributed.comm.timeouts.connect": "1s"}):
        yield cluster_of_threads
        cluster_of_threads.close(timeout=2)


def test_workers_of_several_threads_make_the_same_parts(tiny_recipe, threaded, tmp_path):
    recipe = tmp_path / "many.yaml"
    recipe.write_text(tiny_recipe.read_text().replace("records_per_part: 12", "records_per_part: 2"))
    alone = generate(recipe, tmp_path / "alone", records=12)
    generate(recipe, tmp_path / "threads", records=12, scheduler=threaded.scheduler_address)
    assert_the_same_corpus(tmp_path / "threads", alone)


def negated(item):
    return -item


def test_few_tasks_are_submitted_ahead_of_their_results(threaded):
    """Four per thread, of which there are eight: memory does not grow with the number of items."""
    taken = 0

    def items():
        nonlocal taken
        for item in range(200):
            taken += 1
            yield item

    with Client(threaded, set_as_default=False) as client:
        for done, _ in enumerate(run(negated, items(), client)):
            assert taken - done <= 4 * 8 + 1


def test_workers_that_come_later_are_given_tasks(threaded, monkeypatch):
    """With one worker of four threads at most 16 items are held, with two 32."""
    monkeypatch.setattr(cluster, "COUNT_AGAIN_S", 0.0)
    taken = 0

    def items():
        nonlocal taken
        for taken in range(1, 201):  # noqa: B007
            yield 0

    threaded.scale(1)
    with Client(threaded, set_as_default=False) as client:
        while len(client.nthreads()) != 1:
            time.sleep(0.05)
        tasks = run(negated, items(), client)
        next(tasks)
        assert taken <= 17
        threaded.scale(2)
        client.wait_for_workers(2)
        assert 16 < max(taken - done for done, _ in enumerate(tasks, start=2)) <= 33
