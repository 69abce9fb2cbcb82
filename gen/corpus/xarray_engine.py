"""Engine of xarray for corpora: ``xarray.open_dataset("corpus", engine="raceway")`` opens what :func:`gen.open_corpus` opens."""

from collections.abc import Iterable
from typing import Any

import xarray as xr
from xarray.backends import BackendEntrypoint


class CorpusEngine(BackendEntrypoint):
    """A folder or single file of a corpus, checked as by :func:`gen.open_corpus`; it is never taken unless its name is given."""

    description = "Corpora of Raceway: a folder or a single file"
    open_dataset_parameters = ("filename_or_obj", "drop_variables", "check")

    def open_dataset(
        self, filename_or_obj: Any, *, drop_variables: str | Iterable[str] | None = None, check: Any = "sha256"
    ) -> xr.Dataset:
        """Open a corpus lazily, without some variables; the errors are those of :func:`gen.open_corpus`."""
        from gen.corpus.index import open_corpus  # xarray loads all engines whenever it guesses one

        corpus = open_corpus(filename_or_obj, check)
        return corpus if drop_variables is None else corpus.drop_vars(drop_variables)
