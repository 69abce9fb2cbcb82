"""The files of a finished corpus beside its parts: index, manifest and data card."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from gen.corpus.card.page import write_card
from gen.corpus.index import write_index
from gen.corpus.manifest import write_manifest
from gen.corpus.part import PartRow
from gen.corpus.signals import SignalCounts, summed


def finish_corpus(directory: Path, rows: Iterable[PartRow], **facts: Any) -> SignalCounts:
    """Write index, manifest and data card over finished parts; returns the counts of records that cannot be used.

    ``facts`` are further fields of the manifest.
    """
    rows = list(rows)
    signals = summed(row.signals for row in rows)
    write_index(directory, rows)
    write_manifest(directory, rows, complete=True, **facts)
    write_card(directory)
    return signals
