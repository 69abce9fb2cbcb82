"""Code blocks of the pages, and their run one after the other, as a reader would run them."""

import importlib.util
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tests.paths import ROOT


def blocks(page: str, language: str = "python") -> list[str]:
    """Code blocks of a page of ``docs`` in one language."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


def run_blocks(page: str, folder: Path, replacements: Mapping[str, str] | None = None, **names: Any) -> dict[str, Any]:
    """Variables of all Python blocks, run in one name space; one that begins with ``# NAME.py`` is written into that file.

    ``folder`` is the current one. ``replacements`` are made in the text, for fewer and shorter records than those of the page;
    ``names`` are variables that the page does not define.
    """
    names |= {"__name__": "example"}
    for block in blocks(page):
        for whole, part in (replacements or {}).items():
            block = re.sub(whole, part, block, flags=re.MULTILINE)
        if module := re.match(r"# (\w+\.py)\n", block):
            (folder / module[1]).write_text(block, encoding="utf-8")
        elif all(
            importlib.util.find_spec(name) for name in re.findall(r"^import (torch|tensorflow)", block, re.MULTILINE)
        ):
            exec(compile(block, f"docs/{page}", "exec"), names)  # noqa: S102 - our own page
    return names
