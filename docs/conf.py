"""Settings of the documentation site: `sphinx-build -W -b html docs build/docs`.

The build needs no network: formulas become MathML by the pandoc that the report uses, and nothing
is loaded from another site. `docs/generators` writes the tables from the program itself.
"""

import sys
from importlib.metadata import version as version_of
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

project = "platecontact"
author = "the authors of platecontact"
version = release = version_of("platecontact")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "docs.generators.sphinx_hooks",
]
exclude_patterns = ["gallery/*.py", "generators"]
templates_path: list[str] = []

smartquotes = False  # `--paper` would become a dash
myst_enable_extensions = ["attrs_inline", "dollarmath"]
myst_heading_anchors = 3

autosummary_generate = False  # the tables link to entries on the same page
autodoc_typehints = "none"  # types stand in the docstrings
default_role = "py:obj"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

html_theme = "pydata_sphinx_theme"
html_title = f"platecontact {release}"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_copy_source = False
html_show_sourcelink = False
html_sidebars = {"gallery/index": [], "index": []}  # they have no pages below them
html_theme_options = {
    "navbar_end": ["theme-switcher"],
    "secondary_sidebar_items": ["page-toc"],
    "show_prev_next": False,
    "footer_start": ["copyright"],
    "footer_end": [],
}
copyright = "the authors of platecontact, MIT licence"  # noqa: A001 (its name in Sphinx)
linkcheck_ignore = [r"https?://.*"]  # local links alone: the build needs no network
