"""OpenFOAM's polyMesh compared with VTK's reader, and with OpenFOAM if it is installed."""
import os
import shutil
import subprocess

import numpy as np
import pytest
import pyvista

shapes = pytest.importorskip("motet", reason="the package is not installed: ./test does it").shapes
has_openfoam = pytest.mark.skipif(not shutil.which("checkMesh"), reason="OpenFOAM is not installed: apt-get install openfoam")
CONTROL = """FoamFile { version 2.0; format ascii; class dictionary; object controlDict; }
application none; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep; writeInterval 1;
writeFormat %s; writePrecision 17; writeCompression %s;
"""
OTHERS = {"fvSchemes": "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} interpolationSchemes {} snGradSchemes {}", "fvSolution": ""}
BLOCK = """FoamFile { version 2.0; format ascii; class dictionary; object blockMeshDict; }
convertToMeters 1;
vertices ((0 0 0) (2 0 0) (2 1 0) (0 1 0) (0 0 1) (2 0 1.3) (2 1 1) (0 1 1));
blocks (hex (0 1 2 3 4 5 6 7) (4 3 3) simpleGrading (2 1 1));
edges ();
boundary (inlet { type patch; faces ((0 4 7 3)); } wall { type wall; faces ((1 2 6 5) (0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7)); });
"""


def new_case(folder, form="ascii", packed="off"):
    (folder / "system").mkdir(parents=True)
    (folder / "constant").mkdir()
    (folder / "system" / "controlDict").write_text(CONTROL % (form, packed))
    for name, text in OTHERS.items():
        (folder / "system" / name).write_text(f"FoamFile {{ version 2.0; format ascii; class dictionary; object {name}; }}\n{text}\n")
    (folder / "case.foam").touch()
    return folder


def foam(case, *command):
    done = subprocess.run(command, cwd=case, capture_output=True, text=True, timeout=300, env=os.environ | {"WM_PROJECT_DIR": "/usr/share/openfoam"})
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr
    return done.stdout


def by_vtk(case):
    """Read a case with VTK; return the mesh, and the number of faces of each patch."""
    reader = pyvista.POpenFOAMReader(str(case / "case.foam"))
    reader.case_type = "reconstructed"
    reader.enable_all_patch_arrays()
    blocks = reader.read()
    patches = blocks["boundary"] if "boundary" in blocks.keys() else {}
    return blocks["internalMesh"], {name: patches[name].n_cells for name in patches.keys()}


def volumes(grid):
    return grid.compute_cell_sizes(length=False, area=False)["Volume"]


def same(motet, case, tmp_path, given=None):
    """Read a case with motet and with VTK, and assert that the meshes are equal."""
    motet("convert", given or case, tmp_path / "read.vtu")
    ours = pyvista.read(tmp_path / "read.vtu")
    solid = ours.extract_cells(ours.celltypes >= 10)
    theirs, patches = by_vtk(case)
    assert solid.n_cells == theirs.n_cells
    # VTK's reader orders the vertices of wedges so that their volume is negative.
    np.testing.assert_allclose(volumes(solid), np.abs(volumes(theirs)), rtol=1e-6)
    np.testing.assert_allclose(np.array(ours.bounds), theirs.bounds, rtol=1e-6)
    named = {key.split(":")[1]: int(ours.field_data[key][0]) for key in ours.field_data.keys() if key.startswith("patch:")}
    assert {name: int((ours.cell_data["patch"] == label).sum()) for name, label in named.items()} == patches
    return ours


MESHES = {
    "mixed": lambda path: shapes.mixed(2).save(path),
    "tets": lambda path: shapes.sphere_in_box(4, 4).save(path),
    "ball": lambda path: shapes.ball().save(path),
}


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
@pytest.mark.parametrize("name", MESHES)
def test_vtk_and_motet_read_cases_of_motet(motet, tmp_path, name, encoding):
    MESHES[name](tmp_path / "mesh.vtu")
    case = new_case(tmp_path / "case", encoding)
    motet("convert", tmp_path / "mesh.vtu", case / "constant" / "polyMesh", "--encoding", encoding)
    ours = same(motet, case, tmp_path)
    first = pyvista.read(tmp_path / "mesh.vtu")
    # The order and kinds of cells, and the coordinates, are exactly the same.
    assert np.array_equal(first.celltypes[first.celltypes >= 10], ours.celltypes[ours.celltypes >= 10])
    np.testing.assert_array_equal(first.points, ours.points)
    np.testing.assert_allclose(volumes(first), volumes(ours), rtol=1e-12, atol=1e-300)
    if shutil.which("checkMesh"):
        output = foam(case, "checkMesh", "-allTopology")
        assert "Boundary definition OK" in output and "Upper triangular ordering OK" in output and "Point usage OK" in output
        assert "Mesh OK" in output or name == "mixed", output


@has_openfoam
@pytest.mark.parametrize("form, packed", [("ascii", "off"), ("binary", "off"), ("ascii", "on"), ("binary", "on")])
def test_motet_and_vtk_read_cases_of_openfoam_alike(motet, tmp_path, form, packed):
    case = new_case(tmp_path / "case", form, packed)
    (case / "system" / "blockMeshDict").write_text(BLOCK)
    foam(case, "blockMesh")
    for given in (case, case / "constant" / "polyMesh", case / "case.foam"):
        ours = same(motet, case, tmp_path, given)
    assert (ours.celltypes == 12).sum() == 36


@has_openfoam
@pytest.mark.parametrize("form", ["ascii", "binary"])
def test_polyhedra_of_openfoam_are_read_and_written(motet, tmp_path, form):
    case = new_case(tmp_path / "case", form)
    shapes.ball().save(tmp_path / "ball.vtu")
    motet("convert", tmp_path / "ball.vtu", case / "constant" / "polyMesh")
    foam(case, "polyDualMesh", "75", "-overwrite")
    ours = same(motet, case, tmp_path)
    assert (ours.celltypes == 42).sum() > 100
    again = new_case(tmp_path / "again", form)
    motet("convert", tmp_path / "read.vtu", again / "constant" / "polyMesh", "--encoding", form)
    assert "Upper triangular ordering OK" in foam(again, "checkMesh")
    back = same(motet, again, tmp_path)
    np.testing.assert_array_equal(back.points, ours.points)


@has_openfoam
def test_cell_zones_are_read_as_regions(motet, tmp_path):
    for form in ("ascii", "binary"):
        case = new_case(tmp_path / form, form)
        (case / "system" / "blockMeshDict").write_text(BLOCK)
        (case / "system" / "topoSetDict").write_text(
            "FoamFile { version 2.0; format ascii; class dictionary; object topoSetDict; }\n"
            "actions ({ name left; type cellSet; action new; source boxToCell; box (0 0 0) (0.5 1 1); }"
            " { name left; type cellZoneSet; action new; source setToCellZone; set left; });\n")
        foam(case, "blockMesh")
        foam(case, "topoSet")
        motet("convert", case, tmp_path / "zones.vtu")
        zones = pyvista.read(tmp_path / "zones.vtu")
        left = zones.cell_data["region"] == zones.field_data["region:left"][0]
        assert 0 < left.sum() < 36 and (zones.cell_centers().points[left][:, 0] < 0.5).all()
        again = new_case(tmp_path / f"{form}-again")
        motet("convert", tmp_path / "zones.vtu", again / "constant" / "polyMesh", "--encoding", form)
        motet("convert", again, tmp_path / "back.vtu")
        back = pyvista.read(tmp_path / "back.vtu")
        np.testing.assert_array_equal(back.cell_data["region"] > 0, left)
