"""The examples of README.md run as they stand, with a smaller corpus and recipe."""

import re
import shutil

import gen
from tests.paths import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
RECORDS, CORPORA = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
SMALLER = "waviness_nm=20, duration_s=0.1)"


def test_records_and_a_ladder_are_made_as_the_readme_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    smaller = RECORDS.replace("seed=1)", f"seed=1, {SMALLER}").replace("n=50)", f"n=1, {SMALLER}")
    exec(smaller, names)  # noqa: S102 - our own page
    assert names["record"].fault_name == "outer"
    assert len(names["ladder"].record) == 3
    assert gen.validate_corpus("ladder") == []


def test_corpora_tables_and_scenarios_are_made_as_the_readme_says(tiny_corpus, tiny_recipe, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(tiny_corpus, "corpus")
    names = {}
    exec(CORPORA.replace('"quickstart"', repr(str(tiny_recipe))), names)  # noqa: S102 - our own page
    assert len(names["pair"].acceleration) == 2
    assert names["table"].sizes["record"] == names["corpus"].sizes["record"]
    assert names["twin"].fault == "healthy" != names["scenario"].fault
