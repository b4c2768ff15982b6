"""Reproduces figure 13 of the paper: gaps between an unexpanded stent and an aneurysm.

    target/venv/bin/python examples/paper/figure_13.py

Writes docs/paper_13.png and prints two tables. Shows the exact distance of every vertex to the other surface,
on (a) the stent and (b) the wall; (c), (d) just before the stent touches the wall. The second table expands
the stent in steps and shows when motet warns, so that a contact model would be called.
"""
import numpy as np
from common import DOCS, poly, print_table
from matplotlib.colors import LinearSegmentedColormap
from pictures import COPPER, lit, save_sheet, scale_of, shot

PANEL = (600, 400)
RANGE, WARN = (0.0, 1.2), 0.1
# Radius of the circle on which the vessel's axis lies: its length over its bend. The radius of the vessel is
# 1.
AXIS = 10.0 / np.radians(90.0)
LENGTH = 7.0
# Distance of the stent from the axis, towards the inside of the bend.
OFF = 0.2
RADII = (0.4, 0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85)
# Red: warning; pale: near; blue: far.
GAP = LinearSegmentedColormap.from_list("gap", [(0.0, "#8c0f2d"), (0.083, "#e0583f"), (0.085, "#f0c36a"), (0.5, "#8fc7b4"), (1.0, "#2b6c8a")])


def bent_stent(radius):
    """Return a stent along the axis of the vessel, with its centre at the sac."""
    from motet import shapes

    stent = shapes.stent(radius, length=LENGTH, rings=7, crowns=6, strut_width=0.12, thickness=0.08)
    x, y, z = stent.points.T
    angle, out = (z - 0.5 * LENGTH) / AXIS, AXIS - OFF + y
    stent.points = np.stack([out * np.sin(angle), out * np.cos(angle) - AXIS, x], axis=1)
    return stent


def contact(stent, vessel):
    import motet

    return motet.Contact({"stent": stent, "vessel": vessel}, room=["vessel"], warn=WARN)


def with_gaps(mesh, body, first):
    """Return a surface for drawing, with the gap at each vertex."""
    drawn = poly(mesh)
    gap = np.full(mesh.n_points, np.nan)
    gap[body.vertices.astype(int) - first] = body.gap
    drawn["gap"] = gap
    return drawn


def panel(stent, vessel, on):
    """Return an image of both surfaces, one of them coloured by its gaps."""
    plotter = lit(vessel, PANEL)
    coloured = dict(scalars="gap", cmap=GAP, clim=RANGE, show_scalar_bar=False, ambient=0.6, diffuse=0.45)
    if on == "stent":
        plotter.add_mesh(vessel, color="#d9c7bb", opacity=0.25, ambient=0.4, diffuse=0.6)
        plotter.add_mesh(stent, **coloured)
    else:
        far = vessel.extract_cells(vessel.cell_centers().points[:, 2] < 0.0)
        plotter.add_mesh(far, **coloured, show_edges=True, edge_color="#22303c", edge_opacity=0.25, line_width=0.6)
    if on == "wall and stent":
        plotter.add_mesh(stent, color=COPPER, ambient=0.5, diffuse=0.5)
    plotter.camera_position = [(4.0, 5.0, 24.0), (0.0, 0.55, 0.0), (0.0, 1.0, 0.0)]
    plotter.camera.view_angle = 16.2
    plotter.enable_depth_peeling(8)
    return shot(plotter)


def row(radius, gaps):
    body = gaps.bodies["stent"]
    crossed = "yes" if gaps.least == 0.0 else "no"
    return [f"{radius:.2f}", f"{gaps.least:.4f}", f"{np.median(body.gap):.4f}", int(body.warning.sum()), int(gaps.bodies["vessel"].warning.sum()), crossed]


def main():
    from motet import shapes

    vessel = shapes.aneurysm(around=48)
    stents = [bent_stent(radius) for radius in RADII]
    measure = contact(stents[0], vessel)
    found = []
    for stent in stents:
        measure.refit(np.concatenate([stent.points, vessel.points]))
        found.append(measure.measure())
    print_table(["surface", "vertices", "least gap", "median", "largest"], [spread(name, body) for name, body in found[0].bodies.items()])
    print()
    print_table(["stent radius", "least gap", "median, stent", f"stent below {WARN:g}", f"wall below {WARN:g}", "touches"], list(map(row, RADII, found)))
    draw(vessel, stents, found)


def spread(name, body):
    return [name, f"{len(body.gap):,}", *(f"{x:.4f}" for x in (body.gap.min(), np.median(body.gap), body.gap.max()))]


def draw(vessel, stents, found):
    last = max(k for k, gaps in enumerate(found) if gaps.least > 0.0)

    def both(k):
        bodies = found[k].bodies
        return with_gaps(stents[k], bodies["stent"], 0), with_gaps(vessel, bodies["vessel"], stents[k].n_points)

    pictures = [
        (panel(*both(0), "stent"), f"(a) unexpanded, gaps of the stent: least {found[0].least:.2f}"),
        (panel(*both(0), "wall and stent"), "(b) gaps of the wall, cut open"),
        (panel(*both(last), "stent"), f"(c) opened to radius {RADII[last]:g}: least {found[last].least:.2f}"),
        (panel(*both(last), "wall"), "(d) gaps of the wall then"),
    ]
    save_sheet(pictures, DOCS / "paper_13.png", 2, scale_of(GAP, RANGE, (0.0, WARN, 0.4, 0.8, 1.2), "gap"))


if __name__ == "__main__":
    main()
