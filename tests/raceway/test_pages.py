"""The tables of ``docs/features.md`` are the definitions, its examples run, and its commands exist; README.md runs too."""

import re
import shlex
import shutil
from pathlib import Path

import pytest

from benchmarks.feature_pages import with_tables
from features.table.definitions import define_features
from raceway.cli import cli
from tests.page_examples import run_blocks
from tests.paths import ROOT
from tests.tone_corpora import write_corpus

PAGE = (ROOT / "docs" / "features.md").read_text(encoding="utf-8")


def test_the_tables_are_the_definitions():
    assert with_tables(PAGE) == PAGE, "run make generated"


def test_the_examples_run_one_after_the_other(tmp_path, monkeypatch):
    write_corpus(tmp_path / "corpus")
    monkeypatch.chdir(tmp_path)
    names = run_blocks("features.md", tmp_path)
    assert names["values"].shape == (4, len(define_features()))


@pytest.mark.parametrize("line", re.findall(r"^raceway (.*?)(?: +#.*)?$", PAGE, re.MULTILINE))
def test_a_command_of_the_page_has_these_options(line):
    name, *arguments = shlex.split(line)
    command = cli.commands[name]
    known = {option for parameter in command.params for option in parameter.opts}
    assert {argument for argument in arguments if argument.startswith("-")} <= known


(LINES,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)


def test_a_record_a_corpus_and_its_features_are_made_as_the_readme_says(tiny_corpus, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(tiny_corpus, Path("out/quickstart/corpus"))
    names = {}
    exec(LINES.replace("seed=1)", "seed=1, waviness_nm=20, duration_s=0.1)"), names)  # noqa: S102 - our own page
    assert names["record"].fault_name == "outer"
    assert names["table"].sizes["record"] == names["corpus"].sizes["record"]
