"""Processor time of short commands and imports, against that of Python importing xarray and netCDF4 alone.

Each is a process of its own, with its files in the page cache; user and system time are added, so that other processes on the machine
count less than in wall time.
"""

import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from benchmarks.pairs import Line, interleaved, row
from benchmarks.pipeline import SHORT, variant
from gen.generation import generate

IMPORTS = ("gen", "gen.corpus", "features")
ALTERNATIVE = "import xarray, netCDF4"


def rows(pairs: int = 9) -> Iterator[Line]:
    """Lines of the table."""
    with tempfile.TemporaryDirectory() as folder:
        recipe = variant(SHORT, Path(folder) / "short.yaml", corpus={"records_per_part": 20})
        corpus = str(generate(recipe, Path(folder) / "corpus", records=40).directory)
        commands = {
            "help": ("-m", "raceway", "--help"),
            "recipes": ("-m", "raceway", "recipes"),
            "info": ("-m", "raceway", "info", corpus),
            "misspelt": ("-m", "raceway", "plan", "quikstart"),
            **{f"import {name}": ("-c", f"import {name}") for name in IMPORTS},
        }
        found = interleaved(
            pairs,
            alternative=lambda: processor_seconds("-c", ALTERNATIVE),
            **{name: lambda given=given: processor_seconds(*given) for name, given in commands.items()},
        )
    for name, given in commands.items():
        what = "raceway " + " ".join(given[2:]).replace(corpus, "CORPUS") if given[0] == "-m" else given[1]
        yield row(f"starting {name}", f"{what}, CPU", "s", found[name], ALTERNATIVE, found["alternative"])


def processor_seconds(*arguments: str) -> float:
    """User and system time of a Python process and its children [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
