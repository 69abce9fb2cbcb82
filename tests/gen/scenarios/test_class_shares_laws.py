"""Laws of the class shares: the specimens of a corpus have the classes of the weights, whatever the number of specimens of a rig is."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.scenarios import draw_scenarios, fault_of_each_specimen, first_records
from gen.scenarios.classes import class_shares

CLASSES = ("healthy", "inner", "outer", "ball")
seeds = st.integers(0, 2**31)
weights_of_all = st.tuples(*[st.floats(0.05, 10)] * 4)


def faults(weights):
    widths = [{}] + [{"width_mm": 0.5}] * 3
    return [
        {"kind": kind, "weight": weight, **width} for kind, weight, width in zip(CLASSES, weights, widths, strict=True)
    ]


def counted(recipe, rigs):
    """Number of specimens of each class on each rig, shape (rig, class)."""
    counters = [Counter(fault_of_each_specimen(recipe, rig)) for rig in range(rigs)]
    return np.array([[counts[kind] for kind in CLASSES] for counts in counters])


@given(seeds, st.integers(1, 9), weights_of_all, st.integers(0, 3))
def test_every_rig_has_of_each_kind_what_the_weights_give_it(recipe_with, seed, specimens, weights, absent):
    weights = (*weights[: 4 - absent], *[0.0] * absent)
    recipe = recipe_with({"seed": seed, "corpus.specimens_per_rig": specimens, "faults": faults(weights)})
    counts = counted(recipe, 12)
    expected = specimens * weights[0] / sum(weights)
    assert (counts.sum(axis=1) == specimens).all()
    assert (np.abs(counts[:, 0] - expected) < 1 + 1e-6).all()
    if expected >= 1:
        assert counts[:, 0].min() >= 1
    if specimens - expected >= 1:
        assert counts[:, 1:].sum(axis=1).min() >= 1
    assert not counts[:, 4 - absent :].any()


@given(seeds, st.integers(1, 9), weights_of_all)
def test_over_the_rigs_the_classes_have_the_shares_of_their_weights(recipe_with, seed, specimens, weights):
    recipe = recipe_with({"seed": seed, "corpus.specimens_per_rig": specimens, "faults": faults(weights)})
    rigs, shares = 400, np.array(weights) / sum(weights)
    excess = np.cumsum(counted(recipe, rigs), axis=0) - specimens * np.outer(np.arange(1, rigs + 1), shares)
    assert np.abs(excess[:, 0]).max() < 5  # of up to 3600: the offsets are evenly spread from the first rig on
    assert np.abs(excess).max() < 12


@given(seeds, st.integers(1, 5), weights_of_all, st.sampled_from([(0, 1), (0, 0.25, 0.5, 1), (0.5, 1)]))
def test_with_rungs_the_records_have_the_shares_of_the_weights(recipe_with, seed, specimens, weights, rungs):
    weights = (weights[0] + sum(weights[1:]) / (len(rungs) - 1), *weights[1:])
    recipe = recipe_with(
        {"seed": seed, "corpus.specimens_per_rig": specimens, "corpus.rungs": rungs, "faults": faults(weights)}
    )
    of_specimens = class_shares(recipe)
    of_records = {kind: share for kind, share in of_specimens.items() if kind != "healthy"}
    before_damage = sum(of_records.values()) / len(rungs) if rungs[0] == 0 else 0
    damaged = 1 - before_damage / sum(of_records.values())
    for kind, weight in zip(CLASSES[1:], weights[1:], strict=True):
        assert of_records[kind] * damaged == pytest.approx(weight / sum(weights))
    assert of_specimens.get("healthy", 0) + before_damage == pytest.approx(weights[0] / sum(weights))


@pytest.mark.parametrize("rungs", [None, (0, 1), (0.5, 1)])
@pytest.mark.parametrize("specimens", [1, 5])
@pytest.mark.parametrize("groups", [None, 3, 1])
def test_the_first_record_of_each_class_is_the_first_one_drawn_with_it(recipe_with, specimens, groups, rungs):
    records = None if groups is None else groups * len(rungs or [1])
    changes = {"corpus.specimens_per_rig": specimens, "records": records, "faults": faults((4, 1, 1, 1))}
    recipe = recipe_with(changes | {"corpus.rungs": rungs})
    drawn = [(scenario.fault, scenario.origin.record) for scenario in draw_scenarios(recipe)]
    assert first_records(recipe) == dict(reversed(drawn))
