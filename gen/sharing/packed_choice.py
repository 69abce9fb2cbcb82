"""A corpus, or a choice of it, as one netCDF-4 file: ``folder -> (select, convert) -> pack -> FILE.nc``."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from gen.corpus.codecs import CODECS, Codec
from gen.corpus.files import remove_left_behind_of, temporary_beside
from gen.corpus.index import corpus_attributes
from gen.corpus.manifest import INDEX_NAME, part_paths
from gen.corpus.part import PartRow, write_part
from gen.corpus.part_forms import dataset_of, form_of
from gen.corpus.reading import stored_blocks
from gen.corpus.record_checks import per_record
from gen.corpus.schema import SIGNAL
from gen.errors import CorpusError
from gen.progress import Progress
from gen.sharing.copying import in_floating_point
from gen.sharing.packing import PackedFile, pack_whole, small_files
from gen.sharing.selecting import select
from gen.sharing.unpacking import finish_again


def pack(
    directory: Path | str,
    file: Path | str,
    *,
    where: str | None = None,
    split: str | None = None,
    channels: Sequence[str] | None = None,
    float32: bool = False,
    codec: Codec = "zlib",
    progress: Progress | None = None,
) -> PackedFile:
    """Write a corpus into one netCDF-4 file that any reader opens and :func:`gen.open_corpus` takes in place of the folder.

    The same corpus gives the same bytes. A choice of records or channels is first written as a corpus of its own beside the file
    (:func:`gen.select`), and so is a corpus in floating point; it is removed at the end.

    Parameters
    ----------
    directory : path
        Folder of a finished corpus.
    file : path
        The new file.
    where, split, channels : optional
        Condition on the records, name of a split, names of channels, as for :func:`gen.select`.
    float32 : bool
        Whether to store accelerations [m s-2] in single precision in place of counts.
    codec : {"zlib", "zstd", "none"}
        Compression of the signals. Every netCDF-4 reader knows ``zlib``.
    progress : callable, optional
        Called with the number of records done and of all records.

    Raises
    ------
    CorpusError
        If the file exists, the corpus is unfinished or damaged, nothing is chosen, or writing fails.
    """
    directory, file = Path(directory), Path(file)
    if file.exists():
        raise CorpusError(f"{file}: exists; give another name, or remove it first.")
    if codec not in CODECS:
        raise CorpusError(f"codec: there is no codec {codec!r}; allowed are {', '.join(CODECS)}.")
    aside = file.with_name(f"{file.name}-corpora")
    for path in (file, aside):
        remove_left_behind_of(path)
    with temporary_beside(aside) as corpora:
        if where is not None or split is not None or channels is not None:
            chosen = corpora / "chosen"
            select(directory, chosen, where=where, split=split, channels=channels)
            directory = chosen
        elif directory.is_file():
            raise CorpusError(
                f"{directory}: is one file already; copy it, or say which records with --where or --split."
            )
        if float32:
            converted = corpora / "float32"
            _convert(directory, converted)
            directory = converted
        return pack_whole(directory, file, codec, progress)


def _convert(directory: Path, output: Path) -> None:
    """Write a corpus with accelerations in single precision in place of counts, one part at a time."""
    (output / "parts").mkdir(parents=True)
    rows = [_converted(path, output / "parts" / path.name) for path in part_paths(directory)]
    finish_again(output, rows, small_files(directory), corpus_attributes(directory / INDEX_NAME))


def _converted(path: Path, output: Path) -> PartRow:
    attributes, form = form_of(path)
    values = {name: variable.values for name, variable in per_record(path)[1].items()}
    values[SIGNAL] = np.concatenate([*stored_blocks(path)])
    return write_part(in_floating_point(dataset_of(form, attributes, values)), output, form["codec"])
