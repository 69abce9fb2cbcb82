"""No command writes over its input, into a corpus, or over a file that it did not make; an earlier result is replaced."""

import shutil
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

from features.baselines import Model
from gen import generate, write_corpus
from gen.corpus import corpus_files, result_folder
from gen.corpus.disk import _HOST, remove_unfinished
from gen.recipe import Recipe
from gen.support.errors import CorpusError
from raceway import copy
from raceway.importing.published import published_sets
from raceway.sharing.card.card_page import card_folder
from tests.command_tree import COMMANDS
from tests.conftest import small_with
from tests.pulses import write_pulses
from tests.recipes import LIVES
from tests.same_corpora import files

# every command with -o by the line that comes before it, and the name of its result; a folder has no suffix
RESULTS = {
    "features {corpus}": "result.nc",
    "features {corpus} --band 300 5000": "result.parquet",
    "train {corpus} --estimator majority": "result.skops",
    "plot {corpus} --record 1": "result.png",
    "explore {corpus}": "result.html",
    "life {lives}": "result.png",
    "limit {sized} --workers 1": "result.png",
    "diagnose {recording} --bearing 6205 --rpm 1500 --rate 12000 --unit g --model {model}": "result.html",
    "replay {corpus} --record 1": "record.nc",
    "benchmark {corpus}": "report",
    "compare {corpus} {corpus}": "report",
    "generate {recipe}": "new",
    "imitate {recording} --bearing 6205 --rpm 1500 --rate 12000 --unit g": "result.yaml",
    "import generic {raw}": "new",
    **{f"import {name} {{raw}}": "new" for name in published_sets()},
    "copy {corpus}": "new",
}


@pytest.fixture(scope="module")
def originals(tiny_recipe, tmp_path_factory):
    """A corpus of eight records, and files of other kinds."""
    folder = tmp_path_factory.mktemp("originals")
    corpus = write_pulses(folder / "corpus", records=2, identity=[f"pulses/0/{n}/{n}/-1" for n in range(8)])
    generate(Recipe(small_with(LIVES | {"corpus": LIVES["corpus"] | {"rigs": 1}})), folder / "lives")
    width = np.append(np.zeros(20), np.geomspace(0.1e-3, 1e-3, 20))
    write_pulses(folder / "sized", classes=("healthy", "outer"), records=20, duration=0.2, width=width)
    shutil.copy(tiny_recipe, folder / "recipe.yaml")
    Model("majority").fit(corpus).save(folder / "model.skops")
    np.save(folder / "recording.npy", np.random.default_rng(0).standard_normal(12_000))
    (folder / "raw").mkdir()
    return folder


@pytest.fixture
def places(originals, tmp_path):
    shutil.copytree(originals, tmp_path, dirs_exist_ok=True)
    names = {
        "recording": "recording.npy",
        "recipe": "recipe.yaml",
        "raw": "raw",
        "model": "model.skops",
        "lives": "lives",
        "sized": "sized",
    }
    return {"corpus": tmp_path / "corpus", **{name: tmp_path / file for name, file in names.items()}}


def of_the_user(corpus: Path, folder: Path) -> list[Path]:
    """Files of the formats of results that raceway did not make as results: HDF5, a zip with a model, Parquet, HTML and SVG."""
    folder.mkdir()
    names = [folder / name for name in ("a.nc", "a.zip", "a.parquet", "a.html", "a.svg")]
    with h5py.File(names[0], "w") as file:
        file["features"] = 1.0
    with zipfile.ZipFile(names[1], "w") as archive:
        archive.write(folder.parent / "model.skops", "model.skops")
        archive.writestr("schema.json", "{}")
    copy(corpus, names[2], where="specimen == 0")
    names[3].write_text("<!doctype html>\n<title>Raceway</title>")
    names[4].write_text("<?xml version='1.0'?><svg/>")
    return names


def test_every_command_with_an_output_is_tried():
    tried = {line.partition(" {")[0] for line in RESULTS}
    assert {
        " ".join(words) for words, command in COMMANDS.items() if any("-o" in one.opts for one in command.params)
    } <= tried


@pytest.mark.parametrize("line", RESULTS)
def test_nothing_is_written_into_a_corpus(run, places, line, tmp_path):
    corpus, name, before = places["corpus"], Path(RESULTS[line]), files(tmp_path)
    (tmp_path / "link").symlink_to(corpus / "parts")
    link = tmp_path / f"into{name.suffix}"
    link.symlink_to(corpus / f"new{name.suffix}")
    for place in (corpus / name, corpus / "parts" / name, tmp_path / "link" / name, *([link] if name.suffix else ())):
        result = run(*line.format(**places).split(), "-o", place)
        assert result.exit_code == 2, result.output
        assert f"is in the corpus {corpus.resolve()}; choose a place outside it." in result.stderr
    assert files(tmp_path) == before


@pytest.mark.parametrize("line", [line for line, name in RESULTS.items() if name != "new"])
def test_a_place_that_cannot_hold_the_result_is_refused(run, places, line, tmp_path):
    name, before = Path(RESULTS[line]), files(tmp_path)
    if not name.suffix:
        refused = {places["recipe"]: "is a file; give a folder"}
    else:
        (tmp_path / "folder").mkdir()
        (tmp_path / f"folder{name.suffix}").mkdir()
        refused = {
            tmp_path / f"folder{name.suffix}": "is a folder; give a file",
            tmp_path / "none" / name: "there is no folder",
            tmp_path / "result.bmp": "does not end in ",
        }
    for place, sentence in refused.items():
        result = run(*line.format(**places).split(), "-o", place)
        assert (result.exit_code, result.stderr.count("\n")) == (2, 1), result.output
        assert sentence in result.stderr
    assert files(tmp_path) == before


