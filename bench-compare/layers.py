"""Thickness of prism layers on the walls of the branched vessel when it bends, twists and widens,
by method."""
import subprocess

import numpy as np

from common import MOTET, TARGET, table
from meshes import written
from walls import LENGTH, branched_vessel

WEDGE = 13
# Angles of bending and twisting in degrees, and relative widening at the centre.
MOTIONS = {"bent 60": (60, 0, 0.0), "twisted 60": (0, 60, 0.0), "wider by 0.15": (0, 0, 0.15), "all three": (60, 60, 0.15)}
METHODS = {"delaunay": [], "guided": ["--method", "guided"], "elastic": ["--method", "elastic"],
           "delaunay, rigid layer": ["--rigid-layer", "0.1"]}


def place(points, bend, twist, wider):
    x, y, z = points.T
    turn = np.radians(twist) * z / LENGTH
    x, y = np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y
    radius = 1 + wider * np.sin(np.pi * np.clip(z / LENGTH, 0, 1))
    x, y = x * radius, y * radius
    if not bend:
        return np.stack([x, y, z], axis=1)
    k = np.radians(bend) / LENGTH
    return np.stack([(1 - np.cos(k * z)) / k + x * np.cos(k * z), y, np.sin(k * z) / k - x * np.sin(k * z)], axis=1)


def thickness(points, wedges):
    """Return the volume of each wedge over the mean area of its two triangles."""
    p = points[wedges]
    area = lambda a, b, c: np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    six = lambda a, b, c, d: np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    tets = ((0, 1, 2, 3), (1, 2, 3, 4), (2, 3, 4, 5))  # a division of the prism, up to orientation
    volume = sum(np.abs(six(*(p[:, i] for i in tet))) for tet in tets)
    return volume / ((area(p[:, 0], p[:, 1], p[:, 2]) + area(p[:, 3], p[:, 4], p[:, 5])) / 2)


def run():
    import pyvista

    surface, layered, moved = (TARGET / name for name in ("vessel_wall.vtp", "vessel_layers.vtu", "vessel_moved.vtu"))
    whole = pyvista.read(written("vessel", branched_vessel, TARGET)).extract_surface().triangulate()
    whole.clear_data()
    whole.save(surface)
    motet = lambda *arguments: subprocess.run([MOTET / "motet", *map(str, arguments)], capture_output=True, check=False).returncode
    motet("mesh", surface, "-o", layered, "--size", 0.25, "--layers", "4,0.015,1.3", "--keep-prisms")
    mesh = pyvista.read(layered)
    first, wedges = np.asarray(mesh.points), mesh.cells_dict[WEDGE]
    before, rows = thickness(first, wedges), []
    for motion, numbers in MOTIONS.items():
        mesh.point_data["u"] = place(first, *numbers) - first
        mesh.save(TARGET / "vessel_u.vtu")
        for method, options in METHODS.items():
            status = motet("move", TARGET / "vessel_u.vtu", "-o", moved, "--displacement", "u", *options)
            share = thickness(np.asarray(pyvista.read(moved).points), wedges) / before
            parts = [share.min(), *np.quantile(share, (0.01, 0.5, 0.99)), share.max()]
            rows.append([motion, method, *[f"{x:.2f}" for x in parts], "" if status == 0 else f"exit status {status}"])
    print(f"\n### Thickness of layers\n\n{len(wedges):,} prisms, thickness after the motion relative to that before.\n")
    print(table(["motion", "method", "min", "1 %", "median", "99 %", "max", ""], rows))
