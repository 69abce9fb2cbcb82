"""CSV: one file per record with the time and the acceleration of each channel, and a table of labels.

Numbers have the nine digits that single precision needs, so that nothing is lost.
"""

from pathlib import Path

from raceway.sharing.columns import Export
from raceway.sharing.tables import label_table, record_file

_BLOCK_BYTES = 4_000_000  # of single precision; as Python numbers a value takes ten times the memory


def write_csv(export: Export, folder: Path) -> str:
    """Write ``labels.csv``, ``variables.csv`` and ``records/``; returns the page about them."""
    header = ",".join(["elapsed_time_s", *(f"{name}_m_s2" for name in export.channels)])
    times = export.chosen.corpora[0]["elapsed_time"].values
    row = ",%.9g" * len(export.channels)
    lines = header + "\n" + "".join(f"{time:.9g}{row}\n" for time in times)
    with label_table(export, folder) as write:
        for block in export.blocks(_BLOCK_BYTES):
            files = [record_file(folder, number) for number in block.numbers]
            for file, signal in zip(files, block.accelerations(), strict=True):
                (folder / file).write_text(lines % tuple(signal.T.ravel().tolist()), encoding="ascii")
            write(block, files)
    return export.page(_READING)


_READING = """\
`labels.csv` has one row for each record and `variables.csv` the unit and meaning of its columns. `file` is the file of the
signal: time [s] and the acceleration of each channel [m s-2]. A cell of a number that is not known is empty, a missing
sample is `nan`.

    import pandas
    labels = pandas.read_csv("labels.csv")
    signal = pandas.read_csv(labels["file"][0])
"""
