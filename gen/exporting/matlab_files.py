"""MATLAB: files of version 5 with a struct array of records, which MATLAB and Octave open, and a table of labels.

Such a file holds at most 2 GB; these hold some ten megabytes each, so that one can be opened without the others.
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.corpus.copying import Block
from gen.exporting.columns import Export
from gen.exporting.tables import label_table
from gen.support.errors import CorpusError

FILE_BYTES = 32_000_000
"""Largest size of the signals of a file in single precision."""
_HEADER = b"MATLAB 5.0 MAT-file, records of rolling bearings copied by Raceway"
_HEADER_BYTES = 116


def write_mat(export: Export, folder: Path) -> str:
    """Write ``records-00000.mat`` ..., ``labels.csv`` and ``variables.csv``; returns the page about them.

    Raises
    ------
    CorpusError
        If one record exceeds what a file of version 5 can hold.
    """
    from scipy.io import savemat

    if 4 * len(export.channels) * export.chosen.samples >= 2**31 - FILE_BYTES:
        raise CorpusError("mat: a record exceeds the 2 GB of a MATLAB file of version 5; choose fewer channels.")
    about = _about(export)
    with label_table(export, folder, ["place"]) as write:
        for number, block in enumerate(export.blocks(FILE_BYTES)):
            path = folder / f"records-{number:05d}.mat"
            savemat(
                path,
                {"records": _struct_array(export, block), **about},
                long_field_names=True,
                oned_as="row",
                do_compression=True,
            )
            with path.open(
                "rb+"
            ) as stream:  # SciPy writes the date here, and the same records must give the same bytes
                stream.write(_HEADER.ljust(_HEADER_BYTES))
            write(block, [(path.name, place + 1) for place in range(len(block.numbers))])
    return export.page(_READING)


def _about(export: Export) -> dict[str, Any]:
    """Variables that are the same in every file: channels, sample rate, units and meanings."""
    units = {column.name: column.units for column in export.columns} | {"acceleration": "m s-2"}
    meanings = {column.name: column.meaning for column in export.columns}
    meanings["acceleration"] = "acceleration (sample, channel)"
    return {
        "channels": np.array(export.chosen.channels, object),
        "sample_rate": export.chosen.sample_rate,
        "units": units,
        "meanings": meanings,
    }


def _struct_array(export: Export, block: Block) -> NDArray[Any]:
    """Struct array of shape (1, record): a field for each label, and the samples as columns."""
    signal = block.accelerations()
    fields: dict[str, Any] = {"record": block.numbers.astype(float), "acceleration": [each.T for each in signal]}
    for column in export.columns:
        values = column.of(block.dataset)  # whole numbers as double: arithmetic of MATLAB with other types rounds
        fields[column.name] = values.tolist() if values.dtype.kind in "OUT" else values.astype(float).tolist()
    rows = np.empty((1, len(signal)), [(name, object) for name in fields])
    for name, values in fields.items():
        column = rows[0][name]
        for place, value in enumerate(values):
            column[place] = value
    return rows


_READING = """\
Each `records-*.mat` has a struct array `records`, one element for each record, with `acceleration` (sample, channel) [m s-2]
and the labels; `channels`, `sample_rate`, `units` and `meanings` describe them. `labels.csv` tells in which `file` and at which
`place` a record is.

    load('records-00000.mat');
    inner = records(strcmp({records.fault}, 'inner'));
    plot((0:numel(records(1).acceleration(:, 1)) - 1) / sample_rate, records(1).acceleration(:, 1))
"""
