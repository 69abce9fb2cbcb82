"""Rules that objects of a plug-in keep: one that breaks a rule is named, in this process and without an installation."""

from importlib.metadata import EntryPoint

import numpy as np
import pytest

from features.table.definitions import GROUPS
from features.table.feature_group import Feature, FeatureGroup
from features.table.indicators import Orders, indicators
from gen.measurement.components import _checked
from gen.mechanisms.background.source import MachineSource
from gen.mechanisms.chain.drift import Drift
from gen.mechanisms.chain.measuring_chain import disturb
from gen.mechanisms.chain.sensor_fault import SensorFault
from gen.mechanisms.mechanism import with_plugins
from gen.support.errors import RacewayError


class Taken(Drift):
    """A fault in the place of a built-in one."""


class OfNoLevel(Drift):
    """A fault that is drawn at no level."""

    place, drawn_per = "of_no_level", "machine"


@pytest.mark.parametrize(
    ("mechanism", "said"), [(Taken, "drift is taken"), (OfNoLevel, "drawn_per is 'machine' and not")]
)
def test_a_mechanism_that_breaks_a_rule_is_named_when_it_is_loaded(monkeypatch, mechanism, said):
    entries = {"mine": EntryPoint("mine", "mine:Mine", "raceway.mechanisms")}
    for module in ("gen.support.plugins", "gen.mechanisms.mechanism"):
        monkeypatch.setattr(f"{module}.plugins", lambda _: entries)
    monkeypatch.setattr("gen.mechanisms.mechanism.plugin", lambda *_: mechanism)
    with pytest.raises(RacewayError, match=f"its mine in raceway.mechanisms cannot be used .{said}"):
        with_plugins(SensorFault, (Drift,))


class Leak(MachineSource):
    """A source in the machine."""

    place = "leak"


class Bent(SensorFault):
    """A fault of the measuring chain."""

    place = "bent"


def of_plugin(monkeypatch, mechanism, method, result):
    """A mechanism of a plug-in whose method returns a ``result``."""
    monkeypatch.setattr(mechanism, method, lambda *_: result)
    monkeypatch.setattr("gen.mechanisms.mechanism.plugins", lambda _: ["mine"])
    monkeypatch.setattr("gen.mechanisms.mechanism.plugin", lambda *_: mechanism)
    entries = {"mine": EntryPoint("mine", "mine:Mine", "raceway.mechanisms")}
    monkeypatch.setattr("gen.support.plugins.plugins", lambda _: entries)
    return mechanism.model_construct(probability=1.0)


@pytest.mark.parametrize(
    "result", [None, 1.0, np.ones(8), [np.ones(7)], [[1.0] * 8, [1.0]], [np.full(8, np.nan)], [["a"] * 8]]
)
def test_a_source_with_a_wrong_result_is_named(monkeypatch, result):
    leak = of_plugin(monkeypatch, Leak, "vibrations", result)
    with pytest.raises(
        RacewayError, match=r"its mine in raceway.mechanisms .*vibrations\(\) of leak must return a list"
    ):
        _checked(leak.vibrations(None, 1.0, None), leak, (8,))


@pytest.mark.parametrize("result", [None, np.ones((1, 8)), [np.ones((1, 8))], (np.ones(8),), (np.ones((1, 8)), 1.0)])
def test_a_fault_of_the_chain_with_a_wrong_result_is_named(monkeypatch, result):
    section = [("bent", of_plugin(monkeypatch, Bent, "disturb", result))]
    with pytest.raises(RacewayError, match=r"its mine in raceway.mechanisms .*disturb\(\) of bent must return a tuple"):
        disturb(np.ones((1, 8)), section, 1.0, lambda _: None)


@pytest.mark.parametrize(
    ("group", "said"),
    [
        (
            FeatureGroup((Feature("cepstral_bpfo_comb", "a name of another", "x"),), lambda batch: batch.x[:, :1]),
            "cepstral_bpfo_comb is taken",
        ),
        (
            FeatureGroup((Feature("mine", "values in one dimension", "x"),), lambda batch: batch.x[:, 0]),
            r"the shape \(2,\) and not \(2, 1\)",
        ),
    ],
)
def test_a_group_of_features_that_breaks_a_rule_is_named_when_it_is_computed(monkeypatch, group, said):
    entries = {"mine": EntryPoint("mine", "mine:GROUP", "raceway.features")}
    monkeypatch.setattr("gen.support.plugins.plugins", lambda _: entries)
    monkeypatch.setattr("features.table.definitions.plugin", lambda *_: group)
    monkeypatch.setattr("features.table.definitions.ALL_GROUPS", (*GROUPS, "mine"))
    x = np.random.default_rng(0).standard_normal((2, 6000))
    with pytest.raises(RacewayError, match=f"its mine in raceway.features cannot be used .*{said}"):
        indicators(x, 12_000.0, 25.0, Orders(*map(np.float64, (0.4, 3.6, 5.4, 2.4))), ("mine",))
