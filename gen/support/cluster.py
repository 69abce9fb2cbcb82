"""Clients of dask: of processes on this machine, or of a scheduler anywhere; and a sentence when a cluster is lost.

Processes of this machine are started as programs of their own, not as copies of the calling one: a script that starts some needs no
``if __name__ == "__main__":``, and what it defines is sent to them.
"""

import asyncio
import logging
import math
import os
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from typing import Any

import psutil
from distributed import Client, Future, KilledWorker, Scheduler
from distributed.comm.core import connect
from distributed.deploy.spec import SpecCluster
from distributed.deploy.subprocess import Subprocess
from distributed.security import Security

from gen.support import copied_workers
from gen.support.errors import ClusterError

CONNECT_S = 3.0  # a scheduler that is near answers within milliseconds
COUNT_AGAIN_S = 10.0  # the workers of a batch system start one by one
PATIENCE_S = 60.0
"""How long a cluster may be without workers before the call ends with an error [s]."""
logging.getLogger("distributed.batched").setLevel(
    logging.WARNING
)  # at the end of a cluster it logs tracebacks as information
_HERE = {"host": "127.0.0.1", "port": 0, "dashboard": False, "dashboard_address": "127.0.0.1:0"}


@contextmanager
def client_of(place: "Client | str | int", module: str) -> Iterator[Client]:
    """Client of a number of processes that end with the block, or of the scheduler at an address; a client is yielded as it is.

    Raises
    ------
    ClusterError
        If no scheduler answers there, it has no worker within ten seconds, or a worker lacks Raceway.
    """
    if isinstance(place, Client):
        yield place
    elif isinstance(place, str):
        with _client_at(place) as client:
            yield client
    else:
        # processes load the modules of the task while the caller still checks
        options = {"module": module, "count": place}
        workers = {"local": {"cls": _Processes, "options": options, "group": _suffixes(place)}}
        scheduler = {"cls": Scheduler, "options": _HERE}
        silent = {"asynchronous": False, "silence_logs": logging.CRITICAL}
        with SpecCluster(workers, scheduler, **silent) as cluster, Client(cluster, set_as_default=False) as client:
            yield client


class _Processes(Subprocess):
    """Workers of one thread in processes of their own, which end with this one."""

    def __init__(self, scheduler: str, name: object, module: str, count: int) -> None:
        super().__init__()
        self.scheduler, self.module = scheduler, module
        self.names = [f"{name}{suffix}" for suffix in _suffixes(count)]
        self._ours: int | None = None

    async def _start(self) -> None:
        environment = {"OMP_NUM_THREADS": "1", "DASK_LOGGING__DISTRIBUTED": "critical"} | os.environ
        environment["PYTHONPATH"] = os.pathsep.join(path or os.getcwd() for path in sys.path)  # noqa: PTH109 - as text
        command = [sys.executable, "-m", copied_workers.__name__, self.scheduler, self.module, *self.names]
        # a pipe of our own: asyncio closes its pipe when the program ends, and its copies would end too
        theirs, self._ours = os.pipe()
        try:
            silent = asyncio.subprocess.DEVNULL
            self.process = await asyncio.create_subprocess_exec(*command, stdin=theirs, stdout=silent, env=environment)
        finally:
            os.close(theirs)

    async def close(self) -> None:
        """End the processes: the copies too where the program that made them was killed."""
        if self._ours is not None:
            os.close(self._ours)
            self._ours = None
        while True:
            with suppress(psutil.NoSuchProcess):  # a copy has ended with its pipe while it was to be killed
                return await super().close()
            await asyncio.sleep(0.01)


def _suffixes(count: int) -> list[str]:
    return [f"-{number}" for number in range(count)]


@contextmanager
def _client_at(scheduler: str) -> Iterator[Client]:
    """Client of the dask scheduler at an address; certificates for ``tls://`` come from the configuration of dask."""
    _check_scheduler(scheduler)
    with Client(scheduler, timeout=f"{CONNECT_S}s", set_as_default=False) as client:
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


def sent_once(client: Client, function: Callable[..., Any]) -> Future:
    """A function as the result of a task: each worker gets it once, and dask makes it again if a worker that has it is lost."""
    with warnings.catch_warnings():
        # a function may bring a feature table along; it is sent no more than once for each worker
        warnings.filterwarnings("ignore", "Sending large graph")
        return client.submit(_itself, function, pure=False)


def _itself(function: Callable[..., Any]) -> Callable[..., Any]:
    return function


def threads(client: Client) -> Iterator[int]:
    """Number of threads of the workers, counted again now and then; ClusterError if the cluster is lost."""
    count, counted_at, had_workers_at = 0, -math.inf, time.monotonic()
    while True:
        if client.status != "running":
            raise _lost(client)
        now = time.monotonic()
        workers = getattr(client.cluster, "workers", {}).values()
        here = [worker for worker in workers if isinstance(worker, _Processes)]
        # processes of this machine that have ended, such as for want of memory
        for ended in (worker.process for worker in here if worker.process and worker.process.returncode is not None):
            if _threads(client):
                break  # the program was killed, and its copies work on
            raise ClusterError(
                f"all worker processes have ended, with code {ended.returncode}; use fewer workers if memory is short."
            )
        if now - counted_at > COUNT_AGAIN_S or not count:
            count, counted_at = sum(_threads(client).values()), now
            # a cluster may be without workers for a while, between two jobs of a batch system
            if count or here:
                had_workers_at = now
            elif now - had_workers_at > PATIENCE_S:
                raise ClusterError(
                    f"{_name(client)}: has had no worker for {PATIENCE_S:g} s; start workers and run the same command again; "
                    "finished parts are kept."
                )
        yield max(count, *(len(worker.names) for worker in here), 1)


def result_within(client: Client, future: Future, patience: float) -> tuple[Any] | None:
    """Result of a task, or None if it is not here within some seconds; the error of the task, or ClusterError if it never will be here.

    A result that is done can be lost with its worker while it is fetched. Then dask makes it again, and waits for workers without end.
    """
    try:
        return (future.result(patience),)
    except KilledWorker:
        raise ClusterError(
            "several workers died on the same task; use fewer workers, or fewer records per part."
        ) from None
    except CancelledError:
        raise _lost(client) from None
    except TimeoutError:
        # the task itself may have raised it
        if future.status == "error":
            raise
        return None


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
