"""Where the programs and the real meshes are, and how to call them."""
import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SUFFIX = ".exe" if os.name == "nt" else ""


class Program:
    """A built program of the project: `program("info", path, json=True)`."""

    def __init__(self, path):
        self.path = Path(path)

    def run(self, *words, code=0, timeout=300, **options):
        """Runs it and asserts its exit status (`code=None`: any); the completed process, output as text."""
        done = subprocess.run([str(self.path), *map(str, words)], capture_output=True, text=True,
                              timeout=timeout, **options)
        if code is not None:
            assert done.returncode == code, (
                f"{self.path.name} {' '.join(map(str, words))}: exit status {done.returncode}, expected {code}\n"
                f"{done.stdout}{done.stderr}")
        return done

    def json(self, *words, **options):
        """Runs it with `--json` and returns the one object that it prints."""
        return json.loads(self.run(*words, "--json", **options).stdout)

    __call__ = run


def _built(name):
    folder = Path(os.environ.get("MOTET_BIN_DIR") or ROOT / "target" / "debug")
    path = folder / (name + SUFFIX)
    if not path.exists():
        pytest.fail(f"{path} is not built: cargo build --workspace --bins --examples", pytrace=False)
    return Program(path)


def data_folder():
    """The folder of real meshes, or None."""
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
    """The folder of real meshes; the test is skipped where there is none."""
    folder = data_folder()
    if folder is None:
        pytest.skip("no real meshes: set MOTET_DATA")
    return folder


@pytest.fixture(scope="session")
def sphere(motet, tmp_path_factory):
    """A folder and a report: `box.vtu`, a sphere in a box of 184,320 tets, two patches; `moved.pvd`, the sphere moves to near a wall; `move.json`, the report."""
    shapes = pytest.importorskip("motet", reason="the package is not installed: ./test does it").shapes
    folder = tmp_path_factory.mktemp("sphere")
    shapes.sphere_in_box(16, 20).save(folder / "box.vtu")
    told = motet("move", folder / "box.vtu", "-o", folder / "moved.pvd", "--translate", "sphere=3,0,0", "--quality", "--json").stdout
    (folder / "move.json").write_text(told)
    return folder, json.loads(told)
