"""CGNS files compared with VTK's reader, Gmsh, meshio, and the library and programs of CGNS."""
import shutil
import subprocess

import numpy as np
import pytest
import pyvista
import vtk
from vtkmodules.vtkIOCGNSReader import vtkCGNSReader

cells = pyvista.examples.cells


def read_cgns(path, patches=False):
    """Read a zone with VTK; with `patches` also its boundary conditions by name."""
    reader = vtkCGNSReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    for all_of in (reader.EnableAllBases, reader.EnableAllPointArrays, reader.EnableAllCellArrays):
        all_of()
    reader.SetLoadBndPatch(patches)
    reader.Update()
    zone = pyvista.wrap(reader.GetOutput())["Base"]["Zone"]
    if not patches:
        return zone
    return zone["Internal"], {name: zone["Patches"][name] for name in zone["Patches"].keys()}


def joined(*parts):
    append = vtk.vtkAppendFilter()
    append.MergePointsOn()
    for part in parts:
        append.AddInputData(part)
    append.Update()
    return pyvista.wrap(append.GetOutput())


def with_arrays(grid):
    rng = np.random.default_rng(5)
    grid.clear_data()
    grid.point_data["velocity"] = rng.normal(size=(grid.n_points, 3))
    grid.point_data["pressure"] = rng.normal(size=grid.n_points).astype(np.float32)
    grid.cell_data["index"] = np.arange(grid.n_cells, dtype=np.int32)
    grid.cell_data["flux"] = rng.normal(size=(grid.n_cells, 3))
    return grid


def tets():
    grid = pyvista.ImageData(dimensions=(4, 4, 4)).to_tetrahedra()
    grid.points = grid.points.astype(float)
    return with_arrays(grid)


def side_by_side(*parts):
    return with_arrays(joined(*[part.translate((3.0 * i, 0, 0)) for i, part in enumerate(parts)]))


DATA = {
    "tets": tets,
    "mixed": lambda: side_by_side(cells.Hexahedron(), cells.Wedge(), cells.Pyramid(), cells.Tetrahedron()),
    "quadratic": lambda: side_by_side(cells.QuadraticTetrahedron(), cells.QuadraticHexahedron(), cells.QuadraticWedge(),
                                      cells.TriQuadraticHexahedron(), cells.BiQuadraticQuadraticWedge()),
    "faces": lambda: side_by_side(cells.Triangle(), cells.Quadrilateral(), cells.QuadraticTriangle(),
                                  cells.QuadraticQuadrilateral(), cells.BiQuadraticQuadrilateral()),
}


# VTK does not support PYRA_13.
ALL_DATA = DATA | {"pyramid": lambda: side_by_side(cells.QuadraticPyramid())}


def assert_same_grid(ours, theirs):
    assert np.array_equal(ours.points, theirs.points)
    assert ours.celltypes.tolist() == theirs.celltypes.tolist()
    assert ours.cell_connectivity.tolist() == theirs.cell_connectivity.tolist()
    for a, b in ((ours.point_data, theirs.point_data), (ours.cell_data, theirs.cell_data)):
        for name in b:
            assert a[name].dtype == b[name].dtype, name
            assert np.array_equal(np.squeeze(a[name]), np.squeeze(b[name])), name


@pytest.mark.parametrize("name", DATA)
def test_vtk_reads_files_of_motet(motet, tmp_path, name):
    data = DATA[name]()
    data.save(tmp_path / "in.vtu")
    done = motet("convert", tmp_path / "in.vtu", tmp_path / "out.cgns")
    assert "warning" not in done.stderr
    assert_same_grid(read_cgns(tmp_path / "out.cgns"), data)
    motet("convert", tmp_path / "out.cgns", tmp_path / "back.vtu")
    assert_same_grid(pyvista.read(tmp_path / "back.vtu"), data)


def faces_of(grid):
    """Return each cell as the set of its faces."""
    return [frozenset(frozenset(face.point_ids) for face in cell.faces) for cell in grid.cell]


def polyhedra():
    return joined(cells.Polyhedron(), tets().extract_cells([0, 1, 5]).translate((5, 0, 0)),
                  cells.Hexahedron().translate((9, 0, 0)))


