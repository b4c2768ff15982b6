"""Reproduces figure 6 of the paper: division of a tet and its neighbours (writes docs/paper_6.png, prints two
tables).

    target/venv/bin/python examples/paper/figure_6.py

One of three regular tets (a) is divided into eight; the others are cut to conform: (b) shares an edge with
it, (c) a facet. The upper row shows the new edges, the lower row the separated parts, coloured by quality.
Then a mesh is divided repeatedly around one point, and its quality is compared with that of a mesh whose
divisions are forgotten after each generation, so that cut pieces are divided again.
"""
import numpy as np
import pyvista as pv
from common import DOCS, grid, print_table
from pictures import COPPER, EDGES, INK, QUALITY, RANGE, colour_bar, lit, save_sheet, seen_straight

PANEL = (420, 320)
GENERATIONS = 8
APART = 0.5
HEIGHT, LIFT = 3.9, 0.3
PLACE = ((1.7, 0.3, 0.2), 0.02)
# For each panel, the camera's direction and the upward direction.
VIEWS = (((12.0, -8.0, 2.0), (1.0, 1.0, 1.0)), ((9.0, -14.0, 7.0), (0.0, 0.0, 1.0)), ((9.0, -14.0, 7.0), (0.0, 0.0, 1.0)))


def regular():
    """Return three regular tets: one, one that shares a facet with it, and one that shares an edge with it.

    A fourth, separate tet is flat: without it motet would divide all three, since no part may be much worse
    than the worst tet of the mesh.
    """
    import motet

    points = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    points.append(mirrored(points, (0, 1, 2), 3))
    points.append(mirrored(points, (0, 1, 4), 2))
    flat = np.array([[9, 0, 0], [10, 0, 0], [9, 1, 0], [9.3, 0.3, 0.2]])
    points = np.vstack([points, flat])
    tets = ([0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 4, 5], [6, 7, 8, 9])
    return motet.Mesh(points, np.array([upright(points, tet) for tet in tets]))


def mirrored(points, facet, v):
    """Return the mirror image of a vertex of a regular tet beyond the opposite facet."""
    return 2.0 * np.mean([points[i] for i in facet], axis=0) - points[v]


def upright(points, tet):
    a, b, c, d = points[tet]
    return tet if np.linalg.det([b - a, c - a, d - a]) > 0 else [tet[1], tet[0], *tet[2:]]


def divided(mesh):
    """Return the mesh with its first tet divided, and the original cell of each cell."""
    import motet

    refinement = motet.Refinement(mesh)
    history, _ = refinement.refine([0])
    return refinement.mesh, history.cell_to_main


def apart(drawn):
    """Return the cells moved away from their common centre."""
    middle = drawn.cell_centers().points.mean(axis=0)
    parts = [drawn.extract_cells([i]) for i in range(drawn.n_cells)]
    return pv.merge([part.translate(APART * (np.array(part.center) - middle)) for part in parts], merge_points=False)


def upper_panel(parts, whole, view):
    """Return an image of a tet with its new edges and new vertices."""
    plotter = lit(whole, PANEL)
    plotter.add_mesh(whole, color="#e8ecf0", opacity=0.35, ambient=0.6, diffuse=0.4)
    plotter.add_mesh(parts.extract_all_edges(), color=COPPER, line_width=2.0, lighting=False)
    plotter.add_mesh(whole.extract_all_edges(), color=INK, line_width=2.5, lighting=False)
    new = [p for p in parts.points if np.linalg.norm(whole.points - p, axis=1).min() > 1e-9]
    plotter.add_mesh(pv.PolyData(np.array(new)), color=COPPER, point_size=12.0, render_points_as_spheres=True, lighting=False)
    return seen_straight(plotter, whole.cell_centers().points[0] + LIFT * np.array(view[1]), *view, HEIGHT)


def lower_panel(parts, whole, view):
    """Return an image of the separated parts."""
    plotter = lit(whole, PANEL)
    lines = EDGES | dict(line_width=1.6, edge_opacity=0.9)
    plotter.add_mesh(apart(parts), scalars="EAS", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, **lines)
    return seen_straight(plotter, whole.cell_centers().points[0] + LIFT * np.array(view[1]), *view, HEIGHT)


def range_text(values):
    low, high = min(values), max(values)
    return f"{low:.3f}" if high - low < 5e-4 else f"{low:.3f} to {high:.3f}"


def main():
    mesh = regular()
    fine, origin = divided(mesh)
    drawn, whole = grid(fine), grid(mesh)
    rows, upper, lower = [], [], []
    names = ((0, "(a) marked"), (2, "(b) beside it, an edge shared"), (1, "(c) beside it, a facet shared"))
    for (tet, name), view in zip(names, VIEWS):
        parts, one = drawn.extract_cells(np.flatnonzero(origin == tet)), whole.extract_cells([tet])
        upper.append((upper_panel(parts, one, view), name))
        lower.append((lower_panel(parts, one, view), f"{parts.n_cells} parts, EAS {range_text(parts['EAS'])}"))
        rows.append([name, f"{whole['EAS'][tet]:.3f}", parts.n_cells, range_text(parts["EAS"])])
    save_sheet(upper + lower, DOCS / "paper_6.png", 3, colour_bar)
    print_table(["tet", "EAS before", "parts", "EAS after"], rows)
    print()
    generations()


def generations():
    """Print the quality of a mesh divided repeatedly around one point, with and without stored divisions."""
    import motet
    from motet import shapes

    first = shapes.sphere_in_box(8, 6)
    meshes, rows = {False: first, True: first}, []
    for generation in range(GENERATIONS + 1):
        eas = [tet_quality(mesh) for mesh in meshes.values()]
        rows.append([generation, *(text for q in eas for text in (f"{len(q):,}", f"{q.min():.3f}", f"{np.median(q):.3f}"))])
        meshes = {forget: motet.refine(mesh, ball=[PLACE], forget=forget).mesh for forget, mesh in meshes.items()}
    print_table(["generation", "tets", "worst EAS", "median EAS", "tets, forgetful", "worst EAS", "median EAS"], rows)


def tet_quality(mesh):
    return mesh.quality()[mesh.cell_ids("tetra")]


if __name__ == "__main__":
    main()
