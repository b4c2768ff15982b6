"""Reproduces figure 7 of the paper: implantation of a body into a mesh, step by step (writes
docs/paper_7.png).

    target/venv/bin/python examples/paper/figure_7.py

(a) The outer and (b) the inner mesh; (c) the part of the outer mesh that is kept; (d) the surfaces that bound
the space in between; (e) its new tets; (f) the whole mesh, coloured by quality. Cuts through the centre.
"""
import numpy as np
from common import BAD, DOCS, PALE, behind, grid, patch_triangles, poly
from pictures import COPPER, EDGES, QUALITY, RANGE, colour_bar, lit, save_sheet, seen_straight

PANEL = (420, 330)
BLUE = "#9fc4d6"
VIEW = (np.array([-0.1, 0.0, 0.2]), (-6.0, -40.0, 11.0), (0.0, 0.0, 1.0), 4.9)
LOOK = dict(show_scalar_bar=False, **EDGES)


def seen(*layers):
    plotter = lit(layers[0][0], PANEL)
    for drawn, options in layers:
        plotter.add_mesh(drawn, **options)
    return seen_straight(plotter, *VIEW)


def outer():
    """Return an unstructured mesh of a box, filled from its surface."""
    import motet
    from motet import shapes

    box = shapes.box((14, 12, 11), (-2.5, -2.1, -2.0), (2.5, 2.1, 2.0))
    return motet.mesh(motet.Mesh(box.points, {"triangle": box.triangles}), size=0.36).mesh


def facets(tets):
    """Return the facets that belong to only one tet."""
    rows = np.concatenate([tets[:, [i for i in range(4) if i != j]] for j in range(4)])
    keys, first, counts = np.unique(np.sort(rows, axis=1), axis=0, return_index=True, return_counts=True)
    return rows[first[counts == 1]]


def half(drawn):
    """Return the triangles behind the cut."""
    return drawn.extract_cells(drawn.cell_centers().points[:, 1] > 0.0)


def main():
    import motet
    from motet import shapes

    host, ball = outer(), shapes.ball(6, 4)
    made = motet.implant(host, {"ball": ball})
    save_sheet(panels(host, ball, made), DOCS / "paper_7.png", 3, colour_bar)
    q = made.mesh.quality()[made.mesh.cell_ids("tetra")]
    report = made.report
    print(f"host: {len(host.tets):,} tets; kept to the bit {100 * report.kept_share:.1f} %; ball: {len(ball.tets):,} tets, its own")
    print(f"with the ball: {len(made.mesh.tets):,} tets, worst EAS {q.min():.3f}, {np.count_nonzero(q < BAD)} below {BAD}")


def panels(host, ball, made):
    mesh = made.mesh
    ids = mesh.cell_ids("tetra")
    in_ball = mesh.cell_data["region"][ids] > 1
    stayed = (made.history.cell_to_old[ids] >= 0) & ~in_ball
    all_tets = grid(mesh, stayed=stayed, in_ball=in_ball)
    kept, inner, new = (behind(all_tets.extract_cells(which), 1) for which in (stayed, in_ball, ~stayed & ~in_ball))
    room = facets(mesh.tets[~stayed & ~in_ball])
    on_ball = np.isin(room, patch_triangles(mesh, "ball")).all(axis=1)
    hollow, skin = (half(poly(mesh, rows)) for rows in (room[~on_ball], room[on_ball]))
    pale, copper, blue = (dict(color=colour, **LOOK) for colour in (PALE, COPPER, BLUE))
    coloured = dict(scalars="EAS", cmap=QUALITY, clim=RANGE, **LOOK)
    return [
        (seen((behind(grid(host), 1), pale)), f"(a) outer mesh, {len(host.tets):,} tets"),
        (seen((behind(grid(ball), 1), copper)), f"(b) inner mesh, {len(ball.tets):,} tets"),
        (seen((kept, pale)), f"(c) {np.count_nonzero(stayed):,} tets of (a) stay"),
        (seen((hollow, blue), (skin, copper)), "(d) surfaces that bound the room"),
        (seen((kept, pale), (new, blue), (inner, copper)), f"(e) filled by {np.count_nonzero(~stayed & ~in_ball):,} tets"),
        (seen((behind(all_tets, 1), coloured)), f"(f) worst EAS {all_tets['EAS'].min():.2f}"),
    ]


if __name__ == "__main__":
    main()
