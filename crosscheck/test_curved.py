"""Jacobians of quadratic cells compared with Gmsh, for a moved mesh and for each kind of cell."""
import numpy as np
import pytest

gmsh = pytest.importorskip("gmsh")
meshio = pytest.importorskip("meshio")


@pytest.fixture
def model():
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield gmsh.model
    gmsh.finalize()


def qualities(path):
    """Return `minDetJac` and `minSJ` of the volume cells of a file, by Gmsh."""
    gmsh.open(str(path))
    tags = np.concatenate(gmsh.model.mesh.getElements(3)[1])
    return [np.array(gmsh.model.mesh.getElementQualities(tags, name)) for name in ("minDetJac", "minSJ")]


def sampled(points, cells, n=12):
    """Return the least scaled Jacobian of all quadratic tets, by its definition, at the points of a grid.

    The scaled Jacobian is `det J` over that of the tet with straight edges.
    """
    edges = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    slopes = np.array([[-1, -1, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    nodes = points[cells]
    straight = np.linalg.det(nodes[:, 1:4] - nodes[:, :1])
    least = np.inf
    for i, j, k in np.ndindex(n + 1, n + 1, n + 1):
        if i + j + k <= n:
            at = np.array([n - i - j - k, i, j, k]) / n
            slope = [(4 * at[a] - 1) * slopes[a] for a in range(4)] + [4 * (at[a] * slopes[b] + at[b] * slopes[a]) for a, b in edges]
            least = min(least, (np.linalg.det(np.einsum("cni,nj->cij", nodes, np.array(slope))) / straight).min())
    return least


def sphere_in_box(path):
    """Write a box with a spherical hole, of quadratic tets that are curved at the sphere."""
    occ = gmsh.model.occ
    box, ball = occ.addBox(-2, -2, -2, 4, 4, 4), occ.addSphere(0, 0, 0, 0.8)
    occ.cut([(3, box)], [(3, ball)])
    occ.synchronize()
    surfaces = [tag for _, tag in gmsh.model.getEntities(2)]
    is_ball = [gmsh.model.getType(2, tag) == "Sphere" for tag in surfaces]
    for name, wanted in (("ball", True), ("box", False)):
        gmsh.model.addPhysicalGroup(2, [t for t, b in zip(surfaces, is_ball) if b == wanted], name=name)
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], name="fluid")
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.7)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.9)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.option.setNumber("Mesh.RandomSeed", 1)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(path))


def test_scaled_jacobians_of_a_moved_curved_mesh_agree_with_gmsh(motet, tmp_path, model):
    first, moved = tmp_path / "first.msh", tmp_path / "moved.msh"
    sphere_in_box(first)
    for options in ([], ["--method", "elastic"], ["--method", "bodies"]):
        report = motet.json("move", first, "-o", moved, "--translate", "ball=0.2,0.05,0", "--steps", 3, *options)
        determinants, scaled = qualities(moved)
        worst = report["after"]["worst_curved_jacobian"]
        print(options, worst["value"], "Gmsh:", scaled.min(), determinants.min())
        assert report["complete"] and report["after"]["inverted"] == (determinants <= 0).sum() == 0
        mesh = meshio.read(moved)
        least = sampled(mesh.points, mesh.cells_dict["tetra10"])
        # Gmsh gives a lower bound; values at grid points are upper bounds of the minimum.
        assert scaled.min() - 1e-5 <= worst["value"] <= least + 1e-9 and least - worst["value"] < 0.05
        nodes = mesh.points[mesh.cells_dict["tetra10"]]
        # Edges that are not on a surface are straight.
        surface = np.unique(mesh.cells_dict["triangle6"])
        edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
        off = np.stack([nodes[:, 4 + m] - nodes[:, list(e)].mean(1) for m, e in enumerate(edges)], 1)
        inner = ~np.isin(mesh.cells_dict["tetra10"][:, 4:], surface)
        assert np.abs(off[inner]).max() < 1e-6


