"""Plug-ins: the example in ``tests/plugin`` is installed into a folder and used through the command line."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib

import numpy as np
import pytest

from tests.page_examples import blocks
from tests.paths import ROOT

SOURCE = ROOT / "tests" / "plugin"
RECIPE = """\
name: dented
title: Dented bearings
seed: 2
corpus: {rigs: 3, specimens_per_rig: 3, records_per_specimen: 2}
storage: {records_per_part: 18}
recording: {sample_rate_hz: 12000, duration_s: 0.2, settle_s: 0.05, converter: {kind: float32}}
bearing: "6205"
operation: {shaft_rpm: 'uniform(1500, 1800)', load_n: 600}
faults:
  - {kind: healthy}
  - {kind: inner, width_mm: 0.8}
  - {kind: brinelled, width_mm: 0.8, n_spalls: 3}
sensor_faults: {stuck_bits: {probability: 1, step_m_s2: 0.01}}
background: {hiss: {probability: 1, level_db: 6}}
machine_conditions: {worn_chain: {probability: 1, links: 7, level_db: 20}}
"""
RUN = """
import contextlib, io, json, sys
from matplotlib.figure import Figure
from raceway.cli import cli
Figure.savefig = lambda figure, stream, **options: stream.write(b"a picture")  # painting takes most of the time
ends = []
for line in json.load(sys.stdin):
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
        try: cli.main(line.split(), prog_name="raceway")
        except SystemExit as end: ends.append((end.code, out.getvalue() or err.getvalue()))
print(json.dumps(ends))
"""


def run(folder, lines, *plugins):
    """Exit code and text of each of some commands, one after the other in a process that finds the plug-ins."""
    path = os.pathsep.join(map(str, (*plugins, *sys.path)))
    done = subprocess.run(
        [sys.executable, "-c", RUN], input=json.dumps(lines), cwd=folder, env={**os.environ, "PYTHONPATH": path},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return json.loads(done.stdout)


def distribution(folder, name, version, groups):
    """Folder with the facts of an installed distribution; ``groups`` are its entry points."""
    facts = folder / f"{name.replace('-', '_')}-{version}.dist-info"
    facts.mkdir(parents=True)
    (facts / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    lines = [
        f"[{group}]\n" + "".join(f"{key} = {place}\n" for key, place in of.items()) for group, of in groups.items()
    ]
    (facts / "entry_points.txt").write_text("".join(lines))
    return folder


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Folder in which the example lies as pip installs it: its module, and its entry points."""
    folder = tmp_path_factory.mktemp("plugin")
    shutil.copy(SOURCE / "raceway_example.py", folder)
    project = tomllib.loads((SOURCE / "pyproject.toml").read_text())["project"]
    return distribution(folder, project["name"], project["version"], project["entry-points"])


@pytest.fixture(scope="module")
def made(installed, tmp_path_factory):
    """Folder with what commands made with the plug-in, and what they printed."""
    folder = tmp_path_factory.mktemp("made")
    (folder / "dented.yaml").write_text(RECIPE)
    (folder / "recorded").mkdir()
    rng = np.random.default_rng(0)
    for fault in ("healthy", "brinelled"):
        np.save(folder / "recorded" / f"{fault}-6205-1700.npy", rng.standard_normal(6000))
    lines = [
        "--help",
        "recipes --keys sensor_faults.stuck",
        "doctor",
        "generate dented.yaml -o corpus",
        "validate corpus",
        "info corpus --json",
        "info corpus --where 'worn_chain'in(machine_condition) --json",
        "replay corpus --record 5",
        "features corpus --group crossings -o features.nc",
        "train corpus --group crossings --estimator logistic_regression -o model.skops",
        "evaluate corpus --model model.skops",
        "benchmark corpus -o report --group crossings --estimator envelope_rule --folds 2",
        "explore corpus -o explore.html",
        "import plain recorded -o imported --window 0.2",
        "diagnose recorded/brinelled-6205-1700.npy --rate 12000 --bearing 6205 --rpm 1700 --unit m/s2 --model model.skops -o page.html",
        "copy imported corpus -o corpora.nc --where fault=='brinelled'",
        "info corpora.nc --json",
        "peaks corpus",
    ]
    ends = dict(zip(lines, run(folder, lines, installed), strict=True))
    assert {line: end for line, end in ends.items() if end[0] not in (0, None)} == {}
    return folder, {line: text for line, (_, text) in ends.items()}


