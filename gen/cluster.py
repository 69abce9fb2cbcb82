"""Independent tasks on dask, their results in the order in which they finish, and a sentence when the cluster is lost.

Two tasks per thread of the workers are submitted at a time, so that memory does not grow with their number. A task may run twice: dask
repeats the tasks of a lost worker.
"""

import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager
from itertools import islice
from typing import Any, TypeVar
from uuid import uuid4

from distributed import Client, Future, KilledWorker, LocalCluster, get_worker, wait
from distributed import TimeoutError as DaskTimeoutError
from distributed.comm.core import CommClosedError

from gen.errors import ClusterError

Item = TypeVar("Item")
Result = TypeVar("Result")

POLL_S = 2.0
PATIENCE_S = 60.0
"""How long a cluster may be without workers before the call ends with an error [s]."""


@contextmanager
def local_client(workers: int | None = None, threads: int = 1) -> Iterator[Client]:
    """Client of a cluster of processes on this machine, by default one for each core, with some threads each."""
    with (
        LocalCluster(n_workers=workers, threads_per_worker=threads, dashboard_address="127.0.0.1:0") as cluster,
        Client(cluster) as client,
    ):
        yield client


@contextmanager
def client_of(scheduler: str) -> Iterator[Client]:
    """Client of the dask scheduler at an address.

    Raises
    ------
    ClusterError
        If no scheduler answers there, or it has no worker within ten seconds.
    """
    try:
        # the first client is not the default one: a default client without a scheduler stays, and xarray asks it for locks
        Client(scheduler, timeout="10s", set_as_default=False).close()
    except (OSError, ValueError, TimeoutError) as error:
        reason = " ".join(str(error).split())
        raise ClusterError(
            f"scheduler {scheduler}: does not answer ({reason}); give the address that dask scheduler printed."
        ) from None
    with Client(scheduler) as client:
        try:
            client.wait_for_workers(1, timeout=10)
        except TimeoutError:
            raise ClusterError(
                f"scheduler {scheduler}: has no workers; start some with dask worker {scheduler}."
            ) from None
        yield client


def listen(client: Client, handler: Callable[..., None]) -> str:
    """Call ``handler`` with every message published from now on, in a thread of the client; returns the topic to publish to."""
    topic = f"raceway-{uuid4().hex}"
    client.subscribe_topic(topic, lambda event: handler(*event[1]))
    return topic


def publisher(topic: str) -> Callable[..., None]:
    """Function for a task that sends a message to the client that listens to a topic; its threads may call it too."""
    worker = get_worker()
    return lambda *message: worker.log_event(topic, message)


def run_tasks(
    client: Client, task: Callable[[Item], Result], items: Iterable[Item], meanwhile: Callable[[], None] = lambda: None
) -> Iterator[Result]:
    """Results of ``task`` on every item, in the order in which the tasks finish.

    ``meanwhile`` is called every ``POLL_S`` seconds in which no task finishes.

    Raises
    ------
    ClusterError
        If the scheduler is gone, no worker is left, or several workers died on the same task.
    """
    waiting = iter(items)
    width = 2 * max(sum(_threads(client).values()), 1)
    running = {client.submit(task, item, pure=False) for item in islice(waiting, width)}
    alone_since: float | None = None
    while running:
        try:
            future, result = _first_result(client, running)
        except (TimeoutError, DaskTimeoutError):
            alone_since = _alone_since(client, alone_since)
            meanwhile()
            continue
        alone_since = None
        running.remove(future)
        running |= {client.submit(task, item, pure=False) for item in islice(waiting, 1)}
        yield result


def _first_result(client: Client, running: set[Future]) -> tuple[Future, Any]:
    """A finished task and its result; TimeoutError if no task finishes within ``POLL_S``.

    Fetching the result has the same time limit: a result can be lost with its worker, and another worker then computes it again.
    """
    try:
        with client.as_current():
            waited: Any = wait(running, timeout=POLL_S, return_when="FIRST_COMPLETED")
        future = next(iter(waited.done))
        if future.status == "error":
            raise future.exception(timeout=POLL_S)  # pyright: ignore[reportGeneralTypeIssues]
        return future, future.result(timeout=POLL_S)
    except KilledWorker:
        raise ClusterError(
            "several workers of the cluster died on the same task; use fewer workers, or fewer records per part."
        ) from None
    except (CancelledError, CommClosedError) as error:
        raise _lost(client) from error


def _threads(client: Client) -> dict[str, int]:
    try:
        found: Any = client.nthreads()
    except (CancelledError, OSError, ValueError, RuntimeError) as error:
        raise _lost(client) from error
    return found


def _alone_since(client: Client, before: float | None) -> float | None:
    """Time since which the cluster has had no worker [s]; None if it has one."""
    if client.status != "running":
        raise _lost(client)
    if _threads(client):
        return None
    since = time.monotonic() if before is None else before
    if time.monotonic() - since > PATIENCE_S:
        raise ClusterError(
            f"{_name(client)}: has had no worker for {PATIENCE_S:g} s; start workers and run the same command again; "
            "finished parts are kept."
        )
    return since


def _lost(client: Client) -> ClusterError:
    return ClusterError(f"{_name(client)}: is gone; start it and run the same command again; finished parts are kept.")


def _name(client: Client) -> str:
    return f"scheduler {client.scheduler.address if client.scheduler else 'of the cluster'}"
