"""Output of each command, as text and as JSON."""

import json
import subprocess
import sys

import netCDF4
import numpy as np
import pytest
from click.testing import CliRunner

from features.baselines.calibration import UNCALIBRATED
from features.table.indicators import feature_names
from features.table.table_files import read_table
from gen.corpus import FAULTS, SIGNAL, open_corpus
from gen.support.limits import VARIABLE
from raceway.cli import GROUPS, cli
from raceway.commands.model_commands import calibration_text
from tests.command_tree import commands
from tests.labels import write_labels

pytestmark = pytest.mark.usefixtures("tables_once")


@pytest.mark.parametrize(
    ("path", "command"), list(commands()), ids=lambda value: " ".join(value) if isinstance(value, tuple) else ""
)
def test_help_shows_how_a_command_is_called(run, path, command):
    result = run(*path, "--help")
    assert result.exit_code == 0
    assert result.stdout.startswith(f"Usage: raceway {' '.join(path)} ")
    assert f"\n    raceway {' '.join(path)}" in result.stdout  # an example on a line of its own
    assert len(command.get_short_help_str(60)) < 60
    assert "..." not in command.get_short_help_str(60)


def test_raceway_alone_shows_the_road_and_every_command_of_it_exists(run):
    result = run()
    steps = [line.split()[1] for line in result.stdout.splitlines() if line.startswith("  raceway ")]
    assert (result.exit_code, steps) == (0, ["generate", "plot", "features", "train", "benchmark", "diagnose"])
    assert "raceway --help" in result.stdout
    assert set(steps) < set(cli.commands)


@pytest.mark.parametrize("words", ["plan", "generate"])
def test_a_shell_completes_names_of_recipes_and_else_files(words):
    parts = ["raceway", *words.split()]

    def completed(begun):
        environment = {"_RACEWAY_COMPLETE": "bash_complete", "COMP_WORDS": " ".join([*parts, begun])}
        return CliRunner().invoke(cli, [], prog_name="raceway", env=environment | {"COMP_CWORD": str(len(parts))})

    assert completed("qui").output == "plain,quickstart\n"
    assert completed("my_").output == "file,my_\n"


HEAVY = ("numpy", "xarray", "gen", "features.table", "numba", "distributed", "scipy.stats", "sklearn", "matplotlib")
LIGHT = {
    "--help": HEAVY, "--version": HEAVY, "generate --help": HEAVY,
    "recipes": HEAVY[4:], "plan quikstart": HEAVY[4:], "generate quikstart -o new": HEAVY[4:], "info {corpus}": HEAVY[4:],
}  # fmt: skip
"""Commands, each after those before it, and modules that none of them loads."""


def test_help_lists_misspelt_names_and_info_load_no_heavy_library(tiny_corpus):
    lines = {line.format(corpus=tiny_corpus): modules for line, modules in LIGHT.items()}
    code = (
        "import sys\nfrom raceway.cli import cli\n"
        f"for line, modules in {lines!r}.items():\n"
        "    try: cli.main(line.split(), prog_name='raceway')\n"
        "    except SystemExit: pass\n"
        "    print('loaded', line, *(set(modules) & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert [line for line in done.stdout.splitlines() if line.startswith("loaded")] == [
        f"loaded {line}" for line in lines
    ]


def test_recipes_are_listed_with_their_purpose(run, told):
    listed = told("recipes")["recipes"]
    assert {"quickstart", "domain_randomised", "ophel2025"} <= {recipe["name"] for recipe in listed}
    for recipe in listed:
        assert len(recipe["purpose"]) > 20
        assert recipe["name"] in run("recipes").stdout


def test_recipe_keys_are_listed_by_prefix_with_unit_range_default_and_meaning(run, told):
    keys = told("recipes", "--keys", "machine.resonator.f")["keys"]
    assert [keys[0][name] for name in ("key", "unit", "allowed", "default")] == [
        "machine.resonator.frequency_hz", "Hz", "[100, 50000]", "3000",
    ]  # fmt: skip
    shown = run("recipes", "--keys", "machine").stdout.splitlines()
    assert shown[0].split() == ["key", "kinds", "unit", "allowed", "default", "meaning"]
    assert next(line for line in shown if line.startswith("machine.resonator.f")).endswith(keys[0]["meaning"])
    assert len(told("recipes", "--keys")["keys"]) > 150


