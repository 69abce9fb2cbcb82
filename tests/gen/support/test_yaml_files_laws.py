"""YAML from a stranger: reading is never slow and needs little memory; types beyond the few plain ones are refused with their line."""

import io
import os
import subprocess
import sys
import time

import pytest
from hypothesis import example, given, reject, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from gen.recipe import read_recipe
from gen.support.errors import CorpusError, RecipeError
from gen.support.limits import VARIABLE
from gen.support.yaml_files import read_yaml
from raceway.importing.label_tables import keys_of_yaml

LAYERS = range(1, 12)
LAUGHS = [
    "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]",
    *(f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in LAYERS),
]
MERGES = ["a0: &a0 {k: 1}", *(f"a{n}: &a{n} {{<<: [{', '.join([f'*a{n - 1}'] * 10)}]}}" for n in LAYERS)]

REFUSED = {
    "recursive_list": ("a: &a [*a, *a]", "line 1: is not valid YAML (*a is inside the value that it repeats)"),
    "recursive_merge": ("a: &a {<<: *a}", "line 1: is not valid YAML (*a is inside the value that it repeats)"),
    "unknown_alias": ("a: *b", "line 1: is not valid YAML (found undefined alias 'b')"),
    "aliases_of_aliases": ("\n".join(LAUGHS), "up to line 5, with aliases expanded, holds 23460 values, and the"),
    "merges_of_merges": ("\n".join(MERGES), "up to line 5, with aliases expanded, holds "),
    "long_list": ("a: [" + "1," * 400_000 + "]", "up to line 1, with aliases expanded, holds 20001 values, and the"),
    "deep_list": ("a: " + "[" * 100_000, "line 1: is not valid YAML (more than 50 levels deep)"),
    "deep_by_aliases": (
        "\n".join(["a0: &a0 [1]", *(f"a{n}: &a{n} [*a{n - 1}]" for n in range(1, 1000))]),
        "up to line 198, with aliases expanded, holds 20096 values, and the limit is 20000",
    ),
    "long_integer": ("a: " + "9" * 5000, "line 1: is not valid YAML (a number of 5000 characters"),
    "long_tag": ("a: !" + "b" * 900_000 + " 1", "is not valid YAML (a tag of more than 500 characters)"),
    "half_a_character": ('a: 1\nb: "\\ud800"', "line 2: is not valid YAML (a lone surrogate"),
    "character_beyond_unicode": ('a: "\\UFFFFFFFF"', "is not valid YAML ("),
    "key_twice": ("a: 1\nb: 2\na: 3", "line 3: is not valid YAML (while constructing a mapping found duplicate key"),
    "merge_twice": ("a: &a {k: 1}\nb: {<<: *a, <<: *a}", "line 2: is not valid YAML (while constructing a mapping"),
    "merge_of_a_number": ("b: {<<: 1}", "line 1: is not valid YAML (while constructing a mapping expected a"),
    "list_as_key": ("{[1]: 2}", "line 1: is not valid YAML (a key must be one word, not a list or mapping)"),
    "tag_of_python": ("a: !!python/name:os.system b", "line 1: is not valid YAML (the tag"),
    "tag_that_does_not_fit": ("a: !!int wide", "line 1: is not valid YAML (wide is no number)"),
    "number_of_underscores": ("a: 0x_", "line 1: is not valid YAML (0x_ is no number)"),
    "older_yaml": ("%YAML 1.1\n---\na: yes", "is not valid YAML (only YAML 1.2 is read)"),
    "two_documents": ("a: 1\n---\nb: 1", "line 2: is not valid YAML (expected a single document"),
}


def refusal(tmp_path, text):
    path = tmp_path / "odd.yaml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    with pytest.raises(RecipeError) as refused:
        read_yaml(path, RecipeError)
    assert "\n" not in str(refused.value)
    assert str(refused.value).startswith(f"{path}: ")
    return str(refused.value).removeprefix(f"{path}: ")


def value(tmp_path, text):
    path = tmp_path / "value.yaml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_yaml(path, RecipeError)


@pytest.mark.parametrize(("text", "sentence"), REFUSED.values(), ids=REFUSED)
def test_what_swells_or_is_of_no_plain_type_is_refused_within_seconds(tmp_path, text, sentence):
    start = time.process_time()
    assert refusal(tmp_path, text).startswith(sentence)
    assert time.process_time() - start < 5  # each took 20 s or more, or all memory, or was an error of another type


