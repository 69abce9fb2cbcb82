"""Laws of model files of unknown origin: a damaged or forged file is refused in one sentence before any object is created."""

import json
import zipfile
from pathlib import Path

import numpy as np
import pytest

from features.baselines import evaluate, load_model
from features.baselines.calibration import UNCALIBRATED
from features.baselines.model_file import pack
from features.baselines.model_rules import LEARNED, LISTS
from gen.errors import CorpusError
from tests.model_files import NAMES, Archive, make_table, write_models


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> dict[str, Path]:
    """A model file of every estimator."""
    return write_models(tmp_path_factory.mktemp("models"), 3)


def refusal(path: Path) -> str:
    """The sentence that a model file is refused with."""
    with pytest.raises(CorpusError) as caught:
        load_model(path)
    sentence = str(caught.value)
    assert sentence.startswith(str(path))
    assert "\n" not in sentence
    assert len(sentence) < 500
    return sentence


@pytest.mark.parametrize("name", ["random_forest", "extra_trees", "ensemble"])
@pytest.mark.parametrize(
    ("key", "value", "sentence"),
    [
        ("left_child", 2**40, "a node with a child that is not between the node and the last"),
        ("right_child", -7, "a node with a child that is not between the node and the last"),
        ("left_child", 0, "a node with a child that is not between the node and the last"),
        ("right_child", 1, "a node with two parents"),
        ("left_child", -1, "a leaf with a child"),
        ("feature", 2**40, "an index outside 0..5"),
        ("feature", -2, "an index outside 0..5"),
        ("feature", len(NAMES), "an index outside 0..5"),
        ("threshold", np.nan, "a number that is not finite"),
    ],
)
def test_a_tree_with_an_index_outside_its_arrays_is_refused(files, tmp_path, name, key, value, sentence):
    archive = Archive(files[name])
    nodes = archive.array("nodes")
    nodes[key][0] = value
    archive.put("nodes", nodes)
    assert f"tree_.nodes has {sentence}" in refusal(archive.write(tmp_path / "m"))


def test_a_tree_with_a_cycle_is_refused(files, tmp_path):
    archive = Archive(files["random_forest"])
    nodes = archive.array("nodes")
    last = np.flatnonzero(nodes["left_child"] != -1)[-1]
    nodes["left_child"][last] = last
    archive.put("nodes", nodes)
    assert "a child that is not between the node and the last" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize("change", [lambda nodes: nodes[:0], lambda nodes: nodes[:1], lambda nodes: nodes[None]])
def test_a_tree_with_too_few_nodes_is_refused(files, tmp_path, change):
    archive = Archive(files["extra_trees"])
    archive.put("nodes", change(archive.array("nodes")))
    assert "estimator" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize("count", [-1, 2**40, 10**30, 0, 1.5, None, "3"])
def test_a_tree_that_miscounts_its_nodes_is_refused(files, tmp_path, count):
    archive = Archive(files["extra_trees"])
    archive.places("node_count")[0]["content"] = json.dumps(count)
    assert "tree_.node_count" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize(("place", "value"), [(0, 2**20), (2, 2**20), (2, -1)])