def test_generate_counts_its_records_and_a_second_call_keeps_them(told, tiny_recipe, tmp_path):
    made = told("generate", tiny_recipe, "-o", tmp_path / "corpus", "--records", 20, "--seed", 9)
    assert (made["records"], made["parts"], made["kept"], made["failures"]) == (20, 2, 0, [])
    assert made["seconds"] > 0
    again = told("generate", tiny_recipe, "-o", tmp_path / "corpus", "--records", 20, "--seed", 9)
    assert (again["records"], again["kept"]) == (20, 2)
    assert told("info", tmp_path / "corpus")["overrides"] == {"seed": 9, "records": 20}


def test_info_says_of_how_many_parts_a_corpus_has_some(run, told, tiny_recipe, tiny_corpus, tmp_path):
    told("generate", tiny_recipe, "-o", tmp_path / "first", "--parts", "0-1")
    assert [told("info", corpus)["parts_of_recipe"] for corpus in (tmp_path / "first", tiny_corpus)] == [4, 4]
    assert "state       2 of 4 parts of its recipe; raceway copy joins them" in run("info", tmp_path / "first").stdout
    assert "complete" in run("info", tiny_corpus).stdout
    (tmp_path / "first" / "recipe.yaml").unlink()
    assert "complete, if its recipe has no more parts" in run("info", tmp_path / "first").stdout


def test_a_single_file_is_generated_kept_shown_and_used_like_a_folder(run, told, tiny_recipe, tiny_corpus, tmp_path):
    file = tmp_path / "corpus.nc"
    made = told("generate", tiny_recipe, "-o", file)
    assert (made["corpus"], made["records"], made["parts"], made["kept"]) == (str(file), 48, 4, 0)
    assert told("generate", tiny_recipe, "-o", file)["kept"] == 4
    assert [path.name for path in tmp_path.iterdir()] == ["corpus.nc"]
    assert told("validate", file) == {"corpus": str(file), "valid": True, "problems": [], "warnings": []}
    own = {"corpus", "bytes", "parts", "parts_of_recipe"}
    one, other = (told("info", corpus) for corpus in (file, tiny_corpus))
    assert {name: one[name] for name in one.keys() - own} == {name: other[name] for name in other.keys() - own}
    assert "complete\n" in run("info", file).stdout
    for corpus, name in ((file, "file.nc"), (tiny_corpus, "folder.nc")):
        told("features", corpus, "-o", tmp_path / name)
    assert read_table(tmp_path / "file.nc").equals(read_table(tmp_path / "folder.nc"))
    assert run("plot", file, "--record", 5, "-o", tmp_path / "record.png").exit_code == 0
    assert (tmp_path / "record.png").stat().st_size > 5000


def test_a_limit_can_be_raised_for_one_command(run, tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, "")
    (tmp_path / "large.yaml").write_text("# " + "x" * 2_000_000 + "\n")
    plan = ("plan", tmp_path / "large.yaml")
    assert "yaml_bytes" in run(*plan).stderr
    assert "yaml_bytes" not in run("--limit", "yaml_bytes=3000000", *plan).stderr


def test_the_plan_tells_the_time_once_the_kernel_is_compiled(run, told, tiny_recipe, monkeypatch):
    few, many = (told("plan", tiny_recipe, "--records", count)["seconds"] for count in (1_000, 10_000))
    assert 3 < many / few < 30
    assert " on one core, by some of its records\n" in run("plan", tiny_recipe).stdout
    monkeypatch.setattr("gen.generation.trial.is_compiled", lambda: False)
    assert told("plan", tiny_recipe)["seconds"] is None


def test_a_record_that_diverges_is_named_and_left_out(run, told, tiny_recipe, tmp_path, monkeypatch):
    def first_diverges(number, *_):
        return None if number % 12 else f"record {number} diverged."

    monkeypatch.setattr("gen.simulation.simulate.failure", first_diverges)
    result = run("generate", tiny_recipe, "-o", tmp_path / "corpus", "--records", 24)
    assert result.exit_code == 0
    assert "left out: record 0 diverged.\nleft out: record 12 diverged.\n" in result.stderr
    assert "22 records in 2 parts; 2 records left out" in result.stdout
    assert told("info", tmp_path / "corpus")["failures"] == ["record 0 diverged.", "record 12 diverged."]
    assert "Left out:\n- record 0 diverged.\n" in run("info", tmp_path / "corpus").stdout


