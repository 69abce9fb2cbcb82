"""The choice between this thread, threads of this process, processes on this machine and a cluster, for independent tasks.

Compiled kernels, Fourier transforms and compression run without the interpreter lock, so a few threads share one process: they start at
once and share its libraries. The rest of a task holds the lock: beyond ``MOST_THREADS`` workers there are several processes, each with
some threads. A task may run in any of them, so it holds :data:`gen.corpus.LIBRARY_LOCK` while it uses netCDF4 or h5py.
"""

import ctypes
import os
import threading
from collections.abc import Callable, Generator, Iterable
from contextlib import nullcontext, suppress
from functools import partial
from itertools import islice
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any

from gen.support.errors import RacewayError

if TYPE_CHECKING:
    from distributed import Client

MOST_THREADS = 4  # of a process: about a fifth of the time of a record holds the interpreter lock
POLL_S = 0.5
_ARENA_MAX = -8  # M_ARENA_MAX of malloc.h
_END = object()


def run(
    task: Callable[..., Any],
    items: Iterable[Any],
    *,
    workers: int = 1,
    scheduler: "Client | str | None" = None,
    report: Callable[..., None] | None = None,
    meanwhile: Callable[[], None] = lambda: None,
) -> Generator[Any]:
    """Results of ``task`` on every item, in the order in which the tasks finish.

    About two items per worker are taken in advance, so ``items`` may be a long generator. The first error of a task is raised here, and no
    further task begins. The same holds when the generator is closed. Both wait for the tasks that run in threads of this process;
    KeyboardInterrupt does not.

    Parameters
    ----------
    task : callable
        Called with an item; or with ``report`` and an item, if ``report`` is given. Where it may run in another process, task, items and
        results are pickled.
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
    return stream(
        partial(_alone, task), items, workers=workers, scheduler=scheduler, report=report, meanwhile=meanwhile
    )


def stream(
    task: Callable[..., Iterable[Any]],
    items: Iterable[Any],
    *,
    workers: int = 1,
    scheduler: "Client | str | None" = None,
    report: Callable[..., None] | None = None,
    meanwhile: Callable[[], None] = lambda: None,
) -> Generator[Any]:
    """All results of tasks that give several, one after the other; all else as in :func:`run`.

    Results come when the task yields them, those from another process when the task is finished.
    """
    if scheduler is None and workers == 1:
        return _here(task if report is None else partial(task, report), items)
    if scheduler is None and workers <= MOST_THREADS:
        return _in_threads(task, items, workers, report, meanwhile)
    return _on_dask(task, items, workers, scheduler, report, meanwhile)


def _alone(task: Callable[..., Any], *given: Any) -> tuple[Any]:
    return (task(*given),)


def _listed(task: Callable[..., Iterable[Any]], item: Any) -> list[Any]:
    return list(task(item))


def _publishing(task: Callable[..., Iterable[Any]], topic: str, item: Any) -> Iterable[Any]:
    from gen.support.cluster import publisher

    return task(publisher(topic), item)


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def threads_of(workers: int) -> int:
    """Number of threads of each process for a number of workers: the largest one up to ``MOST_THREADS`` that divides it.

    >>> [threads_of(workers) for workers in (1, 4, 6, 7, 16)]
    [1, 4, 3, 1, 4]
    """
    return next(threads for threads in range(MOST_THREADS, 0, -1) if workers % threads == 0)


def _here(task: Callable[[Any], Iterable[Any]], items: Iterable[Any]) -> Generator[Any]:
    for item in items:
        yield from task(item)


def _on_dask(
    task: Callable[..., Iterable[Any]],
    items: Iterable[Any],
    workers: int,
    scheduler: "Client | str | None",
    report: Callable[..., None] | None,
    meanwhile: Callable[[], None],
) -> Generator[Any]:
    from gen.support.cluster import client_of, listen, local_client, run_tasks  # distributed takes 0.3 s to load

    if scheduler is None:
        threads = threads_of(workers)
        opened: Any = local_client(workers // threads, threads)
    else:
        opened = client_of(scheduler) if isinstance(scheduler, str) else nullcontext(scheduler)
    with opened as client:
        if report is not None:
            task = partial(_publishing, task, listen(client, report))
        for results in run_tasks(client, partial(_listed, task), items, meanwhile):
            yield from results


def share_one_heap() -> None:
    """Let all threads of this process take memory from one heap, where the C library is that of GNU.

    Called before libraries start threads, it saves 70 MB of 560 with two threads, at the same speed.
    """
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).mallopt(_ARENA_MAX, 1)


class _StoppedError(RacewayError):
    """Raised in a task that reports after another task has failed or the results are no longer wanted."""


class _Threads:
    """Threads that take items from a queue until they are stopped; among the results are errors, and ``_END`` after each task."""

    def __init__(self, task: Callable[..., Iterable[Any]], count: int, report: Callable[..., None] | None) -> None:
        self.items: SimpleQueue[Any] = SimpleQueue()
        self.results: SimpleQueue[tuple[Any, BaseException | None]] = SimpleQueue()
        self.stopped = threading.Event()
        self._task = task if report is None else partial(task, partial(self._passed_on, report))
        # daemons: a process that ends does not wait for them
        self._threads = [threading.Thread(target=self._work, daemon=True) for _ in range(count)]
        for thread in self._threads:
            thread.start()

    def result(self) -> Any:
        """Result of the next task that finishes; raises its error, or Empty if no task finishes within ``POLL_S``."""
        result, error = self.results.get(timeout=POLL_S)
        if error is not None:
            raise error
        return result

    def stop(self) -> None:
        """Let no further task begin, and make those that run end with their next report."""
        self.stopped.set()
        for _ in self._threads:
            self.items.put(None)

    def join(self) -> None:
        """Wait until no task runs."""
        for thread in self._threads:
            thread.join()

    def _work(self) -> None:
        while (item := self.items.get()) is not None and not self.stopped.is_set():
            try:
                for result in self._task(item[0]):
                    self.results.put((result, None))
                    if self.stopped.is_set():
                        return
                self.results.put((_END, None))
            except BaseException as error:  # noqa: BLE001 - raised in the thread that takes the results
                self.results.put((None, error))

    def _passed_on(self, report: Callable[..., None], *numbers: int) -> None:
        if self.stopped.is_set():
            raise _StoppedError
        report(*numbers)


def _in_threads(
    task: Callable[..., Iterable[Any]],
    items: Iterable[Any],
    count: int,
    report: Callable[..., None] | None,
    meanwhile: Callable[[], None],
) -> Generator[Any]:
    threads, waiting = _Threads(task, count, report), iter(items)
    try:
        under_way = 0
        for item in islice(waiting, 2 * count):
            threads.items.put((item,))
            under_way += 1
        while under_way:
            try:
                result = threads.result()
            except Empty:
                meanwhile()
                continue
            if result is not _END:
                yield result
                continue
            under_way -= 1
            for item in islice(waiting, 1):
                threads.items.put((item,))
                under_way += 1
    except KeyboardInterrupt:
        threads.stop()
        raise
    except BaseException:
        threads.stop()
        threads.join()
        raise
    threads.stop()
    threads.join()
