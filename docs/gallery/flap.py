"""A dissection flap

A sheet inside a vessel is held along one line and beats to both sides. The mesh on both of its sides follows, and is
repaired where tets become bad.
"""
import numpy as np
import pyvista as pv

import motet
from motet import shapes

tube = shapes.tube(n=6, slices=24)
wall = tube.points[tube.patch_vertices("wall")]
hinge = wall[(abs(wall[:, 0] + 1) < 1e-9) & (abs(wall[:, 2] - 2.5) < 1.7)]
across = np.linspace(0, 1.3, 8)[None, :, None] * (1, 0, 0)
sheet = pv.StructuredGrid(*(hinge[:, None] + across).transpose(2, 0, 1)[..., None])
flap = sheet.extract_surface(algorithm="dataset_surface").triangulate()
mesh = motet.mesh(motet.Mesh(tube.points, tube.triangles), membranes=[flap], size="auto").mesh

moving = motet.MovingMesh(mesh, method="guided", within_walls=True, smooth=4, inside=["membrane"])
x, y, z = moving.driven_places.T
along = np.where((abs(y) < 1e-9) & (x < 0.31) & (abs(z - 2.5) < 1.7), x + 1, 0)
plotter = pv.Plotter(shape=(1, 3), border=False, window_size=(1200, 460))
look = dict(scalars="EAS", clim=(0, 1), show_edges=True, line_width=0.5, ambient=0.5, diffuse=0.5)
for k, degrees in enumerate((0, 30, 60, 30, 0, -30, -60)):
    angle = np.radians(degrees) * along / 1.3 + 1e-9
    bent = along * np.array([np.sin(angle) / angle - 1, (1 - np.cos(angle)) / angle, 0 * x])
    step = moving.advance(k + 1, bent.T)
    if k in (0, 2, 6):
        grid = moving.mesh.to_pyvista()
        grid["EAS"] = moving.mesh.quality()
        plotter.subplot(0, (0, 2, 6).index(k))
        tets = grid.extract_cells(moving.mesh.cell_ids("tetra"))
        plotter.add_mesh(tets.clip("z", crinkle=True), **look, show_scalar_bar=k == 6)
        plotter.add_mesh(grid.motet.blocks()["membrane"], color="tomato", show_edges=True)
        plotter.add_text(f"{degrees} degrees: worst {step.worst.eas:.2f}, {step.bad} bad", position="upper_edge", font_size=10)
        plotter.camera_position = [(1, 1.5, 10), (0, 0, 2.5), (0, 1, 0)]
plotter.show(screenshot="flap.png")
