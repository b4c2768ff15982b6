"""MSH, STL, OBJ, Medit, Abaqus, TetGen, SU2, Netgen, UNV, Nastran, Ansys archives, Fluent, MED, Exodus II, XDMF, DOLFIN XML and
SimVascular folders compared with Gmsh, mapdl-archive, meshio, Netgen, pyNastran and VTK."""
import gzip
import itertools
import os
from pathlib import Path

import gmsh
import meshio
import numpy as np
import pytest
import pyvista
import vtk
from cff import mixed_box, write_cff
from conftest import data_folder
from meshes import assert_same_array, assert_same_mesh, cell_array_of, cells_of, tet_set, volumes
from vtk.util.numpy_support import vtk_to_numpy

MSH_FORMS = list(itertools.product(["2.2", "4.1"], ["ascii", "binary"]))
# Gmsh's numbers of the elements that motet reads, with VTK's.
TYPES = {1: 3, 2: 5, 3: 9, 4: 10, 5: 12, 6: 13, 7: 14, 8: 21, 9: 22, 16: 23, 10: 28, 11: 24, 17: 25, 12: 29, 18: 26,
         13: 32, 19: 27}


@pytest.fixture
def gmsh_session():
    """Gmsh, quiet and empty."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield gmsh
    gmsh.finalize()


def gmsh_write(path, version, encoding):
    gmsh.option.setNumber("Mesh.MshFileVersion", float(version))
    gmsh.option.setNumber("Mesh.Binary", int(encoding == "binary"))
    gmsh.write(str(path))


def tet_box(order):
    """Mesh a box of two regions, with named patches, one named curve and one named point."""
    gmsh.model.add("box")
    a = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    b = gmsh.model.occ.addBox(1, 0, 0, 1, 1, 1)
    gmsh.model.occ.fragment([(3, a)], [(3, b)])
    gmsh.model.occ.synchronize()
    volumes_ = [tag for _, tag in gmsh.model.getEntities(3)]
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    gmsh.model.addPhysicalGroup(3, volumes_[:1], 7, "left half")
    gmsh.model.addPhysicalGroup(3, volumes_[1:], 9, "right half")
    gmsh.model.addPhysicalGroup(2, faces[:3], 3, "wall")
    gmsh.model.addPhysicalGroup(2, faces[3:], 12, "rest")
    gmsh.model.addPhysicalGroup(1, [1], 5, "edge")
    gmsh.model.addPhysicalGroup(0, [1], 6, "corner")
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)


def layered_box(kind, order):
    """Mesh a box with hexahedra or prisms, in two groups."""
    gmsh.model.add(kind)
    base = gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.extrude([(2, base)], 0, 0, 1, numElements=[2], recombine=True)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
    if kind == "hexahedra":
        gmsh.model.mesh.setTransfiniteSurface(base)
        gmsh.model.mesh.setRecombine(2, base)
    gmsh.model.addPhysicalGroup(3, [1], 1, "body")
    gmsh.model.addPhysicalGroup(2, [base], 2, "floor")
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)


def one_element(element_type):
    """Create one element of a type with the node positions of Gmsh; return these."""
    _, dim, _, n, local, _ = gmsh.model.mesh.getElementProperties(element_type)
    local = np.reshape(local, (n, -1))
    points = np.zeros((n, 3))
    points[:, : local.shape[1]] = local
    points = points @ np.array([[2, 0.125, 0], [0.25, 3, 0.125], [0, 0.375, 4]]) + [1.0, 2.0, 3.0]
    gmsh.model.add("one")
    tag = gmsh.model.addDiscreteEntity(dim)
    gmsh.model.mesh.addNodes(dim, tag, range(1, n + 1), points.ravel())
    gmsh.model.mesh.addElements(dim, tag, [element_type], [[1]], [list(range(1, n + 1))])
    return points


def vtk_grid(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    return reader.GetOutput()


def gmsh_content():
    """Return the nodes, the elements by type with entity and groups, and the group names of Gmsh's model."""
    tags, points, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tags)
    points = points.reshape(-1, 3)[order]
    renumber = np.empty(int(tags.max()) + 1, int)
    renumber[tags[order]] = np.arange(len(tags))
    elements = {}
    for dim, entity in gmsh.model.getEntities():
        groups = sorted(map(int, gmsh.model.getPhysicalGroupsForEntity(dim, entity)))
        for kind, _, nodes in zip(*gmsh.model.mesh.getElements(dim, entity)):
            n = gmsh.model.mesh.getElementProperties(kind)[3]
            rows = renumber[nodes.reshape(-1, n)]
            elements.setdefault(int(kind), []).extend((tuple(map(int, row)), entity, tuple(groups)) for row in rows)
    names = {(dim, tag): gmsh.model.getPhysicalName(dim, tag) for dim, tag in gmsh.model.getPhysicalGroups()}
    return points, {kind: sorted(rows) for kind, rows in elements.items()}, names


def opened(path):
    gmsh.clear()
    gmsh.open(str(path))
    return gmsh_content()


BUILDS = {
    "tets": lambda: tet_box(1),
    "tets of second order": lambda: tet_box(2),
    "hexahedra": lambda: layered_box("hexahedra", 1),
    "hexahedra of second order": lambda: layered_box("hexahedra", 2),
    "prisms": lambda: layered_box("prisms", 1),
    "prisms of second order": lambda: layered_box("prisms", 2),
}


@pytest.mark.parametrize("version, encoding", MSH_FORMS)
@pytest.mark.parametrize("build", BUILDS)
def test_gmsh_reads_its_own_mesh_from_files_of_motet(motet, gmsh_session, tmp_path, build, version, encoding):
    BUILDS[build]()
    source = tmp_path / "source.msh"
    gmsh_write(source, version, encoding)
    points, elements, names = opened(source)
    for out_version, out_encoding in MSH_FORMS:
        copy = tmp_path / f"{out_version}-{out_encoding}.msh"
        motet("convert", source, copy, "--version", out_version, "--encoding", out_encoding)
        copy_points, copy_elements, copy_names = opened(copy)
        # The order of nodes differs, so elements are compared as sets by the coordinates of their nodes.
        assert_same_located(copy_points, copy_elements, points, elements)
        assert copy_names == names


def assert_same_located(points, elements, other_points, other_elements):
    """Assert equal elements, with nodes identified by their coordinates, in order, and with entity and
    groups."""
    assert len(points) == len(other_points)
    assert set(elements) == set(other_elements)

    def located(points, rows):
        return sorted((tuple(map(tuple, points[list(nodes)])), entity, groups) for nodes, entity, groups in rows)

    for kind in elements:
        assert located(points, elements[kind]) == located(other_points, other_elements[kind]), kind


@pytest.mark.parametrize("version, encoding", MSH_FORMS)
@pytest.mark.parametrize("build", BUILDS)
def test_meshio_reads_the_same_mesh_from_a_copy(motet, gmsh_session, tmp_path, build, version, encoding):
    BUILDS[build]()
    source, copy = tmp_path / "source.msh", tmp_path / "copy.msh"
    gmsh_write(source, version, encoding)
    motet("convert", source, copy, "--version", version, "--encoding", encoding)
    ours, theirs = meshio.read(copy), meshio.read(source)
    assert_same_mesh(ours, theirs)
    for name, value in theirs.field_data.items():
        assert list(ours.field_data[name]) == list(value), name


@pytest.mark.parametrize("version, encoding", MSH_FORMS)
@pytest.mark.parametrize("element_type", TYPES)
def test_nodes_of_every_element_are_in_the_order_of_vtk(motet, gmsh_session, tmp_path, element_type, version, encoding):
    points = one_element(element_type)
    source, target, back = tmp_path / "one.msh", tmp_path / "one.vtu", tmp_path / "back.msh"
    gmsh_write(source, version, encoding)
    motet("convert", source, target)
    grid = vtk_grid(target)
    assert grid.GetCellType(0) == TYPES[element_type]
    cell = grid.GetCell(0)
    found = vtk_to_numpy(cell.GetPoints().GetData())
    # The same points, possibly in another order.
    assert sorted(map(tuple, found)) == sorted(map(tuple, points))
    # Middle nodes lie between the corners of their edge or face, and the volume is positive.
    for part, n_corners in parts_of(cell):
        middle = vtk_to_numpy(part.GetPoints().GetData())
        corners, further = middle[:n_corners], middle[n_corners:]
        if n_corners == 2 and len(further):
            np.testing.assert_allclose(further[0], corners.mean(axis=0), atol=1e-14)
        if len(further) > n_corners:
            np.testing.assert_allclose(further[-1], corners.mean(axis=0), atol=1e-14)
    if cell.GetCellDimension() == 3:
        size = vtk.vtkCellSizeFilter()
        size.SetInputData(grid)
        size.Update()
        assert size.GetOutput().GetCellData().GetArray("Volume").GetValue(0) > 0
    motet("convert", target, back, "--version", version, "--encoding", encoding)
    again, elements, _ = opened(back)
    (nodes, *_), = elements[element_type]
    assert_same_array(again[list(nodes)], points, "nodes in Gmsh's order")


def parts_of(cell):
    """Return the edges and faces of a cell, with their number of corners."""
    result = [(deep(cell.GetEdge(i)), 2) for i in range(cell.GetNumberOfEdges())]
    for i in range(cell.GetNumberOfFaces()):
        face = cell.GetFace(i)
        result.append((deep(face), face.GetNumberOfEdges()))
    return result


def deep(cell):
    """Return a copy: VTK reuses the object for the next edge."""
    copy = cell.NewInstance()
    copy.DeepCopy(cell)
    return copy


@pytest.mark.parametrize("version, encoding", MSH_FORMS)
def test_a_pyramid_of_fourteen_nodes_is_preserved(motet, gmsh_session, tmp_path, version, encoding):
    points = one_element(14)
    source, copy = tmp_path / "one.msh", tmp_path / "copy.msh"
    gmsh_write(source, version, encoding)
    motet("convert", source, copy)
    again, elements, _ = opened(copy)
    (nodes, *_), = elements[14]
    assert_same_array(again[list(nodes)], points, "nodes in Gmsh's order")


@pytest.mark.parametrize("version, encoding", MSH_FORMS)
def test_gmsh_reads_arrays_of_motet(motet, gmsh_session, tmp_path, version, encoding):
    tet_box(1)
    source, with_data, copy = (tmp_path / name for name in ("source.msh", "data.vtu", "copy.msh"))
    gmsh_write(source, "4.1", "binary")
    motet("convert", source, with_data)
    mesh = meshio.read(with_data)
    rng = np.random.default_rng(1)
    mesh.point_data = {"p": rng.normal(size=len(mesh.points)), "u": rng.normal(size=(len(mesh.points), 3))}
    mesh.cell_data = {"stress": [rng.normal(size=(len(block.data), 9)) for block in mesh.cells]}
    mesh.write(with_data)
    motet("convert", with_data, copy, "--version", version, "--encoding", encoding)
    opened(copy)
    found = {}
    for view in gmsh.view.getTags():
        name = gmsh.view.option.getString(view, "Name")
        kind, tags, values, _, n = gmsh.view.getHomogeneousModelData(view, 0)
        found[name] = (kind, np.reshape(values, (-1, n))[np.argsort(tags)].squeeze())
    assert found["p"][0] == found["u"][0] == "NodeData" and found["stress"][0] == "ElementData"
    assert_same_array(found["p"][1], mesh.point_data["p"], "p")
    assert_same_array(found["u"][1], mesh.point_data["u"], "u")
    assert_same_array(found["stress"][1], np.vstack(mesh.cell_data["stress"]), "stress")


