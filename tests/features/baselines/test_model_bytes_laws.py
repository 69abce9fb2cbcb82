"""Laws of the model files of Raceway: all allowed types occur in models, and equal models give equal bytes."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from features.baselines import ESTIMATORS, estimators, load_model, save_model, train
from features.baselines.model_file import read_state
from features.baselines.model_rules import LEARNED, LISTS, TOGETHER
from features.baselines.model_states import KINDS, Known, State
from gen.corpus import FAULTS
from tests.model_files import Archive, make_table, write_models
from tests.paths import ROOT


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> dict[str, Path]:
    """A model file of every estimator."""
    return write_models(tmp_path_factory.mktemp("models"), 3)


def states(root: State) -> set[State]:
    """Every state within one, itself included."""
    found, left = set(), [root]
    while left:
        value = left.pop()
        if isinstance(value, State) and value not in found:
            found.add(value)
            left.append(value.parts)
        elif not isinstance(value, State):
            left += list(value.values()) if isinstance(value, dict) else list(value) if isinstance(value, tuple) else []
    return found


@pytest.fixture(scope="module")
def held(tmp_path_factory) -> set[State]:
    """States of model files of every estimator, over two and over all classes."""
    folder = tmp_path_factory.mktemp("held")
    paths = [path for classes in (2, len(FAULTS)) for path in write_models(folder, classes).values()]
    return set().union(*(states(read_state(path, Known())) for path in paths))


def test_the_types_allowed_in_a_model_file_are_those_of_models(held):
    assert {state.kind for state in held} == KINDS


def test_every_rule_is_for_an_attribute_that_models_have(held):
    objects = [state for state in held if isinstance(state.parts.get("content"), State)]
    names = {state.kind[1] for state in objects}
    found = {f"{state.kind[1]}.{key}" for state in objects for key in state.parts["content"].parts.get("content") or ()}
    assert set(LEARNED) | set(LISTS) <= found
    assert set(TOGETHER) <= names


@pytest.mark.parametrize("name", list(ESTIMATORS))
def test_models_of_any_training_are_accepted(tmp_path, name):
    for seed, scale, classes, records in [(0, 1.0, 2, 20), (1, 0.0, 3, 33), (2, 1e-6, 6, 61), (3, 1e6, 4, 40)]:
        table = make_table(classes, records, seed)
        table = table.assign(features=table.features * scale).isel(record=np.arange(records) != 5)
        save_model(train(table, name, seed=seed), tmp_path / "m")
        assert load_model(tmp_path / "m").seed == seed


def test_a_forest_of_another_size_is_accepted(files, monkeypatch):
    monkeypatch.setattr(estimators, "TREES", 7)
    assert len(load_model(files["random_forest"]).estimator[-1].estimators_) == 2


TRAINING = """
import sys
from pathlib import Path
from tests.model_files import write_models
from tests.paths import ROOT
write_models(Path(sys.argv[1]), 3, seed=5)
"""


def test_two_trainings_in_two_processes_give_the_same_bytes(tmp_path):
    for number in ("1", "2"):
        (tmp_path / number).mkdir()
        subprocess.run(
            [sys.executable, "-c", TRAINING, tmp_path / number],
            cwd=ROOT,
            env=os.environ | {"PYTHONHASHSEED": number},
            check=True,
        )
    for name in ESTIMATORS:
        one, other = (tmp_path / number / f"{name}_3.skops" for number in ("1", "2"))
        assert one.read_bytes() == other.read_bytes(), name


@pytest.mark.parametrize("name", list(ESTIMATORS))
def test_a_model_that_was_loaded_is_saved_with_the_same_bytes(files, tmp_path, name):
    save_model(load_model(files[name]), tmp_path / "m")
    assert (tmp_path / "m").read_bytes() == files[name].read_bytes()


def test_bytes_between_the_fields_of_a_node_are_zero(files):
    nodes = Archive(files["random_forest"]).array("nodes")
    gaps = nodes.view(np.uint8).reshape(len(nodes), -1)[
        :, sum(nodes.dtype[name].itemsize for name in nodes.dtype.names) :
    ]
    assert gaps.shape[1] > 0
    assert not gaps.any()


def test_a_model_file_holds_each_array_once(files):
    members = Archive(files["ensemble"]).members
    assert len(set(members.values())) == len(members)
