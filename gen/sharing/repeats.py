"""Search for records with the same samples in different corpora."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import SIGNAL
from gen.corpus.record_hashes import hashes_of
from gen.corpus.signals import VERDICTS, judge
from gen.errors import CorpusError

Digests = NDArray[np.bytes_]

_DIGITS = 32  # hexadecimal, of 64
_WITHOUT_CONTENT = [VERDICTS.index(verdict) for verdict in ("dead", "constant", "not_finite")]


def sample_digests(records: xr.Dataset) -> Digests:
    """First half of the SHA-256 of the stored samples of each record, shape (record,); empty if they are constant or not numbers.

    Labels do not count: two records with the same samples and different labels are no more different than two equal ones.
    """
    signal = records[SIGNAL].variable
    scale = signal.attrs.get("scale_factor")
    found = hashes_of(signal.values, None if scale is None else float(scale), {})
    digests = np.array([digest[:_DIGITS] for digest in found], f"S{_DIGITS}")
    digests[np.isin(judge(signal.values), _WITHOUT_CONTENT)] = b""
    return digests


class Seen:
    """Samples of the records of corpora that were read before."""

    def __init__(self) -> None:
        self._corpora: list[tuple[str, Digests, NDArray[np.intp]]] = []

    def add(self, corpus: str, digests: Sequence[Digests]) -> None:
        """Remember all records of a corpus, given part by part."""
        every = np.concatenate(digests)
        order = np.argsort(every, kind="stable")
        self._corpora.append((corpus, every[order], order))

    def check(self, corpus: str, first: int, digests: Digests) -> None:
        """CorpusError if one of some records, the first of which has number ``first``, has the samples of a record seen before."""
        for earlier, known, order in self._corpora:
            places = np.minimum(np.searchsorted(known, digests), len(known) - 1)
            same = np.flatnonzero((known[places] == digests) & (digests != b""))
            if same.size:
                record, other = first + int(same[0]), int(order[places[same[0]]])
                raise CorpusError(
                    f"{corpus}: record {record} has the same samples as record {other} of {earlier}, and a record that is there twice can "
                    "be in training and test set at once; give corpora of different seeds, or leave these records out with raceway select."
                )
