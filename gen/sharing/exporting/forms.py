"""A corpus written in another form: each form is one function, and the folder of the export is whole or absent."""

from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from gen.corpus import open_corpus, whole_folder_or_none
from gen.errors import CorpusError
from gen.progress import Progress
from gen.sharing.exporting.choosing import Chosen, choose
from gen.sharing.exporting.csv_files import write_csv
from gen.sharing.exporting.huggingface import write_huggingface
from gen.sharing.exporting.matlab_files import write_mat
from gen.sharing.exporting.parquet_files import write_parquet
from gen.sharing.exporting.report import Report, reporter
from gen.sharing.exporting.wav_files import write_wav
from gen.sharing.exporting.zarr_store import write_zarr


class Form(NamedTuple):
    """One form of export: the function that writes it, and the package that it needs, with the extra that brings it."""

    write: Callable[[Chosen, Path, Report], str]
    """Writes into a folder and returns README.md of the export."""
    package: str = ""
    extra: str = ""


FORMS: Mapping[str, Form] = {
    "parquet": Form(write_parquet, "pyarrow", "parquet"),
    "mat": Form(write_mat),
    "csv": Form(write_csv),
    "wav": Form(write_wav),
    "zarr": Form(write_zarr, "zarr", "zarr"),
    "huggingface": Form(write_huggingface, "pyarrow", "parquet"),
}


class Exported(NamedTuple):
    """Result of an export."""

    directory: Path
    to: str
    records: int
    channels: int
    files: int
    bytes: int


def export(
    directory: Path | str,
    output: Path | str,
    to: str,
    *,
    where: str | None = None,
    split: str | None = None,
    channels: Sequence[str] | None = None,
    progress: Progress | None = None,
) -> Exported:
    """Write a corpus, or a choice of its records and channels, in the form of another program.

    The corpus is read and written in blocks, so that the memory does not grow with the number of records. The same corpus gives the same
    bytes.

    Parameters
    ----------
    directory : path
        The corpus.
    output : path
        Folder for the result; it must not exist, or be empty.
    to : {"parquet", "mat", "csv", "wav", "zarr", "huggingface"}
        Form of the result.
    where, split, channels : optional
        Condition on records, name of a split, and names of channels.
    progress : callable, optional
        Called with the number of records written and of all.

    Raises
    ------
    CorpusError
        If the form is unknown or needs a package that is not installed, nothing is chosen, ``output`` is not empty or cannot be written,
        or the corpus is unfinished or altered.
    """
    form, output = _form(to), Path(output)
    with whole_folder_or_none(output) as folder, open_corpus(directory) as corpus:
        chosen = choose(corpus, where, split, channels)
        readme = form.write(chosen, folder, reporter(chosen, progress))
        (folder / "README.md").write_text(readme, encoding="utf-8")
    files = [path for path in output.rglob("*") if path.is_file()]
    size = sum(path.stat().st_size for path in files)
    return Exported(output, to, len(chosen.records), len(chosen.channels), len(files), size)


def _form(to: str) -> Form:
    """The form of that name, if its package is installed."""
    if to not in FORMS:
        raise CorpusError(f"to: there is no form {to!r}; allowed are {', '.join(FORMS)}.")
    form = FORMS[to]
    if form.package and find_spec(form.package) is None:
        raise CorpusError(f"{to}: needs {form.package}; pip install 'raceway[{form.extra}]', or choose another form.")
    return form
