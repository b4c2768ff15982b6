"""Reproduces figure 12 of the paper: a coil in an aneurysm (writes docs/paper_12.png, prints a table).

    target/venv/bin/python examples/paper/figure_12.py

As in the paper, the mesh is refined until no edge at the wire is longer than SIZE, then the wire is
implanted. Shows the whole mesh and three cuts: along the vessel, across it, and through the sac, with the
lumen coloured by quality and the wire in copper. The last row of the table is for the implantation without
refinement, which is motet's default.
"""
import numpy as np
from common import BAD, DOCS, grid, patch_triangles, poly, print_table
from pictures import COPPER, QUALITY, RANGE, colour_bar, lit, save_sheet, seen_straight, shot

PANEL = (600, 430)
SAC = np.array([0.0, 2.2, 0.0])
SIZE, GROWTH = 0.12, 0.35
# Normal of the cut, direction of the camera, upward direction, centre and visible height.
CUTS = (
    ("(b) along the vessel", "z", (0.0, 0.0, 40.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0), 5.6),
    ("(c) across the vessel", "x", (40.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 1.3, 0.0), 5.2),
    ("(d) through the sac", "y", (0.0, 40.0, 0.0), (0.0, 0.0, -1.0), tuple(SAC), 3.1),
)


def host_and_coil():
    import motet
    from motet import shapes

    wire = shapes.coil(SAC, radius=0.85, pitch=0.38, turns=4.5, wire_radius=0.09, steps=48, around=10)
    return motet.mesh(shapes.aneurysm(), size=0.4, growth=0.3).mesh, wire


def row(name, mesh):
    q = mesh.quality()[mesh.cell_ids("tetra")]
    return [name, f"{mesh.n_points:,}", f"{len(mesh.tets):,}", np.count_nonzero(q < BAD), f"{q.min():.3f}", f"{q.mean():.3f}"]


def whole(mesh):
    """Return an image of the transparent wall with the wire."""
    plotter = lit(poly(mesh), PANEL)
    plotter.add_mesh(poly(mesh, patch_triangles(mesh, "wall")), color="#d9a79a", opacity=0.3, show_edges=True, edge_color="#8a6a60", edge_opacity=0.25, ambient=0.5, diffuse=0.5)
    plotter.add_mesh(poly(mesh, patch_triangles(mesh, "coil")), color=COPPER, smooth_shading=True, ambient=0.55, diffuse=0.6, specular=0.1)
    plotter.camera_position = [(7.0, 9.0, 22.0), (0.0, 0.7, 0.0), (0.0, 1.0, 0.0)]
    plotter.camera.view_angle = 18.0
    plotter.enable_depth_peeling(8)
    return shot(plotter)


def cut(drawn, normal, offset, up, centre, height):
    """Return an image of a planar cut: the lumen coloured by quality, the wire in copper."""
    plotter = lit(drawn, PANEL)
    origin = SAC if normal == "y" else (0.0, 0.0, 0.0)
    flat = drawn.slice(normal=normal, origin=np.array(origin) + 1e-4, generate_triangles=False)
    lines = dict(show_edges=True, edge_color="#2b3640", line_width=0.8, edge_opacity=0.6, lighting=False, show_scalar_bar=False)
    lumen = flat["region"] == 1
    plotter.add_mesh(flat.extract_cells(lumen), scalars="EAS", cmap=QUALITY, clim=RANGE, **lines)
    plotter.add_mesh(flat.extract_cells(~lumen), color=COPPER, **lines)
    return seen_straight(plotter, centre, offset, up, height)


def main():
    import motet

    host, coil = host_and_coil()
    fine = motet.refine(host, near_size=[(coil, SIZE, GROWTH)])
    made = motet.implant(fine.mesh, {"coil": coil})
    mesh = made.mesh
    head = ["mesh", "vertices", "tets", "bad", "worst EAS", "mean EAS"]
    print_table(head, [row("aneurysm", host), row("refined", fine.mesh), row("with the coil", mesh), row("with it, unrefined", motet.implant(host, {"coil": coil}).mesh)])
    device = made.report.devices[0]
    print(f"\ntriangles of the coil: {device.triangles:,}, facets of the mesh as they came: {device.triangles_kept:,}")
    print(f"volume in it: {device.enclosed:.12g}, of its tets: {device.volume:.12g}; host kept to the bit: {100 * made.report.kept_share:.1f} %")
    drawn = grid(mesh, region=mesh.cell_data["region"][mesh.cell_ids("tetra")])
    pictures = [(whole(mesh), f"(a) aneurysm and coil, {len(mesh.tets):,} tets")]
    save_sheet(pictures + [(cut(drawn, *view), name) for name, *view in CUTS], DOCS / "paper_12.png", 2, colour_bar)


if __name__ == "__main__":
    main()
