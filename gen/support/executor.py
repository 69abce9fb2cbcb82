"""A function of many items: one after the other in this process, or by dask in processes of this machine or on any cluster.

An item may be worked on twice: dask repeats what a lost worker was doing.
"""

import os
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from itertools import islice
from threading import Event
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from gen.support.errors import ClusterError

if TYPE_CHECKING:
    from distributed import Client, Future

AHEAD, HELD = (
    2,
    4,
)  # items under way for each worker, so that the next one is there when one is done; and those with results that wait
PATIENCE_S, LONGEST_S = 2.0, 60.0
"""How long a result is waited for before the cluster is looked at again; and how long, twice as long each time, while it is fetched [s]."""

Workers: TypeAlias = "Client | str | int"
"""Number of processes on this machine, where 1 is the calling one; or a dask client, or the address of a dask scheduler."""
Item = TypeVar("Item")
Result = TypeVar("Result")


def run(function: Callable[[Item], Result], items: Iterable[Item], workers: Workers = 1) -> Generator[Result]:
    """Results of a function on every item, in the order of the items.

    With one worker the function runs in this process, when its result is asked for. Otherwise dask runs it, some items for each worker in
    advance, so ``items`` may have no end. The first error of the function is raised here. Processes that were started for the call end
    with it: with the last result, with an error, or when the generator is closed.

    Parameters
    ----------
    function : callable
        Called with an item. Function, items and results are pickled where another process works; the function once for each worker.
    items : iterable
        Inputs; taken in this thread.
    workers : int, str or Client
        As for ``Workers``.

    Raises
    ------
    ClusterError
        If the scheduler does not answer or has no workers, or if the cluster or all processes are lost.
    """
    with connected(workers, getattr(function, "func", function).__module__) as client:
        if isinstance(client, int):
            yield from map(function, items)
            return
        from gen.support import cluster

        # the function is sent once to each worker
        task, waiting, left = cluster.sent_once(client, function), deque["Future"](), iter(items)
        arrived, threads, patience = Event(), cluster.threads(client), PATIENCE_S
        while True:
            n_threads, under_way = next(threads), sum(not future.done() for future in waiting)
            # a bounded number of tasks and of results, so that memory does not grow with the items
            for item in islice(left, max(0, min(AHEAD * n_threads - under_way, HELD * n_threads - len(waiting)))):
                waiting.append(client.submit(_call, task, item, pure=False))
                waiting[-1].add_done_callback(lambda _: arrived.set())
            if not waiting:
                return
            if not waiting[0].done():
                arrived.wait(PATIENCE_S)
                arrived.clear()
                continue
            # a result that is long in coming is asked for again, ever more patiently
            done = cluster.result_within(client, waiting[0], patience)
            patience = min(2 * patience, LONGEST_S) if done is None else PATIENCE_S
            if done is not None:
                waiting.popleft()
                yield done[0]


@contextmanager
def connected(workers: Workers, module: str) -> "Iterator[Client | int]":
    """Client of processes or of a scheduler, for several calls of :func:`run`; 1 where this process works.

    Parameters
    ----------
    workers : int, str or Client
        As for ``Workers``.
    module : str
        Name of a module with what the processes will do: it is loaded once, before they are copied.

    Raises
    ------
    ClusterError
        If the scheduler does not answer or has no workers, or a number of processes is below 1.
    """
    if workers == 1:
        yield 1
        return
    if isinstance(workers, int) and workers < 1:
        raise ClusterError(f"workers: {workers} is not allowed; use 1 or more.")
    from gen.support import cluster  # distributed takes 0.5 s to load, and work in this process does not need it

    with cluster.client_of(workers, module) as client:
        yield client


def _call(function: Callable[[Item], Result], item: Item) -> Result:
    return function(item)


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def too_many(workers: Workers) -> str | None:
    """Sentence about more processes than cores; None if there are none too many.

    >>> too_many(1)
    """
    if not isinstance(workers, int) or workers <= cores():
        return None
    return f"workers: {workers} is above the number of cores, {cores()}; more processes take memory and add no speed."
