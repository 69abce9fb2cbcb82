"""Independent tasks on dask, their results in the order in which they finish, and a sentence when the cluster is lost.

Two tasks per thread of the workers are submitted at a time, so that memory does not grow with their number. A task may run twice: dask
repeats the tasks of a lost worker.
"""

import asyncio
import math
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import lru_cache, partial
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from itertools import islice
from queue import Empty, SimpleQueue
from typing import Any, TypeVar
from uuid import uuid4

from distributed import Client, Future, KilledWorker, LocalCluster, get_worker
from distributed import TimeoutError as DaskTimeoutError
from distributed.comm.core import CommClosedError, connect
from distributed.protocol.pickle import dumps, loads
from distributed.security import Security

from gen.support.errors import ClusterError

Item = TypeVar("Item")
Result = TypeVar("Result")

POLL_S = 2.0
CONNECT_S = 3.0  # a scheduler that is near answers within milliseconds
COUNT_AGAIN_S = 10.0  # the workers of a batch system start one by one
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
    """Client of the dask scheduler at an address; certificates for ``tls://`` come from the configuration of dask.

    Raises
    ------
    ClusterError
        If no scheduler answers there, it has no worker within ten seconds, or a worker lacks Raceway.
    """
    _check_scheduler(scheduler)
    with Client(scheduler, timeout=f"{CONNECT_S}s") as client:
        try:
            client.wait_for_workers(1, timeout=10)
        except TimeoutError:
            raise ClusterError(
                f"scheduler {scheduler}: has no workers; start some with dask worker {scheduler}."
            ) from None
        _check_workers(client)
        yield client


def _check_scheduler(address: str) -> None:
    """Connect to a scheduler and close the connection: a client that cannot connect takes half a minute to end, and prints tracebacks."""

    async def connected() -> None:
        comm = await connect(address, timeout=CONNECT_S, **Security().get_connection_args("client"))
        comm.abort()

    try:
        # in a thread of its own: the caller may be in an event loop, such as that of a notebook
        with ThreadPoolExecutor(1) as thread:
            thread.submit(asyncio.run, asyncio.wait_for(connected(), 2 * CONNECT_S)).result()
    except TypeError:  # no certificates
        raise ClusterError(
            f"scheduler {address}: needs certificates; name them in the configuration of dask, "
            "distributed.comm.tls.ca-file, client.cert and client.key."
        ) from None
    except Exception as error:  # noqa: BLE001 - dask takes the answer of another server for sizes and types
        reason = " ".join(str(error).split()) or type(error).__name__
        raise ClusterError(
            f"scheduler {address}: does not answer ({reason}); give the address that dask scheduler printed."
        ) from None


def _check_workers(client: Client) -> None:
    """ClusterError if a worker cannot import Raceway; such a worker ends with its first task."""
    specs: Any = client.run(find_spec, __name__, on_error="return")
    for worker, spec in specs.items():
        if not isinstance(spec, ModuleSpec):
            raise ClusterError(
                f"{_name(client)}: its worker {worker} has no Raceway; install it there, or start the worker in an environment that has it."
            )


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

    ``meanwhile`` is called every ``POLL_S`` seconds in which no task finishes. The cost of a task in this process does not depend on the
    number of tasks or workers: finished tasks report themselves, and their results are fetched together.

    Raises
    ------
    ClusterError
        If the scheduler is gone, no worker is left, or several workers died on the same task.
    """
    waiting = iter(items)
    call = partial(_call, dumps(task))
    width, counted_at = 0, -math.inf
    finished: SimpleQueue[Future] = SimpleQueue()
    running: set[Future] = set()
    alone_since: float | None = None
    while True:
        if time.monotonic() - counted_at > COUNT_AGAIN_S:
            width, counted_at = 2 * max(sum(_threads(client).values()), 1), time.monotonic()
        if new := list(islice(waiting, max(0, width - len(running)))):
            submitted: Any = client.map(call, new, pure=False)
            running.update(submitted)
            _report_to(finished, submitted)
        if not running:
            return
        batch: list[Future] = []
        try:
            batch = _next_batch(finished)
            failed = [future for future in batch if future.status == "error"]
            results = _results(client, [future for future in batch if future not in failed])
        except (TimeoutError, DaskTimeoutError):
            _report_to(finished, batch)
            alone_since = _alone_since(client, alone_since)
            meanwhile()
            continue
        alone_since = None
        running.difference_update(batch)
        yield from results
        for future in failed:
            _raise_error(future)


def _call(packed: bytes, item: Any) -> Any:
    return _unpack(packed)(item)


@lru_cache(maxsize=4)
def _unpack(packed: bytes) -> Callable[[Any], Any]:
    """Task from its pickled form: to pickle and unpickle a recipe for every item takes 0.6 ms."""
    return loads(packed)


def _report_to(finished: "SimpleQueue[Future]", futures: Iterable[Future]) -> None:
    """Put each future into the queue as soon as it has a result or an error, or is cancelled."""
    for future in futures:
        future.add_done_callback(finished.put)


def _next_batch(finished: "SimpleQueue[Future]") -> list[Future]:
    """All tasks that have finished; TimeoutError if none finishes within ``POLL_S``."""
    try:
        batch = [finished.get(timeout=POLL_S)]
    except Empty:
        raise TimeoutError from None
    with suppress(Empty):
        while True:
            batch.append(finished.get_nowait())
    return batch


def _results(client: Client, batch: list[Future]) -> list[Any]:
    """Results of finished tasks; TimeoutError if they do not arrive within ``POLL_S``.

    A result can be lost with its worker, and another worker then computes it again.
    """
    gather: Any = partial(client.gather, batch, asynchronous=True)
    try:
        results: Any = client.sync(gather, callback_timeout=POLL_S)
    except (CancelledError, CommClosedError) as error:
        raise _lost(client) from error
    return results


def _raise_error(future: Future) -> None:
    try:
        raise future.exception(timeout=POLL_S)  # pyright: ignore[reportGeneralTypeIssues]
    except KilledWorker:
        raise ClusterError(
            "several workers of the cluster died on the same task; use fewer workers, or fewer records per part."
        ) from None


def _threads(client: Client) -> dict[str, int]:
    try:
        threads: Any = client.nthreads()
    except (CancelledError, OSError, ValueError, RuntimeError) as error:
        raise _lost(client) from error
    return threads


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
