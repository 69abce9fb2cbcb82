"""Bad usage and bad input: one sentence on standard error that says what to do, exit code 2, nothing written."""

import json
import shutil

import h5py
import pytest

from features.baselines import Model
from features.table.table_files import write_table
from raceway.console import ending, show
from raceway.console.options import _Corpus
from tests.command_tree import COMMANDS
from tests.tampering import edit_manifest, edited, seal


@pytest.fixture(scope="module")
def places(tiny_recipe, tiny_corpus, tiny_table, tmp_path_factory):
    """Sound, damaged and absent files and folders, by their names in the table below."""
    here = tmp_path_factory.mktemp("places")
    (here / "file.txt").write_text("not what is wanted\n")
    (here / "folder").mkdir()
    (here / "folder" / "something").write_text("of another kind\n")
    (here / "binary.yaml").write_bytes(bytes(range(256)))
    Model("majority").fit(tiny_table).save(here / "model.skops")
    write_table(tiny_table, here / "table.nc")
    whole = (here / "model.skops").read_bytes()
    (here / "cut.skops").write_bytes(whole[: len(whole) // 2])
    for name, (whole, broken) in RECIPES.items():
        (here / f"{name}.yaml").write_text(tiny_recipe.read_text().replace(whole, broken))
    for damage, change in DAMAGES.items():
        folder = shutil.copytree(tiny_corpus, here / damage)
        change(folder)
    names = {path.name.partition(".")[0]: path for path in here.iterdir()}
    absent = {name: here / name for name in ("nowhere", "new", "begun")}
    return names | absent | {"recipe": tiny_recipe, "corpus": tiny_corpus}


def alter_a_part(folder):
    path = folder / "parts" / "part-00002.nc"
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 255
    path.write_bytes(content)


def lead_out(folder):
    edit_manifest(folder, {0: {"name": "../../secret.nc"}})


def point_elsewhere(folder):
    """A virtual dataset over another file, in an index with the right checksum."""
    with edited(folder / "index.nc") as index:
        del index["load"]
        layout = h5py.VirtualLayout((48,), "f8")
        layout[:] = h5py.VirtualSource("/etc/secret.nc", "load", (48,), "f8")
        index.create_virtual_dataset("load", layout)


DAMAGES = {
    "no_json": lambda folder: (folder / "manifest.json").write_text("{"),
    "vague": lambda folder: edit_manifest(folder, complete="yes"),
    "later_format": lambda folder: edit_manifest(folder, raceway_format=99),
    "unfinished": lambda folder: edit_manifest(folder, complete=False),
    "leading_out": lead_out,
    "missing_part": lambda folder: (folder / "parts" / "part-00001.nc").unlink(),
    "altered_part": alter_a_part,
    "pointing_elsewhere": point_elsewhere,
}

RECIPES = {
    "straight": ("operation: {", "operation: {axial_load_n: 100, "),
    "coming_loose": ("20}\noperation: {", "20, contact_angle_deg: 10}\noperation: {axial_load_n: 10, "),
    "wide": ("{kind: healthy}", "{kind: ball, width_mm: 6}"),
}

TABLE = [
    # usage
    ("frob", "raceway: No such command 'frob'; see raceway --help."),
    ("generate {recipe}", "raceway generate: Missing option '-o' / '--output'; see raceway generate --help."),
    ("info", "raceway info: Missing argument 'DIR'"),
    ("info {corpus} --quiet", "raceway info: --quiet is for all commands; put it between raceway and info."),
    ("info {corpus} --limit records=5", "raceway info: --limit is for all commands; put it between raceway and info."),
    ("info {corpus} --colour", "raceway info: No such option '--colour'"),
    ("import skf {folder} -o {new}", "raceway import: No such command 'skf'"),
    # where results go
    ("generate {recipe} -o /proc/corpus", "/proc/corpus: could not be written"),
    ("explore {corpus} -o {new}.html --features {model}", "not a readable netCDF file"),
    ("copy {corpus} -o {new} --where x", "--where: there is no column x"),
    ("copy {corpus} -o {new} --channels nose", ": --channels: there is no channel 'nose'"),
    ("copy {corpus} -o {new} --rename-channel nose=ear", "--rename-channel: there is no channel 'nose'"),
    ("explore {corpus} -o {new}.html --channel nose", "no channel 'nose'; give one of"),
    # recipes
    ("plan {nowhere}", "nowhere: neither a file nor one of the recipes dirty_sensors, domain_randomised"),
    ("plan {binary}", "binary.yaml: cannot be read"),
    ("plan {file}", "file.txt: a recipe is a mapping"),
    ("generate {straight} -o {begun}", "operation.axial_load_n: needs a contact angle; "),
    # corpora
    ("benchmark {corpus} -o {new} --test {table}", "table.nc: its bytes do not have the hash that Raceway stored"),
    ("features {unfinished} -o {new}.nc", "is unfinished; run the raceway generate command that began it again."),
    ("plot {missing_part} --record 0 -o {new}.png", "part-00001.nc: is missing; copy it again"),
    ("features {altered_part} -o {new}.nc", "part-00002.nc: its bytes do not have the hash that Raceway stored"),
    ("replay {corpus} --record 48", "record 48 is not in it; it has records 0 to 47."),
    ("plot {corpus} --record 99 -o {new}.png", "no record 99; give one of 0 to 47."),
    # models and scores
    ("evaluate {corpus} --model {nowhere}", "nowhere: no such file; give a model made with raceway train."),
    ("evaluate {corpus} m.skops", "raceway evaluate: a model is no argument; give it with --model FILE.skops."),
    ("evaluate m.skops {corpus}", "raceway evaluate: a model is no argument; give it with --model FILE.skops."),
    ("evaluate {corpus} {nowhere}", "see raceway evaluate --help."),
    ("evaluate {corpus} --model {cut}", "cut.skops: not a readable model"),
    ("benchmark {corpus} -o {new} --track rig --folds 3", "2 rig(s) cannot fill 3 folds; use at most 2 folds."),
    ("benchmark {corpus} -o {new} --folds 3 --test {corpus}", "48 of its records are in the training corpus too"),
    # recordings
    ("import cwru {nowhere} -o {new}", "nowhere: no such folder; give the folder that holds the .mat files."),
    ("import generic {model} -o {new}", "model.skops: is no table of labels; save one as CSV"),
    ("import generic {file} -o {new} --set unit", "'unit' is not KEY=VALUE, such as unit=g"),
]  # fmt: skip


@pytest.mark.parametrize(("line", "sentence"), TABLE, ids=[line for line, _ in TABLE])
def test_bad_usage_or_input_ends_in_one_sentence_and_exit_code_2(run, places, line, sentence):
    result = run(*line.format(**places).split())
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    said = [line for line in result.stderr.splitlines() if not line.startswith("computing features")]
    assert len(said) == 1
    assert sentence.format(**places) in said[0]
    assert said[0].endswith((".", "?"))
    assert not [path for path in places["new"].parent.iterdir() if path.name.startswith((".", "new"))]


# commands that read a corpus, and what they say of places that hold none
READERS = {
    "info": "info {}", "validate": "validate {}", "replay": "replay {} --record 0", "plot": "plot {} --record 0 -o {new}.png",
    "explore": "explore {} -o {new}.html", "features": "features {} -o {new}.nc", "train": "train {} -o {new}.skops",
    "evaluate": "evaluate {} --model {model}", "benchmark": "benchmark {} -o {new}", "compare": "compare {} {corpus} -o {new}",
    "copy": "copy {} -o {new}", "card": "card {} --license MIT", "life": "life {} -o {new}.png", "prognose": "prognose {}",
    "limit": "limit {}",
}  # fmt: skip
NO_CORPORA = {
    "nowhere": "nowhere: no such folder or file; give a corpus: a folder with manifest.json, or one .nc file.",
    "file": "file.txt: is no corpus, which is a folder with manifest.json or one .nc file; a copy in another form",
    "table": "table.nc: its bytes do not have the hash that Raceway stored at its end: it is altered, cut off or rewritten by",
    "folder": "folder: has no manifest.json, so it is not a corpus; make one with raceway generate.",
    "no_json": "manifest.json: not the manifest of a corpus",
    "vague": "manifest.json: not the manifest of a corpus (complete: input should be a valid boolean)",
    "later_format": "manifest.json: corpus format 99, this version of raceway reads format 4; make the corpus again.",
    "leading_out": "manifest.json: not the manifest of a corpus (parts.0.name: string should match pattern",
}


@pytest.mark.parametrize("command", READERS)
def test_every_command_that_reads_a_corpus_refuses_what_is_none_in_one_sentence(run, places, command):
    for place, sentence in NO_CORPORA.items():
        if command == "validate" and place not in ("nowhere", "folder"):  # tells of a damaged corpus as its result
            continue
        result = run(*READERS[command].replace("{}", f"{{{place}}}").format(**places).split())
        assert (result.exit_code, result.stdout) == (2, ""), result.output
        if command in (
            "plot",
            "train",
            "replay",
            "limit",
        ):  # take recordings or recipes too, or read no more than a part
            sentence = places[place].name
        assert sentence in result.stderr
        assert len(result.stderr.splitlines()) == 1


def test_every_command_with_a_corpus_is_among_these():
    assert {
        words[0] for words, command in COMMANDS.items() if any(isinstance(one.type, _Corpus) for one in command.params)
    } <= {*READERS}


@pytest.mark.parametrize("damage", [name for name in DAMAGES if name != "unfinished"])
def test_validate_finds_a_damaged_corpus_wanting(run, places, damage):
    result = run("validate", places[damage], "--json")
    found = json.loads(result.stdout)
    assert (result.exit_code, found["valid"], result.stderr) == (1, False, "")
    assert len(found["problems"]) == 1
    assert run("validate", places[damage]).stdout == found["problems"][0] + "\n"


def test_a_record_that_replays_differently_is_found_wanting(run, tiny_corpus, tmp_path):
    folder = shutil.copytree(tiny_corpus, tmp_path / "corpus")
    with edited(folder / "parts" / "part-00000.nc") as part:
        part["acceleration"][3, 0, 100] += 1
    seal(folder)
    assert run("replay", folder, "--record", 2).exit_code == 0
    result = run("replay", folder, "--record", 3, "--json")
    assert (result.exit_code, json.loads(result.stdout)["identical"]) == (1, False)
    assert "differs" in run("replay", folder, "--record", 3).stdout


def test_an_unforeseen_error_ends_in_one_sentence_too(run, places, monkeypatch):
    def fail(*_):
        raise ZeroDivisionError("float division by zero")

    monkeypatch.setattr("raceway.console.summary.corpus_facts", fail)
    result = run("info", places["corpus"])
    assert result.exit_code == 70
    assert result.stderr == (
        "internal error (ZeroDivisionError: float division by zero); "
        "please report it with the output of RACEWAY_TRACEBACK=1.\n"
    )
    monkeypatch.setenv("RACEWAY_TRACEBACK", "1")
    assert "Traceback" in run("info", places["corpus"]).stderr


@pytest.mark.parametrize(
    ("error", "code", "sentence"),
    [
        (PermissionError(13, "Permission denied", "/locked/x"), 2, "/locked/x: Permission denied; choose another"),
        (MemoryError("Unable to allocate 9 GiB"), 2, "this needs more memory than there is"),
        (RuntimeError("NetCDF: HDF error"), 2, "a file of the corpus cannot be read (NetCDF: HDF error)"),
        (type("KilledWorker", (Exception,), {})("part-3"), 2, "several workers of the cluster died"),
        (ModuleNotFoundError("", name="matplotlib.figure"), 2, "this needs the Python module matplotlib, which is"),
        (ModuleNotFoundError("", name="gen.nothing"), 70, "internal error"),
        (KeyboardInterrupt(), 130, "interrupted."),
    ],
)
def test_an_exception_of_a_library_ends_in_one_sentence(capsys, error, code, sentence):
    def fail():
        raise error

    assert ending.exit_code(fail) == code
    assert sentence in capsys.readouterr().err


def test_control_characters_of_a_recipe_are_not_printed(run, tiny_recipe, tmp_path):
    path = tmp_path / "rude.yaml"
    path.write_text(tiny_recipe.read_text().replace("title: Tiny corpus", 'title: "Tiny \\e[2J corpus"'))
    shown = run("plan", path).stdout
    assert "Tiny ?[2J corpus" in shown
    assert "\x1b" not in shown


def test_json_has_null_for_nan_and_infinity():
    assert show.plain({"load": [float("nan"), 1.5], "rate": float("inf")}) == {"load": [None, 1.5], "rate": None}


def test_a_limit_of_memory_that_libraries_need_is_told_before_they_are_loaded(start):
    process = start("recipes", LARGEST_MEMORY="600000000")
    output, errors = process.communicate(timeout=60)
    assert (process.returncode, output) == (2, "")
    assert errors == "memory: the limit of this shell is 600 MB; raise it with ulimit -v 2000000.\n"
