"""Cost from a recipe to validated parts: compared with the kernel alone, with two workers, and for large corpora.

CPU time of the process and its children, unless the row says otherwise.
"""

import json
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

from benchmarks.kernel import FULL, integrate_every, laid_out
from benchmarks.pairs import Line, cpu_seconds, interleaved, row, run_python, seconds
from gen.generation.corpus import generate
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios
from gen.simulation.timeline import timeline

SHORT = Path(__file__).with_name("short.yaml")
SIZES = (256, 768)  # records; a corpus of either size repeats as many records at half the step
SCALES = (1000, 20_000)


def rows(pairs: int = 2) -> Iterator[Line]:
    """Lines of the table."""
    yield from throughput_rows(pairs + 1)  # a difference of two times is noisier than a time
    yield from worker_rows(pairs)
    yield from growth_rows(1)


def throughput_rows(pairs: int, recipe: Path = FULL, sizes: tuple[int, int] = SIZES) -> Iterator[Line]:
    """Whole pipeline compared with the kernel alone.

    The cost of a record is the difference of two corpora over the difference of their records, so that what every corpus costs once does
    not count.
    """
    small, large = sizes
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        whole = variant(recipe, folder / "whole.yaml", corpus={"specimens_per_rig": large})

        def made(records: int) -> float:
            with tempfile.TemporaryDirectory(dir=folder) as corpus:
                return cpu_seconds(lambda: generate(whole, Path(corpus) / "corpus", records=records))

        made(small)  # compiles
        seconds_of = interleaved(
            pairs,
            kernel=_kernel_alone(whole, small),
            ours=lambda: (large - small) / (made(large) - made(small)),
        )
    what = "recipe to validated parts, full model, one worker"
    yield row("pipeline parts", what, "records/s", seconds_of["ours"], "the kernel alone", seconds_of["kernel"])


def _kernel_alone(recipe: Path, records: int) -> Callable[[], float]:
    """Function that measures the records per second of the kernel; as in a corpus, a record with a fault is also run without it."""
    checked = read_recipe(recipe)
    batches = laid_out(draw_scenarios(checked, 0, records))
    return lambda: records / cpu_seconds(integrate_every, batches, timeline(checked))


def worker_rows(pairs: int, recipe: Path = FULL, records: int = 1024, records_per_part: int = 32) -> Iterator[Line]:
    """Two workers compared with one: wall time of the whole command."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        corpus, storage = {"specimens_per_rig": 256}, {"records_per_part": records_per_part}
        small = variant(recipe, folder / "small.yaml", corpus=corpus, storage=storage)

        def speed(workers: int, wanted: int = records) -> float:
            with tempfile.TemporaryDirectory(dir=folder) as target:
                line = ("-m", "raceway", "generate", small, "-o", Path(target) / "corpus", "--records", wanted)
                return wanted / seconds(run_python, *line, "--workers", workers)

        speed(1, 2 * records_per_part)  # compiles
        speeds = interleaved(pairs, two=lambda: speed(2), one=lambda: speed(1))
    what = f"raceway generate of {records:,} one-second records, full model, two workers, wall time"
    yield row("pipeline workers", what, "records/s", speeds["two"], "one worker", speeds["one"])


def corpus_cost(recipe: Path, folder: Path, records: int) -> dict[str, float]:
    """CPU time [ms] and file size [bytes] per record, and peak memory [MB], of a corpus that is generated in its own process."""
    with tempfile.TemporaryDirectory(dir=folder) as own:
        return json.loads(run_python("-m", "benchmarks.cost", recipe, own, records))


def growth_rows(pairs: int, recipe: Path = SHORT, scales: tuple[int, int] = SCALES) -> Iterator[Line]:
    """Cost per record and peak memory of a large corpus compared with a small one, each in its own process."""
    small, large = (f"{scale:,} records" for scale in scales)
    with tempfile.TemporaryDirectory() as temporary:
        costs = {scale: lambda scale=scale: corpus_cost(recipe, Path(temporary), scale) for scale in scales}
        runs = [{scale: cost() for scale, cost in costs.items()} for _ in range(pairs)]
    for unit, name, what in (("ms", "growth cost", "short record"), ("MB", "growth memory", "peak of the process")):
        slopes = [[run[scale][unit] for run in runs] for scale in scales]
        yield row(name, f"{what}, {large}", unit, slopes[1], small, slopes[0])


def variant(recipe: Path, path: Path, **sections: dict[str, Any]) -> Path:
    """Write a recipe with other values in some of its sections."""
    yaml = YAML(typ="safe")
    content = yaml.load(recipe)
    for section, values in sections.items():
        content[section].update(values)
    yaml.dump(content, path)
    return path
