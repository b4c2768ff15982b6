"""Rebuilds figure 11 of the paper: a sphere moves along a channel, bad tets are counted and repaired (writes docs/paper_11.png, prints three tables).

    target/venv/bin/python examples/paper/figure_11.py

The mesh follows as an elastic body, as in the paper, (a) to (b) in four equal steps to the right; (c) is (b) repaired. The first table has these steps, all
from the first place, each repaired for itself; the second a longer way, repaired after every step of it; the third the same way as a moving mesh, which keeps what it was.
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
    """The room between a box and a sphere in it."""
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
    """The mesh after its sphere has moved along x, as an elastic body; nothing is checked on the way."""
    import motet

    mover = motet.Mover(mesh, method="elastic")
    on_sphere = np.isin(mover.boundary, mesh.patch_vertices("sphere"))
    moved = mesh.copy()
    moved.points = mover.step(np.where(on_sphere[:, None], (way, 0.0, 0.0), 0.0))
    return moved


def counts(mesh):
    q = tet_quality(mesh)
    return [np.count_nonzero(q < BAD), np.count_nonzero(q <= 0.0), f"{q.min():.3f}"]


def from_the_first_place(mesh):
    """The meshes of the first table, and the last of them repaired."""
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
    """Moves and repairs in turn."""
    import motet

    rows = []
    for k in range(1, STEPS + 1):
        moved = elastic(mesh, STEP)
        mesh = motet.remesh(moved).mesh
        rows.append([f"{k * STEP:g}", *counts(moved), *counts(mesh), f"{tet_quality(mesh).mean():.3f}", f"{len(mesh.tets):,}"])
    print_table(["way", "bad", "inverted", "worst EAS", "bad, repaired", "inverted", "worst EAS", "mean EAS", "tets"], rows)


def as_a_moving_mesh(mesh):
    """The same way; what a repair changes is improved, vertices are kept, and a band beside the sphere takes the strain."""
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


def panel(mesh, words):
    drawn = grid(mesh)
    plotter = lit(drawn, PANEL)
    cells = behind(drawn, 1)
    plotter.add_mesh(cells, scalars="EAS", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, **EDGES)
    plotter.add_mesh(poly(mesh, patch_triangles(mesh, "sphere")), color="#b9c6d2", **EDGES)
    bad = np.count_nonzero(drawn["EAS"] < BAD)
    centre = 0.5 * (LOW + HIGH) + (0.05, 0.0, 0.12)
    return seen_straight(plotter, centre, (-4.0, -40.0, 9.0), (0.0, 0.0, 1.0), 2.5), f"{words}: {bad or 'no'} bad tet{'' if bad == 1 else 's'}"


def main():
    mesh = channel()
    print(f"{mesh.n_points:,} vertices, {len(mesh.tets):,} tets, worst EAS {tet_quality(mesh).min():.3f}, mean {tet_quality(mesh).mean():.3f}; radius of the sphere {RADIUS:g}\n")
    moved, repaired = from_the_first_place(mesh)
    words = [f"moved by {way:g}" for way in SHIFTS]
    words[0], words[-1] = f"(a) {words[0]}", f"(b) {words[-1]}"
    meshes = [mesh, *moved, repaired]
    pictures = [panel(one, word) for one, word in zip(meshes, ["the first place", *words, "(c) repaired"])]
    save_sheet(pictures, DOCS / "paper_11.png", 2, colour_bar)
    print()
    step_by_step(mesh)
    print()
    as_a_moving_mesh(mesh)


if __name__ == "__main__":
    main()
