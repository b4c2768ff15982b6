"""What the scripts of this folder share: where things are, how motet is called, how a sheet of pictures is laid out."""
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


def motet_json(*words):
    """Calls the program with --json; its report."""
    done = subprocess.run([str(binary()), *map(str, words), "--json"], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        sys.exit(f"motet {' '.join(map(str, words))}: exit status {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def work(name):
    """A file of this name among those that are made on the way."""
    WORK.mkdir(parents=True, exist_ok=True)
    return WORK / name


def patch_triangles(mesh, name):
    """The triangles of a patch, as rows of vertices."""
    label = next(number for number, word in mesh.patch_names.items() if word == name)
    return mesh.triangles[mesh.cell_data["patch"][mesh.cell_ids("triangle")] == label]


def surface(points, triangles, name):
    """A surface of these triangles and no other points, of one patch."""
    import motet

    used, rows = np.unique(triangles, return_inverse=True)
    return motet.Mesh(
        np.asarray(points)[used],
        {"triangle": rows.reshape(-1, 3)},
        cell_data={"patch": np.ones(len(triangles), np.int32)},
        patch_names={1: name},
    )


def grid(mesh, **arrays):
    """The tets of a mesh for drawing, with their EAS and more arrays, a row a tet."""
    import pyvista as pv

    drawn = pv.UnstructuredGrid({pv.CellType.TETRA: mesh.tets}, mesh.points)
    drawn["EAS"] = mesh.quality()[mesh.cell_ids("tetra")]
    for name, values in arrays.items():
        drawn.cell_data[name] = values
    return drawn


def poly(mesh, triangles=None):
    """Triangles of a mesh for drawing: all, or these rows."""
    import pyvista as pv

    rows = mesh.triangles if triangles is None else triangles
    return pv.PolyData.from_regular_faces(mesh.points, rows)


def behind(drawn, axis, at=0.0):
    """The cells of a grid whose middle lies beyond a plane, seen from its lower side."""
    return drawn.extract_cells(drawn.cell_centers().points[:, axis] > at)


def print_table(head, rows):
    """A table as Markdown has it."""
    for row in (head, ["---"] * len(head), *rows):
        print("| " + " | ".join(map(str, row)) + " |")