def test_vtk_reads_polyhedra_of_motet(motet, tmp_path):
    data = polyhedra()
    data.clear_data()
    data.cell_data["index"] = np.arange(data.n_cells) * 1.5
    data.save(tmp_path / "in.vtu")
    motet("convert", tmp_path / "in.vtu", tmp_path / "out.cgns")
    read = read_cgns(tmp_path / "out.cgns")
    assert set(read.celltypes) == {42} and np.array_equal(read.points, data.points)
    assert np.array_equal(read.cell_data["index"], data.cell_data["index"])
    assert faces_of(read) == faces_of(data)
    motet("convert", tmp_path / "out.cgns", tmp_path / "back.vtu")
    back = pyvista.read(tmp_path / "back.vtu")
    # The first polyhedron has the faces of a tet, and is read as one.
    assert faces_of(back) == faces_of(data) and back.celltypes.tolist() == [10, 10, 10, 10, 12]
    assert np.allclose(back.compute_cell_sizes()["Volume"], data.compute_cell_sizes()["Volume"])


def labelled():
    """Tets in two regions and their boundary in three patches, one of them without a name.

    Values on all cells.
    """
    volume = tets()
    grid = joined(volume, volume.extract_surface(algorithm=None).cast_to_unstructured_grid())
    grid.clear_data()
    x = grid.cell_centers().points[:, 0]
    is_tet = grid.celltypes == 10
    grid.cell_data["region"] = np.where(is_tet, np.where(x < 1.5, 1, 2), 0).astype(np.int32)
    grid.cell_data["patch"] = np.where(is_tet, 0, np.where(x < 1e-9, 4, np.where(x > 2.999, 7, 9))).astype(np.int32)
    for name, number in (("region:fluid", 1), ("region:solid", 2), ("patch:inlet", 4), ("patch:outlet", 7)):
        grid.field_data[name] = np.array([number], np.int32)
    grid.cell_data["value"] = np.arange(grid.n_cells) * 0.5
    return grid


@pytest.fixture
def labelled_file(motet, tmp_path):
    labelled().save(tmp_path / "in.vtu")
    motet("convert", tmp_path / "in.vtu", tmp_path / "out.cgns")
    return tmp_path / "out.cgns"


def test_patches_are_written_as_boundary_conditions(motet, labelled_file):
    data = labelled()
    inner, patches = read_cgns(labelled_file, patches=True)
    assert inner.n_cells == (data.celltypes == 10).sum()
    counts = {name: (data.cell_data["patch"] == number).sum() for name, number in
              (("inlet", 4), ("outlet", 7), ("Patch_9", 9))}
    assert {name: patch.n_cells for name, patch in patches.items()} == counts
    motet("convert", labelled_file, labelled_file.with_suffix(".vtu"))
    back = pyvista.read(labelled_file.with_suffix(".vtu"))
    for name in ("region", "patch", "value"):
        key = "value"
        ours, theirs = np.argsort(back.cell_data[key]), np.argsort(data.cell_data[key])
        assert np.array_equal(back.cell_data[name][ours], data.cell_data[name][theirs])
    assert {name for name in back.field_data.keys()} == set(data.field_data.keys())


def test_gmsh_reads_files_of_motet(labelled_file):
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(labelled_file))
        kinds, tags, _ = gmsh.model.mesh.getElements()
        data = labelled()
        assert dict(zip(kinds.tolist(), map(len, tags))) == {2: (data.celltypes == 5).sum(), 4: (data.celltypes == 10).sum()}
        groups = {gmsh.model.getPhysicalName(*group) for group in gmsh.model.getPhysicalGroups()}
        assert groups == {"inlet", "outlet", "Patch_9"}
        _, points, _ = gmsh.model.mesh.getNodes()
        assert np.array_equal(np.sort(points.reshape(-1, 3), axis=0), np.sort(data.points, axis=0))
    finally:
        gmsh.finalize()


@pytest.mark.parametrize("order", [1, 2])
def test_motet_reads_files_of_gmsh(motet, tmp_path, order):
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        model = gmsh.model
        boxes = [model.occ.addBox(i, 0, 0, 1, 1, 1) for i in (0, 1)]
        model.occ.fragment([(3, boxes[0])], [(3, boxes[1])])
        model.occ.synchronize()
        for i, name in enumerate(("left", "right")):
            model.addPhysicalGroup(3, [boxes[i]], name=name)
        inlet = [tag for _, tag in model.getEntitiesInBoundingBox(-0.1, -0.1, -0.1, 0.1, 1.1, 1.1, 2)]
        hull = {tag for _, tag in model.getBoundary(model.getEntities(3), oriented=False)}
        model.addPhysicalGroup(2, inlet, name="inlet")
        model.addPhysicalGroup(2, sorted(hull - set(inlet)), name="wall")
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
        model.mesh.generate(3)
        model.mesh.setOrder(order)
        gmsh.write(str(tmp_path / "in.cgns"))
        gmsh.write(str(tmp_path / "in.msh"))
    finally:
        gmsh.finalize()
    ours, theirs = motet.json("info", tmp_path / "in.cgns"), motet.json("info", tmp_path / "in.msh")
    for what, measure, names in (("regions", "volume", {"left", "right"}), ("patches", "area", {"inlet", "wall"})):
        assert names <= set(ours[what])
        for name in names:
            assert ours[what][name]["cells"] == theirs[what][name]["cells"]
            assert ours[what][name][measure] == pytest.approx(theirs[what][name][measure])


