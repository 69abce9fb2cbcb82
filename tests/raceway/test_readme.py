"""The examples of README.md run as they stand, with a smaller corpus and recipe."""

import re
import shutil

from tests.paths import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_corpora_tables_and_scenarios_are_made_as_the_readme_says(tiny_corpus, tiny_recipe, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(tiny_corpus, "corpus")
    example = re.findall(r"```python\n(.*?)```", README, re.DOTALL)[1]
    names = {}
    exec(example.replace('"quickstart"', repr(str(tiny_recipe))), names)  # noqa: S102 - our own page
    assert len(names["pair"].acceleration) == 2
    assert names["table"].sizes["record"] == names["corpus"].sizes["record"]
    assert names["twin"].specimen.fault == "healthy" != names["scenario"].specimen.fault
