"""The point sets of the Delaunay benchmark, each an (n, 3) array of f64."""
import numpy as np

from meshes import HALF_EDGE, RADIUS, sphere_in_box


def cube(n):
    return np.random.default_rng(n).random((n, 3))


def surface(name, folder):
    """Return the boundary vertices of a sphere in a box: cospherical and coplanar, as usual in
    mesh motion."""
    points, _, sphere, walls = sphere_in_box(name, folder)
    return points[np.concatenate([sphere, walls])]


def spiral_sphere(n):
    """Return points on the unit sphere along a golden spiral, of uniform density."""
    turn = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(n)
    z = 1.0 - (2.0 * np.arange(n) + 1.0) / n
    r = np.sqrt(1.0 - z * z)
    return np.column_stack([r * np.cos(turn), r * np.sin(turn), z])


def large_surface(n):
    """Return points of which a third are on the sphere, and the others random on the six walls, one in each
    square."""
    random = np.random.default_rng(7)
    on_sphere = n // 3
    side = int(np.sqrt((n - on_sphere) / 6))
    step = 2.0 * HALF_EDGE / side
    corner = np.stack(np.meshgrid(np.arange(side), np.arange(side), indexing="ij"), -1).reshape(-1, 2)
    parts = [RADIUS * spiral_sphere(on_sphere),
             HALF_EDGE * np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])]
    for axis in range(3):
        for level in (-HALF_EDGE, HALF_EDGE):
            flat = (corner + random.uniform(0.1, 0.9, corner.shape)) * step - HALF_EDGE
            parts.append(np.insert(flat, axis, level, axis=1))
    return np.vstack(parts)


def turned(points):
    """Rotate and shift points such that no wall is parallel to an axis, or exactly planar."""
    axis = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
    angle = 0.7
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    rotation = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return points @ rotation.T + np.array([0.123, 4.56, -7.89])


def grid(n, step=0.1):
    """Return a regular grid; it is regular only up to rounding, since `step` is not a binary fraction."""
    line = np.arange(n) * step
    return np.stack(np.meshgrid(line, line, line, indexing="ij"), -1).reshape(-1, 3)


def moment_curve(n):
    """(t, t^2, t^3): every pair of points is an edge, (n-2)(n-3)/2 tets."""
    t = np.linspace(-1.0, 1.0, n)
    return np.column_stack([t, t**2, t**3])


def skew_lines(n):
    """n/2 points on each of two lines that cross at a right angle without meeting: (n/2 - 1)^2 tets."""
    t, zero = np.linspace(-1.0, 1.0, n // 2), np.zeros(n // 2)
    return np.vstack([np.column_stack([t, zero, zero]), np.column_stack([zero, t, zero + 1.0])])


def duplicates(n):
    """Return n/200 random points, each repeated 200 times, in random order."""
    random = np.random.default_rng(3)
    return random.permutation(np.repeat(random.random((n // 200, 3)), 200, axis=0))


def scales(n):
    """Return points around the origin at distances over 24 orders of magnitude."""
    random = np.random.default_rng(5)
    direction = random.normal(size=(n, 3))
    return direction * 10.0 ** random.uniform(-12.0, 12.0, (n, 1))


def point_sets(folder, largest):
    """Yield (group, name, points) of every set with at most `largest` points."""
    sizes = (1_000, 10_000, 100_000, 1_000_000)
    makers = [("cube", f"cube {n:,}", lambda n=n: cube(n), n) for n in sizes]
    makers += [("surface", f"surface {name}", lambda name=name: surface(name, folder), 17_000) for name in "ABCD"]
    makers += [
        ("surface", "surface D turned", lambda: turned(surface("D", folder)), 17_000),
        ("surface", "surface 200k", lambda: large_surface(200_000), 200_000),
        ("surface", "surface 200k turned", lambda: turned(large_surface(200_000)), 200_000),
        ("grid", "grid 50^3", lambda: grid(50), 125_000),
        ("adversarial", "moment curve 1,000", lambda: moment_curve(1_000), 1_000),
        ("adversarial", "two skew lines 2,000", lambda: skew_lines(2_000), 2_000),
        ("adversarial", "1,000 places, 200k points", lambda: duplicates(200_000), 200_000),
        ("adversarial", "24 decades, 100k points", lambda: scales(100_000), 100_000),
    ]
    for group, name, make, size in makers:
        if size <= largest:
            yield group, name, make()
