"""Closed surfaces of the mesh benchmark in the formats of all programs, matching sizes, and measures of the
results."""
import math
import os
import subprocess
from pathlib import Path

import numpy as np

from common import MOTET, ROOT, TARGET
from remesh_files import made
from sameness import surface_kept
from tets import measures, volumes

DATA = Path(os.environ.get("MOTET_DATA") or ROOT.parent / "shared" / "data")
OWN = ("aneurysm", "bifurcation")
# Name: file among the real meshes, and interior edge length with which motet makes 50,000 to 200,000 tets.
REAL = {
    "seqseg_demo": ("vessels/seqseg_demo.vtp", 0.2),
    "lh_template": ("vessels/heartdeformnets_lh_template.vtp", 0.01),
    "stretched_arc": ("devices/endobeams_braided_stent/arcStretchObj.obj", 0.6),
    "coil": ("devices/sphinxsys_coil.stl", 2.0),
    "strut": ("devices/confluent_nitinol_strut_deployed.stl", 0.1),
    "7_8ths_cube": ("hostile_surfaces/trimesh_7_8ths_cube.stl", 2.0),
}
OWN_SIZE = 0.15
NEAR = 0.05  # relative difference below which numbers of tets count as equal


def surfaces(quick, wanted):
    """Return the requested cases (all if `wanted` is empty), and the names of those without data."""
    folder = TARGET / "mesh_surfaces"
    folder.mkdir(exist_ok=True)
    subprocess.run([MOTET / "examples" / "shapes", folder, "--around", "24" if quick else "48"], check=True)
    known = {name: (folder / f"{name}.vtp", OWN_SIZE * (2 if quick else 1)) for name in OWN}
    known |= {name: (DATA / file, size) for name, (file, size) in REAL.items()}
    names = wanted.split(",") if wanted else list(OWN[:1]) if quick else list(known)
    if unknown := set(names) - set(known):
        raise SystemExit(f"unknown surface {', '.join(sorted(unknown))}; known: {', '.join(known)}")
    files = {name: known[name] for name in names}
    cases = [Case(name, file, size) for name, (file, size) in files.items() if file.is_file()]
    return cases, [name for name, (file, _) in files.items() if not file.is_file()]


class Case:
    """A surface and its files: `vtp` for motet, `npz` for the others."""

    def __init__(self, name, source, size):
        self.name, self.size, self.folder = name, size, TARGET / f"mesh_{name}"
        self.folder.mkdir(exist_ok=True)
        for path in self.folder.iterdir():
            path.unlink()
        self.vtp, self.npz = self.folder / "surface.vtp", self.folder / "surface.npz"
        subprocess.run([MOTET / "motet", "convert", "-q", source, self.vtp], check=True)
        self.points, self.triangles = merged(*read_vtp(self.vtp))
        np.savez(self.npz, points=self.points, triangles=self.triangles)
        a, b, c = (self.points[self.triangles[:, i]] for i in range(3))
        self.volume = float(np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6)

    def out(self, program, end):
        return self.folder / ("".join(letter if letter.isalnum() else "_" for letter in program) + end)

    def measured(self, path):
        """Measure the quality of a program's mesh, and how much of the surface it kept."""
        points, tets = made(path)
        if volumes(points, tets).sum() < 0:  # TetGen's tets have the opposite orientation
            tets = tets[:, [1, 0, 2, 3]]
        found, extra = surface_kept(self.points, self.triangles, points, tets)
        return {**measures(points, tets), "points": len(np.unique(tets)), "triangles": len(self.triangles), "triangles_found": found,
                "triangles_extra": extra, "volume_off": abs(float(volumes(points, tets).sum()) / self.volume - 1)}


def read_vtp(path):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    whole = reader.GetOutput()
    if whole.GetPolys().GetMaxCellSize() > 3:  # the same triangles for all programs
        divider = vtk.vtkTriangleFilter()
        divider.SetInputData(whole)
        divider.Update()
        whole = divider.GetOutput()
        writer = vtk.vtkXMLPolyDataWriter()
        writer.SetFileName(str(path))
        writer.SetInputData(whole)
        writer.Write()
    corners = vtk_to_numpy(whole.GetPolys().GetConnectivityArray())
    return vtk_to_numpy(whole.GetPoints().GetData()).astype(np.float64), corners.reshape(-1, 3).astype(np.int64)


def merged(points, triangles):
    """Merge coincident points and remove unused ones."""
    used, triangles = np.unique(triangles, return_inverse=True)
    points, row = np.unique(points[used] + 0.0, axis=0, return_inverse=True)  # no negative zeros
    return points, row.ravel()[triangles.reshape(-1, 3)]


def calibrated(count, target, size, tries):
    """Return the size with which a program makes about `target` tets, or the closest one within a number of
    trials.

    `count(size)` returns the number of tets, or None if the program fails. Returns None if the first trial
    fails.
    """
    tried = {}
    slope = 3.0  # counts decrease with this power of the size, or a smaller one if most tets are at the surface
    for _ in range(tries):
        tets = count(size)
        if tets is None:
            break
        if tried:
            last, before = list(tried.items())[-1]
            slope = min(max(math.log(before / tets) / math.log(size / last), 0.5), 3.0)
        tried[size] = tets
        if abs(tets / target - 1) < NEAR:
            break
        fine, coarse = [s for s, n in tried.items() if n > target], [s for s, n in tried.items() if n <= target]
        low = max(fine) if fine else min(coarse) / 4
        high = min(coarse) if coarse else 4 * max(fine)
        size *= (tets / target) ** (1 / slope)
        if not low < size < high:
            size = math.sqrt(low * high)
    return min(tried, key=lambda size: abs(math.log(tried[size] / target)), default=None)
