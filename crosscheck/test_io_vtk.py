"""VTU, VTP and legacy VTK files, exchanged between motet and VTK, PyVista and meshio.

What VTK (or meshio) reads from the files is compared bit by bit.
"""
import itertools

import meshio
import numpy as np
import pytest
import pyvista as pv
import vtk
from conftest import data_folder
from meshes import assert_same_array, assert_same_mesh
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

REAL = sorted(p for p in (data_folder() or ()) and data_folder().rglob("*") if p.suffix in (".vtu", ".vtp", ".vtk"))
# All encodings and compressions in which motet writes the XML formats.
XML_WAYS = [("ascii", "none"), *itertools.product(("base64", "binary"), ("none", "zlib", "lz4", "lzma"))]
VALUE_TYPES = ("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32", "float64")


def vtk_read(path):
    """Read a file with VTK; PyVista would skip string arrays and rename others."""
    readers = {".vtu": vtk.vtkXMLUnstructuredGridReader, ".vtp": vtk.vtkXMLPolyDataReader, ".vtk": vtk.vtkDataSetReader}
    reader = readers[path.suffix]()
    reader.SetFileName(str(path))
    if path.suffix == ".vtk":
        for kind in ("Scalars", "Vectors", "Normals", "Tensors", "TCoords", "Fields", "ColorScalars"):
            getattr(reader, f"ReadAll{kind}On")()
    reader.Update()
    assert reader.GetErrorCode() == 0
    return pv.wrap(reader.GetOutput())


def arrays_of(data):
    """Return all arrays of a vtkFieldData as {name: values}, with strings as lists and bits as bytes."""
    arrays = {}
    for i in range(data.GetNumberOfArrays()):
        array = data.GetAbstractArray(i)
        name = array.GetName()
        if isinstance(array, vtk.vtkStringArray):
            arrays[name] = [array.GetValue(k) for k in range(array.GetNumberOfValues())]
        elif isinstance(array, vtk.vtkBitArray):
            arrays[name] = np.array([array.GetValue(k) for k in range(array.GetNumberOfValues())], np.uint8)
        else:
            arrays[name] = vtk_to_numpy(array)
    return arrays


def faces_of(grid):
    """Return the faces of each polyhedron as lists."""
    faces = {}
    for cell in np.flatnonzero(grid.celltypes == vtk.VTK_POLYHEDRON):
        polyhedron = grid.GetCell(int(cell))
        faces[int(cell)] = [[polyhedron.GetFace(k).GetPointId(i) for i in range(polyhedron.GetFace(k).GetNumberOfPoints())]
                            for k in range(polyhedron.GetNumberOfFaces())]
    return faces


def without_surplus(grid):
    """Return offsets and connectivity without surplus points of lines and quads."""
    starts, ends = grid.cell_offsets[:-1], grid.cell_offsets[1:]
    most = np.full(256, np.iinfo(np.int64).max)
    most[[vtk.VTK_LINE, vtk.VTK_QUAD]] = 2, 4
    sizes = np.minimum(ends - starts, most[grid.celltypes])
    kept = np.repeat(starts, sizes) + np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    return np.concatenate([[0], np.cumsum(sizes)]), grid.cell_connectivity[kept]


def assert_same_data_set(ours, theirs):
    """Assert equal points, cells and arrays of two VTK data sets."""
    assert_same_array(ours.points.astype(np.float64), theirs.points.astype(np.float64), "points")
    for which in ("GetPointData", "GetCellData", "GetFieldData"):
        a, b = arrays_of(getattr(ours, which)()), arrays_of(getattr(theirs, which)())
        if which == "GetCellData":  # labels are written under motet's names too
            for label, source in (("patch", "ModelFaceID"), ("region", "ModelRegionID")):
                if label in a and label not in b:
                    assert_same_array(a.pop(label), b[source], label)
        assert sorted(a) == sorted(b), which
        for name, values in b.items():
            if isinstance(values, list):
                assert a[name] == values, name
            else:
                assert a[name].dtype.name == values.dtype.name, name
                assert_same_array(a[name], values, name)
    ours, theirs = (d if isinstance(d, pv.UnstructuredGrid) else d.cast_to_unstructured_grid() for d in (ours, theirs))
    assert_same_array(ours.celltypes, theirs.celltypes, "kinds of cells")
    offsets, connectivity = without_surplus(theirs)
    assert_same_array(ours.cell_offsets, offsets, "offsets")
    assert_same_array(ours.cell_connectivity, connectivity, "connectivity")
    assert faces_of(ours) == faces_of(theirs)


