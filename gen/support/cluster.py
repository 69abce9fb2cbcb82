"""Independent tasks on a dask cluster, and a sentence when the cluster is lost.

A task may run twice: dask repeats the tasks of a lost worker.
"""

import asyncio
import math
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from functools import lru_cache, partial
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from typing import Any
from uuid import uuid4

from distributed import Client, KilledWorker, get_worker
from distributed.comm.core import connect
from distributed.protocol.pickle import dumps, loads
from distributed.security import Security

from gen.support.errors import ClusterError

CONNECT_S = 3.0  # a scheduler that is near answers within milliseconds
COUNT_AGAIN_S = 10.0  # the workers of a batch system start one by one
PATIENCE_S = 60.0
"""How long a cluster may be without workers before the call ends with an error [s]."""


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


@contextmanager
def dask_pool(
    task: Callable[..., Iterable[Any]], cluster: Client | str, report: Callable[..., None] | None
) -> Iterator[tuple[Callable[[Any], Any], Callable[[], int]]]:
    """What begins a task with an item and returns a future of its results, and the number of tasks that run at a time.

    ``cluster`` is a client, or the address of a scheduler.

    Raises
    ------
    ClusterError
        If the scheduler cannot be used or is gone, no worker is left, or several workers died on the same task.
    """
    with client_of(cluster) if isinstance(cluster, str) else nullcontext(cluster) as client:
        topic = None if report is None else f"raceway-{uuid4().hex}"
        if topic is not None:
            client.subscribe_topic(topic, lambda event: report(*event[1]))  # pyright: ignore[reportOptionalCall]
        try:
            yield partial(client.submit, _call, dumps(task), topic, pure=False), partial(next, _sizes(client))
        except CancelledError:
            raise _lost(client) from None
        except KilledWorker:
            raise ClusterError(
                "several workers of the cluster died on the same task; use fewer workers, or fewer records per part."
            ) from None


def _call(packed: bytes, topic: str | None, item: Any) -> list[Any]:
    """Results of a task on a worker; what it reports is sent to the clients that listen to the topic."""
    task = _unpack(packed)
    if topic is None:
        return list(task(item))
    worker = get_worker()
    return list(task(lambda *numbers: worker.log_event(topic, numbers), item))


@lru_cache(maxsize=4)
def _unpack(packed: bytes) -> Callable[..., Iterable[Any]]:
    """Task from its pickled form: to pickle and unpickle a recipe for every item takes 0.6 ms."""
    return loads(packed)


def _sizes(client: Client) -> Iterator[int]:
    """Number of threads of the workers, counted again now and then; ClusterError if the cluster is lost."""
    threads, counted_at, had_workers_at = 0, -math.inf, time.monotonic()
    while True:
        if client.status != "running":
            raise _lost(client)
        now = time.monotonic()
        if now - counted_at > COUNT_AGAIN_S:
            threads, counted_at = sum(_threads(client).values()), now
            if threads:
                had_workers_at = now
            elif now - had_workers_at > PATIENCE_S:
                raise ClusterError(
                    f"{_name(client)}: has had no worker for {PATIENCE_S:g} s; start workers and run the same command again; "
                    "finished parts are kept."
                )
        yield max(threads, 1)


def _threads(client: Client) -> dict[str, int]:
    try:
        threads: Any = client.nthreads()
    except (CancelledError, OSError, ValueError, RuntimeError) as error:
        raise _lost(client) from error
    return threads


def _lost(client: Client) -> ClusterError:
    return ClusterError(f"{_name(client)}: is gone; start it and run the same command again; finished parts are kept.")


def _name(client: Client) -> str:
    return f"scheduler {client.scheduler.address if client.scheduler else 'of the cluster'}"
