"""Laws of tasks in this thread, in threads, and in processes: the same results, the first error, little taken in advance."""

import itertools
import threading

import pytest

from gen.support.workers import run


def halved(item):
    yield item / 2


@pytest.mark.parametrize("workers", [1, 2, 4, 5])
def test_every_item_has_one_result_for_any_number_of_workers(workers):
    assert sorted(run(halved, iter(range(20)), workers=workers)) == [item / 2 for item in range(20)]
    assert list(run(halved, [], workers=workers)) == []


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
