"""Remeshed meshes read by meshio and VTK: no bad tets by Verdict, and everything else unchanged."""
import json

import numpy as np
import pytest
from meshes import assert_same_array, cell_array_of, cells_of, tet_set, volumes

meshio = pytest.importorskip("meshio")
vtk = pytest.importorskip("vtk")
from vtk.util.numpy_support import vtk_to_numpy  # noqa: E402

NONE = 2**32 - 1
BAD = 0.2


def verdict_eas(path):
    """Return the equi-angle quality of every tet of a VTU file, in the order of its cells, by VTK's Verdict.

    The sign is that of the volume, relative to most tets: all tets of a mesh may be numbered the other way
    round.
    """
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    # Not of the extracted tets: VTK converts their points to single precision.
    grid = reader.GetOutput()
    is_tet = np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]) == vtk.VTK_TETRA
    measured = []
    for measure in ("EquiangleSkew", "Volume"):
        quality = vtk.vtkMeshQuality()
        quality.SetInputData(grid)
        getattr(quality, f"SetTetQualityMeasureTo{measure}")()
        quality.Update()
        measured.append(vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality"))[is_tet])
    skew, volume = measured
    return np.sign(volume) * np.sign(np.median(volume)) * (1 - skew)


def all_cells(mesh):
    """Return the cells of a meshio mesh in the order of the file, as lists of vertices."""
    return [list(row) for block in mesh.cells for row in block.data]


def remeshed(motet, source, folder, *options, code=0):
    """Remesh a mesh; return the report, both meshes read by meshio, both VTU files, and the history."""
    before, after, history = folder / "before.vtu", folder / "after.vtu", folder / "history.json"
    motet("convert", source, before)
    report = motet.json("remesh", before, "-o", after, "--history", history, *options, code=code)
    return report, meshio.read(before), meshio.read(after), (before, after), json.loads(history.read_text())


def assert_quality_by_verdict(report, files):
    """Assert that the quality in the report agrees with Verdict."""
    for state, path in zip(("before", "after"), files):
        eas, reported = verdict_eas(path), report[state]
        assert len(eas) == reported["tets"]
        # Verdict's arc cosines turn rounding errors into 1e-8 for flat tets.
        assert abs(eas.min() - reported["worst_eas"]["value"]) < 1e-7
        assert np.count_nonzero(eas < BAD - 1e-9) <= reported["bad"] <= np.count_nonzero(eas < BAD + 1e-9)


def assert_kept(old, new, history, kept):
    """Assert that cells that the history calls kept are unchanged, and as many tets as reported."""
    was = np.array(history["vertices"]["kept"])
    stayed = was != NONE
    assert_same_array(np.asarray(new.points)[stayed], np.asarray(old.points)[was[stayed]], "kept points")
    before, after = all_cells(old), all_cells(new)
    pairs = [(cell, before[origin]) for cell, origin in zip(after, history["cells"]["kept"], strict=True) if origin != NONE]
    assert sum(len(cell) == 4 for cell, _ in pairs) == kept
    ours, theirs = (np.concatenate(side) for side in zip(*pairs))
    assert_same_array(new.points[ours], old.points[theirs], "points of kept cells")
    # Independent of the history: tets by their coordinates.
    by_corners = lambda mesh: {np.sort(mesh.points[tet].view("V24"), axis=0).tobytes() for tet in cells_of(mesh)["tetra"]}
    assert len(by_corners(old) & by_corners(new)) >= kept


def region_volumes(mesh, array):
    """Return the volume of each region."""
    tets = cells_of(mesh)["tetra"]
    regions = cell_array_of(mesh, array)["tetra"] if array else np.zeros(len(tets), int)
    volume = np.abs(volumes(mesh.points, tets))
    return {int(region): volume[regions == region].sum() for region in np.unique(regions)}


def assert_same_volumes(old, new, array):
    before, after = region_volumes(old, array), region_volumes(new, array)
    assert before.keys() == after.keys()
    for region, volume in before.items():
        assert np.isclose(volume, after[region], rtol=1e-12), (region, volume, after[region])


@pytest.mark.parametrize("options", [(), ("--surface", "adapt"), ("--goal", "best")])
def test_a_mesh_of_another_project_is_repaired(motet, data, tmp_path, options):
    source = data / "bad_tets" / "stellar_house2.node"
    report, old, new, files, history = remeshed(motet, source, tmp_path, *options)
    assert report["before"]["bad"] > 0 and report["after"]["bad"] == 0
    assert verdict_eas(files[1]).min() >= BAD
    assert_quality_by_verdict(report, files)
    # The original, read by another program.
    theirs = meshio.read(source)
    assert_same_array(old.points, theirs.points, "points")
    assert np.array_equal(tet_set(cells_of(old)["tetra"]), tet_set(cells_of(theirs)["tetra"]))
    assert_kept(old, new, history, report["kept"])
    if "adapt" not in options:
        assert_same_volumes(old, new, None)


def shaken_box(n=8, shake=0.37):
    """Create the unit cube in two regions, with the boundary as patches.

    Inner vertices are displaced so that some tets are bad, and none is inverted.
    """
    rng = np.random.default_rng(20240917)
    grid = np.stack(np.meshgrid(*[np.arange(n + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    points = grid / n
    number = lambda p: (p[..., 0] * (n + 1) + p[..., 1]) * (n + 1) + p[..., 2]
    corners = grid[(grid < n).all(axis=1)]
    tets = []
    for axes in [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]:
        steps = np.cumsum([np.zeros(3, int), *np.eye(3, dtype=int)[list(axes)]], axis=0)
        tets.append(np.stack([number(corners + step) for step in steps], axis=1))
    tets = np.vstack(tets)
    flip = volumes(points, tets) < 0
    tets[flip] = tets[flip][:, [0, 1, 3, 2]]
    region = np.where(points[tets][:, :, 0].mean(axis=1) < 0.5, 3, 4)
    facets = np.sort(np.vstack([tets[:, f] for f in ([1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2])]), axis=1)
    facets, counts = np.unique(facets, axis=0, return_counts=True)
    facets = facets[counts == 1]
    patch = np.zeros(len(facets), int)
    for axis in range(3):
        for end in range(2):
            patch[(points[facets][:, :, axis] == end).all(axis=1)] = 11 + 2 * axis + end
    inner = ((grid > 0) & (grid < n)).all(axis=1) & (2 * grid[:, 0] != n)
    shaken = points.copy()
    shaken[inner] += rng.uniform(-shake, shake, (inner.sum(), 3)) / n
    while (inverted := volumes(shaken, tets) <= 1e-3 / (6 * n**3)).any():
        back = np.unique(tets[inverted])
        shaken[back] = (shaken[back] + points[back]) / 2
    return shaken, tets, region, facets, patch


LINEAR = np.array([[1.0, 2.0, -3.0], [0.1, -0.7, 4.0], [3.0, 0.0, 0.2]])


@pytest.fixture(scope="module")
def box():
    points, tets, region, facets, patch = shaken_box()
    rng = np.random.default_rng(7)
    n = len(tets) + len(facets)
    labels = [region.astype(np.int32), patch.astype(np.int32)]
    split = lambda values: [values[:len(tets)], values[len(tets):]]
    return meshio.Mesh(
        points, [("tetra", tets), ("triangle", facets)],
        point_data={"linear": points @ LINEAR + 1, "one": np.ones(len(points), np.float32)},
        cell_data={"CellEntityIds": labels, "pressure": split(rng.standard_normal(n)), "one": split(np.ones(n)),
                   "number": split(np.arange(n))},
    )


@pytest.mark.parametrize("goal", ["repair", "best"])
def test_repair_of_a_deformed_mesh_preserves_its_arrays(motet, box, tmp_path, goal):
    box.write(tmp_path / "box.vtu")
    report, old, new, files, history = remeshed(motet, tmp_path / "box.vtu", tmp_path, "--goal", goal)
    assert report["before"]["bad"] > 5 and report["before"]["inverted"] == 0
    assert report["after"]["bad"] == 0 and verdict_eas(files[1]).min() >= BAD
    assert_quality_by_verdict(report, files)
    assert_same_array(old.points, box.points, "points")
    assert_kept(old, new, history, report["kept"])
    assert_same_volumes(old, new, "CellEntityIds")
    # The surface is exactly the same, patch by patch.
    triangles = lambda mesh: (mesh.points[cells_of(mesh)["triangle"]], cell_array_of(mesh, "CellEntityIds")["triangle"])
    for ours, theirs in zip(triangles(new), triangles(box)):
        assert_same_array(ours, theirs, "triangles")
    # Every array exists, on every cell.
    assert set(new.point_data) == set(box.point_data) and set(new.cell_data) == set(old.cell_data) >= set(box.cell_data)
    assert np.abs(new.point_data["linear"] - (new.points @ LINEAR + 1)).max() < 1e-13
    assert_same_array(new.point_data["one"], np.ones(len(new.points), np.float32))
    assert all((values == 1).all() for values in new.cell_data["one"])
    integrals = []
    for mesh in (old, new):
        tets = cells_of(mesh)["tetra"]
        region, pressure = (cell_array_of(mesh, name)["tetra"] for name in ("CellEntityIds", "pressure"))
        weighted = pressure * volumes(mesh.points, tets)
        integrals.append([weighted[region == label].sum() for label in (3, 4)])
    assert np.allclose(*integrals, rtol=0, atol=1e-13)
    # A tet inherits its number from an old tet that overlaps it.
    rows = history["cells"]["changed"]
    assert set(np.concatenate(new.cell_data["number"])) <= set(np.concatenate(old.cell_data["number"]))
    assert np.allclose(np.add.reduceat(rows["shares"], rows["from"]["offsets"][:-1]), 1, rtol=0, atol=1e-14)


def test_gmsh_files_keep_their_physical_groups(motet, box, tmp_path):
    gmsh = meshio.Mesh(box.points, box.cells, cell_data={"gmsh:physical": box.cell_data["CellEntityIds"],
                                                         "gmsh:geometrical": box.cell_data["CellEntityIds"]},
                       field_data={"fluid": np.array([3, 3]), "inlet": np.array([11, 2])})
    meshio.write(tmp_path / "box.msh", gmsh, file_format="gmsh22")
    motet("remesh", tmp_path / "box.msh", "-o", tmp_path / "out.msh", "--version", "2.2")
    new = meshio.read(tmp_path / "out.msh")
    assert {name: tuple(value) for name, value in new.field_data.items()}.items() >= {"fluid": (3, 3), "inlet": (11, 2)}.items()
    assert_same_volumes(gmsh, new, "gmsh:physical")
    patches = cell_array_of(new, "gmsh:physical")["triangle"]
    assert sorted(patches) == sorted(box.cell_data["CellEntityIds"][1])


@pytest.mark.parametrize("name", ["bad_tets/stellar_house2.node", "bad_tets/polyfem_screw.msh",
                                  "copyleft/lifev_aorta_fluid_30K.mesh", "tetmeshes/ambit_pipe_fsi/pipe_fsi_domain.vtu"])
def test_the_report_on_a_real_mesh_agrees_with_verdict(motet, data, tmp_path, name):
    report, old, new, files, history = remeshed(motet, data / name, tmp_path, "--layers", "repair", "--rounds", 4, code=None)
    assert_quality_by_verdict(report, files)
    assert_kept(old, new, history, report["kept"])
    assert report["after"]["bad"] <= report["before"]["bad"] and report["after"]["inverted"] == 0
    assert len(report["left"]) == report["after"]["bad"]
    cells = all_cells(new)
    for left in report["left"]:
        cell = cells[left["cell"]]
        assert np.allclose(new.points[cell].mean(axis=0), left["place"], rtol=1e-12, atol=1e-12)


def test_requested_sizes_are_reached_and_arrays_are_transferred(motet, box, tmp_path):
    size = 0.03 + 0.35 * box.points[:, 0]
    graded = meshio.Mesh(box.points, box.cells, point_data={**box.point_data, "h": size}, cell_data=box.cell_data)
    graded.write(tmp_path / "box.vtu")
    report, old, new, files, history = remeshed(motet, tmp_path / "box.vtu", tmp_path, "--sizes", "h", "--surface", "adapt")
    assert report["complete"] and verdict_eas(files[1]).min() >= BAD
    assert_quality_by_verdict(report, files)
    assert_same_volumes(old, new, "CellEntityIds")
    for state, mesh in (("before", old), ("after", new)):
        tets = cells_of(mesh)["tetra"]
        edges = np.unique(np.sort(np.vstack([tets[:, e] for e in ([0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3])]), axis=1), axis=0)
        lengths = np.linalg.norm(mesh.points[edges[:, 0]] - mesh.points[edges[:, 1]], axis=1)
        # Requested sizes are linear, so they are known everywhere.
        ratio = lengths / (0.03 + 0.35 * mesh.points[edges, 0].mean(axis=1))
        sizes = report["sizes"][state]
        assert sizes["edges"] == len(edges)
        assert np.allclose([sizes["min"], sizes["mean"], sizes["max"]], [ratio.min(), ratio.mean(), ratio.max()], rtol=1e-9, atol=0)
        if state == "before":
            assert sizes["too_long"] == np.count_nonzero(ratio > 1.5) > 0
            assert sizes["too_short"] == np.count_nonzero(ratio < 0.5) > 0
        else:
            assert sizes["too_long"] == 0 and ratio.max() <= 1.5 + 1e-9 and np.count_nonzero(ratio < 0.5) < 0.05 * len(ratio)
    assert np.abs(new.point_data["linear"] - (new.points @ LINEAR + 1)).max() < 1e-12
    assert np.abs(new.point_data["h"] - (0.03 + 0.35 * new.points[:, 0])).max() < 1e-12
