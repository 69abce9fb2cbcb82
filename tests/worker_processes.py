"""The worker processes that this process has started."""

import psutil

SHARED: set[psutil.Process] = set()
"""Those that several tests of a file share."""


def worker_processes():
    """Other processes of dask below this one; the one that tracks resources of multiprocessing lives on and is none."""
    found = []
    for child in psutil.Process().children(recursive=True):
        try:
            if child not in SHARED and "gen.support.copied_workers" in child.cmdline():
                found.append(child)
        except (psutil.NoSuchProcess, psutil.ZombieProcess):
            continue
    return found