def assert_converts(motet, source, target, *options):
    """Convert `source` to `target` with motet, and assert that VTK reads the same data from both."""
    motet("convert", source, target, *options)
    assert_same_data_set(vtk_read(target), vtk_read(source))


# Data created by the tests.

def points_and_arrays(data_set, rng, texts=True, extreme=True):
    """Add arrays of every type to `data_set`, with extreme values if `extreme`."""
    for holder, n in ((data_set.GetPointData(), data_set.GetNumberOfPoints()),
                      (data_set.GetCellData(), data_set.GetNumberOfCells())):
        for components, kind in itertools.product((1, 3), VALUE_TYPES):
            if np.dtype(kind).kind == "f":
                values = rng.normal(size=(n, components)).astype(kind) * 10.0 ** rng.integers(-30, 30)
                values = values.astype(kind)
                tiny = np.finfo(kind)
                if extreme:
                    values.flat[:4] = (-0.0, tiny.max, tiny.tiny, tiny.smallest_subnormal)
            else:
                info = np.iinfo(kind)
                values = rng.integers(info.min, info.max, size=(n, components), dtype=kind, endpoint=True)
                values.flat[:2] = (info.min, info.max)
            array = numpy_to_vtk(values if components > 1 else values.ravel(), deep=True)
            array.SetName(f"{kind} x {components}: 'é'")
            holder.AddArray(array)
        if texts:
            strings = vtk.vtkStringArray()
            strings.SetName("texts")
            for i in range(n):
                strings.InsertNextValue("" if i % 3 == 0 else f"text {i} <&> é" + "y" * i * 9)
            holder.AddArray(strings)
    time = vtk.vtkDoubleArray()
    time.SetName("TimeValue")
    time.InsertNextValue(0.1)
    data_set.GetFieldData().AddArray(time)
    return data_set


def mixed_grid(polyhedra=True, **options):
    """Return cells of every fixed kind on random points, polygons, and two polyhedra."""
    rng = np.random.default_rng(5)
    grid = vtk.vtkUnstructuredGrid()
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    for point in rng.normal(size=(40, 3)):
        points.InsertNextPoint(point)
    grid.SetPoints(points)
    fixed = {3: 2, 5: 3, 8: 4, 9: 4, 10: 4, 11: 8, 12: 8, 13: 6, 14: 5, 15: 10, 16: 12, 21: 3, 22: 6, 23: 8, 24: 10,
             25: 20, 26: 15, 27: 13, 28: 9, 29: 27, 32: 18, 33: 24, 34: 7, 1: 1}
    free = {4: 5, 7: 6, 2: 3, 6: 5}
    for kind, n in [*fixed.items(), (10, 4), *(free.items() if polyhedra else ()), (10, 4)]:
        grid.InsertNextCell(kind, n, [int(i) for i in rng.permutation(40)[:n]])
    if polyhedra:
        for start in (0, 20):
            faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
            stream = vtk.vtkIdList()
            stream.InsertNextId(len(faces))
            for face in faces:
                stream.InsertNextId(len(face))
                for i in face:
                    stream.InsertNextId(i + start)
            grid.InsertNextCell(vtk.VTK_POLYHEDRON, stream)
            grid.InsertNextCell(vtk.VTK_TETRA, 4, [0, 1, 2, 3])
    return points_and_arrays(grid, rng, **options)


def polygons(**options):
    """Return polygonal data with vertices, lines, polygons and strips."""
    rng = np.random.default_rng(6)
    data = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    for point in rng.normal(size=(12, 3)):
        points.InsertNextPoint(point)
    data.SetPoints(points)

    def cells(lists):
        array = vtk.vtkCellArray()
        for ids in lists:
            array.InsertNextCell(len(ids), ids)
        return array

    data.SetVerts(cells([[0], [1, 2]]))
    data.SetLines(cells([[0, 1], [1, 2, 3]]))
    data.SetPolys(cells([[0, 1, 2], [3, 4, 5, 6], [1, 2, 3, 4, 5]]))
    data.SetStrips(cells([[0, 1, 2, 3, 4]]))
    return points_and_arrays(data, rng, **options)


