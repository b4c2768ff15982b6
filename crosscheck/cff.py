"""Fluent's files in HDF5 (Common Fluids Format), written from grids of VTK as Fluent lays them out."""
import h5py
import numpy as np
import pyvista

# Fluent's numbers of cell types by VTK's.
CELL_TYPES = {10: 2, 12: 4, 14: 5, 13: 6, 42: 7}
INTERIOR, WALL = 2, 3


def outward_faces(grid):
    """Return for each cell its faces, as lists of points that run counter-clockwise seen from outside."""
    points = np.asarray(grid.points, float)
    of_cells = []
    for i in range(grid.n_cells):
        cell = grid.GetCell(i)
        rings = [[cell.GetFace(k).GetPointId(j) for j in range(cell.GetFace(k).GetNumberOfPoints())] for k in range(cell.GetNumberOfFaces())]
        inside = points[sorted({p for ring in rings for p in ring})].mean(axis=0)
        for k, ring in enumerate(rings):
            corners = points[ring]
            normal = sum(np.cross(corners[j - 1], corners[j]) for j in range(len(ring)))
            if np.dot(normal, corners.mean(axis=0) - inside) < 0:
                rings[k] = ring[::-1]
        of_cells.append(rings)
    return of_cells


def write_cff(path, grid, regions, patch_of, names, *, sections=1, sections_of_faces=1, **storage):
    """Write a grid, whose cells are in the zones `regions`, sorted; `patch_of` gives the zone of a face on the border by its middle.

    Zone 99 has the faces between cells. Points and the cells beside faces are in so many `sections`, the points of faces in `sections_of_faces`.
    """
    points = np.asarray(grid.points, float)
    assert (np.diff(regions) >= 0).all()
    known, border = {}, {}
    inner = []
    for cell, rings in enumerate(outward_faces(grid)):
        for ring in rings:
            key = tuple(sorted(ring))
            if key in known:
                inner.append((*known.pop(key), cell + 1))
            else:
                known[key] = (ring, cell + 1)
    for ring, cell in known.values():
        border.setdefault(patch_of(points[ring].mean(axis=0)), []).append((ring, cell, 0))
    zones = [(99, INTERIOR, inner), *((zone, WALL, border[zone]) for zone in sorted(border))]
    faces = [face for *_, of_zone in zones for face in of_zone]

    def spans(n, sections=sections):
        """Divide numbers from 1 to `n` into sections."""
        cuts = np.linspace(0, n, sections + 1).astype(int)
        return [(a + 1, b, slice(a, b)) for a, b in zip(cuts[:-1], cuts[1:]) if a < b]

    def numbers(group, name, values, kind):
        return group.create_dataset(name, data=np.array(values, kind), **storage)

    def number(group, **attributes):
        for name, value in attributes.items():
            group.attrs[name] = np.uint64(value)

    def names_of(ids):
        return np.bytes_(";".join(names.get(i, f"zone-{i}") for i in ids).encode())

    def table(group, ids, counts, **columns):
        last = np.cumsum(counts)
        zones = group.create_group("zoneTopology")
        number(zones, nZones=len(ids))
        numbers(zones, "minId", last - counts + 1, np.uint64)
        numbers(zones, "maxId", last, np.uint64)
        numbers(zones, "id", ids, np.int32)
        numbers(zones, "dimension", [3] * len(ids), np.uint64)
        for name, column in columns.items():
            numbers(zones, name, column, np.int32)
        zones.create_dataset("name", data=names_of(ids))

    with h5py.File(path, "w") as file:
        file.create_group("settings")
        mesh = file.create_group("meshes/1")
        number(mesh, dimension=3, nodeOffset=0, nodeCount=len(points), cellOffset=0, cellCount=grid.n_cells, faceOffset=0, faceCount=len(faces))

        nodes = mesh.create_group("nodes")
        of_points = spans(len(points))
        table(nodes, np.arange(1, len(of_points) + 1), [b - a + 1 for a, b, _ in of_points])
        coords = nodes.create_group("coords")
        for k, (first, last, rows) in enumerate(of_points):
            number(numbers(coords, str(k + 1), points[rows], float), minId=first, maxId=last)

        cells = mesh.create_group("cells")
        ids, counts = np.unique(regions, return_counts=True)
        types = np.array([CELL_TYPES[kind] for kind in grid.celltypes])
        of_zones = [np.unique(types[regions == i]) for i in ids]
        zeros = np.zeros(len(ids), int)
        table(cells, ids, counts, cellType=[kinds[0] if len(kinds) == 1 else 0 for kinds in of_zones], childZoneId=zeros, zoneType=zeros + 1)
        ctype = cells.create_group("ctype")
        number(ctype, nSections=1)
        section = ctype.create_group("1")
        number(section, minId=1, maxId=grid.n_cells)
        section.attrs["elementType"] = np.int16(0)
        numbers(section, "cell-types", types, np.int16)

        of_mesh = mesh.create_group("faces")
        zones = [zone for zone in zones if zone[2]]
        zeros = [0] * len(zones)
        table(of_mesh, [zone[0] for zone in zones], np.array([len(zone[2]) for zone in zones]), zoneType=[zone[1] for zone in zones],
              faceType=zeros, childZoneId=zeros, shadowZoneId=zeros, flags=zeros)
        of_faces = spans(len(faces), sections_of_faces)
        group = of_mesh.create_group("nodes")
        number(group, nSections=len(of_faces))
        for k, (first, last, rows) in enumerate(of_faces):
            section = group.create_group(str(k + 1))
            number(section, minId=first, maxId=last)
            # A face runs counter-clockwise seen from inside the first of its cells.
            rings = [ring[::-1] for ring, *_ in faces[rows]]
            numbers(section, "nnodes", [len(ring) for ring in rings], np.int16)
            flat = numbers(section, "nodes", [p + 1 for ring in rings for p in ring], np.uint32)
            number(flat, chunkDim=len(flat))
        # Faces on the border have no second cell.
        for name, side, spans_ in [("c0", 1, spans(len(faces))), ("c1", 2, spans(len(inner)))]:
            group = of_mesh.create_group(name)
            number(group, nSections=len(spans_))
            for k, (first, last, rows) in enumerate(spans_):
                number(numbers(group, str(k + 1), [face[side] for face in faces[rows]], np.uint32), minId=first, maxId=last)


