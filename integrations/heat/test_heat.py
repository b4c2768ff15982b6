"""The computations keep their heat while motet moves and repairs the mesh."""
import subprocess
import sys
from pathlib import Path

import pytest

SOLVERS = {"dolfinx": "dolfinx", "mfem": "mfem.ser"}


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_heat_stays_and_no_tet_is_bad(solver):
    pytest.importorskip(SOLVERS[solver])
    script = Path(__file__).with_name(f"with_{solver}.py")
    call = subprocess.run([sys.executable, script, "--steps", "20"], capture_output=True, text=True)
    assert call.returncode == 0, call.stderr
    assert " 0 bad, 0 inverted" in call.stdout and float(call.stdout.split("changed by ")[1].split(";")[0]) < 1e-9, call.stdout
    assert "temperature -0.0012 to 0.2066" in call.stdout, "the solvers agree"
