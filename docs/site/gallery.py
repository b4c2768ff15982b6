"""The gallery: `{gallery}` shows scripts of docs/gallery with their pictures and what they print, `{thumbnails}` the pictures as links."""
import ast
import os
import re
from pathlib import Path

from docutils import nodes
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

FOLDER = Path(__file__).resolve().parent.parent / "gallery"
BLOCK = re.compile(r"^```{gallery}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
log = logging.getLogger(__name__)


class Script:
    """A script of the gallery: its title and text from the docstring, and its code."""

    def __init__(self, name):
        self.path = FOLDER / f"{name}.py"
        text = self.path.read_text()
        docstring = ast.parse(text).body[0]
        self.title, _, self.text = (part.strip() for part in docstring.value.value.partition("\n"))
        self.code = "\n".join(text.splitlines()[docstring.end_lineno:]).strip()


def pages():
    """Return the names of the scripts by page, in the order of the pages in docs/gallery/README.md."""
    found = {}
    for page in re.findall(r"\]\((\w+)\.md\)", (FOLDER / "README.md").read_text()):
        found[page] = [name for block in BLOCK.findall((FOLDER / f"{page}.md").read_text()) for name in block.split()]
    return found


class Pictured(SphinxDirective):
    """A directive that shows pictures."""

    def picture(self, name, **words):
        path = os.path.relpath(Path(self.config.pictures) / f"{name}.png", self.env.srcdir)
        return nodes.image(uri=f"/{path}", alt=words.pop("alt"), loading="lazy", **words)


class Gallery(Pictured):
    """Scripts by name, one a line."""

    has_content = True

    def run(self):
        return [self.section(name) for line in self.content for name in line.split()]

    def section(self, name):
        script = Script(name)
        self.env.note_dependency(str(script.path))
        section = nodes.section("", nodes.title(script.title, script.title), ids=[name], names=[name])
        section += self.parse_text_to_nodes(script.text)
        section += self.picture(name, alt=script.title, classes=["picture"])
        section += nodes.literal_block(script.code, script.code, language="python")
        printed = (Path(self.config.pictures) / f"{name}.txt").read_text(encoding="utf-8").rstrip()
        if printed:
            section += nodes.literal_block(printed, printed, language="none", classes=["printed"])
        return section


class Thumbnails(Pictured):
    """All pictures of a page, as links to their scripts."""

    required_arguments = 1

    def run(self):
        page = self.arguments[0]
        box = nodes.container(classes=["thumbnails"])
        for name in pages()[page]:
            title = Script(name).title
            link = nodes.reference("", "", self.picture(name, alt=""), nodes.Text(title), internal=True, refuri=f"{page}.html#{name}")
            box += nodes.paragraph("", "", link)
        return [box]


def check(app, env):
    shown = [name for names in pages().values() for name in names]
    for name in sorted({path.stem for path in FOLDER.glob("*.py")}):
        if shown.count(name) != 1:
            log.warning("docs/gallery/%s.py is on %s pages of the gallery, expected 1", name, shown.count(name))


def setup(app):
    app.add_config_value("pictures", "", "env")
    app.add_directive("gallery", Gallery)
    app.add_directive("thumbnails", Thumbnails)
    app.connect("env-check-consistency", check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
