"""Copies of corpora: ``sources -> choose -> blocks -> one function per form -> target``, which is there as a whole or not at all."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

from gen.corpus.codecs import CODECS, Codec
from gen.corpus.disk import remove_left_behind_of, whole_folder_or_none, whole_or_not_at_all
from gen.corpus.new import NewCorpus, new_corpus
from gen.corpus.outputs import check_new
from gen.support.errors import CorpusError
from gen.support.progress import Progress
from raceway.sharing.acdd import publication_attributes
from raceway.sharing.copying import Chosen, choose
from raceway.sharing.huggingface import write_huggingface
from raceway.sharing.parquet_files import write_parquet
from raceway.sharing.publishing import describe

_PART_BYTES = 16_000_000  # of single precision

FORMS: Mapping[str, Callable[[Chosen, Path], None]] = {"huggingface": write_huggingface}
"""Forms that are folders of files: functions that write into a folder, with a README.md."""
SUFFIXES = (".nc", ".parquet")
"""Suffixes of targets of one file; a target without is a folder."""
_NEEDS = {"parquet": "pyarrow", "huggingface": "pyarrow"}
"""Package that a form needs and Raceway does not bring."""


class Copied(NamedTuple):
    """Result of :func:`copy`."""

    target: Path
    form: str
    """``folder``, ``nc``, or the form of another program."""
    records: int
    of: int
    """Number of records that were chosen from."""
    channels: tuple[str, ...]
    filled: tuple[str, ...]
    """Variables that one of the sources lacks; its records have them marked as not known."""
    files: int
    bytes: int


def copy(
    sources: Path | str | Sequence[Path | str],
    target: Path | str,
    *,
    where: str | None = None,
    split: str | None = None,
    channels: Sequence[str] | None = None,
    rename: Mapping[str, str] | None = None,
    codec: Codec | None = None,
    float32: bool = False,
    to: str | None = None,
    progress: Progress | None = None,
) -> Copied:
    """Copy a corpus, some of its records or channels, or several corpora joined, as a corpus or in the form of another program.

    The form follows from the suffix of the target: ``NAME.nc`` is a corpus in one file, ``NAME.parquet`` one table, and a name without
    suffix the folder of a corpus. Records keep samples, labels and splits. Machines of joined corpora are
    numbered anew, unless all records come from one corpus. Corpora are read and written in blocks, so that the memory does not grow with
    the number of records. The same corpora give the same bytes.

    Parameters
    ----------
    sources : path, or sequence of paths
        Corpora: folders or single files.
    target : path
        The copy; it must not exist, or be an empty folder.
    where : str, optional
        Condition on the records, such as ``fault == 'inner' and width_mm > 0.5`` (:mod:`gen.corpus.where`).
    split : {"train", "validation", "test"}, optional
        Split of the records.
    channels : sequence of str, optional
        Names of the channels.
    rename : mapping, optional
        New names of channels by their old ones; ``channels`` has the new ones.
    codec : {"zlib", "zstd", "none"}, optional
        Compression of the signals of a corpus, ``zlib`` without. Every netCDF-4 reader knows it.
    float32 : bool
        Store accelerations [m s-2] in single precision in place of counts.
    to : {"huggingface"}, optional
        Form of a folder for another program.
    progress : callable, optional
        Called with the number of records written and of all that are chosen.

    Raises
    ------
    CorpusError
        If nothing is chosen, the sources do not fit together or hold the same records, one is unfinished or altered, a form needs a
        package that is not installed, or the target exists, lies in a corpus or cannot be written.
    """
    paths = [Path(path) for path in ([sources] if isinstance(sources, str | Path) else sources)]
    target = Path(target)
    # before anything is read
    check_new(target)
    form = _form(target, to, codec)
    choice = {"where": where, "split": split, "channels": channels, "rename": rename, "float32": float32}
    with choose(paths, **choice, progress=progress) as chosen:
        remove_left_behind_of(target.absolute())
        with _place(form, target, chosen.recipe, codec or "zlib") as place:
            _WRITERS[form](chosen, place)
            # hashes of the records are known when all are written; the target is then still temporary
            chosen.check_repeats()
    files = [target] if target.is_file() else [path for path in target.rglob("*") if path.is_file()]
    size = sum(path.stat().st_size for path in files)
    return Copied(target, form, chosen.count, chosen.of, tuple(chosen.channels), chosen.filled, len(files), size)


def _place(form: str, target: Path, recipe: str | None, codec: Codec) -> AbstractContextManager[Any]:
    """Place to write to: a corpus under way, or a temporary path."""
    if form in ("folder", "nc"):
        return new_corpus(target, codec=codec, recipe_text=recipe, describe=describe)
    return whole_or_not_at_all(target) if target.suffix in SUFFIXES else whole_folder_or_none(target)


def _write_parts(chosen: Chosen, corpus: NewCorpus) -> None:
    corpus.facts |= chosen.facts()
    if chosen.publication:
        corpus.attributes = publication_attributes
    for block in chosen.blocks(_PART_BYTES):
        corpus.write(block.as_stored())


def _form(target: Path, to: str | None, codec: str | None) -> str:
    """Form of a target, after a check of the options."""
    if to is not None and to not in FORMS:
        raise CorpusError(
            f"to: there is no form {to!r}; allowed is {', '.join(FORMS)}; docs/sharing.md writes CSV and Zarr."
        )
    suffix = target.suffix if target.suffix in SUFFIXES else ""
    if suffix and to is not None:
        raise CorpusError(f"{target}: {suffix} is one file, and to={to!r} makes a folder; leave one of the two out.")
    form = to or suffix[1:] or "folder"
    if codec is not None and codec not in CODECS:
        raise CorpusError(f"codec: there is no codec {codec!r}; allowed are {', '.join(CODECS)}.")
    if codec is not None and form not in ("folder", "nc"):
        raise CorpusError(f"codec: --codec is for corpora; leave it out for {form}.")
    # told now, and not after the corpora are read
    package = _NEEDS.get(form)
    if package is not None and find_spec(package) is None:
        raise CorpusError(f"{form}: needs {package}; pip install {package}, or choose another form.")
    return form


_WRITERS: Mapping[str, Callable[[Chosen, Any], None]] = {
    "folder": _write_parts,
    "nc": _write_parts,
    "parquet": write_parquet,
    **FORMS,
}
"""Functions that write the chosen records to their place, by form."""
