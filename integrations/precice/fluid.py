"""A preCICE participant with a mesh moved by motet: reads the wall displacement of a solid, writes the wall
load.

    python fluid.py precice-config.xml vessel.vtu wall

Replace `solve` by a flow solver. Here it is a constant pressure on the facets of the wall.
"""
import sys

import numpy as np

import motet


def solve(points, velocity, mesh, wall):
    """Return the load on each vertex of the wall for a pressure of 1, in place of a flow solver."""
    facets = mesh.triangles[np.isin(mesh.triangles, wall).all(axis=1)]
    a, b, c = (points[facets[:, i]] for i in range(3))
    load = np.zeros_like(points)
    np.add.at(load, facets, (np.cross(b - a, c - a) / 6)[:, None])
    return load[wall]


def couple(participant, mesh, wall, solve=solve):
    """Run the coupling loop; return the final points."""
    ids = participant.set_mesh_vertices("Fluid-Mesh", mesh.points[wall])
    mover = motet.Mover(mesh)
    at_wall = np.searchsorted(mover.boundary, wall)
    displacement = np.zeros((len(mover.boundary), 3))
    points, before = mesh.points.copy(), mesh.points.copy()
    participant.initialize()
    while participant.is_coupling_ongoing():
        # A step of motet depends only on the displacement, so a repeated iteration needs no saved state of
        # the mesh.
        if participant.requires_writing_checkpoint():
            before = points.copy()
        dt = participant.get_max_time_step_size()
        displacement[at_wall] = participant.read_data("Fluid-Mesh", "Displacement", ids, dt)
        points, certificate = mover.advance(displacement, points)
        if not certificate.complete:
            raise RuntimeError(f"only {certificate.fraction:.0%} of the motion was completed: repair the mesh before this step")
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
