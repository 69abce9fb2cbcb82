"""The files of a finished corpus beside its parts: index, manifest and data card."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import xarray as xr

from gen.corpus.files import write_text_durably
from gen.corpus.index import open_corpus, write_index
from gen.corpus.manifest import write_manifest
from gen.corpus.part import PartRow
from gen.corpus.signals import SignalCounts, summed

Page = Callable[[xr.Dataset, SignalCounts], str]


def finish_corpus(directory: Path, rows: Iterable[PartRow], page: Page, **facts: Any) -> SignalCounts:
    """Write index, manifest and data card over finished parts; returns the counts of records that cannot be used.

    ``page`` makes the data card of the opened corpus; ``facts`` are further fields of the manifest.
    """
    rows = list(rows)
    signals = summed(row.signals for row in rows)
    write_index(directory, rows)
    write_manifest(directory, rows, complete=True, **facts)
    with open_corpus(directory, check="size") as corpus:
        write_text_durably(page(corpus, signals), directory / "README.md")
    return signals
