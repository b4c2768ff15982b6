"""Incompressible flow in NGSolve on a mesh of arrays that moves, and is exchanged for a repaired one on the way.

Navier-Stokes in arbitrary Lagrangian-Eulerian form (Donea, Giuliani, Halleux 1982), Taylor and Hood's elements, implicit Euler, convection by
the velocity of the step before, pressure by the incremental projection of Goda (1979). `Mesh.SetDeformation` moves the mesh, by a field of
order 1.
"""
import netgen.meshing
import numpy as np
from ngsolve import (
    H1, BilinearForm, CoefficientFunction, Grad, GridFunction, InnerProduct, Integrate, LinearForm, Mesh, Preconditioner, Projector, VectorH1, div, dx, grad,
)  # fmt: skip
from ngsolve.krylovspace import CGSolver, GMResSolver

VISCOSITY, DT, RAMP = 0.05, 0.04, 0.6
TOLERANCE = 1e-9


def ramp(t):
    """From 0 to 1, so that nothing starts with a blow."""
    return np.sin(np.pi / 2 * min(t / RAMP, 1.0)) ** 2


def to_ngsolve(mesh, points):
    """A mesh of NGSolve: vertices in the order of the points, boundaries named after the patches."""
    made = netgen.meshing.Mesh(dim=3)
    made.AddPoints(np.ascontiguousarray(points))
    patches = mesh.cell_data["patch"][mesh.cell_ids("triangle")]
    for i, (label, name) in enumerate(mesh.patch_names.items()):
        index = made.Add(netgen.meshing.FaceDescriptor(surfnr=i + 1, domin=1, bc=i + 1))
        made.SetBCName(i, name)
        made.AddElements(dim=2, index=index, data=mesh.triangles[patches == label].astype(np.int32), base=0)
    # A tet of netgen is seen in a mirror.
    made.AddElements(dim=3, index=1, data=mesh.tets[:, [0, 1, 3, 2]].astype(np.int32), base=0)
    return Mesh(made)


class Flow:
    """Velocity and pressure on a `motet.Mesh`, whose points move."""

    def __init__(self, arrays):
        self.arrays, self.mesh = arrays, to_ngsolve(arrays, arrays.points)
        walls = "inlet|sides|sphere"
        self.scalars = H1(self.mesh, order=2, dirichlet=walls)
        self.velocities = VectorH1(self.mesh, order=2, dirichlet=walls)
        self.pressures = H1(self.mesh, order=1, dirichlet="outlet")
        self.velocity, self.pressure = GridFunction(self.velocities), GridFunction(self.pressures)
        self.moved, self.grid = [GridFunction(VectorH1(self.mesh, order=1)) for _ in range(2)]
        self.walls, self.free = self.mesh.Boundaries(walls), Projector(self.velocities.FreeDofs(), True)
        self.on_sphere = [GridFunction(self.velocities) for _ in range(3)]
        for axis, field in enumerate(self.on_sphere):
            field.Set(CoefficientFunction(tuple(float(axis == i) for i in range(3))), definedon=self.mesh.Boundaries("sphere"))

    def points(self):
        """Where the mesh is now."""
        return self.arrays.points + self.moved.vec.FV().NumPy().reshape(3, -1).T

    def step(self, points, t, wall):
        """One step, to the time `t` and the mesh at `points`; `wall` is the sphere's velocity. Gives the force on it."""
        moved = (points - self.arrays.points).T.ravel()
        self.grid.vec.FV().NumPy()[:] = (moved - self.moved.vec.FV().NumPy()) / DT
        self.moved.vec.FV().NumPy()[:] = moved
        self.mesh.SetDeformation(self.moved)
        old = GridFunction(self.velocities)
        old.vec.data = self.velocity.vec
        stream = old - self.grid
        self._predict(old, stream, (ramp(t), 0, 0), tuple(wall))
        self._project()
        u, v = self.velocity, self.velocities.TestFunction()
        inertia = InnerProduct(1 / DT * (old - u) - Grad(u) * stream, v)
        lack = LinearForm((inertia - VISCOSITY * InnerProduct(Grad(u), Grad(v)) + self.pressure * div(v)) * dx).Assemble().vec
        self.mesh.UnsetDeformation()
        # The force is what the equation lacks at the sphere's degrees of freedom.
        return np.array([InnerProduct(lack, unit.vec) for unit in self.on_sphere])

    def _predict(self, old, stream, inflow, wall):
        u, v = self.scalars.TnT()
        form = BilinearForm((1 / DT * u * v + VISCOSITY * InnerProduct(grad(u), grad(v)) + InnerProduct(stream, grad(u)) * v) * dx)
        jacobi = Preconditioner(form, "local")
        form.Assemble()
        v = self.velocities.TestFunction()
        right = GridFunction(self.velocities)
        right.vec.data = LinearForm((1 / DT * InnerProduct(old, v) + self.pressure * div(v)) * dx).Assemble().vec
        fixed = GridFunction(self.velocities)
        fixed.Set(self.mesh.BoundaryCF({"inlet": inflow, "sides": inflow, "sphere": wall}, default=(0, 0, 0)), definedon=self.walls)
        self.free.Project(self.velocity.vec)
        self.velocity.vec.data += fixed.vec
        solve = GMResSolver(mat=form.mat, pre=jacobi.mat, maxiter=500, tol=TOLERANCE)
        for axis in range(3):
            part = self.velocity.components[axis].vec
            part.data += solve * (right.components[axis].vec - form.mat * part).Evaluate()

    def _project(self):
        p, q = self.pressures.TnT()
        form = BilinearForm(InnerProduct(grad(p), grad(q)) * dx).Assemble()
        right = LinearForm(-1 / DT * div(self.velocity) * q * dx).Assemble()
        rise = GridFunction(self.pressures)
        rise.vec.data = form.mat.Inverse(self.pressures.FreeDofs(), inverse="sparsecholesky") * right.vec
        self.pressure.vec.data += rise.vec
        u, v = self.scalars.TnT()
        mass = BilinearForm(u * v * dx)
        jacobi = Preconditioner(mass, "local")
        mass.Assemble()
        change = GridFunction(self.velocities)
        change.vec.data = LinearForm(-DT * InnerProduct(grad(rise), self.velocities.TestFunction()) * dx).Assemble().vec
        solve = CGSolver(mat=mass.mat, pre=jacobi.mat, maxiter=500, tol=TOLERANCE)
        for axis in range(3):
            self.velocity.components[axis].vec.data += solve * change.components[axis].vec

    def divergence(self):
        """The L2 norm of the velocity's divergence, on the mesh where it is."""
        self.mesh.SetDeformation(self.moved)
        square = Integrate(div(self.velocity) ** 2, self.mesh)
        self.mesh.UnsetDeformation()
        return np.sqrt(square)


