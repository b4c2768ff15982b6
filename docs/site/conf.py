"""The book: the documents of the repository as they are, the API of the Python package, the gallery, the tutorials.

Sphinx runs in the root of the repository, so that links between documents are those that a reader of the repository
follows. ./site calls it.
"""
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import motet  # noqa: E402

project = "motet"
author = "the authors of motet"
version = release = motet.__version__
root_doc = "docs/site/index"
include_patterns = ["*.md", "docs/**.md", "python/README.md", "crates/motet-capi/README.md", "integrations/*/README.md", "examples/paper/README.md", "bench-compare/README.md", "crosscheck/README.md"]
exclude_patterns = [".*", "target", "fuzz", "mutants", "testdata", "bench-compare/target"]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "book", "gallery"]
myst_enable_extensions = ["substitution"]
myst_heading_anchors = 4
highlight_language = "none"
pictures = os.environ["SITE_PICTURES"]

# The reference of the Rust library is beside the book where `cargo doc` has made it (./site copies it).
RUST = "rust/motet/index.html"
beside = "SITE_RUST" in os.environ
myst_substitutions = {"rust": f'<a href="../../{RUST}">the reference of the crate</a>, with all modules' if beside else "`cargo doc --open` makes the reference of the crate, with all modules"}

# Docstrings name types, shapes and units of parameters; signatures name the parameters.
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
napoleon_google_docstring = False
napoleon_use_rtype = False
python_maximum_signature_line_length = 100
add_module_names = False

html_theme = "furo"
html_title = "motet"
html_static_path = ["static"]
html_css_files = ["site.css"]
templates_path = ["templates"]
html_additional_pages = {"index": "start.html"}
html_show_sourcelink = False
html_copy_source = False
html_show_copyright = False
html_theme_options = {"navigation_with_keys": True}
