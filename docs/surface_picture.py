"""Draws surfaces beside what `motet surface` makes of them (writes docs/surface.png).

    ./test --setup                                        (once: the Python packages)
    cargo build --release
    cargo run --release -p motet --example shapes target
    target/venv/bin/python docs/surface_picture.py target/bifurcation.vtp
    target/venv/bin/python docs/surface_picture.py GIVEN NEW [GIVEN NEW ...]     any surfaces, to target/surfaces.png

Top: a vessel whose vertices were moved along its surface, a ball with a rod through it, the vessel with holes and
triangles that were moved out of place. Bottom: the same with even triangles, united, and wrapped. Triangles are
coloured by their least angle. Prints what was run.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyvista as pv
from pictures import HERE, INK, QUALITY, lit, save_sheet, scale_of, seen_straight
from program import binary

PANEL = (520, 400)
# Degrees; 60 in a regular triangle.
ANGLES = (0.0, 60.0)
FROM = np.array((0.0, -8.0, 40.0))


def least_angles(surface):
    """Return the least angle of each triangle in degrees."""
    corners = np.asarray(surface.points, float)[surface.regular_faces]
    to_next, to_last = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    across = np.linalg.norm(np.cross(to_next, to_last), axis=2)
    return np.degrees(np.arctan2(across, (to_next * to_last).sum(axis=2))).min(axis=1)


def panel(surface, height, from_where=FROM):
    """Return an image of a surface and the text below it."""
    angles = least_angles(surface)
    surface = surface.copy()
    surface.cell_data["least angle"] = angles
    plotter = lit(surface, PANEL)
    plotter.add_mesh(surface, scalars="least angle", cmap=QUALITY, clim=ANGLES, show_scalar_bar=False, show_edges=True, edge_color=INK,
                     line_width=0.8, edge_opacity=0.5, ambient=0.6, diffuse=0.45, specular=0.0)
    picture = seen_straight(plotter, surface.center, from_where, (0.0, 1.0, 0.0), height)
    return picture, f"{surface.n_cells:,} triangles, narrowest {angles.min():.1f}°, mean {angles.mean():.1f}°"


def narrowed(surface, random):
    """Return a surface whose vertices are moved along it at random."""
    surface = surface.compute_normals(cell_normals=False, split_vertices=False, auto_orient_normals=False)
    normals = surface.point_data["Normals"]
    steps = random.uniform(-1.0, 1.0, surface.points.shape) * 0.5 * np.sqrt(surface.area / surface.n_cells)
    steps -= (steps * normals).sum(axis=1, keepdims=True) * normals
    rims = surface.extract_feature_edges(boundary_edges=True, feature_edges=True, feature_angle=40.0, manifold_edges=False)
    stays = np.zeros(surface.n_points, bool)
    if rims.n_points:
        stays = np.isin(np.arange(surface.n_points), [surface.find_closest_point(p) for p in rims.points])
    surface.points[~stays] += steps[~stays]
    return pv.PolyData(surface.points, surface.faces)


def torn(surface, random):
    """Return the triangles of a surface moved apart, a part of them left out."""
    kept = surface.regular_faces[random.random(surface.n_cells) > 0.08]
    corners = np.asarray(surface.points)[kept] + random.normal(0.0, 0.03 * np.sqrt(surface.area / surface.n_cells), (len(kept), 1, 3))
    return pv.PolyData.from_regular_faces(corners.reshape(-1, 3), np.arange(3 * len(kept)).reshape(-1, 3))


def made(given, words):
    """Return what `motet surface` makes of a surface."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / name for name in ("given.vtp", "new.vtp")]
        given.save(paths[0])
        subprocess.run([binary(), "surface", paths[0], "-o", paths[1], "-q", *words.split()], check=True)
        return pv.read(paths[1])


def main():
    bar = scale_of(QUALITY, ANGLES, (0, 15, 30, 45, 60), "least angle")
    if len(sys.argv) > 2 and len(sys.argv) % 2:
        surfaces = [pv.read(path).extract_surface(algorithm="dataset_surface").triangulate() for path in sys.argv[1:]]
        panels = [panel(surface, 1.1 * surface.length / np.sqrt(2.0), np.array((0.5, -1.0, 0.7)) * 5.0 * surface.length) for surface in surfaces]
        columns = len(surfaces) // 2
        save_sheet(panels[::2] + panels[1::2], HERE.parent / "target" / "surfaces.png", columns, bar)
        return
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    random = np.random.default_rng(1)
    vessel = pv.read(sys.argv[1]).extract_surface(algorithm="dataset_surface").triangulate()
    vessel = pv.PolyData(vessel.points, vessel.faces)
    rod = pv.Cylinder(radius=0.8, height=6.0, resolution=24, direction=(1.0, 0.4, 0.0)).triangulate().clean()
    ball = pv.Sphere(radius=2.0, theta_resolution=40, phi_resolution=24)
    cases = [(narrowed(vessel, random), "--size 0.25 --distance 0.02", 8.6), (ball.append_polydata(rod), "--unite --size 0.25 --distance 0.02", 5.6),
             (torn(vessel, random), "--wrap 0.05 --size 0.25 --distance 0.05", 8.6)]
    above, below = [], []
    for given, words, height in cases:
        print(f"motet surface {words}")
        above.append(panel(given, height))
        below.append(panel(made(given, words), height))
    save_sheet(above + below, HERE / "surface.png", 3, bar)


if __name__ == "__main__":
    main()
