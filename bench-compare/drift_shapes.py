"""Closed surfaces in numpy, as outward triangles of shape (n, 3, 3), and their files."""
import numpy as np


def box(sides, cells, centre=(0, 0, 0)):
    """Return a box with a lattice on each side; diagonals alternate to avoid a preferred direction."""
    triangles = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        i, j = (index.ravel() for index in np.indices((cells[u], cells[v])))
        corners = np.zeros((len(i), 4, 3))
        for corner, (right, up) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
            corners[:, corner, u] = (i + right) / cells[u] - 0.5
            corners[:, corner, v] = (j + up) / cells[v] - 0.5
        for end in (-0.5, 0.5):
            corners[:, :, axis] = end
            found = halves(corners, (i + j) % 2 == 1)
            triangles.append(found if end > 0 else found[:, ::-1])
    return np.concatenate(triangles) * sides + np.asarray(centre)


def halves(corners, which):
    """Divide quadrilaterals (n, 4, 3) along their first diagonal where `which`, otherwise along
    the second."""
    cut = lambda rows, ids: rows[:, ids].reshape(-1, 3, 3)
    return np.concatenate([cut(corners[which], [0, 1, 2, 0, 2, 3]), cut(corners[~which], [0, 1, 3, 1, 2, 3])])


def ellipsoid(radii, cells):
    """Return an ellipsoid from a cube with `cells` cells per side, at equal angles so that cells
    are similar."""
    cube = np.tan(box((2, 2, 2), [cells] * 3) * np.pi / 4)
    return cube / np.linalg.norm(cube, axis=2, keepdims=True) * radii


def sheet(origin, u, v, cells):
    """Return a parallelogram from an origin along u and v, an open surface."""
    i, j = (index.ravel() for index in np.indices(cells))
    place = lambda right, up: np.asarray(origin) + np.outer((i + right) / cells[0], u) + np.outer((j + up) / cells[1], v)
    return halves(np.stack([place(0, 0), place(1, 0), place(1, 1), place(0, 1)], axis=1), (i + j) % 2 == 1)


def ring(k, radius):
    """Return 6 k points on a circle, or the centre for k = 0."""
    angle = 2 * np.pi * np.arange(max(6 * k, 1)) / max(6 * k, 1)
    return radius * (k > 0) * np.stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))], axis=1)


def disc(rings, radius):
    """Return triangles of similar size: each ring has six points more than the next inner one."""
    triangles = []
    for k in range(1, rings + 1):
        inner, outer = ring(k - 1, radius * (k - 1) / rings), ring(k, radius * k / rings)
        for sixth in range(6):
            for j in range(k):
                a, b = outer[sixth * k + j], outer[(sixth * k + j + 1) % (6 * k)]
                at = lambda j, sixth=sixth: inner[(sixth * (k - 1) + j) % len(inner)]
                triangles.append((a, b, at(j)))
                if j + 1 < k:
                    triangles.append((at(j), b, at(j + 1)))
    return np.array(triangles)


def cylinder(radius, length, rings, slices):
    """Return a cylinder along z, starting at 0, with both ends closed."""
    rim, low = ring(rings, radius), disc(rings, radius)
    i, j = (index.ravel() for index in np.indices((len(rim), slices)))
    place = lambda right, up: rim[(i + right) % len(rim)] + np.outer((j + up) * length / slices, (0, 0, 1))
    wall = halves(np.stack([place(0, 0), place(1, 0), place(1, 1), place(0, 1)], axis=1), (i + j) % 2 == 1)
    return np.concatenate([wall, low[:, ::-1], low + (0, 0, length)])


def along_x(triangles):
    """Rotate triangles from the z axis to the x axis; they remain outward."""
    return triangles[:, :, [2, 0, 1]]


def write_stl(path, triangles):
    """Write an ASCII STL file with all digits."""
    with open(path, "w") as file:
        file.write("solid made\n")
        for triangle in triangles:
            corners = "".join("vertex %.17g %.17g %.17g\n" % tuple(corner) for corner in triangle)
            file.write(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        file.write("endsolid made\n")


def write_frames(folder, name, triangles, place, count):
    """Write a series NAME.pvd of `count` frames of a period, with points at `place(points, phase)`."""
    points, corners = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    lines = []
    for frame in range(count):
        file = f"{name}_{frame:02d}.vtp"
        write_vtp(folder / file, place(points, frame / count), corners.reshape(-1, 3))
        lines.append(f'<DataSet timestep="{frame / count!r}" file="{file}"/>\n')
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection>\n'
    (folder / f"{name}.pvd").write_text(head + "".join(lines) + "</Collection></VTKFile>\n")


def write_vtp(path, points, triangles):
    """Write an ASCII VTP file with all digits."""
    array = lambda kind, name, width, values: (
        f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{width}" format="ascii">\n'
        + "\n".join(map(repr, values.ravel().tolist())) + "\n</DataArray>\n")
    ends = 3 * np.arange(1, len(triangles) + 1)
    path.write_text(
        '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian">\n<PolyData>\n'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="{len(triangles)}">\n'
        f'<Points>\n{array("Float64", "Points", 3, points)}</Points>\n'
        f'<Polys>\n{array("Int64", "connectivity", 1, triangles)}{array("Int64", "offsets", 1, ends)}</Polys>\n'
        "</Piece>\n</PolyData>\n</VTKFile>\n")
