"""Checks the links inside a folder of HTML pages: each leads to a file, and to a place in it.

    python docs/site/links.py FOLDER

Prints how many there are, and those that lead nowhere. Pages of rustdoc (rust/) are not read.
"""
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The links and the places of a page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.places = [], {"", "top"}
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name"):
                self.places.add(value)
            elif name in ("href", "src") and value is not None:
                self.links.append(value)


def broken(folder):
    """Return the number of links inside the folder, and those that lead nowhere."""
    pages = {path: Page(path) for path in sorted(folder.rglob("*.html")) if "rust" not in path.relative_to(folder).parts[:1]}
    n_links, wrong = 0, []
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            n_links += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            exists = target.is_file() and target.is_relative_to(folder)
            if not exists or (target in pages and unquote(parts.fragment) not in pages[target].places):
                wrong.append(f"{path.relative_to(folder)}: {link}")
    return len(pages), n_links, wrong


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    n_pages, n_links, wrong = broken(Path(sys.argv[1]).resolve())
    print(f"{n_pages} pages, {n_links} links inside, {len(wrong)} of them broken", *wrong, sep="\n  ")
    sys.exit(bool(wrong))
