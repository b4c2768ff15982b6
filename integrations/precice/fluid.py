"""A participant of preCICE whose mesh motet moves: the wall's displacement comes from a solid, the load on the wall goes back.

    python fluid.py precice-config.xml vessel.vtu wall

`solve` stands in for a flow solver: a constant pressure on the facets of the wall.
"""
import sys

import numpy as np

import motet


def solve(points, velocity, mesh, wall):
    """In place of a flow solver: the load on each vertex of the wall, of a pressure of 1."""
    facets = mesh.triangles[np.isin(mesh.triangles, wall).all(axis=1)]
    a, b, c = (points[facets[:, i]] for i in range(3))
    load = np.zeros_like(points)
    np.add.at(load, facets, (np.cross(b - a, c - a) / 6)[:, None])
    return load[wall]


def couple(participant, mesh, wall, solve=solve):
    """The loop. Returns the points at the end."""
    ids = participant.set_mesh_vertices("Fluid-Mesh", mesh.points[wall])
    mover = motet.Mover(mesh)
    at_wall = np.searchsorted(mover.boundary, wall)
    displacement = np.zeros((len(mover.boundary), 3))
    points, before = mesh.points.copy(), mesh.points.copy()
    participant.initialize()
    while participant.is_coupling_ongoing():
        # A step of motet depends on the displacement only: nothing of the mesh is stored for an iteration that is repeated.
        if participant.requires_writing_checkpoint():
            before = points.copy()
        dt = participant.get_max_time_step_size()
        displacement[at_wall] = participant.read_data("Fluid-Mesh", "Displacement", ids, dt)
        points, certificate = mover.advance(displacement, points)
        if not certificate.complete:
            raise RuntimeError(f"{certificate.fraction:.0%} of the motion was reached: repair the mesh before this step")
        velocity = motet.mesh_velocity(before, points, dt)
        participant.write_data("Fluid-Mesh", "Force", ids, solve(points, velocity, mesh, wall))
        participant.advance(dt)
        participant.requires_reading_checkpoint()
    participant.finalize()
    return points


if __name__ == "__main__":
    import precice

    config, path, patch = sys.argv[1:]
    given = motet.read(path)
    couple(precice.Participant("Fluid", config, 0, 1), given, given.patch_vertices(patch))
