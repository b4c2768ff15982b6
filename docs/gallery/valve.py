"""A valve over a cycle

Three leaflets in a vessel close and open. They are membranes in the mesh of the blood, which follows them and is repaired
where tets become bad. The angle is that of the leaflets to the plane of their ring.
"""
import numpy as np
import pyvista as pv

import motet
from motet import shapes

tube = shapes.tube(n=9, slices=20, length=4)
ring = tube.points[tube.patch_vertices("wall")]
ring = ring[abs(ring[:, 2] - 1.2) < 1e-9]
ring = ring[np.argsort(np.arctan2(ring[:, 1], ring[:, 0]))]


def leaflets(degrees):
    out, up = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    rows = np.array([ring * (1 - s * out, 1 - s * out, 1) + (0, 0, s * up) for s in np.linspace(0, 0.75, 6)])
    return pv.merge([pv.StructuredGrid(*rows[:, k : k + 12].transpose(2, 0, 1)) for k in (0, 12, 24)])


start = leaflets(50)
membrane = start.extract_surface(algorithm="dataset_surface").triangulate()
mesh = motet.mesh(motet.Mesh(tube.points, tube.triangles), membranes=[membrane], size="auto").mesh
moving = motet.MovingMesh(mesh, method="guided", within_walls=True, smooth=4, inside=["membrane"])
vertex = np.linalg.norm(moving.driven_places[:, None] - start.points, axis=2).argmin(axis=0)
displacement = np.zeros_like(moving.driven_places)

plotter = pv.Plotter(shape=(1, 3), border=False, window_size=(1200, 460))
for k, degrees in enumerate((40, 25, 40, 55, 70, 50)):
    displacement[vertex] = leaflets(degrees).points - start.points
    step = moving.advance(k + 1, displacement)
    if k in (1, 4, 5):
        plotter.subplot(0, (1, 4, 5).index(k))
        blocks = moving.mesh.to_pyvista().motet.blocks()
        plotter.add_mesh(blocks["surface"].clip("z", origin=(0, 0, 1.2)), color="lightsteelblue", show_edges=True)
        plotter.add_mesh(blocks["membrane"], color="tomato", show_edges=True, ambient=0.4)
        plotter.add_text(f"{degrees} degrees: worst {step.worst.eas:.2f}", position="upper_edge", font_size=10)
        plotter.camera_position = [(4, -3, 7.5), (0, 0, 1), (0, 0, 1)]
plotter.show(screenshot="valve.png")