def test_info_and_validate_find_a_sound_corpus_sound(run, told, tiny_corpus):
    assert told("validate", tiny_corpus) == {"corpus": str(tiny_corpus), "valid": True, "problems": [], "warnings": []}
    assert run("validate", tiny_corpus).stdout == f"{tiny_corpus}: sound.\n"
    found = told("info", tiny_corpus)
    assert (found["complete"], found["bearings"], found["recordings"]) == (True, {"6205": 48}, 48)
    assert found["versions"].keys() >= {"raceway", "numpy", "numba"}
    shown = run("info", tiny_corpus).stdout
    for part in ("Tiny corpus", "recipe tiny", "48 of 0.1 s at 12000 Hz", "6205 48", "train 36, test 12", "complete"):
        assert part in shown


def test_info_shows_the_range_of_the_severities_of_each_class(run, told, tiny_corpus):
    found = told("info", tiny_corpus)["severities"]
    assert list(found) == ["inner", "outer", "ball"]
    with open_corpus(tiny_corpus) as corpus:
        widths = corpus["width"].values[corpus["fault"].values == FAULTS.index("outer")]
    assert found["outer"]["width"] == [widths.min(), widths.max()]
    assert set(found["outer"]) == {"width", "depth", "angle", "largest_drop"}  # those that are 0 in all are left out
    shown = run("info", tiny_corpus).stdout
    for factor, unit in ((1e3, "mm ("), (1, "m), depth ")):
        assert f"{factor * widths.min():.3g} to {factor * widths.max():.3g} {unit}" in shown


def test_info_tells_the_contents_of_chosen_records(run, told, tiny_corpus):
    with open_corpus(tiny_corpus) as corpus:
        wide = corpus["width"].values > 0.5e-3
    found = told("info", tiny_corpus, "--where", "width_mm > 0.5")
    assert (found["chosen"], found["records"]) == (wide.sum(), 48)
    assert sum(found["classes"].values()) == sum(found["bearings"].values()) == wide.sum()
    assert (
        f"records     {wide.sum()} of 48, each of 0.1 s" in run("info", tiny_corpus, "--where", "width_um>500").stdout
    )
    assert "none of 48 records is chosen" in run("info", tiny_corpus, "--where", "width > 1").stderr


@pytest.mark.parametrize("command", ["info", "validate"])
def test_the_index_of_a_corpus_stands_for_its_folder(run, tiny_corpus, command):
    assert run(command, tiny_corpus / "index.nc").stdout == run(command, tiny_corpus).stdout


def test_replay_finds_a_record_identical_and_writes_it(run, told, tiny_corpus, tmp_path):
    path = tmp_path / "record.nc"
    assert told("replay", tiny_corpus, "--record", 17, "-o", path)["identical"] is True
    with open_corpus(tiny_corpus) as corpus, netCDF4.Dataset(path) as written:
        np.testing.assert_allclose(written[SIGNAL][0], corpus[SIGNAL][17], rtol=1e-6)
    assert run("replay", tiny_corpus, "--record", 0).stdout == f"{tiny_corpus}: record 0: identical.\n"


def test_replay_writes_a_recipe_that_gives_the_record_again_and_replaces_no_file(run, told, tiny_corpus, tmp_path):
    path, line = tmp_path / "record.yaml", ("replay", tiny_corpus, "--record", 17, "--recipe", tmp_path / "record.yaml")
    assert told(*line)["recipe"] == str(path)
    told("generate", path, "-o", tmp_path / "again")
    with open_corpus(tiny_corpus) as corpus, open_corpus(tmp_path / "again") as again:
        np.testing.assert_array_equal(again[SIGNAL][0], corpus[SIGNAL][17])
    before = path.read_bytes()
    assert "record.yaml: exists; give another name" in run(*line).stderr
    assert path.read_bytes() == before


def test_the_list_of_features_has_a_row_for_each_column(told, run):
    names = [feature["name"] for feature in told("features", "--list")["features"]]
    assert tuple(names) == feature_names()
    rows = run("features", "--list").stdout.splitlines()
    assert [row.split()[1] for row in rows] == ["feature", *names]
    assert "energy_7000-9000_Hz" in run("features", "--list", "--band", 300, 9000).stdout


