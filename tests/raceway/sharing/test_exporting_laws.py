"""Laws of copies in other forms: the own reader of each form finds the signals, the labels and the units of the corpus."""

import json
import os
import re
import subprocess
import sys

import netCDF4
import numpy as np
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML

import raceway
from gen.corpus import FAULTS, SIGNAL, new_corpus, open_corpus
from gen.support.errors import CorpusError
from raceway import publish
from raceway.sharing import FORMS
from raceway.sharing.form_columns import plain_names
from raceway.sharing.publication import Publication
from tests.corpora import dataset, write_corpus, write_parts
from tests.same_corpora import files


@pytest.fixture(scope="module")
def floats(tmp_path_factory):
    folder = tmp_path_factory.mktemp("float32") / "corpus"
    write_corpus(folder, kind="float32")
    return folder


@pytest.fixture(scope="module")
def counts(nine):
    return nine / "c"


@pytest.fixture(params=["counts", "floats"])
def corpus(request):
    return request.getfixturevalue(request.param)


def opened(folder):
    with open_corpus(folder) as corpus:
        return corpus.load()


def stored(corpus):
    """Acceleration in single precision, shape (record, channel, elapsed_time)."""
    return corpus[SIGNAL].values.astype(np.float32)


def fault_names(corpus):
    return corpus["fault_name"].values.tolist()


def lines_on_reading(folder):
    """The indented lines of README.md: how to read the files, from within their folder."""
    page = (folder / "README.md").read_text(encoding="utf-8").rpartition("---\n")[2]
    return "\n".join(line[4:] for line in page.splitlines() if line.startswith("    "))


def test_parquet_gives_back_every_record_with_units(corpus, tmp_path):
    made = raceway.copy(corpus, tmp_path / "out.parquet")
    assert (made.form, made.records, made.channels) == ("parquet", 9, ("a", "b"))
    table, expected = pq.read_table(tmp_path / "out.parquet"), opened(corpus)
    for place, name in enumerate("ab"):
        found = np.stack(table[f"acceleration_{name}"].to_numpy())
        np.testing.assert_array_equal(found, stored(expected)[:, place])
    np.testing.assert_array_equal(table["width"].to_numpy(), expected["width"].values)
    assert table["fault"].to_pylist() == fault_names(expected)
    assert table["draws"].to_pylist() == expected["draws"].values.tolist()
    assert table.schema.field("width").metadata[b"units"] == b"m"
    assert table.schema.field("acceleration_a").metadata[b"units"] == b"m s-2"
    assert table.schema.metadata[b"title"] == b"A corpus"
    assert b"comment" not in table.schema.metadata  # it is about corpus.nc


def test_hugging_face_loads_the_folder_without_a_network(counts, tmp_path, monkeypatch):
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    raceway.copy(counts, tmp_path / "out", to="huggingface")
    code = (
        f"{lines_on_reading(tmp_path / 'out')}\nimport json; part = records['test']; one = part.with_format('numpy')[:]\n"
        "print(json.dumps([{name: len(part) for name, part in records.items()}, name, "
        "part.features['fault'].int2str(one['fault'].tolist()), signal.tolist(), one['acceleration_b'].tolist()]))"
    )
    environment = os.environ | {"HF_HOME": str(tmp_path / "cache"), "HF_DATASETS_DISABLE_PROGRESS_BARS": "1"}
    pytest.importorskip("datasets")
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path / "out", env=environment, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    assert "dataset card" not in run.stderr  # it warns of a header that it cannot use
    sizes, first_name, names, first_signal, signal = json.loads(run.stdout)
    expected = opened(counts)
    test = expected["split"].values == 2
    assert sizes == {"train": 3, "validation": 3, "test": 3}
    assert names == np.array(fault_names(expected))[test].tolist()
    np.testing.assert_array_equal(np.array(signal, np.float32), stored(expected)[test, 1])
    np.testing.assert_array_equal(np.array(first_signal, np.float32), stored(expected)[0, 0])
    assert first_name == fault_names(expected)[0]


@pytest.mark.parametrize("to", FORMS)
def test_a_choice_has_the_same_records_and_channels_and_the_same_bytes_each_time(counts, tmp_path, monkeypatch, to):
    choice = {"to": to, "where": "fault in ('inner', 'outer')", "split": "test", "channels": ["b"]}
    made = raceway.copy(counts, tmp_path / "out", **choice)
    assert (made.records, made.channels) == (2, ("b",))
    assert (made.files, made.bytes) == (len(files(tmp_path / "out")), sum(map(len, files(tmp_path / "out").values())))
    assert "2 of 9 records" in (tmp_path / "out/README.md").read_text()
    monkeypatch.setattr("time.time", lambda: 0.0)
    raceway.copy(counts, tmp_path / "again", **choice)
    assert files(tmp_path / "out") == files(tmp_path / "again")


