"""Type annotations and documentation of the package."""
import subprocess
import sys
from pathlib import Path

import pytest

import motet

PROJECT = Path(__file__).parents[1] / "pyproject.toml"


def mypy(module, *arguments, cwd):
    call = subprocess.run([sys.executable, "-m", module, *arguments], capture_output=True, text=True, cwd=cwd)
    assert call.returncode == 0, call.stdout + call.stderr


def test_the_stub_matches_the_native_module(tmp_path):
    pytest.importorskip("mypy")
    mypy("mypy.stubtest", "motet._motet", "--mypy-config-file", str(PROJECT), cwd=tmp_path)


def test_the_package_passes_mypy(tmp_path):
    pytest.importorskip("mypy")
    mypy("mypy", "--config-file", str(PROJECT), "-p", "motet", cwd=tmp_path)


def test_everything_public_is_documented():
    missing = [name for name in motet.__all__ if name[0] != "_" and not getattr(getattr(motet, name), "__doc__", None)]
    assert missing in ([], ["MeshLike"])