def test_train_scores_on_the_test_split_and_trains_on_the_other_records(told, run, tiny_corpus, tmp_path):
    path = tmp_path / "model.skops"
    made = told("train", tiny_corpus, "-o", path, "--estimator", "logistic_regression")
    assert (made["records"], made["test"]["records"], made["test"]["seen"]) == (36, 12, 0)
    assert made["classes"] == ["healthy", "inner", "outer", "ball"]
    assert 0 <= made["test"]["balanced_accuracy"] <= 1
    assert made["calibration"]["by"] in ("rig", "specimen")
    assert made["calibration"]["coverage"] >= 0.9
    found = run("evaluate", tiny_corpus, "--model", path, "--json")
    assert json.loads(found.stdout)["seen"] == 36
    assert "no fair test" in found.stderr


def test_evaluate_gives_the_figures_over_the_classes_present(run, told, tiny_corpus, model):
    scores = told("evaluate", tiny_corpus, "--model", model)
    wanted = ("balanced_accuracy", "macro_f1", "accuracy", "classes", "confusion", "records", "by_recording")
    assert set(wanted) <= scores.keys()
    assert sum(map(sum, scores["confusion"])) == scores["records"] == 48
    shown = run("evaluate", tiny_corpus, "--model", model).stdout
    (line,) = (line.split() for line in shown.splitlines() if line.startswith("balanced accuracy"))
    assert line[2] == f"{scores['balanced_accuracy']:.3f}"
    (line,) = (line.split() for line in shown.splitlines() if line.startswith("false alarms on healthy"))
    assert line[4] == f"{scores['false_alarms']:.3f}"


def test_figures_without_records_are_not_known_and_no_threshold_is_at_least_more(run, tiny_corpus, model, tmp_path):
    faulty = tmp_path / "faulty.nc"
    run("copy", tiny_corpus, "-o", faulty, "--where", "fault != 'healthy'")
    shown = run("evaluate", faulty, "--model", model).stdout
    (line,) = (line for line in shown.splitlines() if line.startswith("false alarms on healthy"))
    assert line.split()[-2:] == ["not", "known"]
    assert "No tested record is of class healthy, of which the scores tell nothing." in shown
    for threshold, words in ((0.9999, "of more than 99.9 %,"), (0.8, "of at least 80 %,")):
        assert words in calibration_text(UNCALIBRATED._replace(by="rig", threshold=threshold))


@pytest.mark.parametrize("form", [("copy.parquet",), ("hub", "--to", "huggingface")], ids=["parquet", "huggingface"])
def test_a_copy_in_another_form_is_told_as_one_that_cannot_be_checked(run, tiny_corpus, tmp_path, form):
    pytest.importorskip("pyarrow")
    copied = tmp_path / form[0]
    assert run("copy", tiny_corpus, "-o", copied, *form[1:]).exit_code == 0
    result = run("validate", copied)
    assert (result.exit_code, result.stdout) == (2, "")
    assert (
        "holds no hashes to check, so compare the SHA-256 of its files with those that its maker states"
        in result.stderr
    )


def test_recordings_are_imported_and_counted(run, told, tmp_path):
    rng = np.random.default_rng(0)
    for name in ("healthy", "outer"):
        np.save(tmp_path / f"{name}.npy", rng.standard_normal(4000))
    rows = (("healthy", "new"), ("outer", "worn"), ("lost", "lost"))
    labels = write_labels(
        tmp_path,
        [{"path": f"{name}.npy", "fault": name.replace("lost", "inner"), "specimen": one} for name, one in rows],
        title="Pump", bearing="6205", unit="V", sample_rate_hz=2000, shaft_rpm=1480,
    )  # fmt: skip
    options = ("--window", 0.25, "--set", "unit=g")
    result = run("import", "generic", labels, "-o", tmp_path / "pump", *options, "--json")
    made = json.loads(result.stdout)
    assert (made["recordings"], made["records"], len(made["skipped"])) == (2, 16, 1)
    assert "lost.npy: could not be read" in result.stderr
    found = told("info", tmp_path / "pump")
    assert (found["importer"], found["classes"]) == ("generic", {"healthy": 8, "outer": 8})
    assert "lost.npy: could not be read" in run("info", tmp_path / "pump").stdout


def test_a_file_that_hides_a_package_of_raceway_is_named(tmp_path):
    (tmp_path / "features.py").write_text("")
    done = subprocess.run(
        [sys.executable, "-m", "raceway", "recipes"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "features.py: hides a package of Raceway" in done.stderr


def test_every_command_is_listed_in_one_group():
    listed = [command for commands in GROUPS.values() for command in commands]
    assert sorted(str(one.name) for one in listed) == sorted(cli.commands)
