"""Heat around a sphere that moves through a box, in dolfinx, on a mesh that motet moves and repairs.

    python integrations/dolfinx/heat.py --steps 40

The heat equation in conservative arbitrary Lagrangian-Eulerian form (Donea, Giuliani, Halleux 1982), linear
elements, implicit Euler, no flux through any wall: with the test function 1 the scheme keeps the total heat to
rounding, whatever the mesh does. It is serial.
"""
import argparse
import time

import numpy as np
import ufl
from dolfinx import fem, mesh as dolfinx_mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

import motet
from motet import shapes

DIFFUSIVITY, DT = 1.0, 0.05


def element(kind, size=()):
    """Return a linear element, by whatever name this version of UFL and basix has for it."""
    try:
        import basix.ufl

        return basix.ufl.element(kind, "tetrahedron", 1, shape=size)
    except (ImportError, AttributeError):
        cell = ufl.Cell("tetrahedron", 3) if size else ufl.tetrahedron
        return ufl.VectorElement(kind, cell, 1) if size else ufl.FiniteElement(kind, cell, 1)


def rows(lists):
    """Return lists of equal lengths as the rows of an array, for any version of dolfinx."""
    return np.asarray(lists.array if hasattr(lists, "array") else lists).reshape(-1, 4)


class Heat:
    """Temperature on the tets of a `motet.Mesh`, whose points may move."""

    def __init__(self, tets, points):
        comm, domain = MPI.COMM_SELF, ufl.Mesh(element("Lagrange", (3,)))
        try:
            self.mesh = dolfinx_mesh.create_mesh(comm, tets.astype(np.int64), points, domain)
        except TypeError:
            self.mesh = dolfinx_mesh.create_mesh(comm, tets.astype(np.int64), domain, points)
        # The point of each node of the geometry, and the node of each degree of freedom.
        self.point_of_node = np.asarray(self.mesh.geometry.input_global_indices)
        space = self.space = getattr(fem, "functionspace", fem.FunctionSpace)(self.mesh, element("Lagrange"))
        node_of_dof = np.empty(len(points), np.int64)
        node_of_dof[rows(space.dofmap.list)] = rows(self.mesh.geometry.dofmap)
        self.point_of_dof = self.point_of_node[node_of_dof]
        self.velocity = fem.Function(getattr(fem, "functionspace", fem.FunctionSpace)(self.mesh, element("Lagrange", (3,))))
        self.before = fem.Function(space)
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
        implicit = u * v + DT * ufl.inner(DIFFUSIVITY * ufl.grad(u) + u * self.velocity, ufl.grad(v))
        self.matrix_form, self.vector_form = fem.form(implicit * ufl.dx), fem.form(self.before * v * ufl.dx)
        self.total_form = fem.form(self.before * ufl.dx)

    def place(self, points):
        self.mesh.geometry.x[:] = points[self.point_of_node]

    def total(self, values, points):
        """Return the heat in the mesh."""
        self.place(points)
        self.before.x.array[:] = values[self.point_of_dof]
        return fem.assemble_scalar(self.total_form)

    def step(self, values, start, end):
        """Return the temperature at the points at `end`, given that at `start`."""
        self.place(start)
        self.before.x.array[:] = values[self.point_of_dof]
        vector = petsc.assemble_vector(self.vector_form)
        self.place(end)
        self.velocity.x.array[:] = ((end - start) / DT)[self.point_of_dof].ravel()
        matrix = petsc.assemble_matrix(self.matrix_form)
        matrix.assemble()
        solver = PETSc.KSP().create(MPI.COMM_SELF)
        solver.setOperators(matrix)
        solver.setType("preonly")
        solver.getPC().setType("lu")
        solution = vector.duplicate()
        solver.solve(vector, solution)
        new = np.empty_like(values)
        new[self.point_of_dof] = solution.array
        return new


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--steps", type=int, default=40)
    parser.add_argument("--path", type=float, default=3.0, help="how far the sphere moves, in radii")
    arguments = parser.parse_args()
    moving = motet.MovingMesh(shapes.sphere_in_box(6, 6), valid_at_start=True)
    is_sphere = np.linalg.norm(moving.driven_places, axis=1) < 2
    heat = Heat(moving.mesh.tets, moving.points)
    values = np.exp(-((moving.points - (2.5, 0, 0)) ** 2).sum(axis=1))
    totals, seconds, n_changes = [heat.total(values, moving.points)], np.zeros(2), 0
    print(f"{moving.mesh!r}; heat {totals[0]:.6f}")
    lost = 0.0
    for k in range(1, arguments.steps + 1):
        begin = time.perf_counter()
        moving.set_array("heat", values, on="points")
        report = moving.advance(k * DT, np.outer(is_sphere, [arguments.path * k / arguments.steps, 0, 0]))
        assert report.complete, report
        seconds[0] += time.perf_counter() - begin
        end = moving.points
        start = end - DT * moving.velocity
        if report.changes:
            n_changes += len(report.changes)
            heat = Heat(moving.mesh.tets, end)
            values = moving.mesh.point_data["heat"]
            # Interpolation between meshes does not keep the integral; a constant puts it right.
            error = totals[-1] - heat.total(values, start)
            values = values + error / heat.total(np.ones_like(values), start)
            lost += abs(error)
        before = heat.total(values, start)
        begin = time.perf_counter()
        values = heat.step(values, start, end)
        seconds[1] += time.perf_counter() - begin
        totals.append(heat.total(values, end))
        assert abs(totals[-1] - before) < 1e-10 * abs(before), "the scheme keeps the heat"
    quality = report.quality
    print(f"{arguments.steps} steps, {n_changes} changes of the mesh; heat {totals[-1]:.6f}, changed by {abs(totals[-1] / totals[0] - 1):.1e}; {lost / totals[0]:.1e} of it put right after transfers")
    print(f"temperature {values.min():.4f} to {values.max():.4f}; {report.tets} tets, {report.bad} bad, {report.inverted} inverted; EAS worst {quality.worst:.3f}, 1 % {quality.p1:.3f}, median {quality.median:.3f}, mean {quality.mean:.3f}")
    print(f"per step: motet {1e3 * seconds[0] / arguments.steps:.1f} ms, dolfinx {1e3 * seconds[1] / arguments.steps:.1f} ms")


if __name__ == "__main__":
    main()