@pytest.mark.parametrize("read", [read_recipe, keys_of_yaml])
@pytest.mark.parametrize(
    "name", ["aliases_of_aliases", "merges_of_merges", "recursive_list", "long_integer", "half_a_character"]
)
def test_recipes_and_common_keys_of_labels_are_read_alike(tmp_path, read, name):
    path = tmp_path / "odd.yaml"
    path.write_text(REFUSED[name][0])
    with pytest.raises(RecipeError if read is read_recipe else CorpusError) as refused:
        read(path)
    assert REFUSED[name][1] in str(refused.value)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[null, ~, True, FALSE]", [None, None, True, False]),
        ("[1, -1_000, 0o17, 0x1F, 0b11, +7, 007]", [1, -1000, 15, 31, 3, 7, 7]),
        ("[1e-6, 2e9, .5, -1.5E+3, 1_0.5]", [1e-6, 2e9, 0.5, -1500.0, 10.5]),
        ("[.inf, -.INF, 1e999]", [float("inf"), float("-inf"), float("inf")]),
        ("[yes, no, on, 1:30, 2001-99-99, 2001-01-01, '=', 0b2]",
         ["yes", "no", "on", "1:30", "2001-99-99", "2001-01-01", "=", "0b2"]),
        ("['1', \"2\", !!str 3, !!float 4, !!int 5]", ["1", "2", "3", 4.0, 5]),
        ("{a: &a {x: 1, y: 2}, b: {<<: *a, y: 3}, c: {'<<': 4}}",
         {"a": {"x": 1, "y": 2}, "b": {"x": 1, "y": 3}, "c": {"<<": 4}}),
        ("{a: &a {x: 1}, b: &b {x: 2, y: 2}, c: {<<: [*a, *b]}}",
         {"a": {"x": 1}, "b": {"x": 2, "y": 2}, "c": {"x": 1, "y": 2}}),
        ("a:\nb: 1", {"a": None, "b": 1}),
        ("", None),
        ("# nothing but a comment\n", None),
        ("\ufeffa: 1\r\n", {"a": 1}),
        ("a: ü".encode("utf-16"), {"a": "ü"}),
    ],
)  # fmt: skip
def test_plain_values_are_those_of_yaml_1_2(tmp_path, text, expected):
    read = value(tmp_path, text)
    assert read == expected
    assert repr(read) == repr(expected)


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**64), 2**64) | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text() | st.integers(0, 9), inner),
    max_leaves=12,
)


@settings(max_examples=60)
@given(VALUES)
@example({":0": None})
def test_what_is_written_is_read_again(tmp_path_factory, data):
    stream = io.StringIO()
    YAML(typ="safe", pure=True).dump(data, stream)
    path = tmp_path_factory.mktemp("yaml") / "value.yaml"
    path.write_text(stream.getvalue(), encoding="utf-8")
    try:
        expected = YAML(typ="safe", pure=True).load(stream.getvalue())
    except YAMLError:  # ruamel.yaml writes the key ":0" in a way that it cannot read
        reject()
    assert repr(read_yaml(path, RecipeError)) == repr(expected)


def test_the_limits_are_the_users_to_raise(tmp_path, monkeypatch):
    text = "[" + "1," * 2500 + "]"
    monkeypatch.setenv(VARIABLE, "yaml_values=2000")
    assert "raise it with raceway --limit yaml_values=NUMBER" in refusal(tmp_path, text)
    monkeypatch.setenv(VARIABLE, "yaml_values=3000")
    assert len(value(tmp_path, text)) == 2500
    monkeypatch.setenv(VARIABLE, "yaml_bytes=100")
    assert refusal(tmp_path, text).startswith("is 5002 bytes, and the limit is 100;")


def test_pipes_devices_and_folders_are_refused_and_never_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.yaml")
    for path in (tmp_path / "pipe.yaml", tmp_path, "/dev/zero", "/dev/tty"):
        with pytest.raises(RecipeError, match="cannot be read"):
            read_yaml(type(tmp_path)(path), RecipeError)


def test_a_recursive_alias_takes_no_memory(tmp_path):
    """In a separate process with limited memory."""
    path = tmp_path / "recursive.yaml"
    path.write_text("a: &a [*a, *a]\n")
    code = (
        "import resource, sys; from pathlib import Path\n"
        "from gen.support.errors import RecipeError; from gen.support.yaml_files import read_yaml\n"
        "resource.setrlimit(resource.RLIMIT_AS, (4_000_000_000,) * 2)\n"
        "try: read_yaml(Path(sys.argv[1]), RecipeError)\n"
        "except RecipeError: print('refused')\n"
    )
    done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout == "refused\n", done.stderr
