"""Opening a corpus: a folder with its ``index.nc``, which holds the variables of all parts, or a single file."""

from pathlib import Path

import xarray as xr

from gen.corpus.lazy import open_records
from gen.corpus.manifest import INDEX_NAME, Check, finished
from gen.corpus.schema import add_class_names, operating_problems, records_in_memory, schema_problems
from gen.corpus.simulated import LIFE, SIMULATED
from gen.support.errors import CorpusError


def open_corpus(path: Path | str | xr.Dataset, check: Check = "sha256") -> xr.Dataset:
    """Open a corpus as one dataset, which is read lazily.

    Parameters
    ----------
    path : path
        Folder of a corpus, or a corpus in a single file. Records in memory, of :func:`gen.records` or chosen from an open corpus, get
        the axes and coordinates of a corpus.
    check : {"sha256", "size"}
        Comparison of each file with its hash, or with its size only, before anything is read.

    Returns
    -------
    Dataset
        ``acceleration (record, channel, elapsed_time)`` [m s-2] and the variables of :data:`gen.corpus.SCHEMA`, with the classes in words
        as ``fault_name`` and ``split_name``: ``corpus.sel(record=corpus.fault_name == "inner")``. It can be pickled, and chunked for dask
        with ``.chunk({"record": n})``.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, one of its files is missing, altered or outside its folder, or a variable is not in the format.
    """
    if not isinstance(path, Path | str):
        records = records_in_memory(path)
        for problem in operating_problems({name: records[name].values for name in ("sample_rate", "shaft_rate")}):
            raise CorpusError(f"{corpus_name(path)}: {problem}")
        add_class_names(records)
        return records
    path = Path(path)
    manifest = finished(path, check)
    rows = manifest.parts
    parts, index = [path / "parts" / row.name for row in rows] or [path], path / INDEX_NAME if rows else path
    opened = open_records([index], parts, [row.records for row in rows] or None)
    problems = schema_problems(opened, SIMULATED + LIFE)
    if opened.attrs.get("parts_sha256") != manifest.parts_sha256:
        problems = [f"{INDEX_NAME} is that of other parts than manifest.json lists; copy the corpus again."]
    for problem in problems:
        opened.close()
        raise CorpusError(f"{path}: {problem}")
    add_class_names(opened)
    return opened


def corpus_name(corpus: Path | str | xr.Dataset) -> str:
    """Path of a corpus, or the title of records in memory, with which a sentence begins."""
    return f"{corpus.attrs.get('title', 'records')}" if isinstance(corpus, xr.Dataset) else f"{corpus}"