def vtk_write_xml(data, path, mode, compressor, header=64, big=False, base64=False):
    writer = vtk.vtkXMLUnstructuredGridWriter() if path.suffix == ".vtu" else vtk.vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.SetFileName(str(path))
    getattr(writer, f"SetDataModeTo{mode}")()
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    writer.SetEncodeAppendedData(base64)
    writer.SetHeaderType(header)
    writer.SetByteOrder(0 if big else 1)
    # Small, so that arrays have several blocks, of which the last is not full.
    writer.SetBlockSize(64)
    assert writer.Write() == 1


MADE = {"grid.vtu": mixed_grid, "polygons.vtp": polygons}


# The tests.

@pytest.mark.parametrize("path", REAL, ids=lambda p: p.name)
def test_real_files_are_preserved_in_every_encoding(motet, tmp_path, path):
    ending = ".vtp" if path.suffix == ".vtp" else ".vtu"
    for encoding, compression in XML_WAYS:
        if compression == "lzma" and path.stat().st_size > 500_000:
            continue
        assert_converts(motet, path, tmp_path / f"out{ending}", "--encoding", encoding, "--compression", compression)
    for encoding, version in itertools.product(("ascii", "binary"), ("4.2", "5.1")):
        assert_converts(motet, path, tmp_path / "out.vtk", "--encoding", encoding, "--version", version)


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("mode, base64", [("Ascii", False), ("Binary", False), ("Appended", False), ("Appended", True)])
@pytest.mark.parametrize("compressor", ["None", "ZLib", "LZ4", "LZMA"])
@pytest.mark.parametrize("header", [32, 64])
@pytest.mark.parametrize("big", [False, True], ids=["little", "big"])
def test_motet_reads_xml_files_of_vtk(motet, tmp_path, name, mode, base64, compressor, header, big):
    source = tmp_path / name
    vtk_write_xml(MADE[name](), source, mode, compressor, header, big, base64)
    assert_converts(motet, source, tmp_path / f"out{source.suffix}")


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("encoding, compression", XML_WAYS)
def test_vtk_reads_xml_files_of_motet(motet, tmp_path, name, encoding, compression):
    source = tmp_path / name
    vtk_write_xml(MADE[name](), source, "Appended", "ZLib")
    assert_converts(motet, source, tmp_path / f"out{source.suffix}", "--encoding", encoding, "--compression", compression)


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("version", [42, 51])
@pytest.mark.parametrize("binary", [False, True], ids=["ascii", "binary"])
def test_motet_reads_legacy_files_of_vtk(motet, tmp_path, name, version, binary):
    data = MADE[name](extreme=binary)  # VTK cannot read the smallest numbers that it writes as text
    writer = vtk.vtkUnstructuredGridWriter() if name.endswith("vtu") else vtk.vtkPolyDataWriter()
    source = tmp_path / "source.vtk"
    writer.SetInputData(data)
    writer.SetFileName(str(source))
    writer.SetFileVersion(version)
    (writer.SetFileTypeToBinary if binary else writer.SetFileTypeToASCII)()
    assert writer.Write() == 1
    assert_converts(motet, source, tmp_path / "out.vtu")


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("version", ["4.2", "5.1"])
@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_vtk_reads_legacy_files_of_motet(motet, tmp_path, name, version, encoding):
    source = tmp_path / name
    vtk_write_xml(MADE[name](), source, "Appended", "ZLib")
    assert_converts(motet, source, tmp_path / "out.vtk", "--encoding", encoding, "--version", version)


def test_attributes_of_legacy_files_are_read(motet, tmp_path):
    data = polygons(extreme=False)
    n = data.GetNumberOfPoints()
    for kind, components in (("Scalars", 2), ("Vectors", 3), ("Normals", 3), ("TCoords", 2), ("Tensors", 9)):
        array = numpy_to_vtk(np.arange(float(components * n)).reshape(n, components), deep=True)
        array.SetName(f"the {kind}")
        getattr(data.GetPointData(), f"Set{kind}")(array)
    ids = numpy_to_vtkIdTypeArray(np.arange(n), deep=True)
    ids.SetName("the ids")
    data.GetPointData().SetGlobalIds(ids)
    colours = numpy_to_vtk(np.arange(24, dtype=np.uint8).reshape(8, 3), deep=True)
    colours.SetName("colours")
    data.GetCellData().SetScalars(colours)
    for binary in (False, True):
        writer = vtk.vtkPolyDataWriter()
        writer.SetInputData(data)
        writer.SetFileName(str(tmp_path / "source.vtk"))
        (writer.SetFileTypeToBinary if binary else writer.SetFileTypeToASCII)()
        assert writer.Write() == 1
        assert_converts(motet, tmp_path / "source.vtk", tmp_path / "out.vtp")


