"""Names of regions and patches, passed to PyVista and meshio and back, in memory and by files."""
import numpy as np
import pytest
from test_mesh import same

import motet
from motet import shapes

meshio = pytest.importorskip("meshio")
pyvista = pytest.importorskip("pyvista")


def two_regions():
    """Two bodies side by side, one of tets and one of wedges and tets.

    A region and a patch have the same name, and some labels have none.
    """
    first, second = shapes.box((2, 2, 2)), shapes.tube(n=1, slices=2, wall_layers=1, wall_cells="wedges")
    points = np.concatenate([first.points, second.points + [5.0, 0.0, 0.0]])
    cells, region, patch = [], [], []
    for mesh, shift, label in ((first, 0, 7), (second, first.n_points, 3)):
        for kind in ("tetra", "wedge", "triangle"):
            rows = mesh.cells(kind)
            if len(rows):
                cells.append((kind, rows + shift))
                is_surface = kind == "triangle"
                region.append(np.full(len(rows), 0 if is_surface else label, np.int32))
                patch.append(np.where(is_surface, mesh.cell_data["patch"][mesh.cell_ids(kind)] + label, 0).astype(np.int32))
    return motet.Mesh(
        points, cells, cell_data={"region": np.concatenate(region), "patch": np.concatenate(patch)},
        region_names={7: "wall", 3: "blood: outer"}, patch_names={4: "wall", 5: "inlet", 6: "outlet", 8: "a-b_c"},
    )  # fmt: skip


ALL = [two_regions, shapes.sphere_in_box, shapes.aneurysm, shapes.mixed]


def names(mesh):
    return mesh.region_names, mesh.patch_names


@pytest.mark.parametrize("shape", ALL)
def test_conversion_in_memory_preserves_names(shape):
    mesh = shape()
    assert mesh.patch_names
    for back in (motet.as_mesh(mesh.to_pyvista()), motet.as_mesh(mesh.to_meshio())):
        assert names(back) == names(mesh)
        same(back, mesh)
        assert not back.field_data


@pytest.mark.parametrize("shape", ALL)
@pytest.mark.parametrize("ending", [".vtu", ".vtk"])
def test_files_written_by_motet_contain_the_names(shape, ending, tmp_path):
    mesh, path = shape(), tmp_path / f"mesh{ending}"
    mesh.save(path)
    assert names(motet.as_mesh(pyvista.read(path))) == names(mesh)
    if ending == ".vtu":
        assert names(motet.as_mesh(meshio.read(path))) == names(mesh)


@pytest.mark.parametrize("shape", ALL)
def test_files_written_by_pyvista_contain_the_names(shape, tmp_path):
    mesh, path = shape(), tmp_path / "mesh.vtu"
    mesh.to_pyvista().save(path)
    for back in (motet.read(path), motet.as_mesh(pyvista.read(path)), motet.as_mesh(meshio.read(path))):
        assert names(back) == names(mesh)
        np.testing.assert_array_equal(back.cell_data["patch"], mesh.cell_data["patch"])


def test_labels_of_64_bits_have_names(tmp_path):
    """Programs that use numpy's default integers write labels this way."""
    grid = shapes.aneurysm().to_pyvista()
    for name in grid.field_data.keys():
        grid.field_data[name] = np.asarray(grid.field_data[name], np.int64)
    grid.save(tmp_path / "mesh.vtu")
    assert names(motet.read(tmp_path / "mesh.vtu")) == names(shapes.aneurysm())


def test_surfaces_of_pyvista_keep_their_names():
    surface = shapes.aneurysm().to_pyvista().extract_surface(algorithm="dataset_surface")
    surface.field_data["patch:inlet"] = np.array([2])
    assert motet.as_mesh(surface).patch_names[2] == "inlet"


def test_other_field_data_are_preserved():
    mesh = shapes.box((1, 1, 1))
    mesh.field_data = {"time": np.array([0.25]), "pair": np.array([1, 2]), "patch": np.array([3]), "region:x": np.array([0.5]), "who": ["me", "you"]}
    for back in (motet.as_mesh(mesh.to_pyvista()), motet.as_mesh(mesh.to_meshio())):
        assert back.field_data.keys() == mesh.field_data.keys() and names(back) == names(mesh)
        np.testing.assert_array_equal(back.field_data["pair"], [1, 2])
        assert back.field_data["who"] == ["me", "you"]


def test_names_become_cell_sets_of_meshio():
    mesh = two_regions()
    given = mesh.to_meshio()
    starts = np.cumsum([0] + [len(block) for block in given.cells])
    cells = lambda name: np.concatenate([ids + start for ids, start in zip(given.cell_sets[name], starts)])  # noqa: E731
    np.testing.assert_array_equal(cells("inlet"), np.flatnonzero(mesh.cell_data["patch"] == 5))
    np.testing.assert_array_equal(cells("blood: outer"), np.flatnonzero(mesh.cell_data["region"] == 3))
    both = (mesh.cell_data["region"] == 7) | (mesh.cell_data["patch"] == 4)
    np.testing.assert_array_equal(cells("wall"), np.flatnonzero(both))
    # Without field data, names are restored from the sets.
    given.field_data = {}
    assert names(motet.as_mesh(given)) == names(mesh)


def test_cell_sets_of_meshio_become_labels():
    """Files of Abaqus, for example, have sets but no labels."""
    box = shapes.box((2, 1, 1))
    blocks = [("tetra", box.tets.astype(np.int64)), ("triangle", box.triangles.astype(np.int64))]
    n = len(box.tets)
    sets = {"all": [np.arange(n), np.arange(0)], "left": [np.arange(n // 2), None], "floor": [np.arange(0), np.array([0, 3])]}
    mesh = motet.as_mesh(meshio.Mesh(box.points, blocks, cell_sets=sets))
    summary = mesh.summary()
    assert summary.regions["left"].cells == n // 2 and summary.regions["all"].cells == n - n // 2
    assert summary.patches["floor"].cells == 2


def test_physical_groups_of_gmsh_are_the_same_for_meshio_and_motet(tmp_path):
    """Both read the same names, and meshio writes files with groups from meshes that have them."""
    mesh, path = two_regions(), tmp_path / "mesh.msh"
    # meshio knows only one group per name, not one for each dimension.
    mesh.patch_names[4] = "side"
    mesh.save(path)
    read = motet.read(path)
    assert names(read) == names(mesh)
    by_meshio = motet.as_mesh(meshio.read(path))
    assert names(by_meshio) == names(read)
    again = tmp_path / "again.msh"
    given = by_meshio.to_meshio()
    given.cell_sets = {}
    meshio.write(again, given, file_format="gmsh22")
    assert names(motet.read(again)) == names(read)
