"""The computation in dolfinx keeps its heat while motet moves and repairs the mesh."""
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("dolfinx")


def test_the_heat_stays_and_no_tet_is_bad():
    call = subprocess.run([sys.executable, Path(__file__).with_name("heat.py"), "--steps", "20"], capture_output=True, text=True)
    assert call.returncode == 0, call.stderr
    assert " 0 bad, 0 inverted" in call.stdout and float(call.stdout.split("changed by ")[1].split(";")[0]) < 1e-9, call.stdout
