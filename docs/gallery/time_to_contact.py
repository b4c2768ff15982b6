"""Time to contact

Three balls move in straight lines. Colour is the time before which no triangle at a vertex touches another ball, if all
go on as they do; grey parts touch nothing.
"""
import numpy as np
import pyvista as pv

import motet

starts = {"a": (-2, 0, 0), "b": (0.3, 0.4, 0), "c": (2.4, -0.3, 0.2)}
velocities = {"a": (1, 0, 0), "b": (0, 0, 0), "c": (-0.5, 0.2, 0)}
balls = {name: pv.Icosphere(radius=0.7, nsub=4, center=start) for name, start in starts.items()}
contact = motet.Contact(balls)
velocity = np.concatenate([np.tile(velocities[name], (ball.n_points, 1)) for name, ball in balls.items()])
ahead = contact.look_ahead(velocity, horizon=5)
print(ahead.first)

plotter = pv.Plotter()
for name, ball in balls.items():
    ball["time"] = ahead.times[name]
    ball["time"][~np.isfinite(ball["time"])] = np.nan
    plotter.add_mesh(ball, scalars="time", cmap="plasma", clim=(0, 5), nan_color="lightgrey", smooth_shading=True)
    if any(velocities[name]):
        arrow = pv.Arrow(direction=velocities[name], scale="auto", tip_radius=0.06, shaft_radius=0.025)
        plotter.add_mesh(arrow.translate(np.add(starts[name], (0, 0, 1))), color="black")
plotter.camera_position = [(0.7, -10, 4), (0.7, 0, 0.2), (0, 0, 1)]
plotter.show(screenshot="time_to_contact.png")
