"""Heat around a moving sphere in MFEM (see loop.py): linear elements, by PyMFEM, serial.

    pip install mfem
    python integrations/heat/with_mfem.py --steps 40
"""
import mfem.ser as mfem
import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import spsolve

from loop import DIFFUSIVITY, DT, run

BY_COMPONENT = 0  # MFEM's Ordering.byNODES: all x, then all y, then all z


class Heat:
    """Temperature on the tets of a `motet.Mesh`, whose points may move."""

    def __init__(self, tets, points):
        self.mesh = mfem.Mesh(3, len(points), len(tets))
        for point in points:
            self.mesh.AddVertex(*map(float, point))
        for tet in tets:
            self.mesh.AddTet(*map(int, tet))
        self.mesh.FinalizeTetMesh(1)
        # Linear nodes: one for each vertex, in the order of the points, which move with them.
        self.mesh.SetCurvature(1, False, 3, BY_COMPONENT)
        elements = self.elements = mfem.H1_FECollection(1, 3)
        self.space = mfem.FiniteElementSpace(self.mesh, elements)
        self.vectors = mfem.FiniteElementSpace(self.mesh, elements, 3, BY_COMPONENT)
        self.velocity = mfem.GridFunction(self.vectors)

    def place(self, points):
        self.mesh.GetNodes().Assign(mfem.Vector(np.ascontiguousarray(points.T).ravel()))
        self.mesh.NodesUpdated()

    def matrix(self, *integrators):
        """Return the sum of integrals over the mesh as it is placed."""
        form = mfem.BilinearForm(self.space)
        for integrator in integrators:
            form.AddDomainIntegrator(integrator)
        form.Assemble()
        form.Finalize()
        matrix = form.SpMat()
        parts = matrix.GetDataArray(), matrix.GetJArray(), matrix.GetIArray()
        return csr_array(tuple(part.copy() for part in parts), shape=(matrix.Height(), matrix.Width()))

    def total(self, values, points):
        """Return the heat in the mesh."""
        self.place(points)
        return float((self.matrix(mfem.MassIntegrator()) @ values).sum())

    def step(self, values, start, end):
        """Return the temperature at the points at `end`, given that at `start`."""
        self.place(start)
        right = self.matrix(mfem.MassIntegrator()) @ values
        self.place(end)
        self.velocity.Assign(mfem.Vector(np.ascontiguousarray((end - start).T / DT).ravel()))
        # (w . grad u, v) transposed is (u w, grad v).
        velocity = mfem.VectorGridFunctionCoefficient(self.velocity)
        convection = mfem.TransposeIntegrator(mfem.ConvectionIntegrator(velocity, DT))
        conduction = mfem.DiffusionIntegrator(mfem.ConstantCoefficient(DT * DIFFUSIVITY))
        return spsolve(self.matrix(mfem.MassIntegrator(), conduction, convection).tocsc(), right)


if __name__ == "__main__":
    run(Heat, "MFEM")
