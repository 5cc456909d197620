"""Sphinx: `make docs` builds these pages into out/docs."""

import sys
from importlib.metadata import version as installed
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import other_projects
from drawn_by_pages import draw, show, with_pictures
from plain_docstrings import as_markup, without_constants

project = "beamfem"
version = release = installed("beamfem")
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax", "sphinx-mathjax-offline"]
extensions += ["sphinx_design", "sphinx_copybutton", "sphinx.ext.viewcode"]  # cards, copy buttons, links to the source
extensions += ["sphinx.ext.intersphinx"]
intersphinx_mapping = other_projects.intersphinx_mapping(Path(__file__).parent / "_inventories")
exclude_patterns = ["_pictures", "_inventories"]  # notebooks to download
myst_enable_extensions = ["amsmath", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "off"  # tutorials have their outputs
html_theme = "furo"
html_title = f"beamfem {release}"
html_static_path = ["_static"]
html_css_files = ["wide.css"]
html_show_copyright = False
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
autodoc_typehints_format = "short"
autodoc_use_type_comments = False
python_maximum_signature_line_length = 100
suppress_warnings = ["myst.xref_missing"]


def setup(app):
    app.connect("builder-inited", draw)
    app.connect("env-get-outdated", with_pictures)
    app.connect("source-read", show)
    app.connect("autodoc-process-docstring", as_markup, priority=400)  # napoleon takes its markup at 500
    app.connect("autodoc-process-signature", without_constants)
