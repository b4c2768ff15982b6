"""Makes a book of documents that were written for a repository.

A link to a folder of the repository becomes its text; one to a file leads to a copy of the file. Each public name of the
Python package has to be in the API.
"""
import re
from pathlib import Path

import motet
from sphinx.util import logging

LINK = re.compile(r"\[([^\]\n]+)\]\(([^)#:\s]+)\)")
log = logging.getLogger(__name__)


def without_folders(app, docname, source):
    """Take the links to folders out of a document."""
    here = Path(app.env.doc2path(docname)).parent
    source[0] = LINK.sub(lambda link: link[1] if (here / link[2]).is_dir() else link[0], source[0])


def check(app, env):
    """Warn of public names of the package that no page of the API has."""
    written = {name.removeprefix("motet.") for name in env.get_domain("py").objects}
    for name in sorted(set(motet.__all__) - {"__version__", "shapes", "MeshLike"} - written):
        log.warning("motet.%s is not in the API: docs/site/api", name)


def setup(app):
    app.connect("source-read", without_folders)
    app.connect("env-check-consistency", check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
