"""The site: `python docs/build.py` writes docs/_build/html, which needs no network to be read."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_ext"), str(HERE.parent)]

from eomgen.version import __version__  # noqa: E402

project = "eomgen"
author = "the eomgen authors"
copyright = "MIT licence"
version = release = __version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "notebooks",
    "papers",
    "gallery",
    "kinds",
    "mathml",
    "sources",
]
exclude_patterns = ["_build", "_ext"]
source_suffix = {".md": "markdown"}
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist", "attrs_inline"]
myst_heading_anchors = 4
myst_dmath_double_inline = True
autodoc_member_order = "bysource"
autodoc_typehints = "description"
nitpicky = False
html_theme = "pydata_sphinx_theme"
html_title = "eomgen"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_use_index = False  # it is searched
html_show_sourcelink = False
html_show_search_summary = False  # a browser does not let a page from a file fetch another
html_sidebars = {page: [] for page in ("index", "first_hour", "theory", "python")}
html_theme_options = {
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
    "navbar_persistent": ["search-button"],
    "pygments_light_style": "tango",
    "pygments_dark_style": "monokai",
    "footer_start": ["copyright"],
    "footer_end": [],
}
