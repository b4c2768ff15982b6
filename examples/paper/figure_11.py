"""Reproduces figure 11 of the paper: bad tets around a sphere that moves along a channel, and their repair.

    target/venv/bin/python examples/paper/figure_11.py

Writes docs/paper_11.png and prints three tables. The mesh follows as an elastic body, as in the paper: from
(a) to (b) the sphere moves by four equal shifts; (c) is (b) repaired. The first table contains these shifts,
all from the initial position and each repaired separately; the second a longer motion that is repaired after
every step; the third the same motion with a `MovingMesh`, which keeps the initial quality.
"""
import numpy as np
from common import BAD, DOCS, behind, grid, patch_triangles, poly, print_table, surface
from pictures import EDGES, QUALITY, RANGE, colour_bar, lit, save_sheet, seen_straight

PANEL = (600, 236)
RADIUS = 0.5
LOW, HIGH = np.array([-1.5, -1.0, -1.0]), np.array([4.5, 1.0, 1.0])
SIZE = 0.2
PAPER = (1, 66, 265, 598)
SHIFTS = (0.2, 0.4, 0.6, 0.8)
STEP, STEPS = 0.2, 15


def channel():
    """Return a mesh of the space between a box and a sphere."""
    import motet
    from motet import shapes

    n = np.round((HIGH - LOW) / SIZE).astype(int)
    box, around = shapes.box(tuple(n), LOW, HIGH), shapes.sphere_in_box(8, 1)
    sphere = surface(RADIUS * around.points, patch_triangles(around, "sphere"), "sphere")
    walls = surface(box.points, box.triangles, "walls")
    return motet.mesh({"walls": walls, "sphere": sphere}, holes=[(0.0, 0.0, 0.0)], size=SIZE, growth=0.3).mesh


def tet_quality(mesh):
    return mesh.quality()[mesh.cell_ids("tetra")]


def elastic(mesh, way):
    """Return the mesh moved as an elastic body, with the sphere displaced along x, without any check."""
    import motet

    mover = motet.Mover(mesh, method="elastic")
    on_sphere = np.isin(mover.boundary, mesh.patch_vertices("sphere"))
    moved = mesh.copy()
    moved.points = mover.step(np.where(on_sphere[:, None], (way, 0.0, 0.0), 0.0))
    return moved


def counts(mesh):
    q = tet_quality(mesh)
    return [np.count_nonzero(q < BAD), np.count_nonzero(q <= 0.0), f"{q.min():.3f}"]


def from_initial_position(mesh):
    """Print the first table; return its meshes, and the last of them repaired."""
    import motet

    moved = [elastic(mesh, way) for way in SHIFTS]
    repaired = [motet.remesh(one) for one in moved]
    rows = [
        [f"{way:g}", paper, *counts(one), *counts(done.mesh), f"{100 * done.report.kept_share:.1f} %"]
        for way, paper, one, done in zip(SHIFTS, PAPER, moved, repaired)
    ]
    print_table(["way", "bad, paper", "bad", "inverted", "worst EAS", "bad, repaired", "inverted", "worst EAS", "kept"], rows)
    return moved, repaired[-1].mesh


def step_by_step(mesh):
    """Print the second table: each step is followed by a repair."""
    import motet

    rows = []
    for k in range(1, STEPS + 1):
        moved = elastic(mesh, STEP)
        mesh = motet.remesh(moved).mesh
        rows.append([f"{k * STEP:g}", *counts(moved), *counts(mesh), f"{tet_quality(mesh).mean():.3f}", f"{len(mesh.tets):,}"])
    print_table(["way", "bad", "inverted", "worst EAS", "bad, repaired", "inverted", "worst EAS", "mean EAS", "tets"], rows)


def as_a_moving_mesh(mesh):
    """Print the third table: a `MovingMesh` improves what a repair changes, and strains only a band at the
    sphere."""
    import motet

    moving = motet.MovingMesh(mesh, method="bodies", strain="band", smooth=2)
    places = moving.driven_places
    on_sphere = np.linalg.norm(places, axis=1) < 1.01 * RADIUS
    rows = []
    for k in range(1, STEPS + 1):
        moving.advance(k, np.where(on_sphere[:, None], (k * STEP, 0.0, 0.0), 0.0))
        q = tet_quality(moving.mesh)
        rows.append([f"{k * STEP:g}", *counts(moving.mesh), f"{np.quantile(q, 0.01):.3f}", f"{q.mean():.3f}", f"{moving.mesh.n_points:,}", f"{len(q):,}"])
    print_table(["way", "bad", "inverted", "worst EAS", "1 % below", "mean EAS", "vertices", "tets"], rows)


def panel(mesh, caption):
    drawn = grid(mesh)
    plotter = lit(drawn, PANEL)
    cells = behind(drawn, 1)
    plotter.add_mesh(cells, scalars="EAS", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, **EDGES)
    plotter.add_mesh(poly(mesh, patch_triangles(mesh, "sphere")), color="#b9c6d2", **EDGES)
    bad = np.count_nonzero(drawn["EAS"] < BAD)
    centre = 0.5 * (LOW + HIGH) + (0.05, 0.0, 0.12)
    return seen_straight(plotter, centre, (-4.0, -40.0, 9.0), (0.0, 0.0, 1.0), 2.5), f"{caption}: {bad or 'no'} bad tet{'' if bad == 1 else 's'}"


def main():
    mesh = channel()
    print(f"{mesh.n_points:,} vertices, {len(mesh.tets):,} tets, worst EAS {tet_quality(mesh).min():.3f}, mean {tet_quality(mesh).mean():.3f}; radius of the sphere {RADIUS:g}\n")
    moved, repaired = from_initial_position(mesh)
    captions = [f"moved by {way:g}" for way in SHIFTS]
    captions[0], captions[-1] = f"(a) {captions[0]}", f"(b) {captions[-1]}"
    meshes = [mesh, *moved, repaired]
    pictures = [panel(one, caption) for one, caption in zip(meshes, ["initial position", *captions, "(c) repaired"])]
    save_sheet(pictures, DOCS / "paper_11.png", 2, colour_bar)
    print()
    step_by_step(mesh)
    print()
    as_a_moving_mesh(mesh)


if __name__ == "__main__":
    main()