@pytest.mark.parametrize("version, encoding", MSH_FORMS)
def test_sparse_node_numbers_parameters_and_unknown_sections_are_read(motet, gmsh_session, tmp_path, version, encoding):
    gmsh.model.add("periodic")
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.setPeriodic(2, [2], [1], [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
    gmsh.model.mesh.generate(3)
    tags, _, _ = gmsh.model.mesh.getNodes()
    gmsh.model.mesh.renumberNodes(tags, [int(t) * 1000 + 17 for t in tags])
    gmsh.option.setNumber("Mesh.SaveParametric", 1)
    source, copy = tmp_path / "source.msh", tmp_path / "copy.msh"
    gmsh_write(source, version, encoding)
    expected = opened(source)
    motet("convert", source, copy)
    found = opened(copy)
    assert_same_located(found[0], found[1], expected[0], expected[1])


@pytest.mark.parametrize("version, encoding", MSH_FORMS)
def test_partitions_are_read(motet, gmsh_session, tmp_path, version, encoding):
    tet_box(1)
    n_tets = len(gmsh.model.mesh.getElementsByType(4)[0])
    gmsh.model.mesh.partition(3)
    source, target = tmp_path / "source.msh", tmp_path / "target.vtu"
    gmsh_write(source, version, encoding)
    motet("convert", source, target)
    mesh = meshio.read(target)
    assert len(cells_of(mesh)["tetra"]) == n_tets
    partitions = np.concatenate(mesh.cell_data["gmsh:partition"])
    assert set(partitions[np.concatenate([np.full(len(b.data), b.type == "tetra") for b in mesh.cells])]) == {1, 2, 3}


def swap_bytes(path):
    """Convert a binary MSH 4.1 file of Gmsh to the other byte order."""
    data = path.read_bytes()

    def section(name):
        start = data.index(b"$" + name + b"\n") + len(name) + 2
        return start, data.index(b"\n$End" + name, start)

    out = bytearray(data)

    def turn(at, kinds):
        for size in kinds:
            out[at : at + size] = data[at : at + size][::-1]
            at += size
        return at

    def number(at, size):
        return int.from_bytes(data[at : at + size], "little")

    start, _ = section(b"MeshFormat")
    turn(data.index(b"\n", start) + 1, [4])
    at, end = section(b"Entities")
    counts = [number(at + 8 * i, 8) for i in range(4)]
    at = turn(at, [8] * 4)
    for dim, n in enumerate(counts):
        for _ in range(n):
            at = turn(at, [4] + [8] * (3 if dim == 0 else 6))
            for _ in range(1 if dim == 0 else 2):
                at = turn(at, [8] + [4] * number(at, 8))
    assert at == end
    at, end = section(b"Nodes")
    n_blocks = number(at, 8)
    at = turn(at, [8] * 4)
    for _ in range(n_blocks):
        n = number(at + 12, 8)
        at = turn(at, [4, 4, 4, 8] + [8] * (4 * n))
    assert at == end
    at, end = section(b"Elements")
    n_blocks = number(at, 8)
    at = turn(at, [8] * 4)
    for _ in range(n_blocks):
        n = number(at + 12, 8)
        n_nodes = gmsh.model.mesh.getElementProperties(number(at + 8, 4))[3]
        at = turn(at, [4, 4, 4, 8] + [8] * (n * (1 + n_nodes)))
    assert at == end
    path.write_bytes(bytes(out))


def test_msh_files_of_either_byte_order_are_read_alike(motet, gmsh_session, tmp_path):
    tet_box(1)
    source, straight, turned = (tmp_path / name for name in ("source.msh", "straight.msh", "turned.msh"))
    gmsh_write(source, "4.1", "binary")
    motet("convert", source, straight)
    swap_bytes(source)
    motet("convert", source, turned)
    assert straight.read_bytes() == turned.read_bytes()


# ---- meshio


def mixed_mesh(kinds, seed=0):
    """Return a mesh of random points and ids; the shapes of cells do not matter for files."""
    rng = np.random.default_rng(seed)
    counts = meshio._mesh.num_nodes_per_cell
    points = rng.normal(size=(60, 3)) * 10.0 ** rng.integers(-9, 9, size=(60, 1))
    cells = [(kind, np.array([rng.choice(60, counts[kind], replace=False) for _ in range(4)])) for kind in kinds]
    return meshio.Mesh(points, cells)


@pytest.mark.parametrize("form", ["gmsh22", "gmsh"])
@pytest.mark.parametrize("binary", [False, True])
def test_meshio_reads_its_own_msh_mesh_from_a_copy(motet, tmp_path, form, binary):
    mesh = mixed_mesh(["vertex", "line", "triangle", "quad", "tetra", "hexahedron", "wedge", "pyramid", "tetra10",
                       "hexahedron20", "triangle6", "quad8", "line3", "hexahedron27", "quad9"])
    rng = np.random.default_rng(2)
    mesh.point_data = {"u": rng.normal(size=(60, 3)), "p": rng.normal(size=60)}
    mesh.cell_data = {"gmsh:physical": [np.full(4, 1 + i) for i in range(len(mesh.cells))],
                      "gmsh:geometrical": [np.full(4, 1 + i) for i in range(len(mesh.cells))],
                      "q": [rng.normal(size=4) for _ in mesh.cells]}
    mesh.field_data = {"a wall": np.array([3, 2]), "blood": np.array([5, 3])}
    if form == "gmsh":
        entities = [(meshio._mesh.topological_dimension[block.type], 1 + i) for i, block in enumerate(mesh.cells)]
        # In ascending order: meshio writes nodes by entity, but reads arrays as if nodes kept their order.
        mesh.point_data["gmsh:dim_tags"] = np.array(sorted(map(tuple, np.resize(entities, (60, 2)))))
    else:
        # In version 2.2, meshio cannot read arrays on cells of several kinds.
        del mesh.cell_data["q"]
    if not binary:
        # meshio writes arrays as text that it cannot read (numpy 2 adds its type to each number).
        mesh.point_data = {name: values for name, values in mesh.point_data.items() if name not in ("u", "p")}
        mesh.cell_data.pop("q", None)
    source = tmp_path / "source.msh"
    meshio.write(source, mesh, file_format=form, binary=binary)
    expected = meshio.read(source)
    for version, encoding in MSH_FORMS[2:] if form == "gmsh" else MSH_FORMS:
        copy = tmp_path / "copy.msh"
        motet("convert", source, copy, "--version", version, "--encoding", encoding)
        found = meshio.read(copy)
        assert_same_mesh(found, expected, [name for name in ("u", "p") if name in mesh.point_data], mesh.cell_data)
        for name, value in mesh.field_data.items():
            assert list(found.field_data[name]) == list(value)


@pytest.mark.parametrize("ending", ["mesh", "meshb"])
@pytest.mark.parametrize("source_ending", ["mesh", "meshb"])
def test_meshio_reads_its_own_medit_mesh_from_a_copy(motet, tmp_path, source_ending, ending):
    mesh = mixed_mesh(["line", "triangle", "quad", "tetra", "hexahedron", "wedge", "pyramid"])
    mesh.point_data = {"medit:ref": np.arange(60)}
    mesh.cell_data = {"medit:ref": [np.arange(4) + 10 * i for i in range(len(mesh.cells))]}
    source, copy = tmp_path / f"source.{source_ending}", tmp_path / f"copy.{ending}"
    mesh.write(source)
    motet("convert", source, copy)
    assert_same_mesh(meshio.read(copy), meshio.read(source))


@pytest.mark.parametrize("type_", [np.int32, np.int64])
def test_meshio_reads_its_own_binary_medit_meshes_of_versions_3_and_4(motet, tmp_path, type_):
    """meshio writes version 3 for ids of 32 bits, and version 4 for others."""
    mesh = mixed_mesh(["tetra"])
    for block in mesh.cells:
        block.data = block.data.astype(type_)
    source, copy = tmp_path / "source.meshb", tmp_path / "copy.meshb"
    mesh.write(source)
    assert source.read_bytes()[4] == (3 if type_ is np.int32 else 4)
    motet("convert", source, copy)
    assert_same_mesh(meshio.read(copy), meshio.read(source))


@pytest.mark.parametrize("build", ["tets", "tets of second order", "hexahedra", "prisms"])
def test_gmsh_reads_its_own_medit_mesh_from_a_copy(motet, gmsh_session, tmp_path, build):
    """Gmsh writes text, which motet converts to binary and back to text."""
    BUILDS[build]()
    source, binary, copy = (tmp_path / name for name in ("source.mesh", "binary.meshb", "copy.mesh"))
    gmsh.write(str(source))
    motet("convert", source, binary)
    motet("convert", binary, copy)
    points, elements, _ = opened(source)
    copy_points, copy_elements, _ = opened(copy)
    assert_same_located(copy_points, copy_elements, points, elements)


@pytest.mark.parametrize("ending", ["sol", "solb"])
def test_medit_solutions_have_the_layout_of_the_manual(motet, tmp_path, ending):
    """A scalar, a vector and a symmetric tensor, read with numpy by the layout of RT-422."""
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    names = {"a": np.arange(4) / 3, "b": np.arange(12).reshape(4, 3) / 7, "c": np.arange(24).reshape(4, 6) / 11}
    source = tmp_path / "source.vtu"
    meshio.Mesh(points, [("tetra", [[0, 1, 2, 3]])], point_data=names).write(source)
    out = tmp_path / f"out.{ending}"
    motet("convert", source, out)
    # The order of components is xx yy zz xy yz xz in VTK, and the lower triangle row by row in Medit.
    rows = np.hstack([names["a"][:, None], names["b"], names["c"][:, [0, 3, 1, 5, 4, 2]]])
    if ending == "sol":
        tokens = out.read_text().split()
        assert tokens[:10] == ["MeshVersionFormatted", "2", "Dimension", "3", "SolAtVertices", "4", "3", "1", "2", "3"]
        assert tokens[-1] == "End"
        found = np.array(tokens[10:-1], float).reshape(4, 10)
    else:
        data = out.read_bytes()
        head = np.frombuffer(data, "<i4", 12).tolist()
        assert head == [1, 2, 3, 20, 3, 62, 48 + 4 * 80, 4, 3, 1, 2, 3]
        found = np.frombuffer(data, "<f8", 40, 48).reshape(4, 10)
        assert np.frombuffer(data, "<i4", 2, 48 + 320).tolist() == [54, 0]
    assert_same_array(found, rows)
    back = tmp_path / "back.vtu"
    motet("convert", out, back)
    arrays = meshio.read(back).point_data
    for name, ours in zip("abc", ["medit:sol", "medit:sol_2", "medit:sol_3"]):
        assert_same_array(arrays[ours], names[name])


def test_meshio_reads_its_own_abaqus_mesh_from_a_copy(motet, tmp_path):
    """All kinds of cells that meshio supports, except lines of three nodes, which it leaves in
    VTK's order."""
    mesh = mixed_mesh(["line", "triangle", "quad", "tetra", "hexahedron", "wedge", "triangle6", "quad8", "quad9", "tetra10",
                       "hexahedron20"])
    n = len(mesh.cells)
    mesh.cell_sets = {"tets": [np.array([0, 1, 2] if b.type == "tetra" else [], int) for b in mesh.cells],
                      "mixed": [np.array([i % 4]) for i in range(n)],
                      "faces": [np.array([2, 3] if b.type in ("triangle", "quad9") else [], int) for b in mesh.cells]}
    mesh.point_sets = {"held": np.arange(0, 60, 7), "last": np.array([59])}
    source, copy = tmp_path / "source.inp", tmp_path / "copy.inp"
    mesh.write(source)
    motet("convert", source, copy)
    ours, theirs = meshio.read(copy), meshio.read(source)
    assert_same_mesh(ours, theirs)
    for name, places in theirs.point_sets.items():
        assert_same_array(ours.point_sets[name], places)
    for name, blocks in mesh.cell_sets.items():
        # meshio omits blocks without members.
        blocks = [block for block in blocks if len(block)]
        found = [block for block in ours.cell_sets[name] if len(block)]
        assert len(found) == len(blocks)
        for a, b in zip(found, blocks):
            assert_same_array(a, b)


def round_nodes():
    """Round the coordinates of Gmsh's nodes to the digits that it writes into Abaqus and SU2 files."""
    for tag, x in zip(*(part.reshape(-1, n) for part, n in zip(gmsh.model.mesh.getNodes()[:2], (1, 3)))):
        gmsh.model.mesh.setNode(int(tag[0]), (x.round(9) + 0.0).tolist(), [])


@pytest.mark.parametrize("build", BUILDS)
def test_gmsh_reads_its_own_abaqus_mesh_from_a_copy(motet, gmsh_session, tmp_path, build):
    """The copy has the same cells, with groups as labels."""
    # Gmsh writes prisms of 18 nodes as if they had 6.
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", int(build.startswith("prisms")))
    BUILDS[build]()
    round_nodes()
    points, elements, names = gmsh_content()
    source, again, copy = (tmp_path / name for name in ("source.inp", "again.inp", "copy.msh"))
    gmsh.write(str(source))
    motet("convert", source, again)
    motet("convert", again, copy)
    copy_points, copy_elements, copy_names = opened(copy)

    def located(points, elements, names):
        dims = dict.fromkeys([4, 5, 6, 11, 12, 17, 18], 3) | dict.fromkeys([2, 3, 9, 10, 16], 2)
        found = []
        for kind in set(elements) & set(dims):
            for nodes, _, groups in elements[kind]:
                name = [names[dims[kind], group].replace(" ", "_") for group in groups]
                # Gmsh writes only elements in groups.
                if name:
                    found.append((kind, tuple(map(tuple, points[list(nodes)])), name))
        return sorted(found)

    ours, theirs = located(copy_points, copy_elements, copy_names), located(points, elements, names)
    assert len(theirs) > 0
    assert ours == theirs


@pytest.mark.parametrize("element_type", [2, 3, 4, 5, 6, 7, 8, 9, 16, 10, 11, 17, 12, 18, 19])
def test_nodes_of_abaqus_elements_are_in_the_order_of_vtk(motet, gmsh_session, tmp_path, element_type):
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    points = one_element(element_type)
    source, target, back, again = (tmp_path / name for name in ("one.inp", "one.vtu", "back.inp", "again.vtu"))
    gmsh.write(str(source))
    motet("convert", source, target)
    grid = vtk_grid(target)
    assert grid.GetCellType(0) == TYPES[element_type]
    cell = grid.GetCell(0)
    found = vtk_to_numpy(cell.GetPoints().GetData())
    assert len(found) == len(points)
    for part, n_corners in [(deep(cell), 2 if cell.GetCellDimension() == 1 else 0)] + parts_of(cell):
        middle = vtk_to_numpy(part.GetPoints().GetData())
        corners, further = middle[:n_corners], middle[n_corners:]
        if n_corners == 2 and len(further):
            np.testing.assert_allclose(further[0], corners.mean(axis=0), atol=1e-14)
        if len(further) > n_corners > 0:
            np.testing.assert_allclose(further[-1], corners.mean(axis=0), atol=1e-14)
    if cell.GetCellDimension() == 3:
        size = vtk.vtkCellSizeFilter()
        size.SetInputData(grid)
        size.Update()
        assert size.GetOutput().GetCellData().GetArray("Volume").GetValue(0) > 0
    if element_type == 19:
        return  # Abaqus has no quadratic pyramids, so motet cannot write them.
    motet("convert", target, back)
    numbers = [[int(x) for line in lines.split(",\n") for x in line.split(",") if x.strip()]
               for lines in (path.read_text().split("*ELEMENT")[1].split("\n", 1)[1].split("*")[0].replace(" ", "").strip()
                             for path in (source, back))]
    nodes = [np.array([[float(x) for x in line.split(",")] for line in
                       path.read_text().split("*NODE\n")[1].split("*")[0].strip().split("\n")]) for path in (source, back)]
    placed = [{int(row[0]): row[1:] for row in rows} for rows in nodes]
    theirs, ours = ([where[i] for i in ids[1:]] for where, ids in zip(placed, numbers))
    np.testing.assert_allclose(ours, theirs, atol=1e-14)


# Corners of the faces S1, S2, ... by the CalculiX manual (*SURFACE).
FACES_OF_ABAQUS = {"C3D4": ["123", "142", "243", "341"], "C3D10": ["123", "142", "243", "341"],
                   "C3D8": ["1234", "5876", "1562", "2673", "3784", "4851"], "C3D6": ["123", "456", "1254", "2365", "3146"]}


@pytest.mark.parametrize("build", ["tets", "tets of second order", "hexahedra", "prisms"])
def test_surfaces_of_abaqus_are_the_patches(motet, gmsh_session, tmp_path, build):
    """Surfaces that motet writes coincide with the patches, and restore these if surface cells
    are missing."""
    BUILDS[build]()
    source, out, bare, back = (tmp_path / name for name in ("source.msh", "out.inp", "bare.inp", "back.msh"))
    gmsh_write(source, "4.1", "binary")
    points, elements, names = opened(source)
    motet("convert", source, out)
    blocks = out.read_text().split("*")[1:]
    nodes = {int(row[0]): tuple(row[1:]) for block in blocks if block.startswith("NODE")
             for row in ([float(x) for x in line.split(",")] for line in block.strip().split("\n")[1:])}
    solids, surfaces = {}, {}
    for block in blocks:
        head, *lines = block.strip().split("\n")
        if head.startswith("ELEMENT, TYPE=C3D"):
            for line in lines:
                number, *ids = (int(x) for x in line.split(","))
                solids[number] = head.split("=")[1], ids
        if head.startswith("SURFACE"):
            found = surfaces.setdefault(head.split("NAME=")[1].strip('"'), [])
            for line in lines:
                number, face = line.split(", S")
                kind, ids = solids[int(number)]
                found.append(tuple(sorted(nodes[ids[int(c) - 1]] for c in FACES_OF_ABAQUS[kind][int(face) - 1])))
    n_corners = {2: 3, 3: 4, 9: 3}
    patches = {}
    for kind, rows in elements.items():
        for ids, _, groups in rows if kind in n_corners else []:
            corners = tuple(sorted(tuple(map(float, points[i])) for i in ids[: n_corners[kind]]))
            patches.setdefault(names[2, groups[0]], []).append(corners)
    assert {name: sorted(rows) for name, rows in surfaces.items()} == {name: sorted(rows) for name, rows in patches.items()}
    is_shell = ("ELEMENT, TYPE=S", "ELSET", "NSET")
    bare.write_text("".join("*" + block for block in blocks if not block.startswith(is_shell)))
    motet("convert", bare, back)
    back_points, back_elements, back_names = opened(back)
    for kind in n_corners:
        found = sorted(tuple(sorted(tuple(map(float, back_points[i])) for i in ids[: n_corners[kind]])) + (back_names[2, groups[0]],)
                       for ids, _, groups in back_elements.get(kind, []))
        expected = sorted(tuple(sorted(tuple(map(float, points[i])) for i in ids[: n_corners[kind]])) + (names[2, groups[0]],)
                          for ids, _, groups in elements.get(kind, []))
        assert found == expected


def test_meshio_reads_its_own_tetgen_mesh_from_a_copy(motet, tmp_path):
    mesh = mixed_mesh(["tetra"])
    mesh.point_data = {"tetgen:attr1": np.random.default_rng(3).normal(size=60), "tetgen:ref": np.arange(60)}
    mesh.cell_data = {"tetgen:ref": [np.arange(1, 5)]}
    source = tmp_path / "source.node"
    mesh.write(source)
    for name in ("node.node", "ele.ele"):
        copy = tmp_path / name
        motet("convert", source.with_suffix(copy.suffix), copy)
        found, expected = meshio.read(copy), meshio.read(source)
        assert_same_mesh(found, expected, cell_data=["tetgen:ref"])


@pytest.mark.parametrize("dim", [3, 2])
def test_meshio_reads_an_su2_mesh_from_a_copy(motet, tmp_path, dim):
    """In three dimensions and in two, with numbers of markers as labels, which are all that meshio reads."""
    mesh = mixed_mesh(["tetra", "hexahedron", "wedge", "pyramid"] if dim == 3 else ["triangle", "quad"])
    sides = mixed_mesh(["triangle", "quad"] if dim == 3 else ["line"], seed=1)
    source, copy, other = tmp_path / "source.su2", tmp_path / "copy.su2", tmp_path / "other.msh"
    types = {"line": 3, "triangle": 5, "quad": 9, "tetra": 10, "hexahedron": 12, "wedge": 13, "pyramid": 14}

    def rows(blocks):
        return "".join(" ".join(map(str, [types[b.type], *row])) + "\n" for b in blocks for row in b.data)

    points = "".join(" ".join(map(repr, map(float, p[:dim]))) + "\n" for p in mesh.points)
    markers = "".join(f"MARKER_TAG= {7 + i}\nMARKER_ELEMS= {len(b.data)}\n{rows([b])}" for i, b in enumerate(sides.cells))
    source.write_text(f"NDIME= {dim}\nNELEM= {4 * len(mesh.cells)}\n{rows(mesh.cells)}NPOIN= 60\n{points}NMARK= {len(sides.cells)}\n{markers}")
    motet("convert", source, copy)
    expected = meshio.read(source)
    assert_same_mesh(meshio.read(copy), expected)
    motet("convert", source, other)
    found = meshio.read(other)
    assert_same_array(found.points[:, :dim], expected.points, "points")
    for kind, cells in cells_of(expected).items():
        # meshio takes prisms as they are; Gmsh and motet turn them.
        assert_same_array(cells_of(found)[kind], cells[:, [0, 2, 1, 3, 5, 4]] if kind == "wedge" else cells, kind)
        assert_same_array(cell_array_of(found, "gmsh:physical")[kind], cell_array_of(expected, "su2:tag")[kind], kind)


@pytest.mark.parametrize("build", ["tets", "hexahedra", "prisms"])
def test_su2_markers_are_the_groups_of_gmsh(motet, gmsh_session, tmp_path, build):
    """Gmsh writes groups of surfaces as markers with their names."""
    BUILDS[build]()
    round_nodes()
    points, elements, names = gmsh_content()
    source, again, copy = (tmp_path / name for name in ("source.su2", "again.su2", "copy.msh"))
    gmsh.write(str(source))
    motet("convert", source, again)
    motet("convert", again, copy)
    copy_points, copy_elements, copy_names = opened(copy)

    def located(points, elements, names):
        return sorted((kind, tuple(map(tuple, points[list(nodes)])), [names[2, g].replace(" ", "_") for g in groups if kind in (2, 3)])
                      for kind in set(elements) & {2, 3, 4, 5, 6} for nodes, _, groups in elements[kind] if groups or kind > 3)

    ours, theirs = located(copy_points, copy_elements, copy_names), located(points, elements, names)
    assert len(theirs) > 0
    assert ours == theirs


NETGEN_KINDS = ["line", "triangle", "quad", "triangle6", "quad8", "tetra", "pyramid", "wedge", "hexahedron", "tetra10"]


@pytest.mark.parametrize("ending", ["vol", "vol.gz"])
def test_meshio_reads_its_own_netgen_mesh_from_a_copy(motet, tmp_path, ending):
    """All kinds on which Netgen and meshio agree: meshio has the nodes of second-order bricks in another order."""
    mesh = mixed_mesh(NETGEN_KINDS)
    mesh.cell_data = {"netgen:index": [np.arange(4) // 2 + 1 + i for i in range(len(mesh.cells))]}
    mesh.field_data = {"blood": np.array([5, 3]), "wall": np.array([1, 2])}
    source, copy, other = tmp_path / f"source.{ending}", tmp_path / f"copy.{ending}", tmp_path / "other.msh"
    mesh.write(source)
    motet("convert", source, copy)
    found, expected = meshio.read(copy), meshio.read(source)
    assert_same_mesh(found, expected)
    for name, (number, dim) in mesh.field_data.items():
        assert list(found.field_data[name]) == [number, dim]
    motet("convert", source, other)
    found = meshio.read(other)
    for kind, cells in cells_of(expected).items():
        assert_same_array(cells_of(found)[kind], cells_of(mesh)[kind], kind)
        assert_same_array(cell_array_of(found, "gmsh:physical")[kind], cell_array_of(mesh, "netgen:index")[kind], kind)


@pytest.mark.parametrize("order", [1, 2])
def test_netgen_reads_its_own_mesh_from_a_copy(motet, tmp_path, order):
    csg = pytest.importorskip("netgen.csg")
    from netgen.meshing import Mesh
    geometry = csg.CSGeometry()
    left = csg.OrthoBrick(csg.Pnt(0, 0, 0), csg.Pnt(1, 1, 1)).bc("left wall").mat("left half")
    geometry.Add(left)
    geometry.Add(csg.OrthoBrick(csg.Pnt(1, 0, 0), csg.Pnt(2, 1, 1)).bc("right").mat("right"))
    mesh = geometry.GenerateMesh(maxh=0.6)
    if order == 2:
        mesh.SecondOrder()
    source, vtu, copy = tmp_path / "source.vol.gz", tmp_path / "mesh.vtu", tmp_path / "copy.vol"
    mesh.Save(str(source))
    motet("convert", source, vtu)
    motet("convert", vtu, copy)

    def content(path):
        mesh = Mesh()
        mesh.Load(str(path))
        faces = [mesh.FaceDescriptor(e.index) for e in mesh.Elements2D()]
        return ([p.p for p in mesh.Points()],
                [(tuple(v.nr for v in e.points), mesh.GetMaterial(e.index)) for e in mesh.Elements3D()],
                [(tuple(v.nr for v in e.points), f.bcname, f.domin, f.domout) for e, f in zip(mesh.Elements2D(), faces)],
                {tuple(sorted(v.nr for v in e.points)[:2]) for e in mesh.Elements1D()})

    for ours, theirs in zip(content(copy)[:3], content(source)[:3]):
        assert ours == theirs
    grid = pyvista.read(vtu)
    assert (grid.compute_cell_sizes(length=False, area=False)["Volume"][grid.celltypes > 9] > 0).any()
    if order == 1:
        tets = grid.cells_dict[10]
        assert (volumes(grid.points, tets) > 0).all()


@pytest.mark.parametrize("build", BUILDS)
def test_gmsh_reads_its_own_unv_mesh_from_a_copy(motet, gmsh_session, tmp_path, build):
    """The copy has the same nodes and cells; groups of volume and surface cells are labels with names and numbers."""
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    BUILDS[build]()
    points, elements, names = gmsh_content()
    source, again, copy = (tmp_path / name for name in ("source.unv", "again.unv", "copy.msh"))
    gmsh.write(str(source))
    motet("convert", source, again)
    motet("convert", again, copy)
    copy_points, copy_elements, copy_names = opened(copy)
    dims = dict.fromkeys([4, 5, 6, 11, 17, 18], 3) | dict.fromkeys([2, 3, 9, 16], 2)

    def located(points, elements):
        return sorted((kind, tuple(map(tuple, points[list(nodes)])), groups)
                      for kind in set(elements) & set(dims) for nodes, _, groups in elements[kind] if groups)

    ours, theirs = located(copy_points, copy_elements), located(points, elements)
    assert len(theirs) > 0
    assert ours == theirs
    # Gmsh replaces blanks in names.
    assert {key: name for key, name in copy_names.items() if key[0] > 1} == {
        key: name.replace(" ", "_") for key, name in names.items() if key[0] > 1}
    gmsh.clear()
    gmsh.open(str(again))
    found_points, found, _ = gmsh_content()
    assert len(found_points) == len(points)
    # Gmsh writes only elements in groups.
    grouped = {kind: sum(bool(groups) for *_, groups in rows) for kind, rows in elements.items()}
    for kind in set(found) & set(dims):
        assert len(found[kind]) == grouped[kind]


NASTRAN_KINDS = [["tetra"], ["triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron"],
                 ["triangle6", "quad8", "tetra10", "hexahedron20"]]


def nastran_mesh(kinds):
    """Return a mesh with properties, whose coordinates fit fields of 8 characters."""
    mesh = mixed_mesh(kinds)
    mesh.points = np.round(np.clip(mesh.points, -9, 9), 3) + 0.0
    mesh.cell_data = {"nastran:ref": [np.full(4, i + 3, np.int32) for i in range(len(kinds))]}
    return mesh


@pytest.mark.parametrize("point_format", ["fixed-small", "fixed-large", "free"])
@pytest.mark.parametrize("kinds", NASTRAN_KINDS[:2])
def test_meshio_reads_its_own_nastran_mesh_from_a_copy(motet, tmp_path, kinds, point_format):
    """Elements of first order: those of second order have names of meshio's own when it writes them."""
    source, copy = tmp_path / "source.bdf", tmp_path / "copy.nas"
    meshio.nastran.write(source, nastran_mesh(kinds), point_format=point_format)
    motet("convert", source, copy)
    assert_same_mesh(meshio.read(copy, file_format="nastran"), meshio.read(source))


def nastran_copy(motet, tmp_path, kinds):
    """Return a mesh and the Nastran file that motet makes of it."""
    source, copy = tmp_path / "source.msh", tmp_path / "copy.bdf"
    mesh = nastran_mesh(kinds)
    properties = mesh.cell_data.pop("nastran:ref")
    meshio.write(source, meshio.Mesh(mesh.points, mesh.cells, cell_data={
        "gmsh:physical": properties, "gmsh:geometrical": properties}), file_format="gmsh22", binary=False)
    motet("convert", source, copy)
    mesh.cell_data["nastran:ref"] = properties
    return mesh, copy


@pytest.mark.parametrize("kinds", NASTRAN_KINDS)
def test_meshio_reads_nastran_files_of_motet(motet, tmp_path, kinds):
    mesh, copy = nastran_copy(motet, tmp_path, kinds)
    assert_same_mesh(meshio.read(copy), mesh)


@pytest.mark.parametrize("size", [8, 16])
@pytest.mark.parametrize("kinds", NASTRAN_KINDS)
def test_pynastran_reads_nastran_files_of_motet(motet, tmp_path, kinds, size):
    """pyNastran writes what it read, and motet reads that."""
    bdf = pytest.importorskip("pyNastran.bdf.bdf")
    mesh, copy = nastran_copy(motet, tmp_path, kinds)
    again, back = tmp_path / "again.bdf", tmp_path / "back.bdf"
    model = bdf.read_bdf(copy, xref=False, punch=False, debug=None)
    assert_same_array(np.array([model.nodes[i].xyz for i in sorted(model.nodes)]), mesh.points, "points")
    model.write_bdf(again, size=size, interspersed=False)
    motet("convert", again, back)
    assert_same_mesh(meshio.read(back), mesh)


@pytest.mark.parametrize("fields", [0, 1, 2])
def test_gmsh_reads_its_own_nastran_mesh_from_a_copy(motet, tmp_path, gmsh_session, fields):
    """Fields are free, short and long."""
    tet_box(1)
    source, copy = tmp_path / "source.bdf", tmp_path / "copy.bdf"
    gmsh.option.setNumber("Mesh.BdfFieldFormat", fields)
    gmsh.write(str(source))
    gmsh.clear()
    gmsh.open(str(source))
    expected_points, expected, _ = gmsh_content()
    motet("convert", source, copy)
    gmsh.clear()
    gmsh.open(str(copy))
    points, found, _ = gmsh_content()
    np.testing.assert_allclose(points, expected_points, rtol=0, atol=1e-12)
    for kind in (2, 4):
        assert sorted(nodes for nodes, *_ in found[kind]) == sorted(nodes for nodes, *_ in expected[kind])


CDB_CELLS = [[10], [5, 9, 10, 12, 13, 14], [22, 23, 24, 25, 26, 27]]
# Numbers of nodes of VTK's cells, which have volume from 10 on.
N_NODES = {5: 3, 9: 4, 10: 4, 12: 8, 13: 6, 14: 5, 22: 6, 23: 8, 24: 10, 25: 20, 26: 15, 27: 13}


def mixed_grid(types):
    """Return a grid with four cells of random points of each of VTK's types."""
    rng = np.random.default_rng(7)
    points = rng.normal(size=(60, 3)) * 10.0 ** rng.integers(-9, 9, size=(60, 1))
    rows = [[N_NODES[kind], *rng.choice(60, N_NODES[kind], replace=False)] for kind in np.repeat(types, 4)]
    return pyvista.UnstructuredGrid(np.concatenate(rows), np.repeat(types, 4), points)


def turned_rows(grid):
    """Return the cells of a grid as type and nodes. Wedges may begin at any corner of their triangles: here at the lowest."""
    rows = []
    for i, kind in enumerate(grid.celltypes):
        nodes = np.array(grid.get_cell(i).point_ids)
        if kind in (13, 26):
            first = np.argmin(nodes[:3])
            nodes = np.concatenate([np.roll(part, -first) for part in np.split(nodes, len(nodes) // 3)])
        rows.append((int(kind), nodes.tolist()))
    return rows


@pytest.mark.parametrize("types", CDB_CELLS)
def test_mapdl_archive_reads_cdb_files_of_motet(motet, tmp_path, types):
    """Runs where mapdl-archive is installed (pip install mapdl-archive)."""
    archives = pytest.importorskip("mapdl_archive")
    grid = mixed_grid(types)
    numbers = np.repeat(np.arange(len(types)) + 3, 4).astype(np.int32)
    is_volume = np.isin(grid.celltypes, [10, 12, 13, 14, 24, 25, 26, 27])
    grid.cell_data["region"], grid.cell_data["patch"] = numbers * is_volume, numbers * ~is_volume
    source, copy = tmp_path / "source.vtu", tmp_path / "copy.cdb"
    grid.save(source)
    motet("convert", source, copy)
    archive = archives.Archive(str(copy))
    # Its own numbers may differ in the last bit.
    np.testing.assert_allclose(archive.nodes, grid.points, rtol=1e-15)
    assert_same_array(np.asarray(archive.material_type), numbers, "materials")
    components = {f"{'REGION' if volume else 'PATCH'}_{number}" for number, volume in zip(numbers, is_volume)}
    assert set(archive.element_components) == components
    # It makes no cells of MESH200.
    expected = [row for row, volume in zip(turned_rows(grid), is_volume) if volume]
    assert [row for row in turned_rows(archive.grid) if row[0] not in (0, 5, 9, 22, 23)] == expected


@pytest.mark.parametrize("types", [[10], [5, 9, 10, 12, 13, 14], [24, 25, 26, 27]])
def test_cdb_files_of_mapdl_archive_are_read(motet, tmp_path, types):
    archives = pytest.importorskip("mapdl_archive")
    grid = mixed_grid(types)
    # It writes 13 digits after the point, and only points of cells.
    grid.points = np.array([[float(f"{x:.13e}") for x in point] for point in grid.points])
    grid = grid.extract_cells(range(grid.n_cells))
    rng = np.random.default_rng(9)
    grid.point_data["ansys_node_num"] = np.cumsum(rng.integers(1, 9, size=grid.n_points)).astype(np.int32)
    grid.cell_data["ansys_elem_num"] = np.cumsum(rng.integers(1, 9, size=grid.n_cells)).astype(np.int32)
    grid.cell_data["ansys_material_type"] = np.repeat(np.arange(len(types)) + 2, 4).astype(np.int32)
    source, copy = tmp_path / "source.cdb", tmp_path / "copy.vtu"
    archives.save_as_archive(str(source), grid)
    motet("convert", source, copy)
    found = pyvista.read(copy)
    assert_same_array(np.asarray(found.points), np.asarray(grid.points), "points")
    assert turned_rows(found) == turned_rows(grid)
    if len(types) > 1:
        labels = np.array(found.cell_data["region"]) + np.array(found.cell_data.get("patch", 0))
        assert_same_array(labels, grid.cell_data["ansys_material_type"], "materials")


def test_cdb_files_hold_the_same_mesh_as_msh_files(motet, gmsh_session, tmp_path):
    """Groups of Gmsh are materials and components; motet reads them back as regions and patches with their names."""
    tet_box(2)
    source, copy, back = tmp_path / "source.msh", tmp_path / "copy.cdb", tmp_path / "back.msh"
    gmsh_write(source, "4.1", "binary")
    motet("convert", source, copy)
    motet("convert", copy, back)
    ours, theirs = meshio.read(back), meshio.read(source)
    assert_same_array(ours.points, theirs.points, "points")
    for kind in ("tetra10", "triangle6"):
        assert_same_array(cells_of(ours)[kind], cells_of(theirs)[kind], kind)
        assert_same_array(cell_array_of(ours, "gmsh:physical")[kind], cell_array_of(theirs, "gmsh:physical")[kind], kind)
    for name, (tag, dim) in theirs.field_data.items():
        assert dim < 2 or list(ours.field_data[name.replace(" ", "_")]) == [tag, dim]


def vtk_fluent(path):
    """Return the zones of cells that VTK reads from a Fluent file; it has others for faces."""
    reader = vtk.vtkFLUENTReader()
    reader.SetFileName(str(path))
    reader.Update()
    output = pyvista.wrap(reader.GetOutput())
    return [output[i] for i in range(output.n_blocks) if output.get_block_name(i).endswith(":fluid")]


def cells_at(grid, points=None, chosen=None):
    """Return the cells of a grid, or those chosen: their type and the coordinates of their points, in any order."""
    points = np.asarray(grid.points if points is None else points, float)
    cells = range(grid.n_cells) if chosen is None else np.flatnonzero(chosen)
    return sorted((int(grid.celltypes[i]), sorted(map(tuple, points[list(grid.get_cell(i).point_ids)]))) for i in cells)


def volume_cells(path):
    grid = pyvista.read(path)
    return grid.extract_cells(np.isin(grid.celltypes, [10, 12, 13, 14, 42]))


def fluent_mesh(kind, tmp_path, motet):
    """Return a .vtu file of a box of one kind of cells or of several, and the Fluent file that motet makes of it."""
    source, copy = tmp_path / "source.msh", tmp_path / "copy.cas"
    if kind == "tets":
        tet_box(1)
    else:
        layered_box(kind, 1)
    gmsh_write(source, "4.1", "binary")
    motet("convert", source, tmp_path / "source.vtu")
    motet("convert", source, copy)
    return tmp_path / "source.vtu", copy


def binary_fluent(text, double):
    """Turn the points, cells and faces of a Fluent file of motet into binary sections."""
    import re
    out, at = b"", 0
    for match in re.finditer(r"\((1[023]) \(([0-9a-f ]+)\)\(\n([^()]*)\)\)\n", text):
        out += text[at:match.start()].encode()
        at = match.end()
        index, header, body = match.groups()
        number = ("30" if double else "20") + index
        if index == "10":
            data = np.array(body.split(), np.float64 if double else np.float32)
        else:
            data = np.array([int(word, 16) for word in body.split()], np.int32)
        out += f"({number} ({header})(".encode() + data.tobytes() + f")\nEnd of Binary Section   {number})\n".encode()
    assert at
    return out + text[at:].encode()


@pytest.mark.parametrize("form", ["text", "single", "double"])
@pytest.mark.parametrize("kind", ["tets", "hexahedra", "prisms"])
def test_vtk_and_motet_read_the_same_cells_from_fluent_files(motet, gmsh_session, tmp_path, kind, form):
    source, copy = fluent_mesh(kind, tmp_path, motet)
    if form != "text":
        copy.write_bytes(binary_fluent(copy.read_text(), form == "double"))
    expected = volume_cells(source)
    # VTK reads points in single precision.
    rounded = np.asarray(expected.points, np.float32).astype(float)
    assert sorted(itertools.chain(*map(cells_at, vtk_fluent(copy)))) == cells_at(expected, rounded)
    points = rounded if form == "single" else None
    for ending in ("cas", "msh"):
        renamed = tmp_path / f"renamed.{ending}"
        renamed.write_bytes(copy.read_bytes())
        motet("convert", renamed, tmp_path / "again.vtu")
        found = volume_cells(tmp_path / "again.vtu")
        assert cells_at(found) == cells_at(expected, points)
        assert (found.compute_cell_sizes()["Volume"] > 0).all()
    whole, again = pyvista.read(source), pyvista.read(tmp_path / "again.vtu")
    for name in (name for name in whole.field_data.keys() if name.startswith(("region:", "patch:"))):
        assert again.field_data[name.replace(" ", "_")] == whole.field_data[name]


@pytest.mark.parametrize("binary", [False, True])
def test_meshio_files_of_fluent_are_read(motet, tmp_path, binary):
    """meshio lists the nodes of cells, which Fluent does not."""
    mesh = mixed_mesh(["triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron"])
    source, copy = tmp_path / "source.msh", tmp_path / "copy.vtu"
    meshio.ansys.write(source, mesh, binary=binary)
    motet("convert", source, copy)
    assert_same_mesh(read_turned(copy), mesh)


def read_turned(path):
    """Read a .vtu file with meshio, which turns the prisms of such files."""
    mesh = meshio.read(path)
    for block in mesh.cells:
        if block.type == "wedge":
            block.data = block.data[:, [0, 2, 1, 3, 5, 4]]
    return mesh


def test_meshio_reads_points_and_faces_of_fluent_files_of_motet(motet, gmsh_session, tmp_path):
    source, copy = fluent_mesh("tets", tmp_path, motet)
    text = copy.read_text()
    # meshio takes the points of all sections; mixed faces have their number of points in front.
    (tmp_path / "copy.msh").write_text(text)
    found, expected = meshio.read(tmp_path / "copy.msh", file_format="ansys"), volume_cells(source)
    assert sorted(map(tuple, found.points)) == sorted(map(tuple, expected.points))
    faces = {tuple(sorted(map(tuple, found.points[face]))) for face in cells_of(found)["triangle"]}
    theirs = {tuple(sorted(map(tuple, expected.points[list(face)]))) for tet in expected.cells_dict[10]
              for face in itertools.combinations(tet, 3)}
    assert faces == theirs


def vtk_cff(path):
    """Return the zones of cells that VTK reads from a Fluent file in HDF5."""
    reader = vtk.vtkFLUENTCFFReader()
    reader.SetFileName(str(path))
    reader.Update()
    output = pyvista.wrap(reader.GetOutput())
    return [output[i] for i in range(output.n_blocks)]


def two_zones(kind, tmp_path, motet):
    """Return a box of one kind of cells or of several, and the zone of each cell, in their order."""
    if kind == "mixed":
        return mixed_box()
    source, _ = fluent_mesh(kind, tmp_path, motet)
    grid = volume_cells(source)
    zones = np.where(grid.cell_centers().points[:, 0] < 0.5, 3, 8)
    order = np.argsort(zones, kind="stable")
    return grid.extract_cells(order), zones[order]


@pytest.mark.parametrize("sections, storage", [(1, {}), (3, {"compression": "gzip", "shuffle": True})])
@pytest.mark.parametrize("kind", ["tets", "hexahedra", "prisms", "mixed"])
def test_vtk_and_motet_read_the_same_mesh_from_fluent_files_in_hdf5(motet, gmsh_session, tmp_path, kind, sections, storage):
    expected, zones = two_zones(kind, tmp_path, motet)
    source, again = tmp_path / "source.cas.h5", tmp_path / "again.vtu"

    def patch_of(middle):
        return 4 if middle[0] < 0.1 else 5 if middle[2] < 0.1 else 6

    names = {3: "blood", 8: "tissue", 4: "inlet", 5: "floor", 6: "wall", 99: "inside"}
    write_cff(source, expected, zones, patch_of, names, sections=sections, **storage)
    # VTK reads points in single precision.
    rounded = np.asarray(expected.points, np.float32).astype(float)
    of_zones = [cells_at(expected, rounded, zones == zone) for zone in (3, 8)]
    assert all(of_zones) and [cells_at(zone) for zone in vtk_cff(source)] == of_zones
    motet("convert", source, again)
    whole, found = pyvista.read(again), volume_cells(again)
    for zone in (3, 8):
        assert cells_at(found, chosen=found["region"] == zone) == cells_at(expected, chosen=zones == zone)
    assert np.array_equal(found["region"], zones) and (found.compute_cell_sizes()["Volume"] > 0).all()
    assert sorted(map(tuple, whole.points)) == sorted(map(tuple, expected.points))
    facets = whole.extract_cells(np.isin(whole.celltypes, [5, 9]))
    assert list(facets["patch"]) == [patch_of(facets.get_cell(i).points.mean(axis=0)) for i in range(facets.n_cells)]
    assert facets.n_cells == expected.extract_surface(algorithm=None).n_cells and set(facets["patch"]) == {4, 5, 6}
    labels = {name: int(whole.field_data[name][0]) for name in whole.field_data.keys() if name.startswith(("region:", "patch:"))}
    assert labels == {"region:blood": 3, "region:tissue": 8, "patch:inlet": 4, "patch:floor": 5, "patch:wall": 6}
    # VTK 9.7 takes the points of faces from wrong places where they are in several sections.
    divided = tmp_path / "divided.msh.h5"
    write_cff(divided, expected, zones, patch_of, names, sections=sections, sections_of_faces=4, **storage)
    motet("convert", divided, tmp_path / "divided.vtu")
    assert (tmp_path / "divided.vtu").read_bytes() == again.read_bytes()
    # The same mesh in the form in text.
    motet("convert", source, tmp_path / "text.cas")
    motet("convert", tmp_path / "text.cas", tmp_path / "text.vtu")
    assert cells_at(volume_cells(tmp_path / "text.vtu")) == cells_at(expected)


def labelled_mesh(kinds):
    """Return a mixed mesh whose volume cells have regions and whose surface cells have patches."""
    mesh = mixed_mesh(kinds)
    dims = [meshio._mesh.topological_dimension[kind] for kind in kinds]
    mesh.cell_data = {name: [np.full(4, i + 3 if dim == of else 0, np.int32) for i, dim in enumerate(dims)]
                      for name, of in (("region", 3), ("patch", 2)) if of in dims}
    return mesh


MED_KINDS = [["tetra"], ["vertex", "line", "triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron"],
             ["line3", "triangle6", "quad8", "tetra10", "hexahedron20"]]


@pytest.mark.parametrize("kinds", MED_KINDS)
def test_meshio_files_of_med_are_read(motet, tmp_path, kinds):
    mesh = mixed_mesh(kinds)
    rng = np.random.default_rng(8)
    mesh.point_data = {"u": rng.normal(size=(60, 3)), "p": rng.normal(size=60)}
    mesh.cell_data = {"q": [rng.normal(size=4) for _ in kinds], "t": [rng.normal(size=(4, 9)) for _ in kinds]}
    mesh.point_data["point_tags"] = np.arange(60) % 3
    mesh.cell_data["cell_tags"] = [-(i + 1) * np.ones(4, int) for i in range(len(kinds))]
    mesh.point_tags = {1: ["ends"], 2: ["ends", "middle part"]}
    mesh.cell_tags = {-(i + 1): [f"group of {kind}"] for i, kind in enumerate(kinds)}
    source, copy = tmp_path / "source.med", tmp_path / "copy.vtu"
    meshio.med.write(source, mesh)
    motet("convert", source, copy)
    found = read_turned(copy)
    assert_same_mesh(found, mesh, ["u", "p"], ["q", "t"])
    assert_same_array(found.point_data["nset:ends"], (np.arange(60) % 3 > 0).astype(np.uint8), "ends")
    assert_same_array(found.point_data["nset:middle part"], (np.arange(60) % 3 == 2).astype(np.uint8), "middle part")
    for i, kind in enumerate(kinds):
        dim = meshio._mesh.topological_dimension[kind]
        if dim > 1:
            name = {2: "patch", 3: "region"}[dim]
            assert set(cell_array_of(found, name)[kind]) == {i + 1}
            assert pyvista.read(copy).field_data[f"{name}:group of {kind}"] == [i + 1]


@pytest.mark.parametrize("kinds", MED_KINDS)
def test_meshio_reads_med_files_of_motet(motet, tmp_path, kinds):
    mesh = labelled_mesh(kinds)
    rng = np.random.default_rng(8)
    mesh.point_data = {"u": rng.normal(size=(60, 3)), "n": np.arange(60, dtype=np.int64)}
    mesh.cell_data["q"] = [rng.normal(size=4) for _ in kinds]
    source, copy = tmp_path / "source.vtu", tmp_path / "copy.med"
    mesh.write(source)
    motet("convert", source, copy)
    found = meshio.read(copy)
    assert_same_array(found.points, mesh.points, "points")
    for kind, cells in cells_of(mesh).items():
        # meshio takes cells as they are; in MED volume cells run the other way round.
        same = np.sort(cells_of(found)[kind], axis=1)
        assert_same_array(same, np.sort(cells, axis=1), kind)
        if meshio._mesh.topological_dimension[kind] < 3:
            assert_same_array(cells_of(found)[kind], cells, kind)
        assert_same_array(cell_array_of(found, "q")[kind], cell_array_of(mesh, "q")[kind], "q")
    for name, values in mesh.point_data.items():
        assert_same_array(found.point_data[name], values, name)
    labels = {-number: [f"{prefix}_{number}"] for name, prefix in (("region", "REGION"), ("patch", "PATCH"))
              if name in mesh.cell_data for number in map(int, np.unique(np.concatenate(mesh.cell_data[name]))) if number}
    assert {int(number): groups for number, groups in found.cell_tags.items()} == labels


@pytest.mark.parametrize("build", BUILDS)
def test_gmsh_reads_its_own_med_mesh_from_a_copy(motet, gmsh_session, tmp_path, build):
    # Prisms of 18 nodes are not written.
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", int(build.startswith("prisms")))
    BUILDS[build]()
    source, again, vtu = tmp_path / "source.med", tmp_path / "again.med", tmp_path / "mesh.vtu"
    gmsh.write(str(source))
    points, elements, names = opened(source)
    motet("convert", source, again)
    copy_points, copy_elements, copy_names = opened(again)
    dims = dict.fromkeys([4, 5, 6, 11, 12, 13, 17, 18], 3) | dict.fromkeys([2, 3, 9, 10, 16], 2)

    def located(points, elements, names):
        return sorted((kind, tuple(map(tuple, points[list(nodes)])), sorted(names[dims[kind], g] for g in groups))
                      for kind in set(elements) & set(dims) for nodes, _, groups in elements[kind])

    ours, theirs = located(copy_points, copy_elements, copy_names), located(points, elements, names)
    assert len(theirs) > 0 and ours == theirs
    assert {kind: len(rows) for kind, rows in copy_elements.items()} == {kind: len(rows) for kind, rows in elements.items()}
    motet("convert", source, vtu)
    grid = pyvista.read(vtu)
    solid = grid.extract_cells(np.isin(grid.celltypes, [10, 12, 13]))
    assert (solid.compute_cell_sizes()["Volume"] > 0).all()


@pytest.mark.parametrize("element_type", [kind for kind in TYPES if kind != 14])
def test_nodes_of_every_med_element_are_in_the_order_of_vtk(motet, gmsh_session, tmp_path, element_type):
    """Gmsh writes one element as MED and as MSH, whose nodes other tests check."""
    one_element(element_type)
    med, msh = tmp_path / "one.med", tmp_path / "one.msh"
    gmsh.write(str(med))
    gmsh_write(msh, "4.1", "binary")
    cells = []
    for source in (med, msh):
        motet("convert", source, tmp_path / "one.vtu")
        grid = vtk_grid(tmp_path / "one.vtu")
        assert grid.GetNumberOfCells() == 1
        cells.append((grid.GetCellType(0), vtk_to_numpy(grid.GetCell(0).GetPoints().GetData()).tolist()))
    assert cells[0] == cells[1]


def vtk_exodus(path):
    """Return the blocks and side sets that VTK reads, by name."""
    reader = vtk.vtkExodusIIReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    for kind in (reader.ELEM_BLOCK, reader.SIDE_SET):
        for i in range(reader.GetNumberOfObjects(kind)):
            reader.SetObjectStatus(kind, i, 1)
    for kind in (reader.NODAL, reader.ELEM_BLOCK):
        for i in range(reader.GetNumberOfObjectArrays(kind)):
            reader.SetObjectArrayStatus(kind, i, 1)
    reader.Update()
    output = pyvista.wrap(reader.GetOutput())
    return [{name: output[sort][name] for name in output[sort].keys()} for sort in ("Element Blocks", "Side Sets")]


EXODUS_CELLS = [vtk.vtkTetra, vtk.vtkHexahedron, vtk.vtkWedge, vtk.vtkPyramid, vtk.vtkTriangle, vtk.vtkQuad, vtk.vtkQuadraticTetra,
                vtk.vtkQuadraticHexahedron, vtk.vtkTriQuadraticHexahedron, vtk.vtkQuadraticWedge]


@pytest.mark.parametrize("cell", EXODUS_CELLS)
def test_vtk_reads_nodes_of_exodus_cells_and_arrays_of_motet(motet, tmp_path, cell):
    cell = cell()
    n = cell.GetNumberOfPoints()
    points = np.array([cell.GetParametricCoords()[i] for i in range(3 * n)]).reshape(n, 3)
    grid = pyvista.UnstructuredGrid(np.r_[n, np.arange(n)], [cell.GetCellType()], points)
    grid.cell_data["q"], grid.point_data["u"] = [1.5], points
    grid.save(tmp_path / "one.vtu")
    motet("convert", tmp_path / "one.vtu", tmp_path / "one.exo")
    block, = vtk_exodus(tmp_path / "one.exo")[0].values()
    assert block.celltypes[0] == cell.GetCellType()
    order = block.cell_connectivity
    # VTK reads points in single precision.
    assert_same_array(block.points[order], points.astype(np.float32), "nodes")
    assert_same_array(np.asarray(block.point_data["u"], np.float32)[order], points.astype(np.float32), "u")
    assert list(block.cell_data["q"]) == [1.5]


def exodus_box(motet, tmp_path):
    """Return a box with named regions and patches, and the Exodus file that motet makes of it."""
    tet_box(1)
    source, copy = tmp_path / "source.msh", tmp_path / "copy.exo"
    gmsh_write(source, "4.1", "binary")
    motet("convert", source, copy)
    return source, copy


def facets(points, cells):
    """Return the corners of facets as a set."""
    return {tuple(sorted(map(tuple, np.round(np.asarray(points, np.float32)[cell], 5)))) for cell in cells}


def test_vtk_reads_side_sets_of_exodus_files_of_motet(motet, tmp_path, gmsh_session):
    source, copy = exodus_box(motet, tmp_path)
    blocks, sides = vtk_exodus(copy)
    mesh = meshio.read(source)
    names = {int(tag): name for name, (tag, dim) in mesh.field_data.items() if dim == 2}
    assert {"left half", "right half"} < set(blocks) and set(sides) == set(names.values())
    tags, triangles = cell_array_of(mesh, "gmsh:physical")["triangle"], cells_of(mesh)["triangle"]
    for tag, name in names.items():
        side = sides[name]
        rows = side.cell_connectivity.reshape(-1, 3) if isinstance(side, pyvista.UnstructuredGrid) else side.faces.reshape(-1, 4)[:, 1:]
        assert facets(np.asarray(side.points, float), rows) == facets(mesh.points, triangles[tags == tag]), name


@pytest.mark.parametrize("form", ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA", "NETCDF4", "NETCDF4_CLASSIC"])
def test_exodus_files_in_each_form_of_netcdf_are_read(motet, tmp_path, gmsh_session, form):
    """The netCDF library reads a file of motet and writes it again."""
    netcdf = pytest.importorskip("netCDF4")
    _, copy = exodus_box(motet, tmp_path)
    again, one, two = tmp_path / "again.e", tmp_path / "one.vtu", tmp_path / "two.vtu"
    with netcdf.Dataset(copy) as old, netcdf.Dataset(again, "w", format=form) as new:
        old.set_auto_mask(False)
        for name, dimension in old.dimensions.items():
            new.createDimension(name, None if dimension.isunlimited() else len(dimension))
        for name, array in old.variables.items():
            created = new.createVariable(name, array.dtype, array.dimensions)
            created.setncatts({key: array.getncattr(key) for key in array.ncattrs() if not key.startswith("_")})
            created[:] = array[:]
    motet("convert", copy, one)
    motet("convert", again, two)
    ours, theirs = pyvista.read(two), pyvista.read(one)
    assert_same_array(ours.points, theirs.points, "points")
    assert_same_array(ours.cell_connectivity, theirs.cell_connectivity, "cells")
    assert set(ours.array_names) == set(theirs.array_names)
    for name in ("region", "patch"):
        assert_same_array(ours.cell_data[name], theirs.cell_data[name], name)


@pytest.mark.parametrize("kinds", [["tetra"], ["triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron"], ["triangle6", "quad8", "tetra10"]])
def test_meshio_reads_its_own_exodus_mesh_from_a_copy(motet, tmp_path, kinds):
    pytest.importorskip("netCDF4")
    mesh = mixed_mesh(kinds)
    mesh.point_data = {"p": np.random.default_rng(3).normal(size=60)}
    source, copy = tmp_path / "source.exo", tmp_path / "copy.exo"
    mesh.write(source)
    motet("convert", source, copy)
    ours = meshio.read(copy)
    assert_same_array(ours.points, mesh.points, "points")
    assert_same_array(ours.point_data["p"], mesh.point_data["p"], "p")
    for kind, cells in cells_of(mesh).items():
        assert_same_array(cells_of(ours)[kind], cells, kind)


@pytest.mark.parametrize("data_format", ["XML", "HDF"])
@pytest.mark.parametrize("kinds", [["tetra"], ["triangle"], ["tetra10"], ["line", "triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron"]])
def test_meshio_reads_its_own_xdmf_mesh_from_a_copy(motet, tmp_path, kinds, data_format):
    if data_format == "HDF":
        pytest.importorskip("h5py")
    mesh = mixed_mesh(kinds)
    rng = np.random.default_rng(4)
    mesh.point_data = {"u": rng.normal(size=(60, 3)), "n": np.arange(60, dtype=np.int32)}
    mesh.cell_data = {"q": [rng.normal(size=4) for _ in kinds], "t": [rng.normal(size=(4, 9)) for _ in kinds]}
    source, copy = tmp_path / "source.xdmf", tmp_path / "copy.xdmf"
    meshio.write(source, mesh, data_format=data_format)
    motet("convert", source, copy)
    assert_same_mesh(meshio.read(copy), meshio.read(source))


def test_meshio_reads_names_of_labels_from_xdmf_files(motet, tmp_path):
    source, copy = tmp_path / "source.msh", tmp_path / "copy.xdmf"
    # With volume cells of one kind there would be two grids, of which meshio reads none.
    mesh = mixed_mesh(["triangle", "tetra", "wedge"])
    mesh.cell_data = {name: [np.full(4, 3), np.full(4, 7), np.full(4, 7)] for name in ("gmsh:physical", "gmsh:geometrical")}
    mesh.field_data = {"a <wall>": np.array([3, 2]), "blood": np.array([7, 3])}
    meshio.write(source, mesh, file_format="gmsh22", binary=False)
    motet("convert", source, copy)
    found = meshio.read(copy)
    assert {name: list(map(int, value)) for name, value in found.field_data.items()} == {"a <wall>": [3, 2], "blood": [7, 3]}


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_vtk_reads_cells_and_facets_of_xdmf_files_of_motet(motet, tmp_path, encoding):
    mesh = mixed_mesh(["triangle", "tetra"])
    mesh.cell_data = {"region": [np.zeros(4, np.int32), np.arange(1, 5, dtype=np.int32)], "patch": [np.arange(5, 9, dtype=np.int32), np.zeros(4, np.int32)]}
    source, copy = tmp_path / "source.vtu", tmp_path / "copy.xdmf"
    mesh.write(source)
    motet("convert", source, copy, "--encoding", encoding)
    reader = vtk.vtkXdmfReader()
    reader.SetFileName(str(copy))
    reader.Update()
    cells, facets = (pyvista.wrap(reader.GetOutputDataObject(0))[i] for i in range(2))
    expected = pyvista.read(source)
    for grid, kind, name in ((cells, 10, "region"), (facets, 5, "patch")):
        chosen = expected.extract_cells(expected.celltypes == kind)
        assert_same_array(np.asarray(grid.points, float), np.asarray(expected.points, float), "points")
        assert_same_array(grid.cell_connectivity, expected.cells_dict[kind].ravel(), "cells")
        assert_same_array(grid.cell_data[name], chosen.cell_data[name], name)


def test_dolfinx_reads_cells_and_facets_of_xdmf_files_of_motet(motet, tmp_path):
    """Runs where dolfinx is installed; the tags of the facets of a box say across which axis they are."""
    dolfinx_io, mpi = pytest.importorskip("dolfinx.io"), pytest.importorskip("mpi4py.MPI")
    grid = pyvista.ImageData(dimensions=(4, 4, 4)).to_tetrahedra(5)
    surface = grid.extract_surface().cast_to_unstructured_grid()
    points, tets = np.asarray(grid.points, float), grid.cells_dict[10]
    triangles = surface.point_data["vtkOriginalPointIds"][surface.cells_dict[5]]
    patch = 1 + np.argmax(np.ptp(points[triangles], axis=1) == 0, axis=1).astype(np.int32)
    region = 1 + (points[tets].mean(axis=1)[:, 0] > 1.5).astype(np.int32)
    n, m = len(tets), len(triangles)
    source, copy = tmp_path / "source.vtu", tmp_path / "copy.xdmf"
    meshio.Mesh(points, [("triangle", triangles), ("tetra", tets)], cell_data={
        "region": [np.zeros(m, np.int32), region], "patch": [patch, np.zeros(n, np.int32)]}).write(source)
    motet("convert", source, copy)
    with dolfinx_io.XDMFFile(mpi.COMM_SELF, str(copy), "r") as file:
        mesh = file.read_mesh(name="mesh")
        mesh.topology.create_connectivity(2, 3)
        cell_tags, facet_tags = file.read_meshtags(mesh, name="mesh"), file.read_meshtags(mesh, name="facet_tags")
    assert mesh.topology.index_map(3).size_global == n
    assert np.array_equal(np.bincount(cell_tags.values), np.bincount(region))
    assert np.array_equal(np.bincount(facet_tags.values), np.bincount(patch))


@pytest.mark.parametrize("kinds", [["tetra"], ["triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron"]])
def test_vtk_reads_xdmf_files_of_motet(motet, tmp_path, kinds):
    mesh = mixed_mesh(kinds)
    mesh.point_data = {"u": np.random.default_rng(6).normal(size=(60, 3))}
    source, copy = tmp_path / "source.vtu", tmp_path / "copy.xdmf"
    mesh.write(source)
    motet("convert", source, copy)
    reader = vtk.vtkXdmfReader()
    reader.SetFileName(str(copy))
    reader.Update()
    ours, theirs = pyvista.wrap(reader.GetOutputDataObject(0)), pyvista.read(source)
    assert_same_array(np.asarray(ours.points, float), np.asarray(theirs.points, float), "points")
    assert_same_array(ours.celltypes, theirs.celltypes, "kinds of cells")
    assert_same_array(ours.cell_connectivity, theirs.cell_connectivity, "cells")
    assert_same_array(ours.point_data["u"], theirs.point_data["u"], "u")


@pytest.mark.parametrize("ending", ["stl", "obj", "ply", "off"])
@pytest.mark.parametrize("binary", [False, True])
def test_meshio_reads_its_own_surfaces_from_a_copy(motet, tmp_path, ending, binary):
    mesh = mixed_mesh(["triangle"])
    mesh.points = mesh.points.astype(np.float32).astype(float)
    source, copy = tmp_path / f"source.{ending}", tmp_path / f"copy.{ending}"
    mesh.write(source, **({"binary": binary} if ending in ("stl", "ply") else {}))
    motet("convert", source, copy, "--encoding", "binary" if binary else "ascii")
    ours, theirs = meshio.read(copy), meshio.read(source)
    assert_same_array(corners(ours), corners(theirs), "corners of triangles")


@pytest.mark.parametrize("binary", [False, True])
def test_meshio_reads_its_own_ply_arrays_from_a_copy(motet, tmp_path, binary):
    mesh = mixed_mesh(["triangle", "quad"])
    random = np.random.default_rng(5)
    mesh.point_data = {"p": random.normal(size=len(mesh.points)), "q": random.integers(-9, 9, len(mesh.points)).astype(np.int32)}
    source, copy = tmp_path / "source.ply", tmp_path / "copy.ply"
    mesh.write(source, binary=binary)
    motet("convert", source, copy, "--encoding", "binary" if binary else "ascii")
    found, expected = meshio.read(copy), meshio.read(source)
    assert_same_mesh(found, expected, point_data=["p", "q"])


def corners(mesh):
    return np.asarray(mesh.points, float)[cells_of(mesh)["triangle"]]


# ---- VTK


def test_vtk_reads_surfaces_of_motet(motet, gmsh_session, tmp_path):
    tet_box(1)
    source = tmp_path / "source.msh"
    gmsh_write(source, "4.1", "binary")
    expected = meshio.read(source)
    triangles = np.asarray(expected.points)[cells_of(expected)["triangle"]]
    for name, reader, options in [("a.stl", vtk.vtkSTLReader(), ["--ascii"]), ("b.stl", vtk.vtkSTLReader(), []),
                                  ("c.obj", vtk.vtkOBJReader(), []), ("d.ply", vtk.vtkPLYReader(), ["--ascii"]),
                                  ("e.ply", vtk.vtkPLYReader(), []), ("f.off", vtk.vtkOFFReader(), [])]:
        motet("convert", source, tmp_path / name, *options)
        reader.SetFileName(str(tmp_path / name))
        reader.Update()
        output = reader.GetOutput()
        points = vtk_to_numpy(output.GetPoints().GetData())
        found = points[vtk_to_numpy(output.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
        assert_same_array(found.astype(np.float32), triangles.astype(np.float32), name)


# ---- real meshes


def real_files():
    folder = data_folder()
    if folder is None:
        return []
    endings = (".msh", ".stl", ".obj", ".ply", ".off", ".mesh", ".node", ".ele", ".xml.gz")
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.name.lower().endswith(endings))


REFUSED = {"trimesh_empty.stl", "trimesh_stl_empty_bin.stl", "nvidia_aneurysm_closed_lfs_pointer.stl"}


@pytest.mark.parametrize("name", real_files())
def test_real_files_are_converted_without_changes(motet, data, tmp_path, name):
    source = data / name
    if source.name in REFUSED:
        done = motet("convert", source, tmp_path / "out.vtu", code=3)
        assert str(source) in done.stderr
        return
    expected = meshio.read(for_meshio(source, tmp_path))
    kinds = set(cells_of(expected))
    endings = [".msh", ".vtu", ".mesh", ".node"] if "tetra" in kinds else [".msh", ".vtu", ".mesh", ".obj", ".stl", ".vtp"]
    for ending in endings:
        out = tmp_path / f"out{ending}"
        motet("convert", source, out, *(["--ascii"] if ending == ".stl" else []))
        found = meshio.read(out) if ending != ".vtp" else None
        if found is not None:
            compare(found, expected, source, ending)


def for_meshio(source, folder):
    """Return the file, or a copy that meshio can read completely.

    meshio does not decompress files, reads Medit's version 1 in single precision, and requires as many
    normals as vertices.
    """
    text = source.read_bytes() if source.suffix in (".gz", ".mesh", ".obj") else None
    if source.suffix == ".gz":
        text = gzip.decompress(text)
    elif source.suffix == ".mesh":
        text = text.replace(b"MeshVersionFormatted 1", b"MeshVersionFormatted 2", 1)
    elif source.suffix == ".obj":
        text = b"\n".join(line for line in text.splitlines() if not line.startswith(b"vn "))
    else:
        return source
    copy = folder / source.with_suffix("").name if source.suffix == ".gz" else folder / source.name
    copy.write_bytes(text)
    return copy


def compare(found, expected, source, ending):
    """Assert equal points, cells and labels.

    STL files have no shared vertices, and DOLFIN files no orientation of cells.
    """
    if source.suffix.lower() == ".stl" or ending == ".stl":
        # meshio does not merge the points of text files.
        assert_same_array(corners(found), corners(expected).astype(float), "corners of triangles")
        return
    assert_same_array(np.asarray(found.points), np.asarray(expected.points, float), "points")
    if source.name.endswith(".xml.gz"):
        assert np.array_equal(tet_set(cells_of(found)["tetra"]), tet_set(cells_of(expected)["tetra"]))
        assert (volumes(found.points, cells_of(found)["tetra"]) > 0).all()
        return
    for kind, cells in cells_of(expected).items():
        if ending != ".node" or kind == "tetra":
            assert_same_array(cells_of(found)[kind], cells, kind)
    ours = {".mesh": "medit:ref", ".node": "tetgen:ref", ".msh": "gmsh:physical"}.get(ending)
    for name in ("gmsh:physical", "medit:ref"):
        if name in expected.cell_data:
            target = name if ending == ".vtu" else ours
            for block, values in zip(expected.cells, expected.cell_data[name]):
                if target in found.cell_data and (ending != ".node" or block.type == "tetra"):
                    got = np.concatenate([v for b, v in zip(found.cells, found.cell_data[target]) if b.type == block.type])
                    assert_same_array(got, values, f"labels of {block.type}")


def vtk_files():
    folder = data_folder()
    names = [] if folder is None else [p.relative_to(folder) for p in folder.rglob("*") if p.suffix in (".vtu", ".vtp", ".vtk")]
    # Only one frame of each cycle.
    return sorted(str(p) for p in names if "ENDOCARDIAL" not in p.name or "_000" in p.name)


MSH_HOLDS = {1: "vertex", 3: "line", 5: "triangle", 9: "quad", 10: "tetra", 12: "hexahedron", 13: "wedge", 14: "pyramid"}


@pytest.mark.parametrize("name", vtk_files())
def test_real_vtk_files_are_converted_to_other_formats_without_changes(motet, data, tmp_path, name):
    """meshio reads from MSH, Medit and TetGen files the points, cells and numbers that VTK reads from the
    source."""
    source = data / name
    expected = pyvista.read(source).cast_to_unstructured_grid()
    points = np.asarray(expected.points, float)
    types = expected.celltypes
    for ending in (".msh", ".mesh", ".node"):
        out = tmp_path / f"out{ending}"
        motet("convert", source, out)
        found = meshio.read(out)
        assert_same_array(np.asarray(found.points, float), points, "points")
        cells = cells_of(found)
        held = [t for t in set(types) if t in MSH_HOLDS and t != 1] if ending != ".node" else [10]
        for kind in held:
            at = expected.offset[:-1][types == kind]
            if len(at):
                # Some lines have a third point, for the orientation of a beam.
                n = meshio._mesh.num_nodes_per_cell[MSH_HOLDS[kind]]
                ids = expected.cell_connectivity[at[:, None] + np.arange(n)]
                assert_same_array(cells[MSH_HOLDS[kind]], ids, f"{MSH_HOLDS[kind]} cells")
        if ending != ".msh":
            continue
        for array in expected.point_data.keys():
            if expected.point_data[array].dtype.kind in "iuf":
                assert_same_array(found.point_data[array], np.asarray(expected.point_data[array], float), array)
        for array in expected.cell_data.keys():
            values = expected.cell_data[array]
            for kind in held:
                if values.dtype.kind in "iuf" and array in found.cell_data:
                    got = np.concatenate([v for b, v in zip(found.cells, found.cell_data[array]) if b.type == MSH_HOLDS[kind]])
                    assert_same_array(got, np.asarray(values[types == kind], float), array)


def test_dolfin_markers_are_the_triangles_opposite_a_vertex(motet, data, tmp_path):
    """By the definition: facet i of a cell has its sorted vertices except the i-th."""
    source = data / "copyleft" / "dolfin_aneurysm.xml.gz"
    import xml.etree.ElementTree as tree
    root = tree.fromstring(gzip.decompress(source.read_bytes()))
    cells = np.array([[int(c.get(f"v{k}")) for k in range(4)] for c in root.iter("tetrahedron")])
    collection = next(c for c in root.iter("mesh_value_collection") if c.get("dim") == "2")
    expected = {}
    for value in collection:
        cell = np.sort(cells[int(value.get("cell_index"))])
        facet = np.delete(cell, int(value.get("local_entity")))
        expected[tuple(map(int, facet))] = int(value.get("value"))
    out = tmp_path / "out.vtu"
    motet("convert", source, out)
    mesh = meshio.read(out)
    triangles = cells_of(mesh)["triangle"]
    labels = np.concatenate([v for b, v in zip(mesh.cells, mesh.cell_data["patch"]) if b.type == "triangle"])
    found = {tuple(map(int, np.sort(t))): int(label) - 1 for t, label in zip(triangles, labels)}
    assert found == expected
    # Each triangle faces outward, away from its tet.
    center = {}
    for tet in cells:
        for facet in itertools.combinations(sorted(map(int, tet)), 3):
            if facet in found:
                center.setdefault(facet, mesh.points[tet].mean(axis=0))
    for triangle in triangles:
        a, b, c = mesh.points[triangle]
        behind = center[tuple(sorted(map(int, triangle)))]
        assert np.dot(np.cross(b - a, c - a), behind - a) < 0


def test_patches_of_a_simvascular_folder_are_its_faces(motet, data, tmp_path):
    """The triangles of each patch, by coordinates, are those that VTK reads from the file of the face."""
    pipe = data / "tetmeshes" / "sv_ale_pipe"
    folder = tmp_path / "mesh-complete"
    (folder / "mesh-surfaces").mkdir(parents=True)
    os.symlink(pipe / "lumen.vtu", folder / "mesh-complete.mesh.vtu")
    for face in ("inlet", "outlet", "wall"):
        os.symlink(pipe / f"lumen_{face}.vtp", folder / "mesh-surfaces" / f"{face}.vtp")
    out = tmp_path / "out.msh"
    motet("convert", folder, out)
    mesh = meshio.read(out)
    volume = meshio.read(pipe / "lumen.vtu")
    assert_same_array(cells_of(mesh)["tetra"], cells_of(volume)["tetra"], "tets")
    triangles = cells_of(mesh)["triangle"]
    labels = np.concatenate([v for b, v in zip(mesh.cells, mesh.cell_data["gmsh:physical"]) if b.type == "triangle"])
    for face in ("inlet", "outlet", "wall"):
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(pipe / f"lumen_{face}.vtp"))
        reader.Update()
        output = reader.GetOutput()
        points = vtk_to_numpy(output.GetPoints().GetData()).astype(float)
        expected = points[vtk_to_numpy(output.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
        label, dim = mesh.field_data[face]
        assert dim == 2
        assert_same_array(np.asarray(mesh.points, float)[triangles[labels == label]], expected, face)


def test_face_files_beside_a_volume_are_read_as_patches(motet, data, tmp_path):
    out = tmp_path / "out.msh"
    motet("convert", data / "tetmeshes" / "sv_boundary_layer_pipe", out)
    mesh = meshio.read(out)
    assert {"inlet", "outlet", "wall"} <= set(mesh.field_data)
    done = motet("convert", data / "tetmeshes" / "sv_ale_pipe", Path(out), code=3)
    assert "contains 2 volumes: lumen, wall" in done.stderr


def test_a_written_simvascular_folder_has_the_ids_of_simvascular(motet, data, tmp_path):
    """The element that motet finds behind each facet is the one that SimVascular wrote."""
    pipe = data / "tetmeshes" / "sv_boundary_layer_pipe"
    motet("convert", pipe, tmp_path / "one.vtu")
    folder = tmp_path / "mesh-complete"
    motet("convert", tmp_path / "one.vtu", str(folder) + "/")
    volume, ours = pyvista.read(pipe / "lumen.vtu"), pyvista.read(folder / "mesh-complete.mesh.vtu")
    assert_same_array(ours.points, volume.points.astype(float), "points")
    for name in ("GlobalNodeID",):
        assert_same_array(ours.point_data[name], volume.point_data[name], name)
    for name in ("GlobalElementID", "ModelRegionID"):
        assert_same_array(ours.cell_data[name], volume.cell_data[name], name)

    def elements(face):
        """Return {the three GlobalNodeIDs of a triangle: its GlobalElementID}."""
        triangles = np.sort(face.point_data["GlobalNodeID"][face.regular_faces], axis=1)
        return dict(zip(map(tuple, triangles.tolist()), face.cell_data["GlobalElementID"].tolist()))

    exterior = elements(pyvista.read(folder / "mesh-complete.exterior.vtp"))
    for face in ("inlet", "outlet", "wall"):
        theirs = elements(pyvista.read(pipe / f"lumen_{face}.vtp"))
        assert elements(pyvista.read(folder / "mesh-surfaces" / f"{face}.vtp")) == theirs
        assert all(exterior[triangle] == element for triangle, element in theirs.items())
    assert elements(pyvista.read(folder / "walls_combined.vtp")) == theirs
    done = motet("convert", tmp_path / "one.vtu", str(folder) + "/", code=2)
    assert "not empty" in done.stderr
