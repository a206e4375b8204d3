"""Sphinx settings. `make docs` builds the pages into build/docs without a warning and without the network."""

from __future__ import annotations

import sys
from importlib import metadata
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import docstrings
import generated
from sphinx.application import Sphinx

project = "bearingdyn"
author = "The bearingdyn developers"
copyright = "The bearingdyn developers, BSD-3-Clause"
try:
    release = metadata.version("bearingdyn")
except metadata.PackageNotFoundError:
    release = ""

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml"]
exclude_patterns = ["*.py", "**/.ipynb_checkpoints", "**/__pycache__"]

# ---- pages and notebooks
myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
nb_custom_formats = {".py": ["jupytext.reads", {"fmt": "py:percent"}]}
nb_execution_mode = "cache"  # executed when they change; -D nb_execution_mode=off leaves their outputs out
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_merge_streams = True

# ---- reference
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_type_aliases = {"ArrayLike": "ArrayLike", "Array": "Array", "Float": "Array", "Index": "Array"}
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
napoleon_attr_annotations = False  # types stand in the signatures
default_role = "code"
add_module_names = False
nitpicky = True
# types of other packages, and letters of a type alias, are not looked up: no network
nitpick_ignore_regex = [("py:.*", r".*")]

# ---- looks
html_theme = "furo"
html_title = "bearingdyn"
html_static_path = ["_static", "looks"]
html_css_files = ["wide.css"]
html_math_renderer = "mathml"
html_show_sphinx = False
html_copy_source = False


def setup(app: Sphinx) -> None:
    """Pictures are drawn, and marks in docstrings escaped, at build time."""
    generated.make()
    app.connect("autodoc-process-signature", docstrings.shorten)
    app.connect("autodoc-process-docstring", docstrings.process, priority=400)