def test_a_fault_class_of_a_plugin_goes_all_the_way_to_scores_and_pages(made):
    folder, said = made
    assert "stuck_bits" in said["recipes --keys sensor_faults.stuck"]
    assert "\nfine     plug-in brinelled: raceway.classes of raceway-example 0.1\n" in said["doctor"]
    assert "identical" in said["replay corpus --record 5"]
    facts = json.loads(said["info corpus --json"])
    assert facts["classes"] == {"healthy": 6, "inner": 6, "brinelled": 6}
    assert facts["versions"]["raceway-example"] == "0.1"
    assert json.loads(said["info corpus --where 'worn_chain'in(machine_condition) --json"])["records"] == 18
    assert "crossings" in (folder / "report" / "results.json").read_text()
    assert "\nbrinelled               0      0          6" in said["evaluate corpus --model model.skops"]
    for page in ("report/report.html", "corpus/README.md", "page.html"):
        assert "brinelled" in (folder / page).read_text()


def test_commands_and_importers_of_a_plugin_are_listed_and_run(made):
    _, said = made
    assert "Plug-ins:\n  peaks" in said["--help"]
    assert "imported: 4 records of 2 recordings" in said["import plain recorded -o imported --window 0.2"]
    joined = json.loads(said["info corpora.nc --json"])
    assert (joined["classes"], joined["versions"]["raceway-example"]) == ({"brinelled": 8}, "0.1")
    assert said["peaks corpus"].count("m/s2") == 3


def test_without_the_plugin_a_sentence_names_it(made):
    folder, _ = made
    lines = ["info corpus", "info imported", "validate corpus", "evaluate corpus --model model.skops"]
    for code, text in run(folder, lines):
        assert code in (1, 2)
        assert "raceway-example" in text
        assert text.count("\n") == 1


def test_codes_of_classes_are_those_of_the_file(made, installed, tmp_path):
    """A class that comes before the one in the file moves the code of this one in the process, and nothing in a corpus."""
    folder, said = made
    index, part = folder / "corpus" / "index.nc", folder / "corpus" / "parts" / "part-00000.nc"
    before = index.read_bytes(), part.read_bytes()
    part.unlink()
    other = distribution(tmp_path, "other", "1.0", {"raceway.classes": {"abraded": "raceway_example:BRINELLED"}})
    lines = [
        "generate dented.yaml -o corpus",
        "info corpus --json",
        "validate corpus",
        "evaluate corpus --model model.skops",
    ]
    _, info, sound, scores = run(folder, lines, installed, other)
    assert (index.read_bytes(), part.read_bytes()) == before
    assert json.loads(info[1])["classes"] == json.loads(said["info corpus --json"])["classes"]
    assert (sound[1], scores[1]) == (said["validate corpus"], said["evaluate corpus --model model.skops"])


