"""Dask workers of one thread on this machine: a program that loads libraries once, and is then copied for each worker.

All end when the pipe from the process that started the program closes, so also when that process was killed.
"""

import asyncio
import os
import signal
import sys
import threading
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from typing import Any

from distributed import Worker


def main(scheduler: str, module: str, names: Sequence[str]) -> int:
    """Load a module, start a worker of each name, and wait for their ends; the highest of their exit codes."""
    signal.signal(
        signal.SIGINT, signal.SIG_IGN
    )  # Ctrl-C reaches all processes of a terminal; the first one ends the others
    with suppress(ImportError):
        import_module(module)
    workers = [_copied(scheduler, name) for name in names]
    return max(abs(os.waitstatus_to_exitcode(os.waitpid(worker, 0)[1])) for worker in workers)


def _copied(scheduler: str, name: str) -> int:
    if (process := os.fork()) == 0:
        threading.Thread(target=_end_with_parent, daemon=True).start()
        asyncio.run(_work(scheduler, name))
        os._exit(0)
    return process


def _end_with_parent() -> None:
    os.read(0, 1)
    os._exit(0)


async def _work(scheduler: str, name: str) -> None:
    options: Any = {"host": "127.0.0.1", "dashboard": False, "dashboard_address": "127.0.0.1:0"}
    async with Worker(scheduler, nthreads=1, name=name, memory_limit=0, **options) as worker:
        await worker.finished()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:]))
