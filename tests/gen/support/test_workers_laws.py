"""Laws of tasks in this thread, in threads, and in processes: the same results, the first error, little taken in advance."""

import itertools
import threading

import pytest

from gen.support.workers import MOST_THREADS, run, threads_of


def halved(item):
    yield item / 2


def counted(report, item):
    for step in range(3):
        report(item, step)
        yield item, step


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_every_item_has_one_result_for_any_number_of_threads(workers):
    assert sorted(run(halved, iter(range(20)), workers=workers)) == [item / 2 for item in range(20)]
    assert list(run(halved, [], workers=workers)) == []


@pytest.mark.parametrize("workers", [1, 3])
def test_a_task_reports_and_gives_several_results(workers):
    heard = []
    results = list(run(counted, range(4), workers=workers, report=lambda *numbers: heard.append(numbers)))
    assert sorted(results) == sorted(heard) == [(item, step) for item in range(4) for step in range(3)]


@pytest.fixture(autouse=True)
def no_thread_is_left():
    before = threading.active_count()
    yield
    assert threading.active_count() == before


def test_few_items_are_taken_in_advance():
    """Two for each thread, and one more for each result."""
    taken = []
    results = run(halved, (taken.append(item) or item for item in itertools.count()), workers=2)
    for _ in range(5):
        next(results)
    results.close()
    assert 5 <= len(taken) <= 9


def test_the_error_of_a_task_is_raised_and_no_further_task_begins():
    begun = []

    def failing(item):
        begun.append(item)
        raise ValueError(item)

    with pytest.raises(ValueError, match=r"[01]"):
        list(run(failing, itertools.count(), workers=2))
    assert len(begun) <= 4


def test_a_task_that_reports_ends_when_another_has_failed():
    running = threading.Event()

    def endless_or_failing(report, item):
        if item == 1:
            running.wait()
            raise ValueError("failed")
        while True:
            report(item)
            running.set()

    with pytest.raises(ValueError, match="failed"):
        list(run(endless_or_failing, [0, 1], workers=2, report=lambda _: None))


def test_threads_divide_the_workers():
    for workers in range(1, 40):
        assert 1 <= threads_of(workers) <= MOST_THREADS
        assert workers % threads_of(workers) == 0
