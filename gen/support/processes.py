"""A task in several processes of this machine: each makes its share, a little ahead of who asks for the results."""

import signal
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from importlib import import_module
from multiprocessing import get_context
from multiprocessing.connection import wait
from multiprocessing.context import SpawnProcess
from typing import Any

from gen.support.errors import ClusterError

Task = Callable[[int, int], Iterable[Any]]
_SPAWN = get_context("spawn")  # a copy of this process would hold locks that its threads had at that time
_RESULT, _ERROR, _END = range(3)
_standing_by: deque[tuple[Any, SpawnProcess]] = deque()


def load_ahead(module: str, count: int) -> None:
    """Start processes that load a module, and wait for a task that this process is about to prepare."""
    _standing_by.extend(_start(module) for _ in range(count))


@contextmanager
def in_processes(task: Task, count: int) -> Iterator[list[Iterator[Any]]]:
    """The results of ``task(share, count)`` for each share, in their order, each share from a process of its own.

    The processes end with the ``with`` block. A script needs ``if __name__ == "__main__":`` around what starts them.

    Raises
    ------
    ClusterError
        From an iterator, if its process ended before its share. Errors of the task are raised there too.
    """
    with _started(task, range(count), count) as processes:
        yield [_results(receiver, process) for receiver, process in processes.items()]


def as_they_come(task: Task, count: int) -> Generator[Any]:
    """The results of all shares in the order in which they come, as :func:`in_processes`; this process makes the first share.

    It starts at once, while the others load their libraries. The processes end with the generator.
    """
    with _started(task, range(1, count), count) as processes:
        running = dict(processes)
        for result in task(0, count):
            yield result
            yield from _arrived(running, 0)
        while running:
            yield from _arrived(running, None)


def _arrived(running: dict[Any, SpawnProcess], patience: float | None) -> Generator[Any]:
    """Results that other processes have sent; those that have ended leave ``running``."""
    for receiver in wait(list(running), patience):
        kind, value = _receive(receiver, running[receiver])
        if kind == _END:
            del running[receiver]
        else:
            yield value


@contextmanager
def _started(task: Task, shares: range, count: int) -> Iterator[dict[Any, SpawnProcess]]:
    """Processes by the ends of their pipes."""
    processes: dict[Any, SpawnProcess] = {}
    try:
        for share in shares:
            connection, process = _standing_by.popleft() if _standing_by else _start(__name__)
            processes[connection] = process
            with suppress(OSError):  # a process that has ended is told of when its results are asked for
                connection.send((task, share, count))
        while _standing_by:  # more than there are shares
            _standing_by.pop()[1].terminate()
        yield processes
    finally:
        for process in processes.values():
            process.terminate()
        for process in processes.values():
            process.join()


def _start(module: str) -> tuple[Any, SpawnProcess]:
    """A process that waits for its task, and this end of its pipe."""
    here, there = _SPAWN.Pipe()
    process = _SPAWN.Process(target=_work, args=(there, module), daemon=True)
    process.start()
    there.close()  # so that the end of the process ends the pipe
    return here, process


def _results(receiver: Any, process: SpawnProcess) -> Iterator[Any]:
    while (message := _receive(receiver, process))[0] != _END:
        yield message[1]


def _receive(receiver: Any, process: SpawnProcess) -> tuple[int, Any]:
    try:
        kind, value = receiver.recv()
    except (EOFError, OSError):  # a process that is killed may leave half a message
        process.join()
        raise ClusterError(
            f"a worker process ended with code {process.exitcode}; use fewer workers if memory is short, and put what "
            'starts them under if __name__ == "__main__":.'
        ) from None
    if kind == _ERROR:
        raise value
    return kind, value


def _work(sender: Any, module: str) -> None:
    """Receive a task and send the results of a share; the next one is made while one is sent or waits."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that began this one ends it
    import_module(module)
    sent: Future[None] | None = None
    try:
        task, share, count = sender.recv()
        with ThreadPoolExecutor(1) as thread:
            for result in task(share, count):
                if sent is not None:
                    sent.result()
                sent = thread.submit(sender.send, (_RESULT, result))
        sender.send((_END, None))
    except (BrokenPipeError, ConnectionResetError, EOFError):
        return  # nobody listens any more
    except Exception as error:  # noqa: BLE001 - it is raised where the results are asked for
        sender.send((_ERROR, error))
