"""The commands of docs/guide and docs/tutorials print what the pages show.

    target/venv/bin/python -m pytest crosscheck/test_guide.py
    target/venv/bin/python crosscheck/test_guide.py --write           update the output in the pages

Each page is processed from top to bottom, in a separate folder:

- A block of code that begins with a comment with a file name is written to that file.
- A block `console` contains commands, after `$ `, and their output including errors. A line `...` stands for
  omitted lines, and `...` at the end of a line for the rest of it. If no output is shown, none is compared.
  `$ echo $?` is followed by the exit status of the command before it; the default is 0.
- A command with `pkg-config` runs only if the C library is installed, in target/capi/install.

Text and zeros must be equal. Other numbers may differ; `--write` updates them.
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
PAGES = [page for folder in ("guide", "tutorials") for page in sorted((ROOT / "docs" / folder).glob("*.md"))]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"^(?:#|//|!|/\*) ([\w-]+\.\w+)(?: \*/)?$")
TIME = re.compile(r"\b[\d.]+ (?:ns|us|ms|s|min)\b")
NUMBER = re.compile(r"(?<![\w.])-?(?:\d{1,3}(?: \d{3})+(?!\d)|\d+)(?:\.\d+)?(?:e-?\d+)?(?![\w])(?!\.\d)")
CAPI = ROOT / "target" / "capi" / "install"


class Command:
    """A command of a page, the position and the lines of its output there, and its exit status."""

    def __init__(self, text, start, end, printed):
        self.text, self.start, self.end, self.printed, self.code = text, start, end, printed, 0


def steps(text):
    """Yield the files and commands of a page in order: (name, contents) or Command."""
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
        command = line[2:]
        while command.endswith("\\\n") and lines:
            command += lines[0]
            offset += len(lines.pop(0))
        start, printed = offset, []
        while lines and not lines[0].startswith("$ "):
            printed.append(lines[0].rstrip("\n"))
            offset += len(lines.pop(0))
        if command.strip() == "echo $?":
            found[-1].code = int(printed[0])
        else:
            found.append(Command(command.strip(), start, offset, printed))
    return found


def timeless(line):
    return " ".join(TIME.sub("TIME", line).split())


def masked(line):
    """Replace times and all numbers except 0, which may differ between machines."""
    return NUMBER.sub(lambda number: "0" if number.group() == "0" else "N", timeless(line))


def fits(expected, line):
    if expected.endswith("...") and expected != "...":
        return masked(line).startswith(masked(expected[:-3]))
    return masked(expected) == masked(line)


def matched(expected, lines):
    """Return `expected` with its lines replaced by those that were printed, or None if they do not match."""
    if not expected:
        return [] if not lines else None
    if expected[0] == "...":
        # If several lines match, the one that begins with the same words is preferred.
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
    """Return an environment in which `motet`, `python` and `pkg-config` use this build."""
    programs = folder / ".bin"
    programs.mkdir()
    (programs / "motet").symlink_to(motet)
    (programs / "python").write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    (programs / "python").chmod(0o755)
    # The library path replaces an installation in a system folder.
    return dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}", PKG_CONFIG_PATH=str(CAPI / "lib" / "pkgconfig"), LD_LIBRARY_PATH=str(CAPI / "lib"))


def follow(page, motet, folder):
    """Write the files and run the commands of a page.

    Yield each command, its exit status and printed lines.
    """
    variables = environment(motet, folder)
    with_library = (CAPI / "lib" / "pkgconfig" / "motet.pc").exists() and shutil.which("pkg-config") and shutil.which("gcc") and shutil.which("gfortran")
    not_built = set()
    for step in steps(page.read_text()):
        if isinstance(step, tuple):
            (folder / step[0]).write_text(step[1])
            continue
        if "pkg-config" in step.text and not with_library:
            not_built.add("./" + step.text.split("-o ")[1].split()[0])
        elif step.text.split()[0] not in not_built:
            done = subprocess.run(["bash", "-c", step.text], cwd=folder, env=variables, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
            lines = [line.rstrip() for line in done.stdout.strip("\n").splitlines()]
            yield step, done.returncode, lines


@pytest.mark.skipif(os.name == "nt", reason="the commands need a POSIX shell")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}/{page.stem}")
def test_commands_print_what_the_page_shows(page, motet, tmp_path):
    pytest.importorskip("motet", reason="the package is not installed: ./test does it")
    wrong = []
    for command, code, lines in follow(page, motet.path.resolve(), tmp_path):
        output = "\n".join(lines)
        assert code == command.code, f"$ {command.text}\nexit status {code}, the page shows {command.code}\n{output}"
        if command.printed and matched(command.printed, lines) is None:
            wrong.append(f"$ {command.text}\n{output}\n--- the page shows\n" + "\n".join(command.printed))
    assert not wrong, "\n\n".join(wrong)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}/{page.stem}")
def test_linked_files_exist(page):
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", text):
        assert target.startswith("https://") or (page.parent / target).exists(), f"{page.name}: {target}"


def write(motet, pages):
    """Update the output in the pages; where lines do not match, replace the whole output of the command."""
    for page in pages:
        text = page.read_text()
        changes = []
        with tempfile.TemporaryDirectory() as folder:
            for command, code, lines in follow(page, motet, Path(folder)):
                if code != command.code:
                    print(f"{page.name}: $ {command.text}\n  exit status {code}, the page shows {command.code}\n  " + "\n  ".join(lines))
                if command.printed and (now := matched(command.printed, lines)) != command.printed:
                    if now is None:
                        print(f"{page.name}: $ {command.text}: lines differ, replaced")
                    changes.append((command, lines if now is None else now))
        for command, lines in reversed(changes):
            text = text[: command.start] + "".join(f"{line}\n" for line in lines) + text[command.end :]
        page.write_text(text)


if __name__ == "__main__":
    if sys.argv[1:2] != ["--write"]:
        sys.exit(__doc__)
    write(Path(os.environ.get("MOTET_BIN_DIR") or ROOT / "target" / "debug").resolve() / "motet", [page for page in PAGES if page.stem in sys.argv[2:] or not sys.argv[2:]])
