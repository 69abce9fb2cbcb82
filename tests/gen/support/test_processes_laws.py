"""Laws of shares in processes: order, errors, and a process that dies."""

import itertools
import os
import signal
from multiprocessing import active_children, parent_process

import pytest

from gen.support.errors import ClusterError, RecipeError
from gen.support.processes import as_they_come, in_processes, load_ahead


def every(share, count):
    return itertools.count(share, count)


def some(share, count):
    return range(share, 10, count)


def refused(share, _count):
    yield share
    raise RecipeError("no such thing.")


def killed(share, _count):
    yield share
    if parent_process() is not None:
        os.kill(os.getpid(), signal.SIGKILL)


def test_every_process_makes_its_share_in_order():
    with in_processes(every, 2) as shares:
        found = [next(shares[place % 2]) for place in range(40)]
    assert found == list(range(40))
    assert not active_children()


def test_an_error_of_the_task_is_raised_where_results_are_asked_for():
    with in_processes(refused, 1) as (share,):
        assert next(share) == 0
        with pytest.raises(RecipeError, match="no such thing"):
            next(share)


def test_a_process_that_dies_is_one_sentence():
    with in_processes(killed, 2) as shares:
        with pytest.raises(ClusterError, match="ended with code -9; use fewer workers") as raised:
            list(shares[1])
        assert "\n" not in str(raised.value)
    assert not active_children()


def test_shares_with_an_end_come_whole_from_all_processes():
    assert sorted(as_they_come(some, 3)) == list(range(10))
    with in_processes(some, 2) as shares:
        assert [list(share) for share in shares] == [[0, 2, 4, 6, 8], [1, 3, 5, 7, 9]]
    assert not active_children()


@pytest.mark.parametrize(("task", "error"), [(refused, RecipeError), (killed, ClusterError)])
def test_an_error_of_any_share_ends_all_of_them(task, error):
    with pytest.raises(error):
        list(as_they_come(task, 2))
    assert not active_children()


def own_number(_share, _count):
    yield os.getpid()


def test_a_process_that_stands_by_takes_the_next_task():
    load_ahead("json", 1)
    (waiting,) = active_children()
    assert set(as_they_come(own_number, 2)) == {os.getpid(), waiting.pid}
    assert not active_children()


def test_a_process_that_died_while_it_stood_by_is_one_sentence():
    load_ahead("json", 1)
    (waiting,) = active_children()
    waiting.kill()
    waiting.join()
    with pytest.raises(ClusterError, match="ended with code -9"):
        list(as_they_come(some, 2))
