"""Blocks of a corpus: the records that its recipe asks for, and those of each later extension.

An extension adds rigs, or specimens to every rig that exists. The numbers of its rigs, specimens, records and parts go on where those
before it end, so that no random stream is used twice and no earlier record, file or split changes. Extensions are no key of recipe files:
they are kept in the manifest of the corpus, and they do not count for :func:`gen.recipe.recipe_hash`.
"""

from collections.abc import Iterable
from typing import NamedTuple


class Extension(NamedTuple):
    """Addition to a corpus: a number of rigs, or a number of specimens in every rig; the other number is 0."""

    rigs: int = 0
    specimens: int = 0


class Block(NamedTuple):
    """Consecutive records that were asked for together."""

    rigs: range
    """Numbers of the rigs that have specimens of the block."""
    specimens: range
    records: range
    parts: range
    items: range
    """Numbers of the quasi-random points, and of the combinations of grids, of its records."""
    specimens_per_rig: int
    records_of_a_specimen: int
    n_rungs: int
    records_per_part: int
    adds_rigs: bool
    """Whether its rigs are new; else they are all rigs of the blocks before it."""

    def specimen_of(self, record: int) -> int:
        """Number of the specimen of a record."""
        return self.specimens.start + (record - self.records.start) // self.records_of_a_specimen

    def rig_of(self, specimen: int) -> int:
        """Number of the rig of a specimen."""
        return self.rigs.start + (specimen - self.specimens.start) // self.specimens_per_rig

    def first_specimen_of(self, rig: int) -> int:
        """Number of the first specimen of the block in a rig."""
        return self.specimens.start + (rig - self.rigs.start) * self.specimens_per_rig

    def records_of(self, specimen: int) -> range:
        """Numbers of the records of a specimen; the last specimen of a block may have fewer than the others."""
        first = self.records.start + (specimen - self.specimens.start) * self.records_of_a_specimen
        return range(first, min(first + self.records_of_a_specimen, self.records.stop))

    def item_of(self, record: int) -> int:
        """Number of the quasi-random point of a record of a healthy specimen, and of its combination of grids.

        The first records of all groups of ``n_rungs`` records come first, then the second ones, and so on.
        """
        group, place = divmod(record - self.records.start, self.n_rungs)
        return self.items.start + place * (len(self.items) // self.n_rungs) + group

    def records_of_part(self, part: int) -> range:
        """Numbers of the records of a part; the last part of a block may have fewer than the others."""
        first = self.records.start + (part - self.parts.start) * self.records_per_part
        return range(first, min(first + self.records_per_part, self.records.stop))


def first_block(
    records: int, whole: int, *, per_specimen: int, specimens_per_rig: int, per_part: int, n_rungs: int = 1
) -> Block:
    """Block of the first ``records`` of the ``whole`` records of a recipe."""
    specimens = -(-records // per_specimen)
    return Block(
        rigs=range(-(-specimens // specimens_per_rig)),
        specimens=range(specimens),
        records=range(records),
        parts=range(-(-records // per_part)),
        items=range(records if n_rungs == 1 else whole),
        specimens_per_rig=specimens_per_rig,
        records_of_a_specimen=per_specimen,
        n_rungs=n_rungs,
        records_per_part=per_part,
        adds_rigs=True,
    )


def with_blocks(first: Block, extensions: Iterable[Extension]) -> tuple[Block, ...]:
    """Blocks of a corpus that begins with ``first`` and was extended.

    >>> corpus = first_block(24, 24, per_specimen=2, specimens_per_rig=4, per_part=8)
    >>> [(block.rigs, block.specimens, block.records) for block in with_blocks(corpus, [Extension(specimens=1)])]
    [(range(0, 3), range(0, 12), range(0, 24)), (range(0, 3), range(12, 15), range(24, 30))]
    """
    blocks, n_rigs = [first], first.rigs.stop
    for rigs, specimens in extensions:
        last, per_rig = blocks[-1], specimens or first.specimens_per_rig
        numbers = range(n_rigs, n_rigs + rigs) if rigs else range(n_rigs)
        count = len(numbers) * per_rig
        records = count * first.records_of_a_specimen
        blocks.append(
            first._replace(
                rigs=numbers,
                specimens=_after(last.specimens, count),
                records=_after(last.records, records),
                parts=_after(last.parts, -(-records // first.records_per_part)),
                items=_after(last.items, records),
                specimens_per_rig=per_rig,
                adds_rigs=rigs > 0,
            )
        )
        n_rigs += rigs
    return tuple(blocks)


def _after(numbers: range, count: int) -> range:
    return range(numbers.stop, numbers.stop + count)
