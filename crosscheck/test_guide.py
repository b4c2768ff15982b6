"""The guide as a reader follows it: every command of docs/guide, run as it stands there, prints what stands there.

    target/venv/bin/python -m pytest crosscheck/test_guide.py
    target/venv/bin/python crosscheck/test_guide.py --write           put what the commands print now into the pages

A page is read from top to bottom, in a folder of its own:

- a block of code that begins with a comment that is a file's name is that file;
- a block `console` has commands, after `$ `, and what they print, errors too. A line `...` stands for lines that were left out, and so does `...` at the end of one for
  the rest of it. Without any line it is not looked at what is printed. `$ echo $?` asks for the exit status of the command before it; without that it is 0;
- a command with `pkg-config` runs where the C library is installed, in target/capi/install.

Words have to be the same, and what is 0; other numbers may differ: these are for `--write`.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted((ROOT / "docs" / "guide").glob("*.md"))
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"^(?:#|//|!|/\*) ([\w-]+\.\w+)(?: \*/)?$")
TIME = re.compile(r"\b[\d.]+ (?:ns|us|ms|s|min)\b")
NUMBER = re.compile(r"(?<![\w.])-?(?:\d{1,3}(?: \d{3})+(?!\d)|\d+)(?:\.\d+)?(?:e-?\d+)?(?![\w])(?!\.\d)")
CAPI = ROOT / "target" / "capi" / "install"


class Command:
    """A command of a page, where what it prints stands there, and its exit status."""

    def __init__(self, words, start, end, printed):
        self.words, self.start, self.end, self.printed, self.code = words, start, end, printed, 0


def steps(text):
    """The files and commands of a page in their order: (name, contents) or Command."""
    for block in BLOCK.finditer(text):
        kind, body = block.groups()
        name = FILE.match(body.split("\n", 1)[0])
        if kind == "console":
            yield from commands(body, block.start(2))
        elif name:
            yield name.group(1), body


def commands(body, offset):
    found = []
    lines = body.splitlines(keepends=True)
    while lines:
        line = lines.pop(0)
        offset += len(line)
        if not line.startswith("$ "):
            continue
        words = line[2:]
        while words.endswith("\\\n") and lines:
            words += lines[0]
            offset += len(lines.pop(0))
        start, printed = offset, []
        while lines and not lines[0].startswith("$ "):
            printed.append(lines[0].rstrip("\n"))
            offset += len(lines.pop(0))
        if words.strip() == "echo $?":
            found[-1].code = int(printed[0])
        else:
            found.append(Command(words.strip(), start, offset, printed))
    return found


def timeless(line):
    return " ".join(TIME.sub("TIME", line).split())


def masked(line):
    """Without what differs from machine to machine: times, and numbers but for 0."""
    return NUMBER.sub(lambda number: "0" if number.group() == "0" else "N", timeless(line))


def fits(expected, line):
    if expected.endswith("...") and expected != "...":
        return masked(line).startswith(masked(expected[:-3]))
    return masked(expected) == masked(line)


def matched(expected, lines):
    """`expected` with the lines that were printed in place of those that stood there, or None."""
    if not expected:
        return [] if not lines else None
    if expected[0] == "...":
        # Where several lines would do, the one that begins with the same words.
        named = expected[1].split()[:2] if expected[1:] else []
        for k in sorted(range(len(lines) + 1), key=lambda k: k == len(lines) or lines[k].split()[:2] != named):
            rest = matched(expected[1:], lines[k:])
            if rest is not None:
                return ["...", *rest]
        return None
    if not lines or not fits(expected[0], lines[0]):
        return None
    rest = matched(expected[1:], lines[1:])
    now = expected[0] if timeless(expected[0]) == timeless(lines[0]) else lines[0]
    if expected[0].endswith("..."):
        now = lines[0][: len(expected[0]) - 3].rstrip() + " ..."
    return None if rest is None else [now, *rest]


def environment(motet, folder):
    """Where the page's words `motet`, `python` and `pkg-config` find what they ask for."""
    programs = folder / ".bin"
    programs.mkdir()
    (programs / "motet").symlink_to(motet)
    (programs / "python").write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    (programs / "python").chmod(0o755)
    # The loader's path stands for an installation where the system looks.
    return dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}", PKG_CONFIG_PATH=str(CAPI / "lib" / "pkgconfig"), LD_LIBRARY_PATH=str(CAPI / "lib"))


def follow(page, motet, folder):
    """Does all that a page says; yields each command that was run, its exit status and what it printed, by lines."""
    surroundings = environment(motet, folder)
    with_library = (CAPI / "lib" / "pkgconfig" / "motet.pc").exists() and shutil.which("pkg-config") and shutil.which("gcc") and shutil.which("gfortran")
    left_out = set()
    for step in steps(page.read_text()):
        if isinstance(step, tuple):
            (folder / step[0]).write_text(step[1])
            continue
        if "pkg-config" in step.words and not with_library:
            left_out.add("./" + step.words.split("-o ")[1].split()[0])
        elif step.words.split()[0] not in left_out:
            done = subprocess.run(["bash", "-c", step.words], cwd=folder, env=surroundings, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
            lines = [line.rstrip() for line in done.stdout.strip("\n").splitlines()]
            yield step, done.returncode, lines


@pytest.mark.skipif(os.name == "nt", reason="the commands are those of a shell")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_do_what_the_page_says(page, motet, tmp_path):
    pytest.importorskip("motet", reason="the package is not installed: ./test does it")
    wrong = []
    for command, code, lines in follow(page, motet.path.resolve(), tmp_path):
        told = "\n".join(lines)
        assert code == command.code, f"$ {command.words}\nexit status {code}, the page says {command.code}\n{told}"
        if command.printed and matched(command.printed, lines) is None:
            wrong.append(f"$ {command.words}\n{told}\n--- the page says\n" + "\n".join(command.printed))
    assert not wrong, "\n\n".join(wrong)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text()):
        assert target.startswith("https://") or (page.parent / target).exists(), f"{page.name}: {target}"


def write(motet, pages):
    """Puts what the commands print now into the pages; where other lines are printed than stood there, all of them."""
    for page in pages:
        text = page.read_text()
        changes = []
        with tempfile.TemporaryDirectory() as folder:
            for command, code, lines in follow(page, motet, Path(folder)):
                if code != command.code:
                    print(f"{page.name}: $ {command.words}\n  exit status {code}, the page says {command.code}\n  " + "\n  ".join(lines))
                if command.printed and (now := matched(command.printed, lines)) != command.printed:
                    if now is None:
                        print(f"{page.name}: $ {command.words}: other lines than stood there")
                    changes.append((command, lines if now is None else now))
        for command, lines in reversed(changes):
            text = text[: command.start] + "".join(f"{line}\n" for line in lines) + text[command.end :]
        page.write_text(text)


if __name__ == "__main__":
    if sys.argv[1:2] != ["--write"]:
        sys.exit(__doc__)
    write(Path(os.environ.get("MOTET_BIN_DIR") or ROOT / "target" / "debug").resolve() / "motet", [page for page in PAGES if page.stem in sys.argv[2:] or not sys.argv[2:]])
