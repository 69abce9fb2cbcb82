"""What a corpus of many parts costs beside its records: processor time of the driver and of dask's scheduler for each part.

:func:`gen.generate` runs in this process. Only its tasks are replaced: each waits for a stated time and links a part of real records
under its name. The scheduler is a process of its own, as are groups of the workers; their processor time is read from the system. All
else is as for any corpus: lock, manifest, index and data card.

"""

import asyncio
import logging
import multiprocessing
import os
import resource
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from multiprocessing.queues import Queue
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import patch

import psutil
from distributed import Client, Scheduler, Worker

from benchmarks.pairs import Line, Row
from benchmarks.pipeline import SHORT, variant
from gen.corpus import PartRow, part_name, read_manifest
from gen.generation import corpus as making
from gen.generation.identity import part_file
from gen.recipe import Recipe

PARTS = (100, 1000)
WORKERS = 64
TASK_S = 0.1  # shorter than any real part, so that a run takes minutes
GROUPS = 4  # processes that hold the workers
TICK_S = 1 / os.sysconf(
    "SC_CLK_TCK"
)  # the system counts the time of another process in such steps; a short run takes none


class Cost(NamedTuple):
    """Processor time for each part [s], and memory [MB]."""

    parts: int
    driver: float
    """Of the process that called :func:`gen.generate`, with all of its threads, without the ending."""
    scheduler: float
    ending: float
    """Of index, manifest and data card, which the driver writes at the end."""
    memory: float
    """Largest memory of the driver so far."""


def rows(
    _pairs: int = 1, *, parts: tuple[int, int] = PARTS, workers: int = WORKERS, task_s: float = TASK_S
) -> Iterator[Line]:
    """Lines of the table."""
    few, many = simulated_runs(parts, workers, task_s)
    what = f"CPU per part, {workers} workers, {many.parts:,} parts"
    subjects = {"driver": "driver", "scheduler": "dask's scheduler", "ending": "index, manifest and data card"}
    for name, subject in subjects.items():
        value, other = 1e3 * getattr(many, name), 1e3 * getattr(few, name)
        alternative = f"{few.parts:,} parts"
        yield Row(f"growth {name}", f"{subject}, {what}", value, "ms", alternative, other, value / other, 1)


def simulated_runs(sizes: tuple[int, ...], workers: int, task_s: float, per_part: int = 1) -> list[Cost]:
    """Costs of corpora with some numbers of parts, each of ``per_part`` records."""
    with tempfile.TemporaryDirectory() as temporary, _cluster(workers) as (address, scheduler):
        folder = Path(temporary)
        largest = {"records_per_specimen": per_part, "specimens_per_rig": 1, "rigs": max(*sizes, 2 * workers)}
        storage = {"records_per_part": per_part}
        recipe = variant(SHORT, folder / "parts.yaml", corpus=largest, storage=storage)
        model = making.generate(recipe, folder / "model", records=per_part).path
        linked = partial(_linked, model / "parts" / part_name(0), read_manifest(model).parts[0], task_s)
        with patch.object(making, "_write", linked):
            first = 2 * workers * per_part
            making.generate(recipe, folder / "first", records=first, scheduler=address)  # loads libraries
            return [_cost(recipe, folder / str(size), size, per_part, address, scheduler) for size in sizes]


def _cost(recipe: Path, folder: Path, parts: int, per_part: int, address: str, scheduler: psutil.Process) -> Cost:
    ending = []
    finish = vars(making)["_finish"]

    def timed(*arguments: Any) -> Any:
        start = time.process_time()
        done = finish(*arguments)
        ending.append(time.process_time() - start)
        return done

    before = time.process_time(), _cpu_seconds(scheduler)
    with patch.object(making, "_finish", timed):
        making.generate(recipe, folder, records=parts * per_part, scheduler=address)
    driver, of_scheduler = time.process_time() - before[0] - ending[0], max(_cpu_seconds(scheduler) - before[1], TICK_S)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    return Cost(parts, driver / parts, of_scheduler / parts, ending[0] / parts, memory)


def _linked(
    model: Path, row: PartRow, task_s: float, recipe: Recipe, folder: Path, _sources: str, part: int
) -> making.Outcome:
    """Stand-in for the making of a part: wait, and link the model under its name; the recipe is sent as for a real task."""
    time.sleep(task_s)
    name = part_file(recipe, part)
    (folder / "parts" / name).hardlink_to(model)
    return making.Outcome(row._replace(name=name), ())


@contextmanager
def _cluster(workers: int) -> Iterator[tuple[str, psutil.Process]]:
    """Address of a scheduler with workers of one thread each, in ``GROUPS`` processes, and the process of the scheduler."""
    context = multiprocessing.get_context("spawn")
    addresses: Queue[str] = context.Queue()
    processes = [context.Process(target=_run_scheduler, args=(addresses,), daemon=True)]
    processes[0].start()
    try:
        address = addresses.get(timeout=60)
        share = [workers // GROUPS + (place < workers % GROUPS) for place in range(GROUPS)]
        groups = [context.Process(target=_run_workers, args=(address, n), daemon=True) for n in share if n]
        processes += groups
        for group in groups:
            group.start()
        with Client(address, set_as_default=False) as client:
            client.wait_for_workers(workers, timeout=120)
        yield address, psutil.Process(processes[0].pid)
    finally:
        for process in reversed(processes):
            process.terminate()
            process.join()


def _run_scheduler(addresses: "Queue[str]") -> None:
    async def run() -> None:
        async with Scheduler(host="127.0.0.1", dashboard_address="127.0.0.1:0") as scheduler:
            addresses.put(scheduler.address)
            await scheduler.finished()

    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    asyncio.run(run())


def _run_workers(address: str, count: int) -> None:
    async def run() -> None:
        workers = [await Worker(address, nthreads=1, host="127.0.0.1") for _ in range(count)]
        await asyncio.gather(*(worker.finished() for worker in workers))

    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    asyncio.run(run())


def _cpu_seconds(process: psutil.Process) -> float:
    used = process.cpu_times()
    return used.user + used.system
