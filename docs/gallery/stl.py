"""From an STL file

STL repeats each corner of each triangle and knows no patches. `motet.mesh` welds the corners; PyVista reads the file, and
the accessor `motet` fills it.
"""
import pyvista as pv

from motet import shapes

wire = shapes.coil(radius=1.0, pitch=0.9, turns=2.5, wire_radius=0.3, steps=24, around=12).to_pyvista()
wire.extract_surface(algorithm="dataset_surface").save("wire.stl")
surface = pv.read("wire.stl")
mesh = surface.motet.mesh(size="auto")
tets = mesh.extract_cells(mesh.celltypes == pv.CellType.TETRA)
print(f"volume of the tets {tets.volume:.4f}, within the surface {surface.volume:.4f}")

plotter = pv.Plotter(shape=(1, 2), border=False)
plotter.add_mesh(surface, color="lightsteelblue", show_edges=True)
plotter.add_text(f"wire.stl: {surface.n_cells} triangles", position="upper_edge", font_size=10)
plotter.subplot(0, 1)
plotter.add_mesh(tets.explode(0.3), color="lightsteelblue", show_edges=True)
plotter.add_text(f"{tets.n_cells} tets, pulled apart", position="upper_edge", font_size=10)
plotter.link_views()
plotter.camera_position = [(0, -9, 4), (0, 0, 0), (0, 0, 1)]
plotter.show(screenshot="stl.png")
