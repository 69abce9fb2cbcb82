"""The lines of Python in README.md run as they stand, with a smaller corpus and record."""

import re
import shutil
from pathlib import Path

from tests.paths import ROOT

(LINES,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)


def test_a_record_a_corpus_and_its_features_are_made_as_the_readme_says(tiny_corpus, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(tiny_corpus, Path("out/quickstart/corpus"))
    names = {}
    exec(LINES.replace("seed=1)", "seed=1, waviness_nm=20, duration_s=0.1)"), names)  # noqa: S102 - our own page
    assert names["record"].fault_name == "outer"
    assert names["table"].sizes["record"] == names["corpus"].sizes["record"]
