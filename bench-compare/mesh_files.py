"""Closed surfaces to fill, in the form that each program reads, sizes with which programs make as many tets, and what came of it."""
import math
import os
import subprocess
from pathlib import Path

import numpy as np

from common import MOTET, ROOT, TARGET
from remesh_files import made
from sameness import surface_kept
from tets import volumes, worth

DATA = Path(os.environ.get("MOTET_DATA") or ROOT.parent / "shared" / "data")
OWN = ("aneurysm", "bifurcation")
# name: file within the real meshes, size of edges inside; with these motet makes 50,000 to 200,000 tets
REAL = {
    "seqseg_demo": ("vessels/seqseg_demo.vtp", 0.2),
    "lh_template": ("vessels/heartdeformnets_lh_template.vtp", 0.01),
    "stretched_arc": ("devices/endobeams_braided_stent/arcStretchObj.obj", 0.6),
    "coil": ("devices/sphinxsys_coil.stl", 2.0),
    "strut": ("devices/confluent_nitinol_strut_deployed.stl", 0.1),
    "7_8ths_cube": ("hostile_surfaces/trimesh_7_8ths_cube.stl", 2.0),
}
OWN_SIZE = 0.15
NEAR = 0.05  # counts of tets that differ by less are about equal


def surfaces(quick, wanted):
    """The cases that are asked for (all where `wanted` names none), and the names of those that this machine has not."""
    folder = TARGET / "mesh_surfaces"
    folder.mkdir(exist_ok=True)
    subprocess.run([MOTET / "examples" / "shapes", folder, "--around", "24" if quick else "48"], check=True)
    known = {name: (folder / f"{name}.vtp", OWN_SIZE * (2 if quick else 1)) for name in OWN}
    known |= {name: (DATA / file, size) for name, (file, size) in REAL.items()}
    names = wanted.split(",") if wanted else list(OWN[:1]) if quick else list(known)
    if unknown := set(names) - set(known):
        raise SystemExit(f"no surface called {', '.join(sorted(unknown))}; there are {', '.join(known)}")
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
        """What a mesh that a program wrote is worth, and how much of the surface it has kept."""
        points, tets = made(path)
        if volumes(points, tets).sum() < 0:  # TetGen counts the corners the other way round
            tets = tets[:, [1, 0, 2, 3]]
        found, extra = surface_kept(self.points, self.triangles, points, tets)
        return {**worth(points, tets), "points": len(np.unique(tets)), "triangles": len(self.triangles), "triangles_found": found,
                "triangles_extra": extra, "volume_off": abs(float(volumes(points, tets).sum()) / self.volume - 1)}


def read_vtp(path):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    whole = reader.GetOutput()
    corners = vtk_to_numpy(whole.GetPolys().GetConnectivityArray())
    return vtk_to_numpy(whole.GetPoints().GetData()).astype(np.float64), corners.reshape(-1, 3).astype(np.int64)


def merged(points, triangles):
    """Points at one place as one, those that no triangle uses left out."""
    used, triangles = np.unique(triangles, return_inverse=True)
    points, row = np.unique(points[used] + 0.0, axis=0, return_inverse=True)  # no negative zeros
    return points, row.ravel()[triangles.reshape(-1, 3)]


def calibrated(count, target, size, tries):
    """The size with which a program makes about `target` tets, or comes nearest to that in so many tries.

    `count(size)` gives the number of tets, None where the program fails; so does this where it failed the first time.
    """
    tried = {}
    slope = 3.0  # counts fall with this power of the size, with less where the surface has most of the tets
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