def mixed_box():
    """Return a box of hexahedra, wedges, pyramids, tets and a polyhedron, and the zone of each cell."""
    index = {}

    def point(*at):
        return index.setdefault(at, len(index))

    def corners(x, z, width=1):
        return [point(x + a * width, b, z + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]

    cells = []
    for z in (0, 1):
        cells.append((12, 3, corners(0, z)))
        a, b, c, d, e, f, g, h = corners(1, z)
        cells += [(13, 3, [a, b, c, e, f, g]), (13, 8, [a, c, d, e, g, h])]
        a, b, c, d, e, f, g, h = corners(2, z)
        centre = point(2.5, 0.5, z + 0.5)
        quads = [(a, b, c, d), (e, h, g, f), (b, f, g, c), (a, d, h, e), (a, e, f, b), (d, c, g, h)]
        if z == 1:
            # The pyramid at the top is two tets.
            quads.remove((e, h, g, f))
            cells += [(10, 8, [e, g, f, centre]), (10, 8, [e, h, g, centre])]
        cells += [(14, 8, [*quad, centre]) for quad in quads]
    # A polyhedron beside both layers.
    low, high = corners(3, 0), corners(3, 1)
    sides = [[low[0], low[1], low[2], low[3]], [high[4], high[5], high[6], high[7]]]
    for of in (low, high):
        sides += [[of[i], of[j], of[j + 4], of[i + 4]] for i, j in ((0, 1), (1, 2), (2, 3), (3, 0))]
    cells.append((42, 8, sides))
    cells.sort(key=lambda cell: cell[1])
    flat = []
    for kind, _, cell in cells:
        own = cell if kind != 42 else [len(cell), *(n for side in cell for n in (len(side), *side))]
        flat += [len(own), *own]
    points = np.array(list(index), float)
    # No two coordinates are equal by chance.
    points += np.random.default_rng(5).uniform(-0.01, 0.01, points.shape)
    grid = pyvista.UnstructuredGrid(np.array(flat), np.array([cell[0] for cell in cells]), points)
    return grid, np.array([cell[1] for cell in cells])