def test_pieces_become_one_mesh(motet, tmp_path):
    parts = []
    for i in (1, 2):
        grid = mixed_grid(polyhedra=False)  # VTK does not shift the ids of faces by the points of earlier pieces
        vtk_to_numpy(grid.GetPoints().GetData())[:] += 100 * i  # coincident points would be merged
        vtk_write_xml(grid, tmp_path / f"part{i}.vtu", "Ascii", "None")
        parts.append((tmp_path / f"part{i}.vtu").read_text())
    start, end = parts[1].index("<Piece"), parts[1].index("</Piece>") + len("</Piece>")
    end_of_first = parts[0].index("</Piece>") + len("</Piece>")
    both = tmp_path / "both.vtu"
    both.write_text(parts[0][:end_of_first] + parts[1][start:end] + parts[0][end_of_first:])
    assert vtk_read(both).n_cells == 2 * mixed_grid(polyhedra=False).GetNumberOfCells()
    assert_converts(motet, both, tmp_path / "out.vtu")


@pytest.mark.parametrize("encoding", ["ascii", "base64", "binary"])
def test_non_finite_numbers_are_preserved(motet, tmp_path, encoding):
    grid = mixed_grid()
    values = np.ones(grid.GetNumberOfPoints())
    values[:3] = np.nan, np.inf, -np.inf
    array = numpy_to_vtk(values, deep=True)
    array.SetName("odd")
    grid.GetPointData().AddArray(array)
    vtk_write_xml(grid, tmp_path / "source.vtu", "Appended", "None")
    # Read by motet, because VTK reads -inf as inf from text, even from its own files.
    motet("convert", tmp_path / "source.vtu", tmp_path / "text.vtu", "--encoding", encoding)
    motet("convert", tmp_path / "text.vtu", tmp_path / "out.vtu")
    odd = arrays_of(vtk_read(tmp_path / "out.vtu").GetPointData())["odd"]
    assert np.isnan(odd[0]) and odd[1] == np.inf and odd[2] == -np.inf


# meshio

MESHIO_LEGACY_TYPES = ("int64", "uint64", "float32", "float64")


def meshio_mesh():
    rng = np.random.default_rng(7)
    ids = lambda n, k: np.array([rng.permutation(30)[:k] for _ in range(n)])
    kinds = {"tetra": 4, "wedge": 6, "pyramid": 5, "hexahedron": 8, "triangle": 3, "quad": 4, "line": 2, "tetra10": 10,
             "hexahedron20": 20, "triangle6": 6}
    cells = [(kind, ids(3, k)) for kind, k in kinds.items()]
    return meshio.Mesh(
        rng.normal(size=(30, 3)), cells,
        point_data={kind: rng.integers(0, 100, (30, 3) if i % 2 else 30).astype(kind) for i, kind in enumerate(VALUE_TYPES)},
        cell_data={kind: [rng.integers(0, 100, 3).astype(kind) for _ in cells] for kind in VALUE_TYPES})


@pytest.mark.parametrize("options", [dict(binary=False), dict(binary=True, compression=None),
                                     dict(binary=True, compression="zlib"), dict(binary=True, compression="lzma"),
                                     dict(binary=True, compression="zlib", header_type="UInt64")], ids=str)
def test_motet_reads_vtu_files_of_meshio(motet, tmp_path, options):
    meshio.vtu.write(tmp_path / "source.vtu", meshio_mesh(), **options)
    motet("convert", tmp_path / "source.vtu", tmp_path / "out.vtu")
    assert_same_mesh(meshio.read(tmp_path / "out.vtu"), meshio.read(tmp_path / "source.vtu"))