def test_motet_reads_tets_of_meshio(motet, tmp_path):
    pytest.importorskip("h5py")
    meshio = pytest.importorskip("meshio")
    data = tets()
    mesh = meshio.Mesh(data.points, [("tetra", data.cell_connectivity.reshape(-1, 4))])
    mesh.write(tmp_path / "in.cgns")
    motet("convert", tmp_path / "in.cgns", tmp_path / "out.vtu")
    back = pyvista.read(tmp_path / "out.vtu")
    assert np.array_equal(back.points, data.points)
    assert np.array_equal(back.cell_connectivity, data.cell_connectivity)


def program(name):
    found = shutil.which(name)
    if found is None:
        pytest.skip(f"{name} is not installed")
    return found


def test_cgnscheck_finds_no_errors(motet, tmp_path, labelled_file):
    check = program("cgnscheck")
    files = [labelled_file]
    for name in ALL_DATA:
        ALL_DATA[name]().save(tmp_path / f"{name}.vtu")
        files.append(tmp_path / f"{name}.cgns")
        motet("convert", tmp_path / f"{name}.vtu", files[-1])
    for file in files:
        done = subprocess.run([check, str(file)], capture_output=True, text=True, timeout=60)
        assert done.returncode == 0 and "checking complete" in done.stdout, done.stdout
        assert "ERROR" not in done.stdout + done.stderr, done.stdout


