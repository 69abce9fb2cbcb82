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
from gen.drawing import stream
from gen.recipe import Recipe, class_of

# Irrational steps without a common small multiple, and without one with that of the split (the golden ratio).
_HEALTHY_STEP, _FAULTY_STEP = math.sqrt(2), 2 ** (1 / 3)
_ROUNDING = 1e-9


def class_shares(recipe: Recipe) -> dict[str, float]:
    """Share of the specimens of each class that the recipe has [1]; with rungs, such that the records have the shares of the weights."""
    weights: dict[str, float] = dict.fromkeys(FAULTS, 0.0)
    for entry in recipe.faults:
        weights[class_of(entry)] += entry.weight
    total, corpus = sum(weights.values()), recipe.corpus
    if corpus.rungs is not None and corpus.rungs[0] == 0 and corpus.fault_choice == "by_weight":
        # the specimens of a fault also have one healthy record for every n_rungs - 1 with their fault
        for kind in set(weights) - {"healthy"}:
            before_damage = weights[kind] / (corpus.n_rungs - 1)
            weights[kind] += before_damage
            weights["healthy"] -= before_damage
    return {kind: weight / total for kind, weight in weights.items() if weight > _ROUNDING * total}


def fault_of_each_specimen(recipe: Recipe, rig: int) -> list[str]:
    """Fault class of each specimen of a rig.

    Over all rigs the classes have their shares, whatever the number of specimens is. A rig has healthy and faulty specimens if
    their expected numbers are both at least 1.
    """
    shares, count = class_shares(recipe), recipe.corpus.specimens_per_rig
    if recipe.corpus.fault_choice == "in_turn":
        entries = recipe.faults
        return [class_of(entries[number % len(entries)]) for number in range(rig * count, (rig + 1) * count)]
    # systematic sampling: every rig has nearly the shares of the recipe, and all rigs together have them
    offsets = _offsets(recipe.seed, rig)
    healthy = count * shares.pop("healthy", 0.0)
    n_healthy = math.floor(healthy + _ROUNDING)
    n_healthy += int(offsets[0] < healthy - n_healthy - _ROUNDING)
    faulty = _share_out(shares, count - n_healthy, offsets[1])
    chosen = [*["healthy"] * n_healthy, *faulty]
    return [chosen[i] for i in stream(recipe.seed, "rig", rig, "faults").permutation(count)]


def possible_entries(recipe: Recipe, specimen: int, fault: str) -> list[int]:
    """Places in ``faults`` of the entries that a specimen with a fault class can have."""
    if recipe.corpus.fault_choice == "in_turn":
        return [specimen % len(recipe.faults)]
    return [place for place, entry in enumerate(recipe.faults) if class_of(entry) == fault]


def _offsets(seed: int, rig: int) -> tuple[float, float]:
    """Offsets in [0, 1) of a rig, for its healthy and for its faulty specimens."""
    starts = stream(seed, "corpus", 0, "faults").random(2)
    return (float(starts[0]) + rig * _HEALTHY_STEP) % 1, (float(starts[1]) + rig * _FAULTY_STEP) % 1


def _share_out(shares: dict[str, float], count: int, offset: float) -> list[str]:
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
def first_records(recipe: Recipe) -> dict[str, int]:
    """Number of the first record of each fault class in the corpus, where a record at rung 0 is healthy."""
    corpus, classes = recipe.corpus, class_shares(recipe).keys()
    before_damage = corpus.rungs is not None and corpus.rungs[0] == 0
    first_of: dict[str, int] = {}
    for rig in range(recipe.n_rigs):
        specimens = range(rig * corpus.specimens_per_rig, recipe.n_specimens)
        for specimen, fault in zip(specimens, fault_of_each_specimen(recipe, rig), strict=False):
            first = recipe.records_of(specimen).start
            # the first record of a damaged specimen is the one before its damage
            if before_damage and fault != "healthy":
                first_of.setdefault("healthy", first)
                first += 1
            if first < recipe.n_records:
                first_of.setdefault(fault, first)
        if classes <= first_of.keys():
            break
    return first_of
