"""A new corpus written part by part: a folder or a single file, there as a whole or not at all."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import xarray as xr

from gen.corpus.codecs import Codec
from gen.corpus.disk import (
    remove_left_behind_of,
    temporary_beside,
    whole_folder_or_none,
    write_text_durably,
    writing,
)
from gen.corpus.fault_classes import further_classes
from gen.corpus.finishing import finish_corpus
from gen.corpus.manifest import RECIPE_NAME, Manifest
from gen.corpus.outputs import check_new
from gen.corpus.part import PartRow, part_name, write_part
from gen.corpus.schema import with_file_codes
from gen.support.errors import CorpusError


class NewCorpus:
    """Corpus under way; ``facts`` are fields of its manifest, which can be completed until the end.

    ``attributes`` gives further global attributes of the index or the single file, from the finished manifest.
    ``classes`` of plug-ins have codes in the order in which records have them, unless they are named before.
    """

    def __init__(self, folder: Path, codec: Codec, facts: dict[str, Any]) -> None:
        self.facts, self.rows, self.classes = facts, list[PartRow](), list[str]()
        self.attributes: Callable[[Manifest], Mapping[str, str]] = lambda _: {}
        self._parts = folder / "parts"
        self._codec: Codec = codec

    def write(self, records: xr.Dataset, name: str | None = None) -> None:
        """Write records in the layout of the corpus (undecoded) as the next part, with the next file name or another one."""
        self.classes += [name for name in further_classes(records["fault"].values) if name not in self.classes]
        records = with_file_codes(records, self.classes)
        self.rows.append(write_part(records, self._parts / (name or part_name(len(self.rows))), self._codec))


def is_single_file(target: Path) -> bool:
    """Whether a corpus with this name is one file."""
    return target.suffix == ".nc"


@contextmanager
def new_corpus(
    target: Path | str,
    *,
    codec: Codec = "zlib",
    recipe_text: str | None = None,
    describe: Callable[[Path], object] | None = None,
    **facts: Any,
) -> Iterator[NewCorpus]:
    """New corpus to write parts to: a single file if the name of ``target`` ends in ``.nc``, else a folder.

    Parameters
    ----------
    target : path
        New file, or a folder that does not exist or is empty.
    codec : str
        Compression of the signal.
    recipe_text : str, optional
        Recipe of all records, as YAML.
    describe : callable, optional
        Writes pages about the corpus into its finished folder, before the folder gets its name; not called for a single file.
    **facts
        Fields of the manifest (:class:`gen.corpus.Manifest`).

    Raises
    ------
    CorpusError
        If the target exists, no part was written, or writing fails, with the reason that the system gives.
    """
    target = Path(target).absolute()
    check_new(target)
    if is_single_file(target):
        # a single file is joined from parts beside it, which then go
        parts = target.with_name(f"{target.name}.parts")
        with temporary_beside(parts) as folder, writing(target, folder):
            remove_left_behind_of(parts)
            remove_left_behind_of(target)
            yield from _write(folder, target, codec, recipe_text, facts)
        return
    with whole_folder_or_none(target) as folder:
        yield from _write(folder, None, codec, recipe_text, facts)
        if describe is not None:
            describe(folder)


def _write(
    folder: Path, file: Path | None, codec: Codec, recipe_text: str | None, facts: dict[str, Any]
) -> Iterator[NewCorpus]:
    """Corpus to write parts to, finished in its folder or as a ``file`` at the end."""
    (folder / "parts").mkdir(parents=True)
    if recipe_text is not None:
        write_text_durably(recipe_text, folder / RECIPE_NAME)
    corpus = NewCorpus(folder, codec, facts)
    yield corpus
    if not corpus.rows:
        raise CorpusError("no record was written, so there is no corpus; choose some records.")
    finish_corpus(folder, corpus.rows, file, corpus.attributes, **corpus.facts)
