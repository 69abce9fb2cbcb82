"""Processor time of short commands and imports, against that of Python importing xarray and netCDF4 alone.

Each is a process of its own, with its files in the page cache; user and system time are added, so that other processes on the machine
count less than in wall time.
"""

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.kernel import FULL
from benchmarks.pairs import Line, interleaved, process_seconds, row
from benchmarks.pipeline import SHORT, variant
from gen.generation.corpus import generate

ALTERNATIVE = "import xarray, netCDF4"


def rows(pairs: int = 5, first_records: int = 2) -> Iterator[Line]:
    """Lines of the table."""
    yield from first_record_rows(first_records)
    yield from command_rows(pairs)


def command_rows(pairs: int) -> Iterator[Line]:
    """Short commands and imports, compared with the import of the libraries they need."""
    with tempfile.TemporaryDirectory() as folder:
        recipe = variant(SHORT, Path(folder) / "short.yaml", storage={"records_per_part": 20})
        corpus = str(generate(recipe, Path(folder) / "corpus", records=40).path)
        recording = Path(folder) / "noise.npy"
        np.save(recording, np.random.default_rng(0).standard_normal(48_000))
        machine = ["--bearing", "6205", "--rpm", "1772", "--rate", "12000"]
        commands = {
            "help": ("-m", "raceway", "--help"),
            "info": ("-m", "raceway", "info", corpus),
            "plan": ("-m", "raceway", "plan", "quickstart"),
            "diagnose": ("-m", "raceway", "diagnose", str(recording), *machine),
            "import gen": ("-c", "import gen"),
        }
        for command in commands.values():  # the first diagnosis trains the reference model
            process_seconds(*command, check=False)
        seconds_of = interleaved(
            pairs,
            alternative=lambda: process_seconds("-c", ALTERNATIVE),
            **{
                name: lambda command=command: process_seconds(*command, check=False)
                for name, command in commands.items()
            },
        )
    for name, command in commands.items():
        what = " ".join(command[1:]).replace(corpus, "CORPUS").replace(str(recording), "RECORDING")
        yield row(f"starting {name}", f"{what}, CPU", "s", seconds_of[name], ALTERNATIVE, seconds_of["alternative"])


def first_record_rows(pairs: int, recipe: Path = FULL) -> Iterator[Line]:
    """`raceway generate` of one record without compiled kernels and with all of them in the cache."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)

        def first_record(cache: Path) -> float:
            with tempfile.TemporaryDirectory(dir=folder) as corpus:
                line = ("-m", "raceway", "generate", recipe, "-o", Path(corpus) / "corpus", "--records", 1)
                return process_seconds(*line, NUMBA_CACHE_DIR=str(cache))

        empty, filled = ((folder / f"cache-{pair}" for pair in range(pairs)) for _ in range(2))
        seconds_of = interleaved(
            pairs,
            cold=lambda: first_record(next(empty)),
            warm=lambda: first_record(next(filled)),
            imports=lambda: process_seconds("-c", ALTERNATIVE),
        )
    what = "raceway generate of one record, full model"
    yield row(
        "start cold", f"{what}, nothing compiled", "s", seconds_of["cold"], "kernels in the cache", seconds_of["warm"]
    )
    yield row(
        "start warm", f"{what}, kernels in the cache", "s", seconds_of["warm"], ALTERNATIVE, seconds_of["imports"]
    )
