"""meshio reads and writes files of formats that only motet knows."""
import numpy as np
import pytest

from motet import shapes

meshio = pytest.importorskip("meshio")


@pytest.mark.parametrize("ending", [".vtp", ".unv", ".elem"])
def test_meshio_writes_and_reads_formats_of_motet(ending, tmp_path):
    import motet.meshio  # noqa: F401

    mesh = shapes.sphere_in_box(2, 2)
    if ending == ".vtp":
        mesh = type(mesh)(mesh.points, mesh.triangles)
    path = tmp_path / f"mesh{ending}"
    meshio.write(path, mesh.to_meshio())
    back = meshio.read(path)
    assert len(back.points) == mesh.n_points
    assert sum(len(block.data) for block in back.cells) == mesh.n_cells
    assert np.allclose(back.points, mesh.points, atol=1e-6)


def test_what_meshio_reads_itself_stays_so():
    import motet.meshio  # noqa: F401

    assert meshio.extension_to_filetypes[".vtu"] == ["vtu"] and meshio.extension_to_filetypes[".unv"] == ["motet.unv"]