def test_a_plugin_that_nothing_names_changes_no_byte(installed, tmp_path):
    recipe = RECIPE.replace("brinelled", "outer").partition("sensor_faults")[0]
    for name, plugins in (("with", [installed]), ("without", [])):
        (tmp_path / name).mkdir()
        (tmp_path / name / "plain.yaml").write_text(recipe)
        lines = [
            "generate plain.yaml -o corpus",
            "features corpus -o features.nc",
            "copy corpus -o copy.nc",
        ]
        assert {code for code, _ in run(tmp_path / name, lines, *plugins)} <= {0, None}
    first, second = (
        {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        for folder in (tmp_path / "with", tmp_path / "without")
    )
    assert len(first) >= 8
    assert first == second


def test_a_source_that_draws_what_its_key_does_not_allow_is_refused(installed, tmp_path):
    code = """
from raceway_example import Hiss

class Leak(Hiss):
    place = "leak"

    def draw(self, of):
        return super().draw(of).model_copy(update={"level_db": 1000.0})
"""
    (tmp_path / "leaking.py").write_text(code)
    leaking = distribution(tmp_path, "leaking", "1.0", {"raceway.mechanisms": {"leak": "leaking:Leak"}})
    (tmp_path / "leak.yaml").write_text(RECIPE.replace("hiss:", "leak:"))
    ((ended, said),) = run(tmp_path, ["generate leak.yaml -o corpus"], installed, leaking)
    assert ended == 2
    assert said.startswith("record 0: background.leak.level_db: 1000.0 was drawn, which is not in [-80, 40]")


def test_a_plugin_that_cannot_be_loaded_is_named_and_the_others_work(tmp_path):
    broken = distribution(tmp_path, "broken", "1.0", {"raceway.commands": {"lost": "no_such_module:command"}})
    (_, listed), (code, called), (wanting, doctor) = run(tmp_path, ["--help", "lost", "doctor"], broken)
    assert "problem  plug-in lost: raceway.commands of broken 1.0; ModuleNotFoundError" in doctor
    assert wanting == 1
    sentence = "broken 1.0: its lost in raceway.commands cannot be used"
    assert f"Plug-ins:\n  lost       {sentence}" in listed
    assert (code, called) == (
        2,
        f"{sentence} (ModuleNotFoundError: No module named 'no_such_module'); install another version, or uninstall it.\n",
    )


@pytest.mark.parametrize(
    ("code", "entries", "said"),
    [
        (
            'class Tones(Hiss):\n    place = "tones"',
            {"raceway.mechanisms": {"hum": "mine:Tones"}},
            "mine 1.0: its hum in raceway.mechanisms cannot be used (tones is taken)",
        ),
        (
            'class Rusty(Brinelled):\n    kind: Literal["rusty"]\n\nRUSTY = FaultClass("rusty", BPFO)',
            {"raceway.mechanisms": {"rusty": "mine:Rusty"}, "raceway.classes": {"rosty": "mine:RUSTY"}},
            "mine 1.0: its rosty in raceway.classes cannot be used (it is named rusty",
        ),
        (
            'class Rusty(Spalls):\n    kind: Literal["rusty"]',
            {"raceway.mechanisms": {"rusty": "mine:Rusty"}},
            "mine 1.0: its rusty in raceway.mechanisms cannot be used (fault kind rusty is no class and has no site)",
        ),
    ],
)
def test_a_plugin_that_takes_a_key_or_names_no_class_is_refused_with_every_recipe(
    installed, tmp_path, code, entries, said
):
    (tmp_path / "mine.py").write_text(f"from raceway_example import *\n\n{code}\n")
    ((ended, told),) = run(tmp_path, ["plan quickstart"], installed, distribution(tmp_path, "mine", "1.0", entries))
    assert (ended, told[: len(said)]) == (2, said)


FAILING = """
import click
import numpy as np
from raceway_example import Brinelled, CROSSINGS, Hiss, StuckBits
from gen.corpus.fault_classes import BPFO, FaultClass
from typing import Literal
from features.table.feature_group import Feature, FeatureGroup
from raceway.importing.assemble import Importer

CRACKED = FaultClass("cracked", BPFO, words="Cracked outer race", companion="outer")

class Cracked(Brinelled):
    kind: Literal["cracked"]

    def draw(self, of):
        return of.nope

class Leak(Hiss):
    place = "leak"

    def vibrations(self, angles, fs, stream):
        return [self.si()["levl"]]

class Bent(StuckBits):
    place, labels = "bent", ()

    def disturb(self, signal, fs, rng):
        return {}["bend"]

def count(batch):
    return np.ones(3)[batch.x.shape[0] + 7]

COUNTS = FeatureGroup((Feature("counts", "counts", "n"),), count)

def read(source, output, *, window=0.5, progress=None):
    raise ValueError("no header")

READ = Importer("Recordings.", read)

@click.command()
def fall():
    int("x")
"""


def test_an_error_in_the_code_of_a_plugin_names_it_and_its_line(installed, made, tmp_path):
    (tmp_path / "failing_code.py").write_text(FAILING)
    groups = {
        "mechanisms": {"leak": "Leak", "cracked": "Cracked", "bent": "Bent"},
        "classes": {"cracked": "CRACKED"},
        "features": {"counts": "COUNTS"},
        "importers": {"read": "READ"},
        "commands": {"fall": "fall"},
    }
    entries = {
        f"raceway.{group}": {name: f"failing_code:{of}" for name, of in names.items()}
        for group, names in groups.items()
    }
    failing = distribution(tmp_path, "failing", "2.0", entries)
    for name, (old, new) in {
        "leak": ("hiss", "leak"),
        "cracked": ("brinelled", "cracked"),
        "bent": ("stuck_bits", "bent"),
    }.items():
        (tmp_path / f"{name}.yaml").write_text(RECIPE.replace(old, new))
    folder, _ = made
    told = {
        "generate leak.yaml -o a --workers 1": "vibrations(): KeyError: 'levl'",
        "generate leak.yaml -o b --workers 2": "vibrations(): KeyError: 'levl'",
        "generate cracked.yaml -o c": "draw(): AttributeError: ",
        "generate bent.yaml -o d": "disturb(): KeyError: 'bend'",
        f"features {folder}/corpus --group counts -o f.nc": "count(): IndexError: ",
        f"import read {folder}/recorded -o e": "read(): ValueError: no header",
        "fall": "fall(): ValueError: invalid literal",
    }
    for (line, sentence), (code, said) in zip(told.items(), run(tmp_path, [*told], installed, failing), strict=True):
        assert code == 2, (line, said)
        last = said.splitlines()[-1]
        assert re.match(r"failing 2\.0: failing_code\.py, line \d+, in ", last), (line, said)
        assert sentence in last, (line, said)
        number = int(re.search(r"line (\d+)", last)[1])
        assert FAILING.splitlines()[number - 1].strip().startswith(("return", "raise", "int"))


def test_the_page_shows_the_example():
    source = (SOURCE / "raceway_example.py").read_text() + (SOURCE / "pyproject.toml").read_text()
    shown = blocks("plugins.md") + blocks("plugins.md", "toml")
    assert len(shown) == 7
    assert [block for block in shown if block not in source] == []
