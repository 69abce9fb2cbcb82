"""Time from a recipe to validated parts: compared with the kernel alone, with two workers, for large corpora, and from a cold start.

Everything goes through :func:`gen.generate` into a temporary folder, in this process unless the row says otherwise.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from distributed import LocalCluster
from ruamel.yaml import YAML

from benchmarks.kernel import FULL
from benchmarks.pairs import Line, interleaved, row, seconds
from gen.generation import generate
from raceway.studies.timing import bench

SHORT = Path(__file__).with_name("short.yaml")
CODECS = ("zlib", "zstd")
SCALES = (1000, 20_000)

# VmHWM instead of ru_maxrss of getrusage, which a process inherits from its parent
_PEAK = """
import json, sys, time
from pathlib import Path
from gen.generation import generate
recipe, folder, records = sys.argv[1], Path(sys.argv[2]), int(sys.argv[3])
generate(recipe, folder / "first", records=1)
start = time.perf_counter()
generate(recipe, folder / "corpus", records=records)
took = time.perf_counter() - start
status = Path("/proc/self/status").read_text().split()
print(json.dumps({"ms": 1e3 * took / records, "MB": int(status[status.index("VmHWM:") + 1]) / 1e3}))
"""


def rows(pairs: int = 3) -> Iterator[Line]:
    """Lines of the table."""
    yield from throughput_rows(pairs)
    yield from worker_rows(pairs)
    yield from growth_rows(pairs)
    yield from start_rows(pairs)


def throughput_rows(pairs: int, recipe: Path = FULL, kernel_records: int = 32) -> Iterator[Line]:
    """Whole pipeline compared with the kernel alone, per record, without the first part, whose steps are checked by a second run."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        recipes = {codec: variant(recipe, folder / f"{codec}.yaml", corpus={"codec": codec}) for codec in CODECS}
        steady(recipes["zlib"], folder)  # compiles

        def kernel_alone() -> float:
            made = bench(recipe, kernel_records)
            return made.records / made.stage_seconds["integrate"]

        found = interleaved(
            pairs,
            zlib=lambda: steady(recipes["zlib"], folder),
            zstd=lambda: steady(recipes["zstd"], folder),
            kernel=kernel_alone,
        )
    for codec in CODECS:
        what = f"recipe to parts on disk, {codec}, full model, one worker"
        yield row(f"pipeline {codec}", what, "records/s", found[codec], "the kernel alone", found["kernel"])


def worker_rows(pairs: int, recipe: Path = FULL, records: int = 1024, records_per_part: int = 32) -> Iterator[Line]:
    """Two workers compared with one, on running clusters and with the start of the cluster."""
    with tempfile.TemporaryDirectory() as temporary, _cluster(1) as one, _cluster(2) as two:
        folder = Path(temporary)
        small = variant(
            recipe, folder / "small.yaml", corpus={"records_per_part": records_per_part, "specimens_per_rig": 256}
        )

        def running(cluster: LocalCluster) -> float:
            return speed(small, folder, records=records, scheduler=cluster.scheduler_address)

        for cluster in (one, two):
            running(cluster)  # every worker loads its kernels
        found = interleaved(
            pairs,
            two=lambda: running(two),
            one=lambda: running(one),
            started=lambda: speed(small, folder, records=records, workers=2),
            here=lambda: speed(small, folder, records=records),
        )
    what = f"recipe to {records:,} records on disk, full model, two workers"
    yield row("pipeline workers", f"{what}, running", "records/s", found["two"], "one worker, running", found["one"])
    yield row(
        "pipeline started", f"{what} to be started", "records/s", found["started"], "in this process", found["here"]
    )


def growth_rows(pairs: int, recipe: Path = SHORT, scales: tuple[int, int] = SCALES) -> Iterator[Line]:
    """Time per record and peak memory of a large corpus compared with a small one, each in its own process."""
    small, large = (f"{scale:,} records" for scale in scales)
    with tempfile.TemporaryDirectory() as temporary:
        runs: dict[str, list[dict[str, float]]] = {"small": [], "large": []}
        for pair in range(pairs):
            for name, scale in zip(runs, scales, strict=True):
                folder = Path(temporary) / f"{name}-{pair}"
                runs[name].append(json.loads(_python(_PEAK, recipe, folder, scale)))
    for unit, name, what in (("ms", "growth cost", "short record"), ("MB", "growth memory", "peak of the process")):
        found = {key: [run[unit] for run in series] for key, series in runs.items()}
        yield row(name, f"{what}, {large}", unit, found["large"], small, found["small"])


def start_rows(pairs: int, recipe: Path = FULL) -> Iterator[Line]:
    """`raceway generate` of one record without compiled kernels, compared with all kernels in the cache."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)

        def first_record(cache: Path) -> float:
            with tempfile.TemporaryDirectory(dir=folder) as corpus:
                return seconds(_first_record, recipe, Path(corpus) / "corpus", cache)

        empty, filled = ((folder / f"cache-{pair}" for pair in range(pairs)) for _ in range(2))
        found = interleaved(pairs, cold=lambda: first_record(next(empty)), warm=lambda: first_record(next(filled)))
    yield row("start cold", "first record, nothing compiled", "s", found["cold"], "kernels in the cache", found["warm"])


def variant(recipe: Path, path: Path, **sections: dict[str, Any]) -> Path:
    """Write a recipe with other values in some of its sections."""
    yaml = YAML(typ="safe")
    content = yaml.load(recipe)
    for section, values in sections.items():
        content[section].update(values)
    yaml.dump(content, path)
    return path


def speed(recipe: Path, folder: Path, **options: Any) -> float:
    """Records per second of a whole corpus."""
    with tempfile.TemporaryDirectory(dir=folder) as corpus:
        start = time.perf_counter()
        made = generate(recipe, Path(corpus) / "corpus", **options)
        return made.records / (time.perf_counter() - start)


def steady(recipe: Path, folder: Path) -> float:
    """Records per second of a corpus from its second part on, including the files over all parts."""
    done: list[tuple[int, float]] = []
    with tempfile.TemporaryDirectory(dir=folder) as corpus:
        made = generate(recipe, Path(corpus) / "corpus", progress=lambda n, _: done.append((n, time.perf_counter())))
        end = time.perf_counter()
    first, since = done[0]
    return (made.records - first) / (end - since)


def _cluster(workers: int) -> LocalCluster:
    return LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address="127.0.0.1:0")


def _first_record(recipe: Path, folder: Path, cache: Path) -> None:
    arguments = ("generate", recipe, "-o", folder, "--records", 1)
    _python("from raceway.cli import main; main()", *arguments, NUMBA_CACHE_DIR=str(cache))


def _python(script: str, *arguments: object, **environment: str) -> str:
    """Standard output of a script that runs in its own process."""
    command = [sys.executable, "-c", script, *map(str, arguments)]
    return subprocess.run(command, env=os.environ | environment, check=True, capture_output=True, text=True).stdout
