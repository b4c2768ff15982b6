"""Closed surfaces in numpy, as triangles (n, 3, 3) turned outward, and the files that hold them."""
import numpy as np


def box(sides, cells, centre=(0, 0, 0)):
    """A lattice on each side; diagonals alternate, so that no direction is preferred."""
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
    """Each quadrilateral (n, 4, 3) cut along its first diagonal where `which`, else along the other."""
    cut = lambda rows, ids: rows[:, ids].reshape(-1, 3, 3)
    return np.concatenate([cut(corners[which], [0, 1, 2, 0, 2, 3]), cut(corners[~which], [0, 1, 3, 1, 2, 3])])


def ellipsoid(radii, cells):
    """A cube with so many cells a side, blown up: equal angles, so that cells are about alike."""
    cube = np.tan(box((2, 2, 2), [cells] * 3) * np.pi / 4)
    return cube / np.linalg.norm(cube, axis=2, keepdims=True) * radii


def sheet(origin, u, v, cells):
    """A parallelogram from an origin along u and v: an open surface."""
    i, j = (index.ravel() for index in np.indices(cells))
    place = lambda right, up: np.asarray(origin) + np.outer((i + right) / cells[0], u) + np.outer((j + up) / cells[1], v)
    return halves(np.stack([place(0, 0), place(1, 0), place(1, 1), place(0, 1)], axis=1), (i + j) % 2 == 1)


def ring(k, radius):
    """6 k places on a circle; the centre for k = 0."""
    angle = 2 * np.pi * np.arange(max(6 * k, 1)) / max(6 * k, 1)
    return radius * (k > 0) * np.stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))], axis=1)


def disc(rings, radius):
    """Triangles of about the same size: each ring has six places more than the one in it."""
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
    """Along z from 0, both ends closed."""
    rim, low = ring(rings, radius), disc(rings, radius)
    i, j = (index.ravel() for index in np.indices((len(rim), slices)))
    place = lambda right, up: rim[(i + right) % len(rim)] + np.outer((j + up) * length / slices, (0, 0, 1))
    wall = halves(np.stack([place(0, 0), place(1, 0), place(1, 1), place(0, 1)], axis=1), (i + j) % 2 == 1)
    return np.concatenate([wall, low[:, ::-1], low + (0, 0, length)])


def along_x(triangles):
    """What was along z; still turned outward."""
    return triangles[:, :, [2, 0, 1]]


def write_stl(path, triangles):
    """In text, with all digits."""
    with open(path, "w") as file:
        file.write("solid made\n")
        for triangle in triangles:
            corners = "".join("vertex %.17g %.17g %.17g\n" % tuple(corner) for corner in triangle)
            file.write(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        file.write("endsolid made\n")


def write_frames(folder, name, triangles, place, count):
    """A series NAME.pvd: the surface at `count` times of a period, its points where `place(points, phase)` has them."""
    points, corners = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    lines = []
    for frame in range(count):
        file = f"{name}_{frame:02d}.vtp"
        write_vtp(folder / file, place(points, frame / count), corners.reshape(-1, 3))
        lines.append(f'<DataSet timestep="{frame / count!r}" file="{file}"/>\n')
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection>\n'
    (folder / f"{name}.pvd").write_text(head + "".join(lines) + "</Collection></VTKFile>\n")


def write_vtp(path, points, triangles):
    """In text, with all digits."""
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
