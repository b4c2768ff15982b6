"""Vessels with moving walls: a branched vessel, and a ventricle with a wall measured in 25 frames of a
heartbeat.

The ventricle is that of patient 1 of biv-me; see the README of the data folder.
"""
import os
import subprocess
from pathlib import Path

import numpy as np

from common import MOTET, ROOT, TARGET
from meshes import meshed

LENGTH, RADIUS, SIZE = 10.0, 1.0, 0.2
# Branches of the vessel: position along z, direction in the x-y plane in degrees, radius and length.
BRANCHES = ((4.0, 90.0, 0.35, 3.0), (5.2, 70.0, 0.3, 3.0), (6.4, 110.0, 0.35, 3.0), (8.0, 270.0, 0.25, 2.5))


def branched_vessel():
    """Return points and tets of a vessel of radius 1 along z, from 0 to 10, with four branches."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    occ = gmsh.model.occ
    trunk = occ.addCylinder(0, 0, 0, 0, 0, LENGTH, RADIUS)
    branches = []
    for z, degrees, radius, length in BRANCHES:
        x, y = (length * f(np.radians(degrees)) for f in (np.cos, np.sin))
        branches.append((3, occ.addCylinder(0, 0, z, x, y, 0.3, radius)))
    occ.fuse([(3, trunk)], branches)
    occ.synchronize()
    # Finer in and near the branches.
    field = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(field, "F", f"{SIZE}-{SIZE / 2}*Min(1,Max(0,abs(y)-{0.7 * RADIUS})/{0.5 * RADIUS})")
    return meshed(gmsh, field)


def frames_of(folder):
    """Return the points of each frame, and their common triangles."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    frames = []
    for path in sorted(Path(folder).glob("patient1_LV_ENDOCARDIAL_*.vtk")):
        reader = vtk.vtkPolyDataReader()
        reader.SetFileName(str(path))
        reader.Update()
        surface = reader.GetOutput()
        frames.append(vtk_to_numpy(surface.GetPoints().GetData()).astype(float))
        triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return frames, triangles


def rims(triangles):
    """Yield the loops of open edges, in the direction of the triangles."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    directed = set(map(tuple, edges))
    after = {a: b for a, b in directed if (b, a) not in directed}
    while after:
        loop = [next(iter(after))]
        while loop[-1] in after:
            loop.append(after.pop(loop[-1]))
        yield loop[:-1]


def capped(frames, triangles):
    """Close each rim by successively smaller rings, each with half as many points.

    Each point of a ring is a mean of points of the rim, and therefore moves with them.
    """
    triangles = [triangles]
    for rim in rims(triangles[0]):
        rows = np.eye(len(rim))
        centre = rows.mean(axis=0)
        ring, ids = rows, np.array(rim)
        while True:
            n = (len(ring) + 1) // 2
            inner = n >= 5
            if inner:
                share = n / len(rim)
                at = np.arange(n) * len(rim) / n
                low = at.astype(int)
                part = (at - low)[:, None]
                on_rim = (1 - part) * rows[low] + part * rows[(low + 1) % len(rim)]
                new = centre + share * (on_rim - centre)
            else:
                new = centre[None]
            first = len(frames[0])
            frames = [np.vstack([f, new @ f[rim]]) for f in frames]
            new_ids = first + np.arange(len(new))
            triangles.append(zipped(ids, new_ids))
            if not inner:
                break
            ring, ids = new, new_ids
    return frames, np.vstack(triangles)


def zipped(outer, inner):
    """Return triangles between two loops of equal direction, oriented opposite to those at the outer loop."""
    n, m, i, j, rows = len(outer), len(inner), 0, 0, []
    while i < n or (m > 1 and j < m):
        if m == 1 or j == m or (i < n and (i + 1) * m <= (j + 1) * n):
            rows.append((outer[(i + 1) % n], outer[i % n], inner[j % m]))
            i += 1
        else:
            rows.append((outer[i % n], inner[j % m], inner[(j + 1) % m]))
            j += 1
    return np.array(rows)


def ventricle():
    """Return the path of a mesh of the ventricle with an array of points per frame.

    None if there are no data.
    """
    data = Path(os.environ.get("MOTET_DATA") or ROOT.parent / "shared" / "data") / "moving_wall" / "bivme_lv"
    path, surface, volume = (TARGET / f"ventricle{end}" for end in ("_frames.vtu", ".vtp", ".vtu"))
    if not data.is_dir():
        return None
    if path.exists():
        return path
    import pyvista

    frames, triangles = capped(*frames_of(data))
    cells = np.column_stack([np.full(len(triangles), 3), triangles])
    pyvista.PolyData(frames[0], cells.ravel()).save(surface)
    # The exit status is 4, since some triangles of the wall force bad tets; the mesh is written.
    subprocess.run([MOTET / "motet", "mesh", surface, "-o", volume, "--size", "auto"], capture_output=True)
    grid = pyvista.read(volume)
    # The mesher keeps the points of the surface exactly.
    known = {tuple(p): i for i, p in enumerate(frames[0])}
    which = np.array([known.get(tuple(p), -1) for p in grid.points])
    for number, frame in enumerate(frames[1:], 1):
        places = np.where(which[:, None] >= 0, frame[which], grid.points)
        grid.point_data[f"frame_{number}"] = places
    grid.save(path)
    return path
