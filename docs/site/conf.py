# SPDX-License-Identifier: BSD-3-Clause
"""How Sphinx makes the site; scripts/docs calls it on what assemble.py laid out."""
import os
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BUILD = pathlib.Path(os.environ["LIVENS_DOCS_BUILD"])
sys.path.insert(0, str(HERE / "extensions"))

project = "livens"
author = "The livens authors"
copyright = author   # noqa: A001
release = re.search(r'version = "([0-9.]+)"', (ROOT / "src/livens/base/version.h").read_text()).group(1)
version = release

extensions = ["myst_parser", "breathe", "sphinx_design", "sphinx_copybutton", "sphinx.ext.autodoc",
              "sphinx.ext.napoleon", "livens_site"]
myst_enable_extensions = ["colon_fence", "dollarmath", "deflist", "attrs_inline"]
myst_heading_anchors = 5
html_math_renderer = "livens"
breathe_projects = {"livens": str(BUILD / "doxygen" / "xml")}
breathe_default_project = "livens"
autodoc_typehints = "signature"
autodoc_member_order = "groupwise"
autodoc_default_options = {"members": True}
napoleon_use_rtype = False
nitpicky = False
toc_object_entries = False   # every page copies the whole tree for its sidebar: with them that is most of the time
# `type` of annotations is also an attribute of four classes; every header opens the namespace.
suppress_warnings = ["ref.python", "duplicate_declaration.cpp"]
pygments_style = "friendly"
pygments_dark_style = "monokai"

html_theme = "furo"
html_title = f"livens {release}"
html_favicon = str(HERE / "static" / "mark.svg")
html_logo = str(HERE / "static" / "mark.svg")
html_static_path = [str(HERE / "static")]
html_extra_path = [str(BUILD / "extra")]
html_css_files = ["livens.css"]
html_js_files = ["livens.js"]
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "light_css_variables": {
        "color-brand-primary": "#00664b", "color-brand-content": "#00664b", "color-brand-visited": "#00664b",
    },
    "dark_css_variables": {
        "color-brand-primary": "#4fd1a5", "color-brand-content": "#4fd1a5", "color-brand-visited": "#4fd1a5",
    },
    "navigation_with_keys": False,
    "top_of_page_buttons": [],
}
copybutton_exclude = ".linenos, .gp, .go"
