"""Settings of the documentation site, which ``make docs`` builds from the pages of the repository.

Sphinx, because the docstrings follow the conventions of NumPy, and with the theme of NumPy, pandas and SciPy, whose users ours are; it
reads the Markdown pages as they are. The site needs no network.
"""

import importlib.metadata

project = "Raceway"
project_copyright = "the Raceway developers, BSD-3-Clause"
release = importlib.metadata.version("raceway")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton"]
root_doc = "docs/site/index"
include_patterns = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs/**", "recipes/README.md"]
exclude_patterns = ["docs/site/extra/**"]
myst_heading_anchors = 4
autodoc_member_order = "bysource"
autodoc_default_options = {
    "exclude-members": "set_transform_request"
}  # made by scikit-learn, with links into its pages
autodoc_typehints = "none"  # docstrings have shapes and units in their place

html_theme = "pydata_sphinx_theme"
html_title = "Raceway"
html_extra_path = ["extra"]
html_show_sourcelink = False
html_theme_options = {
    "show_toc_level": 2,
    "header_links_before_dropdown": 4,
    "navbar_align": "left",
    "footer_start": ["copyright"],
    "footer_end": [],
}
