"""A task without end in several processes of this machine: each makes its share, a little ahead of who asks for the results."""

import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from multiprocessing.context import SpawnProcess
from typing import Any

from gen.support.errors import ClusterError

Task = Callable[[int, int], Iterable[Any]]
_SPAWN = get_context("spawn")  # a copy of this process would hold locks that its threads had at that time


@contextmanager
def in_processes(task: Task, count: int) -> Iterator[list[Iterator[Any]]]:
    """The results of ``task(share, count)`` for each share, in their order, each share from a process of its own.

    The processes end with the ``with`` block. A script needs ``if __name__ == "__main__":`` around what starts them.

    Raises
    ------
    ClusterError
        From an iterator, if its process ended before its share. Errors of the task are raised there too.
    """
    processes: list[SpawnProcess] = []
    results = list[Iterator[Any]]()
    try:
        for share in range(count):
            receiver, sender = _SPAWN.Pipe(duplex=False)
            process = _SPAWN.Process(target=_work, args=(sender, task, share, count), daemon=True)
            process.start()
            processes.append(process)
            sender.close()  # so that the end of the process ends the pipe
            results.append(_received(receiver, process))
        yield results
    finally:
        for process in processes:
            process.terminate()
        for process in processes:
            process.join()


def _received(receiver: Any, process: SpawnProcess) -> Iterator[Any]:
    while True:
        try:
            result, error = receiver.recv()
        except EOFError:
            process.join()
            raise ClusterError(
                f"a process that makes records ended with code {process.exitcode}; use fewer workers if memory is short, and put what "
                'starts them under if __name__ == "__main__":.'
            ) from None
        if error is not None:
            raise error
        yield result


def _work(sender: Any, task: Task, share: int, count: int) -> None:
    """Send the results of a share; the next one is made while one is sent or waits."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that began this one ends it
    sent: Future[None] | None = None
    try:
        with ThreadPoolExecutor(1) as thread:
            for result in task(share, count):
                if sent is not None:
                    sent.result()
                sent = thread.submit(sender.send, (result, None))
    except BrokenPipeError:
        return  # nobody listens any more
    except Exception as error:  # noqa: BLE001 - it is raised where the results are asked for
        sender.send((None, error))