def carried(old, mesh, history):
    """The flow on a repaired mesh: to the bit at vertices and edges that stayed, elsewhere the old velocity's value in the place, pressure as motet interpolates it."""
    new = Flow(mesh)
    new.pressure.vec.FV().NumPy()[:] = history.transfer(old.pressure.vec.FV().NumPy(), on="points")
    # NGSolve finds points in a mesh that is not deformed: the old one, where it is now.
    here = to_ngsolve(old.arrays, old.points())
    field = GridFunction(VectorH1(here, order=2))
    field.vec.data = old.velocity.vec
    old_edges, new_edges = edges(old.mesh), edges(new.mesh)
    assert np.array_equal(edges(here), old_edges)
    kept = history.vertex_to_old
    edge_kept = same_edges(kept[new_edges], old_edges)
    ends, middles = mesh.points[kept < 0], mesh.points[new_edges[edge_kept < 0]].mean(axis=1)
    at_ends, at_middles = [field(here(*places.T)) if len(places) else np.zeros((0, 3)) for places in (ends, middles)]
    for axis in range(3):
        before = field.components[axis].vec.FV().NumPy()
        after = new.velocity.components[axis].vec.FV().NumPy()
        vertices, bubbles = after[: len(kept)], after[len(kept) :]
        vertices[:] = before[kept]
        vertices[kept < 0] = at_ends[:, axis]
        bubbles[:] = before[old.mesh.nv + edge_kept]
        # NGSolve's function of an edge is -1/8 in its middle.
        bubbles[edge_kept < 0] = 8 * (vertices[new_edges[edge_kept < 0]].mean(axis=1) - at_middles[:, axis])
    return new


def edges(mesh):
    """The two vertices of each edge."""
    return np.array([[v.nr for v in edge.vertices] for edge in mesh.edges])


def same_edges(wanted, known):
    """For each pair of vertices the number of the known edge that it is, or -1; a vertex of -1 is none."""
    n = known.max() + 1
    keys = known.min(axis=1) * n + known.max(axis=1)
    order = np.argsort(keys)
    sought = np.where(wanted.min(axis=1) < 0, -1, wanted.min(axis=1) * n + wanted.max(axis=1))
    found = order[np.searchsorted(keys[order], sought).clip(max=len(keys) - 1)]
    return np.where(keys[found] == sought, found, -1)
