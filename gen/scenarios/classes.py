"""Choose the fault class of every specimen of a rig.

The number of healthy specimens of a rig is its expected number, rounded down or up; which of the two, a sequence of offsets over the rigs
decides. A second sequence shares the faulty specimens out among the faults. Both are additive sequences (irrational step, random start):
each offset is uniformly distributed over the seeds, so the expected number of each class is its share, and the offsets of successive rigs
are evenly spread, so the shares are met within a few specimens from the first rigs on [1]_.

.. [1] L. Kuipers, H. Niederreiter, *Uniform Distribution of Sequences*, Wiley, 1974.
"""

import functools
import math

import numpy as np

from gen.corpus import FAULTS
from gen.recipe import Block, Recipe, fault_class
from gen.scenarios.model import Purpose, stream

# Irrational steps without a common small multiple, and without one with that of the split (the golden ratio).
_HEALTHY_STEP, _FAULTY_STEP = math.sqrt(2), 2 ** (1 / 3)
_ROUNDING = 1e-9


def class_shares(recipe: Recipe) -> dict[str, float]:
    """Share of the specimens of each class that the recipe has [1]; with rungs, such that the records have the shares of the weights."""
    weights: dict[str, float] = dict.fromkeys(FAULTS, 0.0)
    for entry in recipe.faults:
        weights[fault_class(entry)] += entry.weight
    total, corpus = sum(weights.values()), recipe.corpus
    if corpus.rungs is not None and corpus.rungs[0] == 0 and corpus.fault_choice == "by_weight":
        # the specimens of a fault also have one healthy record for every n_rungs - 1 with their fault
        for kind in set(weights) - {"healthy"}:
            before_damage = weights[kind] / (corpus.n_rungs - 1)
            weights[kind] += before_damage
            weights["healthy"] -= before_damage
    return {kind: weight / total for kind, weight in weights.items() if weight > _ROUNDING * total}


def fault_of_each_specimen(recipe: Recipe, rig: int, block: Block | None = None) -> list[str]:
    """Fault class of each specimen of a block in a rig, by default of the first block.

    Over all rigs of a block the classes have their shares, whatever the number of specimens is. A rig has healthy and faulty specimens if
    their expected numbers are both at least 1.
    """
    block = recipe.blocks[0] if block is None else block
    shares, count = class_shares(recipe), block.specimens_per_rig
    if recipe.corpus.fault_choice == "in_turn":
        start, entries = block.first_specimen_of(rig), recipe.faults
        return [fault_class(entries[number % len(entries)]) for number in range(start, start + count)]
    offsets = _offsets(recipe.seed, rig, block)
    healthy = count * shares.pop("healthy", 0.0)
    n_healthy = math.floor(healthy + _ROUNDING)
    n_healthy += int(offsets[0] < healthy - n_healthy - _ROUNDING)
    faulty = _shared_out(shares, count - n_healthy, offsets[1])
    chosen = [*["healthy"] * n_healthy, *faulty]
    # specimens that are added to a rig have a stream of their own
    first = 0 if block.adds_rigs else block.first_specimen_of(rig)
    return [chosen[i] for i in stream(recipe.seed, rig, first, 0, Purpose.CLASSES).permutation(count)]


def possible_entries(recipe: Recipe, specimen: int, fault: str) -> list[int]:
    """Places in ``faults`` of the entries that a specimen with a fault class can have."""
    if recipe.corpus.fault_choice == "in_turn":
        return [specimen % len(recipe.faults)]
    return [place for place, one in enumerate(recipe.faults) if fault_class(one) == fault]


def _offsets(seed: int, rig: int, block: Block) -> tuple[float, float]:
    """Offsets in [0, 1) of a rig, for its healthy and for its faulty specimens; new rigs go on with the sequences of the rigs before."""
    first = 0 if block.adds_rigs else block.specimens.start
    starts = stream(seed, 0, first, 1, Purpose.CLASSES).random(2)  # the classes of a rig have 0 for the record
    return (float(starts[0]) + rig * _HEALTHY_STEP) % 1, (float(starts[1]) + rig * _FAULTY_STEP) % 1


def _shared_out(shares: dict[str, float], count: int, offset: float) -> list[str]:
    """``count`` classes by systematic sampling: each class its expected number, rounded down or up."""
    if count == 0:
        return []
    expected = count * np.array(list(shares.values())) / sum(shares.values())
    whole = np.floor(expected + _ROUNDING).astype(int)
    rest = count - int(whole.sum())
    edges = np.cumsum(np.maximum(expected - whole, 0.0))
    picks = np.searchsorted(edges, offset + np.arange(rest), side="right")
    whole += np.bincount(np.minimum(picks, len(shares) - 1), minlength=len(shares))
    return [kind for kind, number in zip(shares, whole, strict=True) for _ in range(number)]


@functools.lru_cache(maxsize=16)
def first_specimens(recipe: Recipe) -> dict[str, int]:
    """Number of the first specimen of each fault class in the corpus; the search stops when it has found every class."""
    n_classes = len(class_shares(recipe))
    found: dict[str, int] = {}
    for block, rig in ((one, rig) for one in recipe.blocks for rig in one.rigs):
        first = block.first_specimen_of(rig)
        faults = fault_of_each_specimen(recipe, rig, block)
        for number, fault in enumerate(faults[: block.specimens.stop - first], first):
            found.setdefault(fault, number)
        if len(found) == n_classes:
            break
    return found


def first_records(recipe: Recipe) -> dict[str, int]:
    """Number of the first record of each fault class in the corpus; a record at rung 0 is healthy."""
    corpus = recipe.corpus
    before_damage = corpus.rungs is not None and corpus.rungs[0] == 0
    found: dict[str, int] = {}
    for fault, specimen in sorted(first_specimens(recipe).items(), key=lambda item: item[1]):
        block = next(block for block in recipe.blocks if specimen < block.specimens.stop)
        first = block.records_of(specimen).start
        if before_damage and fault != "healthy":
            found.setdefault("healthy", first)
            first += 1
        if first < block.records.stop:
            found.setdefault(fault, first)
    return found
