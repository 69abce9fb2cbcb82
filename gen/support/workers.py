"""Independent tasks in this thread, in threads of this process, in processes on this machine or on a cluster, behind one function.

Compiled kernels, Fourier transforms and compression run without the interpreter lock, so a few threads share one process: they start at
once and share its libraries. The rest of a task holds the lock: beyond ``MOST_THREADS`` workers there are several processes, each with
some threads. A task may run in any of them, so it holds :data:`gen.corpus.LIBRARY_LOCK` while it uses netCDF4 or h5py.
"""

import os
import threading
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from itertools import islice
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any

from gen.support.errors import RacewayError

if TYPE_CHECKING:
    from distributed import Client

MOST_THREADS = 4  # of a process: about a fifth of the time of a record holds the interpreter lock
POLL_S = 0.5


def run(
    task: Callable[..., Iterable[Any]],
    items: Iterable[Any],
    *,
    workers: int = 1,
    scheduler: "Client | str | None" = None,
    report: Callable[..., None] | None = None,
    meanwhile: Callable[[], None] = lambda: None,
) -> Generator[Any]:
    """Results of ``task`` on every item, in the order in which they are there.

    About two items per worker are taken in advance, so ``items`` may be a long generator. The first error of a task is raised here, and no
    further task begins. The same holds when the generator is closed. Both wait for the tasks that run in threads of this process;
    KeyboardInterrupt does not.

    Parameters
    ----------
    task : callable
        Called with an item; or with ``report`` and an item, if ``report`` is given. It returns or yields any number of results; those from
        another process come when the task is finished. Where it may run in another process, task, items and results are pickled.
    items : iterable
        Inputs of the tasks; taken in this thread.
    workers : int
        Number of tasks that run at a time: 1 in this thread, up to ``MOST_THREADS`` in threads of this process, more in processes on this
        machine with some threads each.
    scheduler : Client or str, optional
        A dask client, or the address of a dask scheduler; replaces ``workers``.
    report : callable, optional
        Takes whole numbers that a task reports. It is called in this process, but may be called in another thread.
    meanwhile : callable, optional
        Called in this thread now and then while no task finishes; not with one worker.

    Raises
    ------
    ClusterError
        If the scheduler does not answer or has no workers, or if the cluster is lost.
    """
    if scheduler is None and workers == 1:
        for item in items:
            yield from task(item) if report is None else task(report, item)
        return
    arrived: SimpleQueue[Any] = SimpleQueue()
    if scheduler is None and workers <= MOST_THREADS:
        opened = _threads(task, workers, report, arrived.put)
    else:
        from gen.support.cluster import dask_pool  # distributed takes 0.3 s to load

        threads = threads_of(workers)
        opened = dask_pool(task, (workers // threads, threads) if scheduler is None else scheduler, report)
    with opened as (submit, size):
        waiting, running = iter(items), 0
        while True:
            for item in islice(waiting, max(0, 2 * size() - running)):
                submit(item).add_done_callback(arrived.put)
                running += 1
            if not running:
                return
            try:
                results = arrived.get(timeout=POLL_S)
            except Empty:
                meanwhile()
                continue
            if not isinstance(results, tuple):
                running -= 1
                results = results.result()
            yield from results


class _StoppedError(RacewayError):
    """Raised in a task that reports after another task has failed or the results are no longer wanted."""


@contextmanager
def _threads(
    task: Callable[..., Iterable[Any]], count: int, report: Callable[..., None] | None, deliver: Callable[[Any], None]
) -> Iterator[tuple[Callable[[Any], Any], Callable[[], int]]]:
    """As :func:`gen.support.cluster.dask_pool`, of threads of this process: results are delivered one by one, before the task ends."""
    stopped = threading.Event()

    def pass_on(*numbers: int) -> None:
        if stopped.is_set():
            raise _StoppedError
        report(*numbers)  # pyright: ignore[reportOptionalCall]

    def work(item: Any) -> Iterable[Any]:
        for result in task(item) if report is None else task(pass_on, item):
            deliver((result,))
            if stopped.is_set():
                break
        return ()

    executor, patient = ThreadPoolExecutor(count), True
    try:
        yield partial(executor.submit, work), lambda: count
    except KeyboardInterrupt:
        patient = False
        raise
    finally:
        stopped.set()
        executor.shutdown(wait=patient, cancel_futures=True)


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


def threads_of(workers: int) -> int:
    """Number of threads of each process for a number of workers: the largest one up to ``MOST_THREADS`` that divides it.

    >>> [threads_of(workers) for workers in (1, 4, 6, 7, 16)]
    [1, 4, 3, 1, 4]
    """
    return next(threads for threads in range(MOST_THREADS, 0, -1) if workers % threads == 0)
