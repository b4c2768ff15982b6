"""The types that the package promises are those that it has."""
import subprocess
import sys
from pathlib import Path

import pytest

import motet

PROJECT = Path(__file__).parents[1] / "pyproject.toml"


def mypy(module, *words, cwd):
    call = subprocess.run([sys.executable, "-m", module, *words], capture_output=True, text=True, cwd=cwd)
    assert call.returncode == 0, call.stdout + call.stderr


def test_the_stub_is_what_is_there(tmp_path):
    pytest.importorskip("mypy")
    mypy("mypy.stubtest", "motet._motet", "--mypy-config-file", str(PROJECT), cwd=tmp_path)


def test_the_package_has_no_wrong_type(tmp_path):
    pytest.importorskip("mypy")
    mypy("mypy", "--config-file", str(PROJECT), "-p", "motet", cwd=tmp_path)


def test_everything_public_is_documented():
    missing = [name for name in motet.__all__ if name[0] != "_" and not getattr(getattr(motet, name), "__doc__", None)]
    assert missing in ([], ["MeshLike"])
