"""Laws of the table of fault classes: complete, and the only place that describes a class."""

import ast
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from features.baselines import estimators
from features.baselines.estimators import EnvelopeRule
from features.signal.lines import FAMILIES
from features.table import class_features as class_features_module
from features.table.class_features import COMBS, EVIDENCE, class_features
from features.table.indicators import Orders, feature_names
from gen.corpus import FAULTS, fault_classes
from gen.corpus.fault_classes import BPFO, FTF, FaultClass, NominalLine, fault_class, fundamentals
from raceway.reports import pictures
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.pictures import DrawnRecord, draw_record, fault_lines
from tests.paths import ROOT

ORDERS = Orders(*map(np.float64, (0.4, 3.6, 5.4, 2.35)))
COLUMNS = [*EVIDENCE, "whitened_fr", "whitened_2fr"]
RULE = ROOT / "features" / "baselines" / "estimators.py"  # three classes interact there: ball, cage and compound


def test_the_features_that_tell_the_classes_are_computed_and_tell_one_class_each():
    assert len(set(EVIDENCE)) == len(EVIDENCE)
    assert set(EVIDENCE) <= set(feature_names(("lines",)))
    assert sorted(COMBS.values()) == sorted(f"whitened_{family}_comb" for family in FAMILIES)


def test_each_class_has_its_textbook_lines_as_multiples_of_the_nominal_orders():
    multiples = {"inner": (1, 2, 3), "outer": (1, 2, 3), "ball": (2, 4, 6), "cage": (1, 2, 3)}
    bases = {"inner": "bpfi", "outer": "bpfo", "ball": "bsf", "cage": "ftf"}
    for name, base in bases.items():
        assert [(line.base, line.multiple) for line in fault_class(name).lines] == [(base, n) for n in multiples[name]]
    assert set(fault_class("compound").lines) <= set(fundamentals())
    assert {line.base for row in map(fault_class, FAULTS) for line in row.lines} <= {*Orders._fields, "shaft"}


def described_classes(path: Path) -> Iterator[str]:
    """Names of faulty classes among the string literals of a file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Constant) and node.value in FAULTS:
            yield str(node.value)


def test_no_module_of_features_but_the_rule_names_a_class():
    named = {path: set(described_classes(path)) for path in (ROOT / "features").rglob("*.py")}
    assert named.pop(RULE) == {"outer", "ball", "cage", "compound"}
    assert not {path: names for path, names in named.items() if names}


@pytest.fixture
def loose(monkeypatch):
    """One more class: a plug-in with a row."""
    row = FaultClass("loose", (NominalLine("fr", "shaft", 1), NominalLine("2 fr", "shaft", 2)))
    monkeypatch.setattr(fault_classes, "plugin", lambda *_: row)
    for module in (estimators, class_features_module):
        monkeypatch.setattr(module, "FAULTS", (*FAULTS, row.name))
    monkeypatch.setattr(pictures, "FAULT_COLOURS", {**FAULT_COLOURS, row.name: "#F0E442"})
    yield row.name
    fault_class.cache_clear()
    class_features.cache_clear()


def test_a_new_class_needs_one_row_to_be_predicted_and_drawn(loose):
    assert class_features(loose) == ("whitened_fr", "whitened_2fr")
    frame = pd.DataFrame(np.zeros((2, len(COLUMNS))), columns=COLUMNS).assign(whitened_fr=[0.0, 4.0])
    rule = EnvelopeRule().fit(frame, np.arange(len(FAULTS) + 1))
    np.testing.assert_array_equal(rule.predict(frame), [0, len(FAULTS)])
    assert fault_lines(ORDERS, loose)[0] == {"fr": 1.0, "2 fr": 2.0}
    signal = np.random.default_rng(0).standard_normal(4000)
    draw_record(DrawnRecord("loose", signal, 10_000.0, 30.0, ORDERS, loose))


@pytest.mark.parametrize("lines", [(), BPFO, (FTF[0], BPFO[0])])
def test_a_class_without_features_of_its_own_is_never_predicted_by_the_rule(loose, lines, monkeypatch):
    monkeypatch.setattr(fault_classes, "plugin", lambda *_: FaultClass(loose, lines))
    assert class_features(loose) == ()
    frame = pd.DataFrame(np.zeros((2, len(COLUMNS))), columns=COLUMNS)
    rule = EnvelopeRule().fit(frame, np.arange(len(FAULTS) + 1))
    np.testing.assert_array_equal(rule.predict(frame), [0, 0])
    np.testing.assert_array_equal(rule.predict_proba(frame)[:, -1], [0.0, 0.0])
