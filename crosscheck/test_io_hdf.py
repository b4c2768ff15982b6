"""VTKHDF files compared with VTK's reader and writer."""
import numpy as np
import pytest
import pyvista
import vtk
from vtk.util.numpy_support import vtk_to_numpy
from vtk.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkIOHDF import vtkHDFReader, vtkHDFWriter


def write_hdf(data, path, compression=0):
    writer = vtkHDFWriter()
    if isinstance(data, vtk.vtkAlgorithm):
        writer.SetInputConnection(data.GetOutputPort())
        writer.SetWriteAllTimeSteps(True)
    else:
        writer.SetInputData(data)
    writer.SetFileName(str(path))
    writer.SetCompressionLevel(compression)
    assert writer.Write() == 1
    return path


def read_hdf(path, step=None):
    """Read a file with VTK, or one step of it."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    if step is not None:
        reader.UpdateInformation()
        reader.SetStep(step)
    reader.Update()
    return pyvista.wrap(reader.GetOutput())


def read_xml(path):
    return pyvista.read(path)


def cells_of(data):
    """Return the kinds, offsets and points of the cells, and the faces of polyhedra."""
    if isinstance(data, pyvista.PolyData):
        parts = [(data.GetVerts(), 1), (data.GetLines(), 3), (data.GetPolys(), 7), (data.GetStrips(), 6)]
        lists = [(kind, vtk_to_numpy(p.GetOffsetsArray()), vtk_to_numpy(p.GetConnectivityArray())) for p, kind in parts]
        return [(kind, offsets.tolist(), ids.tolist()) for kind, offsets, ids in lists if len(offsets) > 1]
    faces = data.GetPolyhedronFaces()
    of_cells = data.GetPolyhedronFaceLocations()
    polyhedra = [] if faces is None or faces.GetNumberOfCells() == 0 else [
        [vtk_to_numpy(part.GetOffsetsArray()).tolist(), vtk_to_numpy(part.GetConnectivityArray()).tolist()]
        for part in (faces, of_cells)]
    return [data.celltypes.tolist(), data.cell_offsets.tolist(), data.cell_connectivity.tolist(), polyhedra]


def arrays_of(attributes):
    raw = [attributes.GetAbstractArray(i) for i in range(attributes.GetNumberOfArrays())]
    return {array.GetName(): [array.GetValue(i) for i in range(array.GetNumberOfValues())]
            if isinstance(array, vtk.vtkStringArray) else vtk_to_numpy(array) for array in raw}


def assert_same_data(ours, theirs, but=()):
    a, b = np.asarray(ours.points, float), np.asarray(theirs.points, float)
    assert a.shape == b.shape and np.array_equal(a, b)
    assert type(ours) is type(theirs)
    assert cells_of(ours) == cells_of(theirs)
    for name in ("GetPointData", "GetCellData", "GetFieldData"):
        x, y = arrays_of(getattr(ours, name)()), arrays_of(getattr(theirs, name)())
        x = {k: v for k, v in x.items() if k not in but}
        y = {k: v for k, v in y.items() if k not in but}
        assert sorted(x) == sorted(y), name
        for key in y:
            if isinstance(y[key], list):
                assert x[key] == y[key]
            else:
                assert x[key].dtype.kind == y[key].dtype.kind and x[key].dtype.itemsize == y[key].dtype.itemsize, key
                assert np.array_equal(x[key].reshape(len(y[key]), -1), y[key].reshape(len(y[key]), -1)), key


def tets(n=4):
    grid = pyvista.ImageData(dimensions=(n, n, n)).to_tetrahedra()
    grid.cell_data.clear()
    rng = np.random.default_rng(7)
    grid.points = grid.points.astype(float) + rng.uniform(-0.1, 0.1, (grid.n_points, 3))
    grid.point_data["velocity"] = rng.normal(size=(grid.n_points, 3))
    grid.point_data["pressure"] = rng.normal(size=grid.n_points).astype(np.float32)
    grid.point_data["gradient"] = rng.normal(size=(grid.n_points, 9))
    grid.cell_data["label"] = rng.integers(0, 9, grid.n_cells).astype(np.int32)
    grid.cell_data["byte"] = rng.integers(0, 9, grid.n_cells).astype(np.uint8)
    grid.cell_data["long"] = rng.integers(-2**60, 2**60, grid.n_cells)
    grid.field_data["time"] = np.array([0.25])
    grid.field_data["matrix"] = np.arange(6.0).reshape(2, 3)
    return grid


def mixed():
    cells = pyvista.examples.cells
    parts = [cells.Hexahedron(), cells.Wedge(), cells.Pyramid(), cells.QuadraticTetrahedron(), cells.Triangle(),
             cells.QuadraticHexahedron(), cells.Polygon(), cells.Line(), cells.Vertex()]
    append = vtk.vtkAppendFilter()
    for i, part in enumerate(parts):
        part.clear_data()
        append.AddInputData(part.translate((3.0 * i, 0, 0)))
    append.Update()
    return pyvista.wrap(append.GetOutput())


def polyhedra():
    append = vtk.vtkAppendFilter()
    for i, part in enumerate([pyvista.examples.cells.Polyhedron(), tets(2), pyvista.examples.cells.Polyhedron()]):
        part.clear_data()
        append.AddInputData(part.translate((3.0 * i, 0, 0)))
    append.Update()
    return pyvista.wrap(append.GetOutput())


def surface():
    data = pyvista.Sphere(theta_resolution=8, phi_resolution=7)
    data.cell_data["patch"] = np.arange(data.n_cells, dtype=np.int32) % 3
    return data


def sections():
    data = pyvista.PolyData()
    data.points = np.random.default_rng(3).normal(size=(9, 3))
    data.verts = [1, 0, 1, 3]
    data.lines = [2, 0, 1, 3, 2, 3, 4]
    data.faces = [3, 0, 1, 2, 4, 3, 4, 5, 6, 5, 4, 5, 6, 7, 8]
    data.strips = np.array([4, 1, 2, 3, 4])
    data.cell_data["c"] = np.arange(data.n_cells) * 1.5
    return data


DATA = {"tets": tets, "mixed": mixed, "polyhedra": polyhedra, "surface": surface, "sections": sections}


@pytest.mark.parametrize("compression", [0, 5])
@pytest.mark.parametrize("name", DATA)
def test_motet_reads_files_of_vtk(motet, tmp_path, name, compression):
    data = DATA[name]()
    write_hdf(data, tmp_path / "in.vtkhdf", compression)
    out = tmp_path / ("out.vtp" if isinstance(data, pyvista.PolyData) else "out.vtu")
    motet("convert", tmp_path / "in.vtkhdf", out)
    assert_same_data(read_xml(out), data, but=("region", "patch"))


@pytest.mark.parametrize("compression", ["none", "zlib"])
@pytest.mark.parametrize("name", DATA)
def test_vtk_reads_files_of_motet(motet, tmp_path, name, compression):
    data = DATA[name]()
    source = tmp_path / ("in.vtp" if isinstance(data, pyvista.PolyData) else "in.vtu")
    data.save(source)
    motet("convert", source, tmp_path / "out.vtkhdf", "--compression", compression)
    assert_same_data(read_hdf(tmp_path / "out.vtkhdf"), data, but=("region", "patch"))


def partitioned(parts):
    data = vtk.vtkPartitionedDataSet()
    for i, part in enumerate(parts):
        data.SetPartition(i, part)
    return data


@pytest.mark.parametrize("name", ["tets", "polyhedra", "sections"])
def test_partitions_are_joined(motet, tmp_path, name):
    one = DATA[name]()
    two = one.translate((10.0, 0, 0))
    for array in ("label", "c"):
        if array in two.cell_data:
            two.cell_data[array] = two.cell_data[array] + two.cell_data[array].dtype.type(100)
    write_hdf(partitioned([one, two]), tmp_path / "in.vtkhdf")
    # Only an unstructured grid can store the cells of several parts of polygonal data in the order of the
    # parts.
    motet("convert", tmp_path / "in.vtkhdf", tmp_path / "out.vtu")
    joined = read_xml(tmp_path / "out.vtu")
    assert joined.n_cells == 2 * one.n_cells and joined.n_points == 2 * one.n_points
    append = vtk.vtkAppendFilter()
    append.AddInputData(one)
    append.AddInputData(two)
    append.Update()
    theirs = pyvista.wrap(append.GetOutput())
    assert np.array_equal(joined.points, theirs.points)
    assert np.array_equal(joined.cell_connectivity, theirs.cell_connectivity)
    assert np.array_equal(joined.celltypes, theirs.celltypes)
    for array in theirs.cell_data:
        assert np.array_equal(joined.cell_data[array], theirs.cell_data[array])


def test_blocks_are_refused_with_a_remedy(motet, tmp_path):
    write_hdf(pyvista.MultiBlock({"a": tets(2), "b": surface()}), tmp_path / "in.vtkhdf")
    error = motet("info", tmp_path / "in.vtkhdf", code=3).stderr
    assert "MultiBlockDataSet" in error and "Merge Blocks" in error


class Moving(VTKPythonAlgorithmBase):
    """A mesh that moves in steps of half a second; with `growing`, its number of cells changes as well."""

    def __init__(self, data, growing):
        kind = "vtkPolyData" if isinstance(data, pyvista.PolyData) else "vtkUnstructuredGrid"
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType=kind)
        self.data, self.growing, self.times = data, growing, [0.0, 0.5, 1.0]

    def at(self, time):
        data = self.data.copy()
        data.points = data.points + np.array([time, 0, -time])
        if "velocity" in data.point_data:
            data.point_data["velocity"] = data.point_data["velocity"] * (1 + time)
        if self.growing and time > 0.25:
            keep = vtk.vtkAppendFilter() if not isinstance(data, pyvista.PolyData) else vtk.vtkAppendPolyData()
            keep.AddInputData(data)
            keep.AddInputData(data.translate((20 * time, 0, 0)))
            keep.Update()
            data = pyvista.wrap(keep.GetOutput())
        return data

    def RequestInformation(self, request, inputs, outputs):
        info, keys = outputs.GetInformationObject(0), vtk.vtkStreamingDemandDrivenPipeline
        info.Set(keys.TIME_STEPS(), self.times, len(self.times))
        info.Set(keys.TIME_RANGE(), [self.times[0], self.times[-1]], 2)
        return 1

    def RequestData(self, request, inputs, outputs):
        info = outputs.GetInformationObject(0)
        time = info.Get(vtk.vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP()) or 0.0
        data = self.at(time)
        data.GetInformation().Set(vtk.vtkDataObject.DATA_TIME_STEP(), time)
        outputs.GetInformationObject(0).Get(vtk.vtkDataObject.DATA_OBJECT()).ShallowCopy(data)
        return 1


@pytest.mark.parametrize("growing", [False, True])
@pytest.mark.parametrize("name", ["tets", "polyhedra", "sections"])
def test_motet_and_vtk_read_the_same_steps(motet, tmp_path, name, growing):
    source = Moving(DATA[name](), growing)
    path = write_hdf(source, tmp_path / "flow.vtkhdf", compression=3)
    frames = motet.json("info", path)["series"]
    assert [frame["time"] for frame in frames] == source.times
    ending = "vtp" if name == "sections" else "vtu"
    for step, time in enumerate(source.times):
        motet("convert", f"{path}#{step}", tmp_path / f"{step}.{ending}")
        ours = read_xml(tmp_path / f"{step}.{ending}")
        assert_same_data(ours, read_hdf(path, step), but=("region", "patch", "Time"))
        assert np.array_equal(ours.points, source.at(time).points)
    first = motet("convert", path, tmp_path / "first.vtu")
    assert "3 steps" in first.stderr


@pytest.mark.parametrize("topology", ["kept", "changing"])
def test_vtk_reads_series_of_motet(motet, tmp_path, topology):
    files = []
    for k in range(3):
        n = 3 + (k if topology == "changing" else 0)
        grid = pyvista.ImageData(dimensions=(n, 3, 3)).cast_to_unstructured_grid()
        grid.points = np.asarray(grid.points, float) * (1 + 0.1 * k)
        grid.point_data["u"] = np.random.default_rng(k).normal(size=(grid.n_points, 3))
        grid.cell_data["label"] = np.arange(grid.n_cells, dtype=np.int32)
        grid.save(tmp_path / f"frame{k}.vtu")
        files.append(f'<DataSet timestep="{0.5 * k}" file="frame{k}.vtu"/>')
    (tmp_path / "in.pvd").write_text(f'<VTKFile type="Collection"><Collection>{"".join(files)}</Collection></VTKFile>')
    motet("convert", tmp_path / "in.pvd", tmp_path / "out.vtkhdf")
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "out.vtkhdf"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 3
    motet("convert", tmp_path / "out.vtkhdf", tmp_path / "back.pvd")
    for k in range(3):
        expected = read_xml(tmp_path / f"frame{k}.vtu")
        for data in (read_hdf(tmp_path / "out.vtkhdf", k), read_xml(tmp_path / f"back_{k:04d}.vtu")):
            assert cells_of(data) == cells_of(expected)
            np.testing.assert_array_equal(data.points, expected.points)
            np.testing.assert_array_equal(data.point_data["u"], expected.point_data["u"])
            np.testing.assert_array_equal(data.cell_data["label"], expected.cell_data["label"])