def test_adf_files_are_refused_with_a_remedy(motet, tmp_path, labelled_file):
    done = subprocess.run([program("cgnsconvert"), "-a", str(labelled_file), str(tmp_path / "old.cgns")],
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stdout + done.stderr
    error = motet("info", tmp_path / "old.cgns", code=3).stderr
    assert "ADF" in error and "cgnsconvert -h" in error
    subprocess.run([program("cgnsconvert"), "-h", str(tmp_path / "old.cgns"), str(tmp_path / "new.cgns")], check=True,
                   capture_output=True, timeout=60)
    ours, theirs = motet.json("info", tmp_path / "new.cgns"), motet.json("info", labelled_file)
    for key in ("points", "cells", "regions", "patches"):
        assert ours[key] == theirs[key]


WITH_LIBRARY = r"""
#include <cgnslib.h>
#define DO(call) if (call) cg_error_exit()
int main(void) {
  int f, b, z, i, s;
  double x[6] = {0, 1, 0, 0, 1, 2}, y[6] = {0, 0, 1, 0, 1, 2}, w[6] = {0, 0, 0, 1, 1, 2};
  float p[6] = {1, 2, 3, 4, 5, 6};
  double q[2] = {10, 20};
  cgsize_t size[3] = {6, 2, 0};
  cgsize_t tets[8] = {1, 2, 3, 4, 2, 3, 4, 5};
  cgsize_t mixed[8] = {CGNS_ENUMV(TRI_3), 1, 2, 3, CGNS_ENUMV(TRI_3), 2, 3, 5};
  cgsize_t starts[3] = {0, 4, 8};
  cgsize_t inlet[1] = {3}, wall[2] = {4, 4};
  DO(cg_set_file_type(CG_FILE_HDF5));
  DO(cg_open("lib.cgns", CG_MODE_WRITE, &f));
  DO(cg_base_write(f, "Base", 3, 3, &b));
  DO(cg_family_write(f, b, "Inflow", &i));
  const char *names[2] = {"Rotor", "Stator"};
  for (int k = 0; k < 2; k++) {
    DO(cg_zone_write(f, b, names[k], size, CGNS_ENUMV(Unstructured), &z));
    DO(cg_coord_write(f, b, z, CGNS_ENUMV(RealDouble), "CoordinateX", x, &i));
    DO(cg_coord_write(f, b, z, CGNS_ENUMV(RealDouble), "CoordinateY", y, &i));
    DO(cg_coord_write(f, b, z, CGNS_ENUMV(RealDouble), "CoordinateZ", w, &i));
    DO(cg_section_write(f, b, z, "Cells", CGNS_ENUMV(TETRA_4), 1, 2, 0, tets, &s));
    DO(cg_poly_section_write(f, b, z, "Sides", CGNS_ENUMV(MIXED), 3, 4, 0, mixed, starts, &s));
    DO(cg_boco_write(f, b, z, "in", CGNS_ENUMV(FamilySpecified), CGNS_ENUMV(PointList), 1, inlet, &i));
    DO(cg_boco_gridlocation_write(f, b, z, i, CGNS_ENUMV(FaceCenter)));
    DO(cg_goto(f, b, "Zone_t", z, "ZoneBC_t", 1, "BC_t", i, "end"));
    DO(cg_famname_write("Inflow"));
    DO(cg_boco_write(f, b, z, "wall", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), 2, wall, &i));
    DO(cg_boco_gridlocation_write(f, b, z, i, CGNS_ENUMV(FaceCenter)));
    DO(cg_sol_write(f, b, z, "AtPoints", CGNS_ENUMV(Vertex), &s));
    DO(cg_field_write(f, b, z, s, CGNS_ENUMV(RealSingle), "Pressure", p, &i));
    DO(cg_sol_write(f, b, z, "AtCells", CGNS_ENUMV(CellCenter), &s));
    DO(cg_field_write(f, b, z, s, CGNS_ENUMV(RealDouble), "VelocityX", q, &i));
    DO(cg_field_write(f, b, z, s, CGNS_ENUMV(RealDouble), "VelocityY", q, &i));
    DO(cg_field_write(f, b, z, s, CGNS_ENUMV(RealDouble), "VelocityZ", q, &i));
  }
  DO(cg_close(f));
  DO(cg_open("linked.cgns", CG_MODE_WRITE, &f));
  DO(cg_base_write(f, "Base", 3, 3, &b));
  DO(cg_zone_write(f, b, "Zone", size, CGNS_ENUMV(Unstructured), &z));
  DO(cg_section_write(f, b, z, "Cells", CGNS_ENUMV(TETRA_4), 1, 2, 0, tets, &s));
  DO(cg_goto(f, b, "Zone_t", z, "end"));
  DO(cg_link_write("GridCoordinates", "lib.cgns", "/Base/Rotor/GridCoordinates"));
  DO(cg_close(f));
  return 0;
}
"""


@pytest.fixture
def from_library(tmp_path):
    """A folder with files written by a program that uses the CGNS library."""
    compiler = program("cc")
    (tmp_path / "lib.c").write_text(WITH_LIBRARY)
    built = subprocess.run([compiler, "lib.c", "-o", "lib", "-lcgns"], cwd=tmp_path, capture_output=True, text=True)
    if built.returncode:
        pytest.skip("the CGNS library is not installed, or has another version")
    subprocess.run([str(tmp_path / "lib")], cwd=tmp_path, check=True, timeout=60)
    return tmp_path


def test_links_are_refused_with_a_remedy(motet, from_library):
    error = motet("info", from_library / "linked.cgns", code=3).stderr
    assert "/Base/Zone/GridCoordinates" in error and "is a link" in error
    remedy = error[error.index("cgnsconvert"):].split()[1:4]
    subprocess.run([program("cgnsconvert"), *remedy, "linked.cgns", "whole.cgns"], cwd=from_library, check=True,
                   capture_output=True, timeout=60)
    assert motet.json("info", from_library / "whole.cgns")["cells"] == {"tetra": 2}


def test_motet_reads_files_of_the_cgns_library(motet, from_library):
    motet("convert", from_library / "lib.cgns", from_library / "out.vtu")
    mesh = pyvista.read(from_library / "out.vtu")
    assert mesh.n_points == 12 and mesh.celltypes.tolist() == [10, 10, 5, 5] * 2
    names = {name: int(np.asarray(mesh.field_data[name]).item()) for name in mesh.field_data.keys()}
    assert set(names) == {"region:Rotor", "region:Stator", "patch:Inflow", "patch:wall"}
    region, patch = mesh.cell_data["region"], mesh.cell_data["patch"]
    rotor, stator = names["region:Rotor"], names["region:Stator"]
    assert region.tolist() == [rotor, rotor, 0, 0, stator, stator, 0, 0]
    assert patch.tolist() == [0, 0, names["patch:Inflow"], names["patch:wall"]] * 2
    assert mesh.point_data["Pressure"].dtype == np.float32
    assert mesh.point_data["Pressure"].tolist() == [1, 2, 3, 4, 5, 6] * 2
    assert mesh.cell_data["Velocity"][[0, 1, 4, 5]].tolist() == [[10] * 3, [20] * 3] * 2
    assert np.isnan(mesh.cell_data["Velocity"][[2, 3, 6, 7]]).all()
