"""Time to open a corpus and read one record, compared with ``xarray.open_mfdataset`` over its parts.

A corpus of many parts is opened as a folder, and as a single file with the same records.

The files are in the page cache; their hashes are compared with the manifest.
"""

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr

from benchmarks.pairs import Line, interleaved, row, seconds
from benchmarks.pipeline import SHORT, variant
from gen.corpus import SIGNAL, open_corpus
from gen.generation.corpus import generate


def rows(pairs: int = 5, *, parts: int = 50, records_per_part: int = 20) -> Iterator[Line]:
    """Lines of the table."""
    with tempfile.TemporaryDirectory() as folder:
        recipe = variant(SHORT, Path(folder) / "parts.yaml", storage={"records_per_part": records_per_part})
        corpus, file = (
            generate(recipe, Path(folder) / name, records=parts * records_per_part).path for name in ("c", "c.nc")
        )
        record = parts * records_per_part // 2
        seconds_of = interleaved(
            pairs,
            hashed=lambda: 1 / seconds(read_record, corpus, record),
            single=lambda: 1 / seconds(read_record, file, record),
            many=lambda: 1 / seconds(read_from_parts, corpus, record),
        )
    what, alternative = f"open {parts} parts, read a record", "xarray.open_mfdataset"
    yield row("opening folder", what, "1/s", seconds_of["hashed"], alternative, seconds_of["many"])
    what = "open one file of the same records, read one"
    yield row("opening file", what, "1/s", seconds_of["single"], alternative, seconds_of["many"])


def read_record(corpus: Path, record: int) -> np.ndarray:
    """Signal of one record, shape (channel, time) [m s-2]."""
    with open_corpus(corpus) as opened:
        return opened[SIGNAL][record].values


def read_from_parts(corpus: Path, record: int) -> np.ndarray:
    """The same signal from the parts, with the fastest options: variables that all parts share are not compared."""
    paths = sorted((corpus / "parts").glob("*.nc"))
    same = {"data_vars": "minimal", "coords": "minimal", "compat": "override", "join": "override"}
    with xr.open_mfdataset(
        paths, combine="nested", concat_dim="record", engine="netcdf4", decode_times=False, **same
    ) as opened:
        return opened[SIGNAL][record].values
