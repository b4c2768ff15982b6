"""Reproduces figure 1 of the paper: how the Delaunay graph of the boundary moves a mesh (writes
docs/paper_1.png).

    target/venv/bin/python examples/paper/figure_1.py

(a) A sphere in a box, (b) the mesh between them, (c) the Delaunay tets between the vertices of both surfaces,
(d) the displacements of the boundary, (e) the displacements of interior vertices, (f) the moved mesh. Cuts
through the centre, seen from the front.
"""
import numpy as np
import pyvista as pv
from common import DOCS, PALE, behind, grid, motet_json, patch_triangles, poly, work
from matplotlib.colors import LinearSegmentedColormap
from pictures import COPPER, EDGES, INK, lit, save_sheet, seen_straight

PANEL = (420, 400)
SHIFT = np.array([1.6, 0.0, 0.0])
VIEW = (np.zeros(3), (-9.0, -40.0, 9.0), (0.0, 0.0, 1.0), 12.6)
BLUE = "#b9c6d2"
BY = LinearSegmentedColormap.from_list("by", ["#f7f8f9", "#e9c39c"])
ARROWS = dict(color=COPPER, lighting=False)


def seen(*layers):
    """Return an image of some meshes, each given with the options of `add_mesh`."""
    plotter = lit(pv.Box((-5.0, 5.0, -5.0, 5.0, -5.0, 5.0)), PANEL)
    for drawn, options in layers:
        plotter.add_mesh(drawn, **options)
    return seen_straight(plotter, *VIEW)


def half_box():
    """Return the edges of the box, with drawing options."""
    frame = pv.Box((-5.0, 5.0, -5.0, 5.0, -5.0, 5.0)).extract_feature_edges(30.0)
    return frame, dict(color=INK, line_width=1.5, lighting=False)


def arrows(points, vectors):
    """Return arrows as long as the vectors, of equal thickness."""
    glyph = pv.Arrow(tip_length=0.3, tip_radius=0.07, shaft_radius=0.022)
    cloud = pv.PolyData(np.ascontiguousarray(points))
    cloud["vectors"] = vectors
    return cloud.glyph(orient="vectors", scale="vectors", geom=glyph, factor=1.0)


def graph_tets(path):
    """Return the Delaunay tets with vertices of both surfaces, written by `motet contact`."""
    gaps, tets = work("figure_1_gaps.vtp"), work("figure_1_graph.vtu")
    motet_json("contact", path, "--patches", "sphere,box", "-o", gaps, "--method", "delaunay", "--gap-tets", tets)
    return pv.read(tets)


def on_cut(points):
    """Return which points lie on the plane of the cut."""
    return np.abs(points[:, 1]) < 1e-9


def main():
    import motet
    from motet import shapes

    mesh = shapes.sphere_in_box(6, 6)
    path = work("figure_1_box.vtu")
    mesh.save(path)
    mover = motet.Mover(mesh)
    at = mesh.points[mover.boundary]
    is_sphere = np.linalg.norm(at, axis=1) < 1.01
    displacement = np.where(is_sphere[:, None], SHIFT, 0.0)
    moved = mesh.copy()
    moved.points = mover.step(displacement)
    save_sheet(panels(mesh, moved, at[is_sphere], graph_tets(path)), DOCS / "paper_1.png", 3)
    before, after = (one.quality()[one.cell_ids("tetra")] for one in (mesh, moved))
    print(f"{mesh.n_points} vertices, {len(at)} on the boundary; worst EAS {before.min():.3f}, moved {after.min():.3f}")


def panels(mesh, moved, at, graph):
    sphere = poly(mesh, patch_triangles(mesh, "sphere"))
    by = moved.points - mesh.points
    cells, after = grid(mesh), grid(moved)
    cells["by"] = np.linalg.norm(by, axis=1)
    ball, there = (sphere, dict(color=BLUE, **EDGES)), (sphere.translate(SHIFT), dict(color=BLUE, **EDGES))
    inside = on_cut(mesh.points) & (np.linalg.norm(by, axis=1) > 0.05) & (np.linalg.norm(mesh.points, axis=1) > 1.01)
    ring = at[on_cut(at)]
    coloured = dict(scalars="by", cmap=BY, clim=(0.0, SHIFT[0]), show_scalar_bar=False, **EDGES)
    vectors = arrows(in_front(mesh.points[inside]), by[inside])
    return [
        (seen(half_box(), ball, (arrows(np.array([[1.1, 0.0, 0.0]]), SHIFT[None]), ARROWS)), "(a) a sphere in a box is to move"),
        (seen((behind(cells, 1), dict(color=PALE, **EDGES)), ball), f"(b) {len(mesh.tets):,} tets between them"),
        (seen((behind(graph, 1), dict(color="#f6e6cf", **EDGES)), ball), f"(c) {graph.n_cells:,} Delaunay tets join both"),
        (seen(half_box(), ball, (arrows(ring, np.tile(SHIFT, (len(ring), 1))), ARROWS)), "(d) displacements of the boundary"),
        (seen((behind(cells, 1), coloured), ball, (vectors, ARROWS)), "(e) interpolated at those inside"),
        (seen((behind(after, 1), dict(color=PALE, **EDGES)), there), "(f) all moved"),
    ]


def in_front(points):
    return points - (0.0, 0.3, 0.0)


if __name__ == "__main__":
    main()
