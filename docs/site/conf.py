"""Settings of the documentation site, which ``make docs`` builds from the pages of the repository.

Sphinx, because the docstrings follow the conventions of NumPy, and with the theme of NumPy, pandas and SciPy, whose users ours are; it
reads the Markdown pages as they are, and runs the tutorials, so that all output on them is that of this version. The site needs no network.
"""

import importlib.metadata
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

project = "Raceway"
project_copyright = "the Raceway developers, BSD-3-Clause"
release = importlib.metadata.version("raceway")

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton"]
root_doc = "docs/site/index"
include_patterns = [
    *("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs/**", "recipes/README.md"),
    "studies/ophel2025/errata.md",
]
exclude_patterns = ["docs/site/extra/**"]
myst_heading_anchors = 4
nb_execution_mode = "force"  # Sphinx itself leaves out pages that have not changed
nb_execution_raise_on_error = True
nb_execution_timeout = 120  # of a cell [s]
nb_execution_in_temp = True
nb_merge_streams = True
copybutton_prompt_text = "!"  # before commands of the shell, in tutorials
copybutton_selector = "div:not(.output) > div.highlight pre"  # no button on outputs
autodoc_member_order = "bysource"
autodoc_default_options = {
    "exclude-members": "set_transform_request"
}  # made by scikit-learn, with links into its pages
autodoc_typehints = "none"  # docstrings have shapes and units in their place

html_theme = "pydata_sphinx_theme"
html_title = "Raceway"
html_extra_path = ["extra"]
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_show_search_summary = (
    False  # a page that is opened from a folder may not fetch others; the search itself needs no server
)
html_context = {"default_mode": "auto"}  # light or dark, as the reader has it
html_theme_options = {
    "show_toc_level": 2,
    "header_links_before_dropdown": 4,
    "navbar_align": "left",
    "footer_start": ["copyright"],
    "footer_end": [],
}

profile = tempfile.TemporaryDirectory()  # the kernel of the tutorials writes into it
shutil.copytree(Path(__file__).with_name("kernel"), Path(profile.name) / "profile_default")
os.environ["IPYTHONDIR"] = profile.name
os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"


def offer_notebook(_app: Any, docname: str, source: list[str]) -> None:
    """Offer the notebook of a tutorial below its title."""
    if docname.startswith("docs/tutorials/"):
        link = f"{{nb-download}}`Download this page as a notebook <{Path(docname).name}.ipynb>`"
        source[0] = re.sub(r"^# .*\n", lambda title: f"{title[0]}\n{link}\n", source[0], count=1, flags=re.MULTILINE)


def setup(app: Any) -> None:
    """Connect the hooks of this site."""
    app.connect("source-read", offer_notebook)