def test_names_may_contain_any_characters(motet, tmp_path):
    grid = pv.UnstructuredGrid({vtk.VTK_TETRA: np.array([[0, 1, 2, 3]])}, np.eye(4, 3))
    name = "a <b> & \"c\" 'd' % é"
    grid.point_data[name] = np.arange(4.0)
    writer = vtk.vtkUnstructuredGridWriter()  # VTK's XML writer does not escape names
    writer.SetInputData(grid)
    writer.SetFileName(str(tmp_path / "source.vtk"))
    assert writer.Write() == 1
    for out in (tmp_path / "out.vtu", tmp_path / "out.vtk"):
        motet("convert", tmp_path / "source.vtk", out)
        assert list(arrays_of(vtk_read(out).GetPointData())) == [name]


@pytest.mark.parametrize("version", ["4.2", "5.1"])
@pytest.mark.parametrize("binary", [False, True], ids=["ascii", "binary"])
def test_motet_reads_legacy_files_of_meshio(motet, tmp_path, version, binary):
    meshio.vtk.write(tmp_path / "source.vtk", meshio_mesh(), fmt_version=version, binary=binary)
    motet("convert", tmp_path / "source.vtk", tmp_path / "out.vtu")
    theirs = meshio.read(tmp_path / "source.vtk")
    theirs.points = theirs.points.astype(np.float64)  # big-endian, as in the file
    theirs.point_data = {name: values.astype(name) for name, values in theirs.point_data.items()}
    theirs.cell_data = {name: [v.astype(name) for v in blocks] for name, blocks in theirs.cell_data.items()}
    assert_same_mesh(meshio.read(tmp_path / "out.vtu"), theirs)


@pytest.mark.parametrize("encoding, compression", [w for w in XML_WAYS if w[1] != "lz4"])  # meshio does not support LZ4
def test_meshio_reads_vtu_files_of_motet(motet, tmp_path, encoding, compression):
    meshio.vtu.write(tmp_path / "source.vtu", meshio_mesh())
    motet("convert", tmp_path / "source.vtu", tmp_path / "out.vtu", "--encoding", encoding, "--compression", compression)
    assert_same_mesh(meshio.read(tmp_path / "out.vtu"), meshio.read(tmp_path / "source.vtu"))


@pytest.mark.parametrize("version", ["4.2", "5.1"])
@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_meshio_reads_legacy_files_of_motet(motet, tmp_path, version, encoding):
    mesh = meshio_mesh()
    if version == "5.1":  # meshio reads int as 64 bits, and does not know VTK's names of the other types
        mesh.point_data = {k: v for k, v in mesh.point_data.items() if k in MESHIO_LEGACY_TYPES}
        mesh.cell_data = {k: v for k, v in mesh.cell_data.items() if k in MESHIO_LEGACY_TYPES}
    meshio.vtu.write(tmp_path / "source.vtu", mesh)
    motet("convert", tmp_path / "source.vtu", tmp_path / "out.vtk", "--encoding", encoding, "--version", version)
    ours = meshio.read(tmp_path / "out.vtk")
    ours.points = ours.points.astype(np.float64)  # big-endian, as in the file
    ours.point_data = {name: values.astype(name) for name, values in ours.point_data.items()}
    ours.cell_data = {name: [v.astype(name) for v in blocks] for name, blocks in ours.cell_data.items()}
    assert_same_mesh(ours, meshio.read(tmp_path / "source.vtu"))


@pytest.mark.parametrize("suffix", [".vtm", ".vtmb"])
def test_nested_blocks_of_pyvista_are_regions_and_patches(motet, tmp_path, suffix):
    grid = pv.ImageData(dimensions=(3, 3, 3)).to_tetrahedra(5)
    plane = {z: pv.Plane(center=(0.0, 0.0, z), i_resolution=2 + z, j_resolution=1).triangulate() for z in range(3)}
    blocks = pv.MultiBlock({
        "blood": grid.extract_cells(range(20)), "clot": grid.extract_cells(range(20, 40)),
        "walls": pv.MultiBlock({"inlet": plane[0], "outlet": plane[1], "none": None}),
        "others": pv.MultiBlock({"deep": pv.MultiBlock({"outlet": plane[2]})}),
    })
    path = tmp_path / f"blocks{suffix}"
    blocks.save(path)
    found = motet.json("info", path)
    assert {name: region["cells"] for name, region in found["regions"].items()} == {"blood": 20, "clot": 20}
    assert {name: patch["cells"] for name, patch in found["patches"].items()} == {
        "inlet": 4, "walls/outlet": 6, "others/deep/outlet": 8}
