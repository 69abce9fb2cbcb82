"""Numbers that tell the machines, bearings, recordings and pairs of a corpus apart."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from gen.support.errors import CorpusError

NUMBERS = ("rig", "specimen", "recording", "pair")
"""Variables that get new numbers when corpora are joined."""


def new_numbers(identities: Sequence[str]) -> dict[str, NDArray[np.int32]]:
    """Rig, specimen, recording and pair of each record, from the identities of all records that are joined.

    An identity is the name of the corpus that numbered the record first, and its four numbers there. Records of one corpus have these
    numbers; those of several are numbered anew, in the order in which each rig, specimen ... first occurs. -1 stands for none.

    >>> new_numbers(["a/7/8/5/-1", "b/7/9/6/-1", "a/7/8/6/-1"])["rig"]
    array([0, 1, 0], dtype=int32)

    Raises
    ------
    CorpusError
        If a text is no identity.
    """
    rows = [text.rsplit("/", len(NUMBERS)) for text in identities]
    try:
        numbers = np.array([row[1:] for row in rows]).astype(np.int32).reshape(len(rows), len(NUMBERS))
    except (ValueError, OverflowError):
        wrong = next((text for text in identities if text.count("/") < len(NUMBERS)), identities[0])
        raise CorpusError(f"identity: {wrong!r} is no corpus with four numbers; make the corpus again.") from None
    corpora = pd.Series([row[0] for row in rows])
    # records of one corpus get their first numbers back
    if corpora.nunique() == 1:
        return dict(zip(NUMBERS, numbers.T, strict=True))
    keys = {
        name: corpora + "/" + pd.Series(values).astype(str) for name, values in zip(NUMBERS, numbers.T, strict=True)
    }
    return {
        name: pd.factorize(keys[name].where(values >= 0))[0].astype(np.int32)
        for name, values in zip(NUMBERS, numbers.T, strict=True)
    }
