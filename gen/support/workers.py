"""Independent tasks in this thread, in threads of this process, in processes on this machine or on a cluster, behind one function.

Compiled kernels, Fourier transforms and compression run without the interpreter lock, so a few threads share one process: they start at
once and share its libraries. The rest of a task holds the lock: more than ``MOST_THREADS`` workers are processes. A task may run in any of
them, so it holds :data:`gen.corpus.LIBRARY_LOCK` while it uses netCDF4 or h5py.
"""

import os
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import islice
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any

from gen.support.processes import as_they_come

if TYPE_CHECKING:
    from distributed import Client

MOST_THREADS = 4  # of a process: about a fifth of the time of a task holds the interpreter lock
POLL_S = 0.5

Task = Callable[..., Iterable[Any]]


def run(
    task: Task,
    items: Iterable[Any],
    *,
    workers: int = 1,
    scheduler: "Client | str | None" = None,
    report: Callable[..., None] | None = None,
) -> Generator[Any]:
    """Results of ``task`` on every item, in the order in which they are there.

    Threads and clusters take about two items per worker in advance, so ``items`` may be a long generator. The first error of a task is
    raised here, and no further task begins. The same holds when the generator is closed. Both wait for the tasks that run in threads of
    this process; KeyboardInterrupt does not.

    Parameters
    ----------
    task : callable
        Called with an item; or with ``report`` and an item, if ``report`` is given. It returns or yields any number of results. Where it
        may run in another process, task, items and results are pickled.
    items : iterable
        Inputs of the tasks; taken in this thread.
    workers : int
        Number of tasks that run at a time: 1 in this thread, up to ``MOST_THREADS`` in threads of this process, more in processes.
    scheduler : Client or str, optional
        A dask client, or the address of a dask scheduler; replaces ``workers``.
    report : callable, optional
        Takes whole numbers that a task on a cluster reports, in another thread of this process.

    Raises
    ------
    ClusterError
        If the scheduler does not answer or has no workers, or if the cluster or a process is lost.
    """
    if scheduler is not None:
        from gen.support.cluster import dask_pool  # distributed takes 0.3 s to load

        with dask_pool(task, scheduler, report) as (submit, size):
            yield from _in_turn(submit, size, items)
    elif workers == 1:
        for item in items:
            yield from task(item)
    elif workers <= MOST_THREADS:
        yield from _in_threads(task, items, workers)
    else:
        yield from as_they_come(partial(_dealt, task, list(items)), workers)


def _in_turn(submit: Callable[[Any], Any], size: Callable[[], int], items: Iterable[Any]) -> Generator[Any]:
    """Results of futures that ``submit`` makes of items, for ``size`` workers."""
    arrived: SimpleQueue[Any] = SimpleQueue()
    waiting, running = iter(items), 0
    while True:
        for item in islice(waiting, max(0, 2 * size() - running)):
            submit(item).add_done_callback(arrived.put)
            running += 1
        if not running:
            return
        try:
            done = arrived.get(timeout=POLL_S)
        except Empty:
            continue
        running -= 1
        yield from done.result()


def _in_threads(task: Task, items: Iterable[Any], count: int) -> Generator[Any]:
    executor, patient = ThreadPoolExecutor(count), True
    try:
        yield from _in_turn(lambda item: executor.submit(lambda: list(task(item))), lambda: count, items)
    except KeyboardInterrupt:
        patient = False
        raise
    finally:
        executor.shutdown(wait=patient, cancel_futures=True)


def _dealt(task: Task, items: list[Any], share: int, shares: int) -> Generator[Any]:
    for item in items[share::shares]:
        yield from task(item)


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def too_many(workers: int) -> str | None:
    """Sentence about more processes than cores; None if there are none too many.

    >>> too_many(1)
    """
    if workers <= cores():
        return None
    return f"workers: {workers} is above the number of cores, {cores()}; more processes take memory and add no speed."
