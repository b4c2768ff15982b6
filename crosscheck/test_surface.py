"""Adapted surfaces beside the given ones: distances both ways and volumes by VTK, angles by NumPy."""
import numpy as np
import pyvista as pv
import pytest

N_SAMPLES = 20_000


def ellipsoid_with_needles():
    """A coarse ellipsoid in which every third triangle has a vertex close to one of its edges."""
    mesh = pv.ParametricEllipsoid(1.0, 0.6, 0.4, u_res=40, v_res=40, w_res=10).triangulate().clean()
    points, faces = list(map(tuple, np.asarray(mesh.points, float))), []
    for k, (a, b, c) in enumerate(mesh.regular_faces):
        if k % 3:
            faces.append((a, b, c))
            continue
        points.append(tuple(np.array([0.02, 0.45, 0.53]) @ mesh.points[[a, b, c]]))
        new = len(points) - 1
        faces += [(a, b, new), (b, c, new), (c, a, new)]
    return pv.PolyData.from_regular_faces(np.array(points), np.array(faces))


SURFACES = {
    "needles": (ellipsoid_with_needles, 0.08),
    "cylinder": (lambda: pv.Cylinder(radius=0.5, height=3.0, resolution=24).triangulate().clean(), 0.12),
    "box": (lambda: pv.Box().triangulate().clean(), 0.2),
    "supertoroid": (lambda: pv.ParametricSuperToroid(n1=0.5, u_res=60, v_res=60, w_res=10).triangulate().clean(), 0.1),
}


def samples(surface, rng):
    """Return random points of a surface, uniformly by area."""
    corners = surface.points[surface.regular_faces].astype(float)
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = corners[rng.choice(len(corners), N_SAMPLES, p=areas / areas.sum())]
    u, v = rng.random((2, N_SAMPLES))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return chosen[:, 0] + u[:, None] * (chosen[:, 1] - chosen[:, 0]) + v[:, None] * (chosen[:, 2] - chosen[:, 0])


def farthest(points, surface):
    """Return the largest distance of points from a surface."""
    _, nearest = surface.find_closest_cell(points, return_closest_point=True)
    return np.linalg.norm(points - nearest, axis=1).max()


def least_angle(surface):
    a, b, c = np.moveaxis(surface.points[surface.regular_faces].astype(float), 1, 0)

    def angle(p, q, r):
        u, v = q - p, r - p
        return np.degrees(np.arccos(np.einsum("ij,ij->i", u, v) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)))

    return min(angle(*corners).min() for corners in [(a, b, c), (b, c, a), (c, a, b)])


@pytest.mark.parametrize("turned", [False, True], ids=["as_is", "turned"])
@pytest.mark.parametrize("name", SURFACES)
def test_an_adapted_surface_is_near_and_even(motet, tmp_path, name, turned):
    make, size = SURFACES[name]
    given = make()
    given.points = np.asarray(given.points, float)
    if turned:
        given = given.rotate_vector((1, 2, 3), 37.0).translate((100.0, -50.0, 7.0))
    given.save(tmp_path / "given.vtp")
    distance = 0.002 * max(given.bounds[2 * k + 1] - given.bounds[2 * k] for k in range(3))
    report = motet.json("mesh", tmp_path / "given.vtp", "-o", tmp_path / "filled.vtu", "--repair", "--size", size,
                        "--surface", "adapt", "--distance", distance)
    filled = pv.read(tmp_path / "filled.vtu")
    adapted = filled.extract_cells(filled.celltypes == pv.CellType.TRIANGLE).extract_surface(algorithm=None)
    assert adapted.n_open_edges == 0 and adapted.is_manifold
    rng = np.random.default_rng(1)
    both = farthest(samples(adapted, rng), given), farthest(samples(given, rng), adapted)
    assert max(both) <= distance, both
    assert report["quality"]["worst"] >= 0.2
    assert least_angle(adapted) > 20
    assert abs(adapted.volume - given.volume) <= distance * given.area
    assert abs(filled.compute_cell_sizes().cell_data["Volume"].sum() - abs(adapted.volume)) < 1e-6 * given.volume