def test_a_tree_is_not_made_with_other_numbers_of_features_and_outputs(files, tmp_path, place, value):
    archive = Archive(files["random_forest"])
    archive.places("__reduce__")[0]["args"]["content"][place]["content"] = json.dumps(value)
    assert f"is {value} and must be" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize(
    ("key", "value", "sentence"),
    [
        ("left", 2**32 - 1, "a node with a child that is not between the node and the last"),
        ("right", 0, "a node with a child that is not between the node and the last"),
        ("feature_idx", 2**40, "an index outside 0..5"),
        ("feature_idx", -1, "an index outside 0..5"),
        ("is_categorical", 1, "a categorical split"),
        ("value", np.inf, "a number that is not finite"),
    ],
)
def test_a_tree_of_gradient_boosting_with_an_index_outside_its_arrays_is_refused(files, tmp_path, key, value, sentence):
    archive = Archive(files["gradient_boosting"])
    nodes = archive.array("nodes")
    assert not nodes["is_leaf"][0]
    nodes[key][0] = value
    archive.put("nodes", nodes)
    assert f"nodes has {sentence}" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize(
    "key",
    ["support_", "support_vectors_", "_n_support", "dual_coef_", "_dual_coef_", "intercept_", "_intercept_", "_probA"],
)
@pytest.mark.parametrize(
    "change", [lambda a: a[:-1], lambda a: np.concatenate([a, a]), lambda a: a.T[None], lambda a: a[..., :1]]
)
def test_a_support_vector_machine_with_arrays_of_other_sizes_is_refused(files, tmp_path, key, change):
    archive = Archive(files["svm"])
    archive.put(key, np.zeros(3) if key == "_probA" else change(archive.array(key)))
    assert "estimator.steps[2][1]" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize("counts", [[-1, 1, 0], [2**31 - 1, 2**31 - 1, 2], [0, 0, 0], [1, 1, 1]])
def test_a_support_vector_machine_that_miscounts_its_vectors_is_refused(files, tmp_path, counts):
    archive = Archive(files["svm"])
    archive.put("_n_support", np.array(counts, dtype=np.int32))
    assert "estimator.steps[2][1]" in refusal(archive.write(tmp_path / "m"))


CALIBRATION = UNCALIBRATED.model_dump()
WRONG_FIELDS = [
    ("name", ["svm"], "name: "),
    ("name", "forest", "'forest' is no baseline; the baselines are majority"),
    ("name", "svm", "estimator"),
    ("classes", [0, 1, 2], "classes"),
    ("classes", (0, 1, 2), "classes"),
    ("classes", ("healthy", "healthy", "inner"), "two names are the same"),
    ("classes", ("healthy", "cracked"), "classes"),
    ("classes", ("inner", "healthy", "outer"), "classes are not those"),
    ("classes", ("healthy",), "classes"),
    ("classes", (), "classes"),
    ("features", NAMES[:-1], "estimator"),
    ("features", NAMES[::-1], "estimator"),
    ("features", "abcdef", "features"),
    ("features", (1, 2, 3, 4, 5, 6), "features"),
    ("groups", 5, "groups"),
    ("band", (5.0,), "band"),
    ("band", (300.0, 1e9), "band[1]"),
    ("corpus", None, "corpus"),
    ("corpus", "\ud800", "corpus: "),
    ("groups", ("\ud800",), "groups[0]: "),
    ("records", "24", "records"),
    ("records", True, "records"),
    ("records", 10**12, "digests must be 1000000000000 of 64 bits"),
    ("seed", -1, "seed"),
    ("seed", 2.5, "seed"),
    ("seed", 1, "random_state is 0 and must be 1"),
    ("widths", {"cracked": ((1e-3, 1e-3),)}, "widths"),
    ("widths", {"inner": ((-1e-3, 1e-3),)}, "widths"),
    ("widths", {"inner": ((1e-3, float("nan")),)}, "widths"),
    ("widths", {"inner": ()}, "widths"),
    ("widths", {"inner": ((1e-3,),)}, "widths"),
    ("digests", "none", "digests"),
    ("digests", np.zeros(24), "digests"),
    ("digests", np.zeros(3, dtype=np.uint64), "digests"),
    ("versions", {"numpy": 2}, "versions"),
    ("versions", {"scikit-learn": "0.1"}, "was trained with scikit-learn 0.1, and "),
    ("calibration", None, "calibration"),
    ("calibration", {}, "calibration.by"),
    *(
        ("calibration", CALIBRATION | change, f"calibration.{next(iter(change))}")
        for change in (
            {"by": "shelf"},
            {"temperature": 0.0},
            {"temperature": 1e-320},
            {"temperature": float("nan")},
            {"temperature": "1"},
            {"dependence": -0.1},
            {"threshold": 1.5},
            {"threshold": float("inf")},
            {"recording_threshold": None},
            {"coverage": True},
            {"code": "print"},
        )
    ),
    ("raceway_model", [1], "not a model of this version"),
    ("estimator", 5, "estimator"),
]


