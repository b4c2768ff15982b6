"""The scripts of examples/paper can be imported, and tables 1 and 2 agree with the paper."""
import importlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("pyvista")
pytest.importorskip("motet", reason="the package is not installed: ./test does it")

FOLDER = Path(__file__).resolve().parent.parent / "examples" / "paper"
SCRIPTS = sorted(path.stem for path in FOLDER.glob("*_[0-9]*.py"))


@pytest.fixture
def load(monkeypatch):
    """A function that imports a script by name, together with the modules beside it."""
    monkeypatch.syspath_prepend(str(FOLDER))
    return importlib.import_module


@pytest.mark.parametrize("name", SCRIPTS)
def test_each_script_can_be_imported_and_documents_its_call(load, name):
    module = load(name)
    assert callable(module.main) and f"examples/paper/{name}.py" in module.__doc__


def test_types_change_at_the_limits_of_the_paper(load):
    table = load("table_2")
    for kind, (_, limit) in table.PAPER.items():
        make, measure = table.FAMILIES[kind]
        change = table.bisected(lambda h, make=make, kind=kind: table.classified(make(h), kind) == kind, 1e-6, 1.0)
        assert measure(make(change)) == pytest.approx(limit, rel=1e-9), kind


def test_table_1_runs_for_its_smallest_mesh(motet):
    done = subprocess.run([sys.executable, FOLDER / "table_1.py", "A"], capture_output=True, text=True, env={**os.environ, "MOTET_BIN_DIR": str(motet.path.parent)})
    assert done.returncode == 0, done.stderr
    assert "| A | 10,816 | 56,700 | 2,704 |" in done.stdout
