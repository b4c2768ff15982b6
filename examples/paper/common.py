"""Helpers of the scripts in this folder: paths, calls of motet, meshes for drawing, and tables."""
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
WORK = ROOT / "target" / "paper"
# The limit of the paper, figure 11: tets with an EAS below it are bad.
BAD = 0.2
PALE = "#f1f3f5"

sys.path.append(str(DOCS))

from program import binary  # noqa: E402


def motet_json(*arguments):
    """Call the program with --json and return its report."""
    done = subprocess.run([str(binary()), *map(str, arguments), "--json"], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        sys.exit(f"motet {' '.join(map(str, arguments))}: exit status {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def work(name):
    """Return the path of an intermediate file."""
    WORK.mkdir(parents=True, exist_ok=True)
    return WORK / name


def patch_triangles(mesh, name):
    """Return the triangles of a patch as rows of vertex ids."""
    label = next(number for number, known in mesh.patch_names.items() if known == name)
    return mesh.triangles[mesh.cell_data["patch"][mesh.cell_ids("triangle")] == label]


def surface(points, triangles, name):
    """Return a surface of the given triangles and only their points, with one patch."""
    import motet

    used, rows = np.unique(triangles, return_inverse=True)
    return motet.Mesh(
        np.asarray(points)[used],
        {"triangle": rows.reshape(-1, 3)},
        cell_data={"patch": np.ones(len(triangles), np.int32)},
        patch_names={1: name},
    )


def grid(mesh, **arrays):
    """Return the tets of a mesh for drawing, with their EAS and further arrays of one row per tet."""
    import pyvista as pv

    drawn = pv.UnstructuredGrid({pv.CellType.TETRA: mesh.tets}, mesh.points)
    drawn["EAS"] = mesh.quality()[mesh.cell_ids("tetra")]
    for name, values in arrays.items():
        drawn.cell_data[name] = values
    return drawn


def poly(mesh, triangles=None):
    """Return triangles of a mesh for drawing: all, or the given rows."""
    import pyvista as pv

    rows = mesh.triangles if triangles is None else triangles
    return pv.PolyData.from_regular_faces(mesh.points, rows)


def behind(drawn, axis, at=0.0):
    """Return the cells of a grid whose centres lie behind a plane, seen from its lower side."""
    return drawn.extract_cells(drawn.cell_centers().points[:, axis] > at)


def print_table(head, rows):
    """Print a Markdown table."""
    for row in (head, ["---"] * len(head), *rows):
        print("| " + " | ".join(map(str, row)) + " |")