@pytest.mark.parametrize(("name", "value", "sentence"), WRONG_FIELDS)
def test_a_field_of_another_type_is_refused(files, tmp_path, name, value, sentence):
    archive = Archive(files["logistic_regression"])
    (tmp_path / "other").write_bytes(pack({"value": value}))
    other = Archive(tmp_path / "other")
    state = json.loads(json.dumps(other.field("value")))
    if "file" in state:
        archive.members["999.npy"] = other.members[state["file"]]
        state["file"] = "999.npy"
    archive.schema["content"][name] = state
    assert sentence in refusal(archive.write(tmp_path / "m"))


def some_states(folder: Path) -> list[dict]:
    """One state of each simple kind, of values that no estimator learns."""
    values = {
        "a": "text",
        "b": None,
        "c": [],
        "d": (),
        "e": {},
        "f": np.zeros(0, dtype="<c16"),
        "g": [None],
        "h": np.array([None]),
    }
    (folder / "simple").write_bytes(pack(values))
    archive = Archive(folder / "simple")
    found = [archive.field(key) for key in values]
    return [*(state for state in found if "file" not in state), *archive.places("key_types")[0]["content"]]


@pytest.mark.parametrize("attribute", [*LEARNED, *LISTS])
def test_a_learned_attribute_of_another_type_is_refused(files, tmp_path, attribute):
    owner, _, name = attribute.partition(".")
    path = next(path for path in files.values() if any(name in held for held in Archive(path).objects(owner)))
    for state in some_states(tmp_path):
        archive = Archive(path)
        held = [held for held in archive.objects(owner) if name in held]
        held[-1][name] = state  # the first may be of an estimator that is not fitted
        assert name in refusal(archive.write(tmp_path / "m"))


def test_an_envelope_rule_without_the_features_that_it_needs_is_refused(files, tmp_path):
    archive = Archive(files["envelope_rule"])
    archive.field("features")["content"] = archive.field("features")["content"][1:]
    assert "features are not those of envelope_rule" in refusal(archive.write(tmp_path / "m"))


def test_a_setting_of_another_version_is_refused(files, tmp_path):
    archive = Archive(files["svm"])
    archive.places("kernel")[0]["content"] = '"precomputed"'
    assert 'steps[2][1].kernel is "precomputed" and must be "rbf"' in refusal(archive.write(tmp_path / "m"))


def test_an_attribute_that_hides_a_method_is_refused(files, tmp_path):
    archive = Archive(files["logistic_regression"])
    attributes = archive.field("estimator")["content"]["content"]
    attributes["predict_proba"] = {
        "__class__": "str",
        "__module__": "builtins",
        "__loader__": "JsonNode",
        "content": "1",
        "is_json": True,
    }
    assert "has other attributes (predict_proba)" in refusal(archive.write(tmp_path / "m"))


def test_an_object_with_the_number_of_another_is_still_read_by_its_content(files, tmp_path):
    archive = Archive(files["svm"])
    corpus, name = archive.field("corpus"), archive.field("name")
    corpus["__id__"] = name["__id__"] = archive.field("features")["__id__"]
    loaded = load_model(archive.write(tmp_path / "m"))
    assert (loaded.corpus, loaded.name, loaded.features) == ("a made-up corpus", "svm", NAMES)


def test_objects_that_double_at_each_level_are_refused(files, tmp_path):
    archive = Archive(files["majority"])
    item = {"__class__": "list", "__module__": "builtins", "__loader__": "ListNode", "__id__": 10**6, "content": []}
    for number in range(10**6 + 1, 10**6 + 60):
        content = [item, {"__id__": number - 1}]
        item = {
            "__class__": "list",
            "__module__": "builtins",
            "__loader__": "ListNode",
            "__id__": number,
            "content": content,
        }
    archive.schema["content"]["corpus"] = item
    assert "raceway --limit model_objects=NUMBER" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize(
    ("key", "content"),
    [
        ("corpus", 5),
        ("corpus", "half a word"),
        ("corpus", "[1]"),
        ("features", {}),
        ("features", [3]),
        ("versions", []),
    ],
)
def test_an_object_with_content_of_another_form_is_refused(files, tmp_path, key, content):
    archive = Archive(files["majority"])
    archive.field(key)["content"] = content
    assert "not a readable model" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize("name", ["coef_", "_dual_coef_"])
