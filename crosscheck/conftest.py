"""Fixtures that find and call the programs, and find the real meshes."""
import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SUFFIX = ".exe" if os.name == "nt" else ""


class Program:
    """A built program of the project, called as `program("info", path)`."""

    def __init__(self, path):
        self.path = Path(path)

    def run(self, *arguments, code=0, timeout=300, **options):
        """Run the program, assert its exit status (`code=None` for any) and return the completed process."""
        done = subprocess.run([str(self.path), *map(str, arguments)], capture_output=True, text=True,
                              timeout=timeout, **options)
        if code is not None:
            assert done.returncode == code, (
                f"{self.path.name} {' '.join(map(str, arguments))}: exit status {done.returncode}, expected {code}\n"
                f"{done.stdout}{done.stderr}")
        return done

    def json(self, *arguments, **options):
        """Run the program with `--json` and return the object that it prints."""
        return json.loads(self.run(*arguments, "--json", **options).stdout)

    __call__ = run


def _built(name):
    folder = Path(os.environ.get("MOTET_BIN_DIR") or ROOT / "target" / "debug")
    path = folder / (name + SUFFIX)
    if not path.exists():
        pytest.fail(f"{path} is not built: cargo build --workspace --bins --examples", pytrace=False)
    return Program(path)


def data_folder():
    """Return the folder of real meshes, or None if there is none."""
    folder = Path(os.environ.get("MOTET_DATA") or ROOT.parent / "shared" / "data")
    return folder if folder.is_dir() else None


@pytest.fixture(scope="session")
def motet():
    """The command line: `motet("convert", a, b)`, `motet.json("info", a)`."""
    return _built("motet")


@pytest.fixture(scope="session")
def example():
    """An example program by name: `example("delaunay").run(path)`."""
    return lambda name: _built(f"examples/{name}")


@pytest.fixture(scope="session")
def data():
    """The folder of real meshes; the test is skipped if there is none."""
    folder = data_folder()
    if folder is None:
        pytest.skip("no real meshes: set MOTET_DATA")
    return folder


@pytest.fixture(scope="session")
def sphere(motet, tmp_path_factory):
    """A folder with a moving sphere, and the report of its motion.

    The folder contains `box.vtu`, a sphere in a box of 184,320 tets with two patches; `moved.pvd`, in which
    the sphere moves close to a wall; and `move.json`, the report.
    """
    shapes = pytest.importorskip("motet", reason="the package is not installed: ./test does it").shapes
    folder = tmp_path_factory.mktemp("sphere")
    shapes.sphere_in_box(16, 20).save(folder / "box.vtu")
    report = motet("move", folder / "box.vtu", "-o", folder / "moved.pvd", "--translate", "sphere=3,0,0", "--quality", "--json").stdout
    (folder / "move.json").write_text(report)
    return folder, json.loads(report)
