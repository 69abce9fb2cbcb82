"""A worker process ends together with the one that started it, even if that was killed: then its end of the pipe to the worker closes."""

import os
import threading


def dask_setup(_worker: object) -> None:
    """Wait for the end of the pipe in a thread; dask calls this when the worker starts."""
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    os.read(0, 1)
    os._exit(0)