def vessel():
    """A bent tube without ends, narrowed in the middle, of narrow triangles, with a patch at each end."""
    n_around, n_along = 60, 14
    u, v = np.meshgrid(np.arange(n_around) * 2 * np.pi / n_around, np.linspace(0.0, 1.0, n_along))
    radius = 0.6 - 0.25 * np.exp(-((v - 0.5) * 6) ** 2)
    bend = 1.2 * v
    across = 3.0 + radius * np.cos(u)
    points = np.column_stack([(across * np.cos(bend)).ravel(), (across * np.sin(bend)).ravel(), (radius * np.sin(u)).ravel()])
    i, j = np.meshgrid(np.arange(n_around), np.arange(n_along - 1))
    a, b = (j * n_around + i).ravel(), (j * n_around + (i + 1) % n_around).ravel()
    mesh = pv.PolyData.from_regular_faces(points, np.concatenate([np.column_stack([a, b, b + n_around]), np.column_stack([a, b + n_around, a + n_around])]))
    mesh.cell_data["patch"] = np.tile(np.where(j.ravel() < (n_along - 1) // 2, 1, 2), 2).astype(np.int32)
    return mesh


OPEN = {
    "vessel": (vessel, 0.2),
    "tube": (lambda: pv.Cylinder(radius=0.5, height=3.0, resolution=48, capping=False).triangulate().clean(), 0.15),
    "ring": (lambda: pv.Disc(inner=0.5, outer=2.0, r_res=2, c_res=60).triangulate().clean(), 0.25),
    "half": (lambda: ellipsoid_with_needles().clip("z", origin=(0, 0, 0.05)).extract_surface(algorithm=None).triangulate().clean(), 0.08),
}


def rim_length(surface):
    rims = surface.extract_feature_edges(boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False)
    return rims.compute_cell_sizes().cell_data["Length"].sum()


@pytest.mark.parametrize("name", OPEN)
def test_an_open_surface_is_near_and_even_and_its_arrays_are_carried(motet, tmp_path, name):
    make, size = OPEN[name]
    given = make()
    given.points = np.asarray(given.points, float)
    given.point_data["f"] = given.points @ [1.0, -2.0, 0.5]
    given.save(tmp_path / "given.vtp")
    distance = 0.004 * max(given.bounds[2 * k + 1] - given.bounds[2 * k] for k in range(3))
    report = motet.json("surface", tmp_path / "given.vtp", "-o", tmp_path / "even.vtp", "--size", size, "--distance", distance)
    even = pv.read(tmp_path / "even.vtp")
    rng = np.random.default_rng(2)
    both = farthest(samples(even, rng), given), farthest(samples(given, rng), even)
    assert max(both) <= distance, both
    # Measured at corners, middles and centroids; in between it can be larger.
    for ours, theirs in zip((report["to_given"], report["from_given"]), both):
        assert ours <= 1.01 * distance and theirs <= 2.0 * ours + 1e-12
    assert least_angle(even) == pytest.approx(report["after"]["angles"]["worst"], abs=1e-3)
    assert least_angle(given) == pytest.approx(report["before"]["angles"]["worst"], abs=1e-3)
    assert least_angle(even) > 18
    assert even.area == pytest.approx(report["after"]["area"], rel=1e-5)
    assert given.n_open_edges and report["before"]["rims"] == report["after"]["rims"]
    assert rim_length(even) == pytest.approx(rim_length(given), rel=0.03)
    # Values come from a place of the given surface that is that near.
    np.testing.assert_allclose(even.point_data["f"], even.points @ [1.0, -2.0, 0.5], atol=1.01 * np.linalg.norm([1.0, -2.0, 0.5]) * distance)
    if "patch" in given.cell_data:
        assert set(np.unique(even.cell_data["patch"])) == {1, 2}
        for label in (1, 2):
            areas = [s.extract_cells(np.flatnonzero(s.cell_data["patch"] == label)).area for s in (given, even)]
            assert areas[0] == pytest.approx(areas[1], rel=0.03)
