"""Heat around a moving sphere in dolfinx (see loop.py): linear elements, serial.

    python integrations/heat/with_dolfinx.py --steps 40
"""
import numpy as np
import ufl
from dolfinx import fem, mesh as dolfinx_mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

from loop import DIFFUSIVITY, DT, run

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


if __name__ == "__main__":
    run(Heat, "dolfinx")
