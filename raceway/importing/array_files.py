"""Tables in files of arrays: NumPy, WAV, Parquet, TDMS of LabVIEW and universal file format 58."""

import logging
import re
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from gen.support.limits import check_limit
from raceway.importing.header import Header, rate_of_step, rounded_rate, unit_said
from raceway.importing.refused_files import UnusableError, guarded, optional
from raceway.importing.table import NumberTable, table_of

_ACCELERATION = 12  # kind of the values in format 58; 0 is unknown and 1 general
_KINDS_WITHOUT_A_NAME = (0, 1, _ACCELERATION)
_TIME_RESPONSE = 1  # kind of the function in format 58
_IS_NUMBER = re.compile("u?int|float|double|halffloat")  # type of a column of Parquet


def read_numpy(path: Path) -> NumberTable:
    """Array in a NumPy ``.npy`` file; pickled objects are refused.

    Raises
    ------
    UnusableError
        If the file is not a NumPy file, or holds no table.
    """
    with guarded(path, "NumPy"):
        # a memory map compares the size in the header with the file before anything is allocated
        return table_of(np.array(np.lib.format.open_memmap(path, mode="r")))


def read_wav(path: Path) -> NumberTable:
    """Channels of a WAV file, integers as shares of their full scale.

    Raises
    ------
    UnusableError
        If the file is truncated or damaged, is not a WAV file, or is compressed.
    """
    from scipy.io import wavfile

    with guarded(path, "WAV"):
        warnings.filterwarnings("error", "Reached EOF prematurely")
        rate, samples = wavfile.read(path)
        full_scale = 1.0 if samples.dtype.kind == "f" else 2.0 ** (8 * samples.itemsize - 1)
        table = table_of(samples.astype(np.int16) - 128 if samples.dtype.kind == "u" else samples)
        scaled = {n: values / full_scale for n, values in table.columns.items()}
        return table._replace(columns=scaled, playback=float(rate) or None, absolute=full_scale == 1)


def read_parquet(path: Path) -> NumberTable:
    """Columns of numbers of a Parquet file.

    Raises
    ------
    UnusableError
        If pyarrow is missing, or the file is damaged or too large.
    """
    parquet = optional("pyarrow.parquet")
    with guarded(path, "Parquet"):
        facts = parquet.read_metadata(path)
        check_limit("file_bytes", 8 * facts.num_rows * facts.num_columns, "is unpacked", UnusableError)
        names = [field.name for field in parquet.read_schema(path) if _IS_NUMBER.match(str(field.type))]
        table = parquet.read_table(path, columns=names)
        return _columns((name, unit_said(name), None, table[name].to_numpy()) for name in names)


def read_tdms(path: Path) -> NumberTable:
    """Scaled channels of a TDMS file, with their units and steps.

    Raises
    ------
    UnusableError
        If npTDMS is missing, or the file is truncated or damaged.
    """
    library = optional("nptdms")
    # its warnings on parts of a file are sentences here
    optional("nptdms.log").log_manager.set_level(logging.ERROR)
    with guarded(path, "TDMS"), path.open("rb") as stream, library.TdmsFile.open(stream) as file:
        if file.file_status.incomplete_final_segment:
            raise UnusableError("is truncated; copy it again, or close it in the program that records")
        every = [channel for group in file.groups() for channel in group.channels() if len(channel)]
        channels = [channel for channel in every if channel.dtype.kind in "iuf"]
        check_limit("file_bytes", sum(8 * len(channel) for channel in channels), "is unpacked", UnusableError)
        columns = []
        for channel in channels:
            step, unit = channel.properties.get("wf_increment"), channel.properties.get("unit_string")
            rate = rounded_rate(1 / step, 1e-9) if step else None
            columns.append((channel.name, unit or unit_said(channel.name), rate, channel[:]))
        return _columns(columns)


def read_uff(path: Path) -> NumberTable:
    """Time responses of a universal file, text or binary.

    Raises
    ------
    UnusableError
        If pyuff is missing, the file is damaged, or it holds something else than time responses.
    """
    library = optional("pyuff")
    with guarded(path, "universal"):
        file = library.UFF(str(path))
        sets = [file.read_sets(number) for number, kind in enumerate(file.get_set_types()) if kind == 58]
    other = next(
        (data_set for data_set in sets if data_set["func_type"] != _TIME_RESPONSE or np.iscomplexobj(data_set["data"])),
        None,
    )
    if not sets or other is not None:
        what = "no data set 58" if other is None else f"a function of kind {other['func_type']} ({other['id1']:.60})"
        raise UnusableError(f"holds {what}, and no signal over time; export the waveform")
    # the step has six digits
    return _columns(
        (data_set["id1"], _unit_of_58(data_set), rate_of_step(f"{data_set['abscissa_inc']:.5e}"), data_set["data"])
        for data_set in sets
    )


def _unit_of_58(data_set: dict[str, Any]) -> str:
    """Unit that a data set states, or the quantity if it is no acceleration."""
    unit, quantity = (data_set[f"ordinate_axis{name}"].replace("NONE", "").strip() for name in ("_units_lab", "_lab"))
    is_other = data_set["ordinate_spec_data_type"] not in _KINDS_WITHOUT_A_NAME
    return unit or (quantity or f"kind {data_set['ordinate_spec_data_type']}" if is_other else "")


def _columns(columns: Iterable[tuple[str, str, float | None, Any]]) -> NumberTable:
    """Table of the name, unit, sample rate [Hz] if it is known, and values of each column."""
    every = [*columns]
    if not every:
        raise UnusableError("holds no column of numbers; export the samples")
    names, units, rates, values = zip(*every, strict=True)
    header = Header(names, units, rates_of={n: rate for n, rate in enumerate(rates) if rate})
    return NumberTable({n: np.asarray(column, np.float64) for n, column in enumerate(values)}, header)