def test_cells_folded_in_their_interior_are_those_of_gmsh(motet, tmp_path, model):
    first = tmp_path / "first.msh"
    sphere_in_box(first)
    mesh = meshio.read(first)
    rng = np.random.default_rng(5)
    cells = mesh.cells_dict["tetra10"]
    middles = np.unique(cells[:, 4:])
    shaken = rng.choice(middles, len(middles) // 4, replace=False)
    mesh.points[shaken] += rng.uniform(-0.22, 0.22, (len(shaken), 3))
    path = tmp_path / "shaken.vtu"
    meshio.write(path, meshio.Mesh(mesh.points, [("tetra10", cells)]))
    motet("convert", path, tmp_path / "shaken.msh")
    determinants, scaled = qualities(tmp_path / "shaken.msh")
    report = motet.json("info", path)
    folded = sum(d["count"] for d in report["defects"] if d["name"] == "folded_cell")
    print(f"\n{folded} of {len(cells)} cells are folded; least scaled Jacobian {report['curved']['min_scaled_jacobian']}, Gmsh's {scaled.min()}")
    assert 0 < folded == (determinants <= 0).sum() < len(cells)
    assert report["inverted"] == folded
    assert abs(report["curved"]["min_scaled_jacobian"] - scaled.min()) < 1e-5 * np.abs(scaled).max()


@pytest.mark.parametrize(("kind", "number"), [
    ("tetra10", 11),
    ("hexahedron20", 17), ("hexahedron27", 12), ("wedge15", 18), ("wedge18", 13), ("pyramid13", 19),
])
def test_folded_cells_of_each_kind_have_negative_samples_of_gmsh_s_jacobian(motet, tmp_path, model, kind, number):
    """Samples of the determinant by Gmsh's shape functions: negative in reported cells, positive in the
    others."""
    gmsh_model = model
    name, _, _, n, local, _ = gmsh_model.mesh.getElementProperties(number)
    local = np.array(local).reshape(n, 3)
    t = np.linspace(0, 1, 17)
    grid = np.stack(np.meshgrid(t, t, t, indexing="ij"), -1).reshape(-1, 3)
    if kind == "tetra10":
        places = grid[grid.sum(1) <= 1 + 1e-12]
    elif kind.startswith("wedge"):
        places = grid[grid[:, :2].sum(1) <= 1 + 1e-12] * [1, 1, 2] - [0, 0, 1]
    elif kind.startswith("hexahedron"):
        places = 2 * grid - 1
    else:
        up = 0.999 * grid[:, 2:]
        places = np.hstack([(2 * grid[:, :2] - 1) * (1 - up), up])
    gradients = np.array(gmsh_model.mesh.getBasisFunctions(number, places.ravel(), "GradLagrange")[1])
    gradients = gradients.reshape(len(places), n, 3)
    rng = np.random.default_rng(number)
    nodes = local + rng.uniform(-1, 1, (60, n, 3)) * np.repeat([0.02, 0.12, 0.25], 20)[:, None, None]
    determinants = np.linalg.det(np.einsum("pnk,cnx->cpxk", gradients, nodes))
    low = determinants.min(1)
    # All cells in one mesh of Gmsh; motet converts the order of nodes.
    gmsh_model.add("cells")
    gmsh_model.addDiscreteEntity(3, 1)
    far = nodes + 10.0 * np.arange(60)[:, None, None] * [1, 0, 0]
    gmsh_model.mesh.addNodes(3, 1, np.arange(1, 60 * n + 1), far.ravel())
    gmsh_model.mesh.addElementsByType(1, number, np.arange(1, 61), np.arange(1, 60 * n + 1))
    path = tmp_path / "cells.msh"
    gmsh.write(str(path))
    report = motet.json("info", path)
    inverted = report["inverted"]
    print(f"\n{kind}: {inverted} of 60 reported, {(low <= 0).sum()} by samples; least scaled Jacobian {report['curved']['min_scaled_jacobian']}")
    # Slightly negative determinants can lie between the samples.
    assert (low <= 0).sum() <= inverted <= (low <= 0.02 * determinants.max(1)).sum()
    assert 0 < inverted < 60
