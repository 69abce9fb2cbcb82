"""Validation of a corpus: its files, the format of each part, and the agreement of ``corpus.nc`` with the parts."""

from pathlib import Path

import h5py
import numpy as np
import xarray as xr

from gen.corpus.files import sha256
from gen.corpus.hdf5 import CRASHES, LIBRARY_LOCK, own_dataset, survives_opening
from gen.corpus.index import open_corpus
from gen.corpus.layout import PACKING
from gen.corpus.manifest import INDEX_NAME, Manifest, file_problems, read_manifest
from gen.corpus.part import PartRow
from gen.corpus.reading import open_part, stored_blocks
from gen.corpus.schema import SIGNAL, schema_problems
from gen.corpus.signals import VERDICTS, counted, described, judge
from gen.errors import CorpusError


def validate_corpus(directory: Path | str) -> list[str]:
    """All problems of a corpus, one sentence each; an empty list if it has none.

    Checks the manifest, the bytes of every file, the format of every part, the values of the signal, and the agreement of ``corpus.nc``
    with the parts; of a packed file, every record in place of the files. One part at a time is held in memory.
    """
    directory, problems = Path(directory), []
    try:
        manifest = read_manifest(directory)
        problems = file_problems(directory, manifest, "sha256")
        if problems or not manifest.complete:
            return problems or [f"{directory}: is unfinished; run the raceway generate command that began it again."]
        problems = [] if directory.is_file() else _mapping_problems(directory, manifest)
        if problems:
            return problems
        with open_corpus(directory, check="size") as index:
            first = 0
            for row in manifest.parts:
                path = directory / "parts" / row.name
                with open_part(path) as part:
                    if part.sizes["record"] != row.records:
                        found = part.sizes["record"]
                        return [
                            *problems,
                            f"{path}: {found} records, the manifest lists {row.records}; do not trust this corpus.",
                        ]
                    here = index.isel(record=slice(first, first + row.records))
                    problems += [
                        f"{path}: {text}" for text in (*_part_problems(part, here), *_signal_problems(path, row))
                    ]
                first += row.records
    except CorpusError as error:
        problems.append(str(error))
    return problems


def _mapping_problems(directory: Path, manifest: Manifest) -> list[str]:
    """Problems of the virtual dataset in ``corpus.nc``, which readers other than :func:`gen.open_corpus` use."""
    path, expected, first = directory / INDEX_NAME, [], 0
    for row in manifest.parts:
        expected.append((f"parts/{row.name}", SIGNAL, first, first + row.records - 1))
        first += row.records
    if not survives_opening(str(path), sha256(path), SIGNAL):
        return [f"{path}: {CRASHES}."]
    try:
        with LIBRARY_LOCK, h5py.File(path, "r", locking=False) as index:
            sources = own_dataset(index, SIGNAL, virtual=True).virtual_sources()
            bounds = [source.vspace.get_select_bounds() for source in sources]
            found = [
                (source.file_name, source.dset_name.lstrip("/"), int(low[0]), int(high[0]))
                for source, (low, high) in zip(sources, bounds, strict=True)
            ]
    except (OSError, KeyError, RuntimeError, ValueError) as error:
        return [f"{path}: not a corpus index ({error}); make or copy the corpus again."]
    if found == expected:
        return []
    wrong = min({str(item[0]) for item in set(found) ^ set(expected)}, default="the order of the parts")
    return [f"{path}: index and manifest disagree about {wrong}; do not trust this corpus."]


def _signal_problems(path: Path, row: PartRow) -> list[str]:
    verdicts = np.concatenate([judge(block) for block in stored_blocks(path)])
    lost = np.flatnonzero(verdicts == VERDICTS.index("not_finite"))
    problems = [f"record {record} of the part has samples that are not finite." for record in lost]
    if counted(verdicts) != row.signals:
        problems.append(
            f"{described(counted(verdicts))} of its records cannot be used, the manifest lists {described(row.signals)}."
        )
    return problems


def _part_problems(part: xr.Dataset, index: xr.Dataset) -> list[str]:
    problems = schema_problems(part)
    if problems:
        return problems
    if set(part.variables) != set(index.variables) or part.sizes != index.sizes:
        return ["corpus.nc has other variables or sizes; make or copy the corpus again."]
    for name, variable in part.variables.items():
        same = (
            _same_storage(variable, index[name].variable)
            if name == SIGNAL
            else variable.identical(index[name].variable)
        )
        if not same:
            problems.append(f"{name} differs from corpus.nc; make or copy the corpus again.")
    return problems


def _same_storage(part: xr.Variable, index: xr.Variable) -> bool:
    """Whether two signals have the same attributes and packing; both read their values from the part."""
    one, other = ([str(variable.encoding.get(key)) for key in PACKING] for variable in (part, index))
    return part.attrs == index.attrs and one == other
