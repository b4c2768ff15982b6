"""The loop of `fluid.py` with a stand-in for preCICE: a wall on springs, with two iterations per
time window."""
import numpy as np

import motet
from fluid import couple


class Participant:
    """The methods of preCICE's `Participant` that `couple` calls."""

    def __init__(self, windows, dt=0.1, stiffness=1.0):
        self.left, self.dt, self.stiffness = 2 * windows, dt, stiffness
        self.read, self.finalized = [], False

    def set_mesh_vertices(self, mesh, places):
        self.displacement = np.zeros_like(places)
        return np.arange(len(places))

    def initialize(self):
        pass

    def is_coupling_ongoing(self):
        return self.left > 0

    def requires_writing_checkpoint(self):
        return self.left % 2 == 0

    def requires_reading_checkpoint(self):
        return self.left % 2 == 1

    def get_max_time_step_size(self):
        return self.dt

    def read_data(self, mesh, data, ids, dt):
        self.read.append(self.displacement[ids])
        return self.read[-1]

    def write_data(self, mesh, data, ids, values):
        # Relaxed by one half, so that iterations differ.
        self.displacement[ids] += 0.5 * (values / self.stiffness - self.displacement[ids])

    def advance(self, dt):
        self.left -= 1

    def finalize(self):
        self.finalized = True


def test_the_mesh_follows_the_wall_independently_of_previous_iterations():
    mesh = motet.shapes.sphere_in_box()
    wall = mesh.patch_vertices("sphere")
    solid = Participant(windows=10)
    points = couple(solid, mesh, wall)
    assert solid.finalized and len(solid.read) == 20
    last = solid.read[-1]
    assert 1e-3 < np.abs(last).max() < 0.1
    np.testing.assert_array_equal(points[wall], mesh.points[wall] + last)
    # One step from the initial position gives the same points, without previous iterations.
    mover = motet.Mover(mesh)
    displacement = np.zeros((len(mover.boundary), 3))
    displacement[np.isin(mover.boundary, wall)] = last
    alone, _ = mover.advance(displacement)
    np.testing.assert_array_equal(points, alone)