def test_an_array_with_its_axes_in_the_wrong_order_is_refused(files, tmp_path, name):
    archive = Archive(files["svm" if name == "_dual_coef_" else "logistic_regression"])
    array = archive.array(name)
    archive.put(name, np.array(array, order="F" if array.flags.c_contiguous else "C"))
    assert f"{name} has its axes in the wrong order" in refusal(archive.write(tmp_path / "m"))


def test_deeply_nested_objects_are_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "m", "w") as archive:
        archive.writestr("schema.json", "[" * 100_000)
    assert "not a readable model" in refusal(tmp_path / "m")


@pytest.mark.parametrize("shape", [(2**40,), (2**62, 4), (-1, -24), (23,), (25,), ()])
def test_an_array_of_another_size_than_its_header_says_is_refused(files, tmp_path, shape):
    archive = Archive(files["majority"])
    member = archive.field("digests")["file"]
    header = f"{{'descr': '<u8', 'fortran_order': False, 'shape': {shape}}}\n".encode()
    data = archive.members[member][-24 * 8 :]
    archive.members[member] = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + data
    assert "not a readable model (an array of" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize("descr", ["|O", "<M8[s]", "|V0", "<U40", "nonsense"])
def test_an_array_of_another_type_is_refused(files, tmp_path, descr):
    archive = Archive(files["majority"])
    member = archive.field("digests")["file"]
    header = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': (24,)}}\n".encode()
    data = bytes(24 * (160 if descr == "<U40" else 8 if descr != "|V0" else 0))
    archive.members[member] = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + data
    assert refusal(archive.write(tmp_path / "m"))


def test_a_compressed_member_is_refused_before_it_is_unpacked(files, tmp_path):
    archive = Archive(files["majority"])
    archive.members = {"999.npy": bytes(10**7), **archive.members}
    assert "999.npy is compressed" in refusal(archive.write(tmp_path / "m", zipfile.ZIP_DEFLATED))


def test_unknown_and_duplicate_members_are_refused(files, tmp_path):
    archive = Archive(files["majority"])
    archive.members["../../x.npy"] = b""
    assert "'../../x.npy' is no member of a model" in refusal(archive.write(tmp_path / "m"))
    path = tmp_path / "double"
    path.write_bytes(files["majority"].read_bytes())
    with zipfile.ZipFile(path, "a") as made, pytest.warns(UserWarning, match="Duplicate name"):
        made.writestr("schema.json", "{}")
    assert "two members have the same name" in refusal(path)


@pytest.mark.parametrize(
    "limit", ["file_bytes=5000", "schema_bytes=1000", "model_objects=10", "model_features=5", "model_nodes=10"]
)
def test_a_model_larger_than_a_limit_is_refused(files, monkeypatch, limit):
    monkeypatch.setenv("RACEWAY_LIMITS", limit)
    assert f"raceway --limit {limit.partition('=')[0]}=NUMBER" in refusal(files["extra_trees"])


def test_a_folder_is_no_model(tmp_path):
    assert "not a file" in refusal(tmp_path)


def test_a_model_that_fails_on_the_tested_records_is_refused(files, tmp_path):
    archive = Archive(files["logistic_regression"])
    archive.put("scale_", np.full(len(NAMES), 1e-300))
    path = archive.write(tmp_path / "m")
    table = make_table()
    with pytest.raises(CorpusError, match="logistic_regression cannot classify these records"):
        evaluate(table.assign(features=table.features * 1e30), load_model(path))


def test_probabilities_that_are_not_finite_are_refused(files, tmp_path):
    archive = Archive(files["random_forest"])
    for place in archive.places("values"):
        archive.put(place, np.full_like(archive.array(place), 1.7e308))
    assert "gives probabilities that are not finite" in refusal(archive.write(tmp_path / "m"))