@pytest.mark.parametrize("line", [line for line, name in RESULTS.items() if "." not in name])
def test_a_corpus_is_no_folder_for_other_results(run, places, line, tmp_path):
    before = files(tmp_path)
    result = run(*line.format(**places).split(), "-o", places["corpus"], *(["--seed", 9] if "generate" in line else []))
    assert result.exit_code == 2, result.output
    assert files(tmp_path) == before


@pytest.mark.parametrize("name", ["results.json", "report.html", "index.html", "figure1.png"])
@pytest.mark.parametrize("line", [line for line, name in RESULTS.items() if name == "report"])
def test_a_folder_with_pages_of_the_user_is_refused(run, places, line, name, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / name).write_text("Raceway and I")
    result = run(*line.format(**places).split(), "-o", tmp_path / "mine")
    assert result.exit_code == 2, result.output
    assert f"{name}: was not made by raceway; choose another folder, or move it first." in result.stderr
    assert (tmp_path / "mine" / name).read_text() == "Raceway and I"


@pytest.mark.parametrize("line", [line for line, name in RESULTS.items() if "." in name])
def test_a_file_of_another_kind_is_not_replaced(run, places, line, tmp_path):
    corpus, suffix = places["corpus"], Path(RESULTS[line]).suffix
    copy([corpus], tmp_path / "single.nc")
    foreign = [
        corpus / "index.nc",
        *corpus_files(corpus)[:1],
        tmp_path / "single.nc",
        places["recipe"],
        places["recording"],
    ]
    for number, file in enumerate([*foreign, *of_the_user(corpus, tmp_path / "own")]):
        shutil.copy(file, tmp_path / f"{number}{suffix}")
    before = files(tmp_path)
    for number in range(len(foreign) + 5):
        result = run(*line.format(**places).split(), "-o", tmp_path / f"{number}{suffix}")
        assert result.exit_code == 2, result.output
        assert "; give another name, or remove it first." in result.stderr
    assert files(tmp_path) == before


@pytest.mark.parametrize("place", ["corpus/parts/x.nc", "corpus/x", "index.nc"])
def test_no_corpus_has_a_place_in_another_nor_the_name_of_an_index(places, tmp_path, place):
    before = files(tmp_path)
    for write in (
        lambda: copy(places["corpus"], tmp_path / place),
        lambda: generate(places["recipe"], tmp_path / place),
        lambda: write_corpus(xr.Dataset(), tmp_path / place),
    ):
        with pytest.raises(CorpusError, match=r"choose a place outside it|is the name of the index in a corpus"):
            write()
    assert files(tmp_path) == before


# imitate writes three files, none of which may exist
FILES = [line for line, name in RESULTS.items() if "." in name and not line.startswith(("replay", "imitate"))]


@pytest.mark.parametrize("line", FILES)
def test_a_result_is_written_to_the_target_of_a_link_and_what_a_killed_command_left_is_removed(
    run, places, line, tmp_path
):
    name, ended = RESULTS[line], 2**22 + 1  # no process of Linux has this number
    (tmp_path / "far").mkdir()
    target, link = tmp_path / "far" / name, tmp_path / f"link{Path(name).suffix}"
    link.symlink_to(target)
    (tmp_path / "far" / f".{name}.{_HOST}.{ended}.1.tmp").write_bytes(b"half")
    for _ in range(2):
        result = run(*line.format(**places).split(), "-o", link)
        assert result.exit_code == 0, result.output
        assert link.is_symlink()
        assert [path.name for path in (tmp_path / "far").iterdir()] == [name]
    (tmp_path / "far" / name).unlink()
    (tmp_path / "far" / name).write_text("mine")
    assert run(*line.format(**places).split(), "-o", link).exit_code == 2
    assert target.read_text() == "mine"


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("form", ["folder", "file"])
def test_links_in_a_corpus_of_a_stranger_lead_no_command_out_of_it(run, places, form, tmp_path):
    corpus = places["corpus"]
    if form == "file":
        copy([corpus], tmp_path / "c.nc")
        corpus = tmp_path / "c.nc"
    assert run("card", corpus, "--license", "CC-BY-4.0").exit_code == 0
    folder = card_folder(corpus)
    (tmp_path / "mine").write_text("mine")
    for name in ("README.md", "croissant.json", "pictures/contents.png"):
        (folder / name).unlink(missing_ok=True)
        (folder / name).symlink_to(tmp_path / "mine")
    result = run("card", corpus, "--license", "CC0-1.0")
    assert (tmp_path / "mine").read_text() == "mine", result.output


def test_of_two_benchmarks_into_one_folder_the_second_is_refused(run, places, tmp_path):
    with result_folder(tmp_path / "report"):
        result = run("benchmark", places["corpus"], "-o", tmp_path / "report", "--estimator", "majority")
        assert result.exit_code == 2
        assert "report: another raceway command is writing into it; wait until it ends" in result.stderr
    assert not (tmp_path / "report").exists()


def test_a_new_folder_in_which_nothing_is_written_is_gone_when_a_signal_ends_the_process(tmp_path):
    for name, is_left in (("old", True), ("full", True), ("new", False)):
        (tmp_path / "old").mkdir(exist_ok=True)
        with result_folder(tmp_path / name):
            if name == "full":
                (tmp_path / name / "report.html").touch()
            remove_unfinished()
            assert (tmp_path / name).exists() == is_left
