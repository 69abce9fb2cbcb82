"""Checkers of others: CF-1.11 and ACDD-1.3 on a simulated and an imported corpus, and mlcroissant on ``croissant.json``."""

import json
import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from gen.corpus import open_corpus, read_manifest, sha256, validate_corpus
from gen.generation.corpus import generate
from raceway import describe, publish
from raceway.importing import import_generic
from raceway.sharing.card.card_page import card_folder
from raceway.sharing.publication import read_publication
from tests.labels import write_labels

FACTS = {
    "license": "CC-BY-4.0",
    "creators": [{"name": "Jane Doe", "orcid": "0000-0002-1825-0097"}],
    "institution": "Example Institute",
    "contact": "jane@example.org",
    "references": ["Doe, On bearings, 2026"],
    "date": "2026-03-31",
}
NOT_ON_EARTH = {
    *(f"geospatial_{name}" for name in ("bounds", "lat_min", "lat_max", "lon_min", "lon_max", "bounds_crs")),
    *(f"geospatial_{name}" for name in ("vertical_min", "vertical_max", "vertical_positive", "bounds_vertical_crs")),
}
NO_CALENDAR = {f"time_coverage_{name}" for name in ("start", "end", "duration", "resolution")}
UNKNOWN = {"standard_name_vocabulary", "comment", "acknowledgment/acknowledgement", "project", "publisher_url"}
OF_THE_WHOLE = {
    "keywords", "summary", "creator_name", "creator_url", "creator_email", "id", "institution", "license",
    "naming_authority", "processing_level", "publisher_name", "publisher_email",
}  # fmt: skip


@pytest.fixture(scope="module")
def simulated(write_recipe, tmp_path_factory):
    folder = tmp_path_factory.mktemp("simulated")
    made = generate(write_recipe(folder / "small.yaml"), folder / "corpus", records=8).path
    publish(made, FACTS)
    return made


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    folder = tmp_path_factory.mktemp("imported")
    np.save(folder / "one.npy", np.random.default_rng(0).normal(size=3000).astype(np.float32))
    row = {"path": "one.npy", "fault": "inner", "specimen": "a", "shaft_rpm": 1500}
    write_labels(folder, [row], bearing="6205", unit="g", sample_rate_hz=1000)
    return publish_import(folder, "corpus")


@pytest.fixture(scope="module")
def single(imported):
    """The imported corpus in a single file."""
    path = publish_import(imported.parent, "corpus.nc")
    describe(path)
    return path


def publish_import(folder, name):
    done = import_generic(folder / "labels.csv", folder / name, window=0.5)
    publish(done.path, read_publication(FACTS))
    return done.path


@pytest.fixture(scope="module")
def checked(simulated, imported, single, tmp_path_factory):
    """Messages about each file, as {file: {checker: [(heading, text)]}}.

    The time grows with the square of the number of variables, 3 s for those of a simulation, so that its parts are left out; the
    validation compares them with the index.
    """
    files = [simulated / "index.nc", imported / "index.nc", imported / "parts" / "part-00000.nc", single]
    result = tmp_path_factory.mktemp("checked") / "found.json"
    checker = Path(sys.executable).with_name("compliance-checker")
    if not checker.exists():
        pytest.skip("compliance-checker is not installed")
    command = [checker, "-f", "json_new", "-o", result, "--test", "cf:1.11", "--test", "acdd:1.3", *files]
    subprocess.run(command, check=False, capture_output=True)
    found = json.loads(result.read_text())
    return {
        path: {
            checker: [(row["name"], text) for row in rows["all_priorities"] for text in row["msgs"]]
            for checker, rows in found[str(path)].items()
        }
        for path in files
    }


def test_no_file_breaks_the_rules_of_cf(checked):
    assert [found["cf:1.11"] for found in checked.values()] == [[]] * 4


def test_all_attributes_of_acdd_that_apply_are_there(checked):
    """No CF standard name fits a vibration or a label, and a bearing has no place on Earth. A part does not tell who made the corpus."""
    for path, found in checked.items():
        part = path.parent.name == "parts"
        with xr.open_dataset(path, decode_times=False) as dataset:
            found_variables = dataset.data_vars.items()
            numbers = {n for n, v in found_variables if v.dtype.kind in "iuf" and "flag_values" not in v.attrs}
        of_whole = OF_THE_WHOLE if part else set()
        expected = {
            *((f'variable "{name}" missing the following attributes:', "standard_name") for name in numbers),
            *(("Global Attributes", f"{name} not present") for name in NOT_ON_EARTH | NO_CALENDAR | UNKNOWN | of_whole),
            *((f"geospatial_{axis}_extents_match", "") for axis in ("lat", "lon")),
            *([("date_created_is_iso", "Attr date_created is not present")] if part else []),
        }
        assert {(name, "" if name.endswith("match") else text) for name, text in found["acdd:1.3"]} == expected


def loaded(corpus):
    """``croissant.json`` as mlcroissant reads it, and its complaints."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mlcroissant = pytest.importorskip("mlcroissant", reason="mlcroissant is not installed")
        dataset = mlcroissant.Dataset(card_folder(corpus) / "croissant.json")
    return dataset, dataset.metadata.issues


@pytest.mark.parametrize("origin", ["simulated", "imported", "single"])
def test_mlcroissant_finds_no_fault_in_a_published_corpus(origin, request):
    path = request.getfixturevalue(origin)
    dataset, issues = loaded(path)
    assert (set(issues.errors), set(issues.warnings)) == (set(), set())
    files = {file.content_url: file.sha256 for file in dataset.metadata.distribution if file.id != "parts"}
    parts = {f"parts/{row.name}" for row in read_manifest(path).parts}
    whole = {"index.nc", "manifest.json"} | ({"recipe.yaml"} if origin == "simulated" else set())
    assert files.keys() == ({path.name} if path.is_file() else parts | whole)
    place = path.parent if path.is_file() else path
    assert all(sha256(place / name) == digest for name, digest in files.items())
    fields = {field.name for group in dataset.metadata.record_sets if group.id == "records" for field in group.fields}
    with open_corpus(path) as corpus:
        assert fields == {name for name, variable in corpus.variables.items() if "role" in variable.attrs}
    assert "Jane Doe" in dataset.metadata.cite_as
    assert validate_corpus(path) == []


def test_without_a_publication_croissant_lacks_licence_and_date_alone(imported, tmp_path):
    folder = tmp_path / "corpus"
    shutil.copytree(imported, folder)
    publish(folder, read_publication({}))
    _, issues = loaded(folder)
    assert set(issues.errors) == set()
    assert sorted(name for name in ("license", "datePublished", "citeAs", "version") if any(name in text for text in issues.warnings)) == [
        "datePublished", "license",
    ]  # fmt: skip