def test_a_single_file_gives_the_same_bytes_as_its_folder(counts, tmp_path):
    raceway.copy(counts, tmp_path / "one.nc")
    raceway.copy(tmp_path / "one.nc", tmp_path / "folder")
    for source in ("folder", "one.nc"):
        raceway.copy(tmp_path / source, tmp_path / f"{source}.parquet")
    assert (tmp_path / "folder.parquet").read_bytes() == (tmp_path / "one.nc.parquet").read_bytes()


def test_licence_and_creators_go_along(tmp_path):
    write_corpus(tmp_path / "c", (3,))
    publish(tmp_path / "c", Publication(license="CC-BY-4.0", creators=[{"name": "Jane Doe"}]))
    for to in FORMS:
        raceway.copy(tmp_path / "c", tmp_path / to, to=to)
        page = (tmp_path / to / "README.md").read_text()
        assert "Licence: CC-BY-4.0" in page
        assert "Creators: Jane Doe" in page
    assert 'license: "cc-by-4.0"' in page


def test_texts_of_strangers_stay_texts(tmp_path):
    folder, wicked = tmp_path / "corpus", '=HYPERLINK("http://x")\n- a: [b'
    part = dataset(0, 3, channels=("../../x", "=1"))
    part["bearing"] = ("record", [wicked, "+1", "-2"], part["bearing"].attrs)
    part["a=1 or b"] = ("record", np.arange(3.0), {"units": "@x", "role": "latent", "long_name": "=1+1"})
    with new_corpus(folder, title='a"\n---\nlicense: mit # \x1b[2J') as corpus:
        corpus.write(part)
    for to in FORMS:
        raceway.copy(folder, tmp_path / to, to=to)
        assert all(re.fullmatch(r"[\w./-]+", name) and ".." not in name for name in map(str, files(tmp_path / to)))
    header = (tmp_path / "huggingface/README.md").read_text().split("---\n")[1]
    facts = YAML(typ="safe").load(header)
    assert "license" not in facts
    assert facts["pretty_name"].startswith('a" --- license: mit')
    assert wicked in pq.read_table(tmp_path / "huggingface/data")["bearing"].to_pylist()


def test_a_class_has_the_same_code_in_hugging_face_and_netcdf_whatever_records_are_chosen(counts, tmp_path):
    raceway.copy(counts, tmp_path / "out", to="huggingface", where="fault in ('healthy', 'outer')")
    header = (tmp_path / "out/README.md").read_text().split("---\n")[1]
    features = YAML(typ="safe").load(header)["dataset_info"]["features"]
    labels = {of["name"]: of["dtype"]["class_label"]["names"] for of in features if "class_label" in str(of)}
    assert {"fault", "split"} <= labels.keys()
    raceway.copy(counts, tmp_path / "out.nc", where="fault in ('healthy', 'outer')")
    with netCDF4.Dataset(tmp_path / "out.nc") as file:
        for name, classes in labels.items():
            stored_classes = dict(zip(file[name].flag_values.tolist(), file[name].flag_meanings.split(), strict=True))
            stored_classes.pop(127, None)
            assert {int(code): text for code, text in classes.items()} == stored_classes


def test_hugging_face_has_unknown_behind_the_classes_where_records_are_unknown(tmp_path):
    part = dataset(0, 3)
    part["fault"] = ("record", np.array([1, 127, 5], np.int8), part["fault"].attrs)
    part["split"] = ("record", np.zeros(3, np.int8), part["split"].attrs)
    write_parts(tmp_path / "c", [part])
    raceway.copy(tmp_path / "c", tmp_path / "out", to="huggingface")
    assert pq.read_table(tmp_path / "out/data")["fault"].to_pylist() == ["inner", "unknown", "compound"]
    card = (tmp_path / "out/README.md").read_text()
    names = dict(enumerate([*FAULTS[:6], "unknown"]))
    assert json.dumps({"class_label": {"names": names}}) in card


@pytest.mark.parametrize(
    ("name", "to", "sentence"),
    [
        (
            "out",
            "xls",
            r"to: there is no form 'xls'; allowed is huggingface; docs/sharing.md writes CSV",
        ),
        ("a.mat", None, "a.mat: no corpus is a .mat file; .* ends in .nc, which MATLAB, R, Julia and Octave read"),
        ("a.CSV", "huggingface", "no corpus is a .CSV file; .*docs/sharing.md writes CSV, Zarr and Parquet"),
        ("a.nc", "huggingface", "nc is one file, and to='huggingface' makes a folder; leave one of the two out"),
        ("a.parquet", None, "parquet: needs pyarrow; pip install pyarrow, or"),
    ],
)
def test_refusals_are_one_sentence(counts, tmp_path, monkeypatch, name, to, sentence):
    monkeypatch.setattr("raceway.sharing.forms.find_spec", lambda _: None)
    with pytest.raises(CorpusError, match=sentence):
        raceway.copy(counts, tmp_path / name, to=to)
    assert not list(tmp_path.iterdir())


@given(st.lists(st.text()))
def test_plain_names_are_safe_and_all_different(names):
    found = plain_names(names, ["record"])
    assert all(re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,60}", name) for name in found)
    assert len({name.lower() for name in [*found, "record"]}) == len(names) + 1
