"""Meshes with bad tets: the sphere moved along x, with interior vertices moved by a Laplace equation.

    python moved.py         creates the meshes of the benchmark, and counts bad tets for a sphere in a channel
"""
import sys
from pathlib import Path

import numpy as np

from common import TARGET
from meshes import HALF_EDGE, RADIUS, SIZES, build, sphere_in_box
from tets import BAD, boundary, eas

# Name: model, and displacement in radii.
MOVED = {"moved_A": ("A", 1.5), "moved_B": ("B", 1.75), "moved_1M": ("D", 0.2)}
CHANNEL = 12.0  # end of the channel of figure 11 in x
STEPS = 4  # number of steps, of one radius each
SPHERE, INSIDE = 1, 1  # patch of the sphere, region of the volume; the walls are patches 2 to 7


def laplace(points, tets, driven, held):
    """Return each vertex's share of the driven displacement, by linear elements with diffusivity 1/volume."""
    import scipy.sparse as sparse
    from scipy.sparse.linalg import cg

    origin = points[tets[:, 0]]
    edges = np.stack([points[tets[:, i]] - origin for i in (1, 2, 3)], axis=2)
    gradients = np.empty((len(tets), 4, 3))
    gradients[:, 1:] = np.linalg.inv(edges)
    gradients[:, 0] = -gradients[:, 1:].sum(axis=1)
    entries = gradients @ gradients.transpose(0, 2, 1)
    rows, columns = np.repeat(tets, 4, axis=1), np.tile(tets, (1, 4))
    matrix = sparse.csr_matrix((entries.ravel(), (rows.ravel(), columns.ravel())), shape=[len(points)] * 2)
    share = np.zeros(len(points))
    share[driven] = 1
    free = np.setdiff1d(np.arange(len(points)), np.r_[driven, held])
    inner = matrix[free][:, free]
    share[free], failed = cg(inner, -(matrix[free] @ share), rtol=1e-10, M=sparse.diags(1 / inner.diagonal()))
    if failed:
        sys.exit("the Laplace equation was not solved")
    return share


def along_x(points, share, travel):
    places = points.copy()
    places[:, 0] += travel * RADIUS * share
    return places


def moved(name, folder=TARGET):
    """Return the points and tets of a moved mesh; cached in `folder`."""
    path = Path(folder) / f"{name}.npz"
    if not path.exists():
        model, travel = MOVED[name]
        points, tets, sphere, walls = sphere_in_box(model, folder)
        points = along_x(points, laplace(points, tets, sphere, walls), travel)
        np.savez(path, points=points, tets=tets)
        write(path.with_suffix(".vtu"), points, tets)
    kept = np.load(path)
    return kept["points"], kept["tets"]


def patches(points, triangles):
    """Return the patch of each triangle: 1 on the sphere, 2 to 7 on the walls at low and high x, y, z."""
    corners = points[triangles]
    patch = np.full(len(triangles), SPHERE, np.int32)
    for wall, (axis, sign) in enumerate((axis, sign) for axis in range(3) for sign in (-1, 1)):
        patch[(np.abs(corners[:, :, axis] - sign * HALF_EDGE) < 1e-9).all(axis=1)] = wall + 2
    return patch


def write(path, points, tets):
    """Write tets and boundary triangles as VTU with raw appended data and the cell arrays `region` and
    `patch`."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

    triangles = boundary(tets)
    sizes = np.repeat([4, 3], [len(tets), len(triangles)])
    zeros = lambda rows: np.zeros(len(rows), np.int32)
    arrays = {"region": np.r_[zeros(tets) + INSIDE, zeros(triangles)],
              "patch": np.r_[zeros(tets), patches(points, triangles)]}
    grid, places, cells = vtk.vtkUnstructuredGrid(), vtk.vtkPoints(), vtk.vtkCellArray()
    places.SetData(numpy_to_vtk(points, deep=True))
    cells.SetData(numpy_to_vtkIdTypeArray(np.r_[0, np.cumsum(sizes)], deep=True),
                  numpy_to_vtkIdTypeArray(np.r_[tets.ravel(), triangles.ravel()].astype(np.int64), deep=True))
    kinds = np.where(sizes == 4, vtk.VTK_TETRA, vtk.VTK_TRIANGLE).astype(np.uint8)
    grid.SetPoints(places)
    grid.SetCells(numpy_to_vtk(kinds, deep=True, array_type=vtk.VTK_UNSIGNED_CHAR), cells)
    for name, values in arrays.items():
        array = numpy_to_vtk(values.astype(np.int32), deep=True)
        array.SetName(name)
        grid.GetCellData().AddArray(array)
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    if writer.Write() != 1:
        sys.exit(f"VTK could not write {path}")


def channel():
    """Count the bad tets before and after each step along a channel without remeshing, as in figure 11 of the
    paper."""
    points, tets = build(*SIZES["A"], ahead=CHANNEL)
    sphere = np.flatnonzero(np.isclose(np.linalg.norm(points, axis=1), RADIUS, rtol=0, atol=1e-9))
    walls = np.setdiff1d(np.unique(boundary(tets)), sphere)
    counts = []
    for step in range(STEPS + 1):
        quality = eas(points, tets)
        counts.append((step, int((quality < BAD).sum()), int((quality <= 0).sum())))
        points = along_x(points, laplace(points, tets, sphere, walls), 1.0)
    return len(tets), counts


if __name__ == "__main__":
    for name in MOVED:
        points, tets = moved(name)
        quality = eas(points, tets)
        print(f"{name}: {len(tets):,} tets, {(quality < BAD).sum()} bad, {(quality <= 0).sum()} inverted, "
              f"worst EAS {quality.min():.3f}")
    count, steps = channel()
    print(f"channel: {count:,} tets (the paper: 1, 66, 265 and 598 bad)")
    for step, bad, inverted in steps:
        print(f"  moved {step} R: {bad} bad, {inverted} of them inverted")
