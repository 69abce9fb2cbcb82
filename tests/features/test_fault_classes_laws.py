"""Laws of the table of fault classes: complete, and the only place that describes a class."""

import ast
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from features.baselines import estimators
from features.baselines.estimators import EnvelopeRule
from features.fault_classes import CLASSES, COMBS, EVIDENCE, FaultClass, NominalLine, fundamentals
from features.signal.lines import FAMILIES
from features.table.indicators import Orders, feature_names
from gen.corpus import FAULTS
from raceway.reports import pictures
from raceway.reports.class_colours import FAULT_COLOURS
from raceway.reports.pictures import DrawnRecord, draw_record, fault_lines
from tests.paths import ROOT

ORDERS = Orders(*map(np.float64, (0.4, 3.6, 5.4, 2.35)))
TABLE = ROOT / "features" / "fault_classes.py"
RULE = ROOT / "features" / "baselines" / "estimators.py"  # three classes interact there: ball, cage and compound


def test_the_features_that_tell_the_classes_are_computed_and_tell_one_class_each():
    assert len(set(EVIDENCE)) == len(EVIDENCE)
    assert set(EVIDENCE) <= set(feature_names(("lines",)))
    assert sorted(COMBS.values()) == sorted(f"whitened_{family}_comb" for family in FAMILIES)


def test_each_class_has_its_textbook_lines_as_multiples_of_the_nominal_orders():
    multiples = {"inner": (1, 2, 3), "outer": (1, 2, 3), "ball": (2, 4, 6), "cage": (1, 2, 3)}
    bases = {"inner": "bpfi", "outer": "bpfo", "ball": "bsf", "cage": "ftf"}
    for name, base in bases.items():
        assert [(line.base, line.multiple) for line in CLASSES[name].lines] == [(base, n) for n in multiples[name]]
    assert set(CLASSES["compound"].lines) <= set(fundamentals())
    assert {line.base for row in CLASSES.values() for line in row.lines} <= {*Orders._fields, "shaft"}


def described_classes(path: Path) -> Iterator[str]:
    """Names of faulty classes among the string literals of a file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Constant) and node.value in FAULTS:
            yield str(node.value)


def test_no_other_module_of_features_names_a_class():
    named = {path: set(described_classes(path)) for path in (ROOT / "features").rglob("*.py")}
    assert named.pop(TABLE) == set(FAULTS[1:])
    assert named.pop(RULE) == {"outer", "ball", "cage", "compound"}
    assert not {path: names for path, names in named.items() if names}


@pytest.fixture
def looseness(monkeypatch):
    """One more class, in the format and in the table."""
    row = FaultClass(
        "looseness", (NominalLine("fr", "shaft", 1), NominalLine("2 fr", "shaft", 2)), single_lines=("whitened_fr",)
    )
    table = {**CLASSES, row.name: row}
    monkeypatch.setattr(estimators, "FAULTS", (*FAULTS, row.name))
    monkeypatch.setattr(estimators, "CLASSES", table)
    monkeypatch.setattr(pictures, "ALL_CLASSES", table)
    monkeypatch.setattr(pictures, "FAULT_COLOURS", {**FAULT_COLOURS, row.name: "#F0E442"})
    return row


def test_a_new_class_needs_one_row_to_be_predicted_and_drawn(looseness):
    frame = pd.DataFrame(np.zeros((2, len(EVIDENCE))), columns=list(EVIDENCE)).assign(whitened_fr=[0.0, 4.0])
    rule = EnvelopeRule().fit(frame, np.arange(len(FAULTS) + 1))
    np.testing.assert_array_equal(rule.predict(frame), [0, len(FAULTS)])
    assert fault_lines(ORDERS, looseness.name)[0] == {"fr": 1.0, "2 fr": 2.0}
    signal = np.random.default_rng(0).standard_normal(4000)
    draw_record(DrawnRecord("loose", signal, 10_000.0, 30.0, ORDERS, looseness.name))
