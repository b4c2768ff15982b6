"""Incompressible flow in NGSolve on a moving `motet.Mesh`, which can be replaced by a repaired mesh.

Navier-Stokes equations in arbitrary Lagrangian-Eulerian form (Donea, Giuliani, Halleux 1982), Taylor-Hood
elements, implicit Euler with convection by the velocity of the previous step, and the incremental projection
of Goda (1979) for the pressure. `Mesh.SetDeformation` moves the mesh by a field of order 1.
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
    """Return a smooth rise from 0 to 1, which avoids an impulsive start."""
    return np.sin(np.pi / 2 * min(t / RAMP, 1.0)) ** 2


def to_ngsolve(mesh, points):
    """Return a mesh of NGSolve, with vertices in the order of the points and boundaries named after the
    patches."""
    made = netgen.meshing.Mesh(dim=3)
    made.AddPoints(np.ascontiguousarray(points))
    patches = mesh.cell_data["patch"][mesh.cell_ids("triangle")]
    for i, (label, name) in enumerate(mesh.patch_names.items()):
        index = made.Add(netgen.meshing.FaceDescriptor(surfnr=i + 1, domin=1, bc=i + 1))
        made.SetBCName(i, name)
        made.AddElements(dim=2, index=index, data=mesh.triangles[patches == label].astype(np.int32), base=0)
    # Tets of netgen have the opposite orientation.
    made.AddElements(dim=3, index=1, data=mesh.tets[:, [0, 1, 3, 2]].astype(np.int32), base=0)
    return Mesh(made)


class Flow:
    """Velocity and pressure on a `motet.Mesh` with moving points."""

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
        """Return the current points of the mesh."""
        return self.arrays.points + self.moved.vec.FV().NumPy().reshape(3, -1).T

    def step(self, points, t, wall):
        """Advance to the time `t` and the mesh at `points`.

        Return the force on the sphere, which moves at `wall`.
        """
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
        residual = LinearForm((inertia - VISCOSITY * InnerProduct(Grad(u), Grad(v)) + self.pressure * div(v)) * dx).Assemble().vec
        self.mesh.UnsetDeformation()
        # The force is the residual of the equation at the degrees of freedom of the sphere.
        return np.array([InnerProduct(residual, unit.vec) for unit in self.on_sphere])

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
        """Return the L2 norm of the divergence of the velocity on the current mesh."""
        self.mesh.SetDeformation(self.moved)
        square = Integrate(div(self.velocity) ** 2, self.mesh)
        self.mesh.UnsetDeformation()
        return np.sqrt(square)


def carried(old, mesh, history):
    """Return the flow on a repaired mesh.

    The velocity is copied exactly at unchanged vertices and edges, and evaluated in the old mesh elsewhere;
    the pressure is interpolated by motet.
    """
    new = Flow(mesh)
    new.pressure.vec.FV().NumPy()[:] = history.transfer(old.pressure.vec.FV().NumPy(), on="points")
    # NGSolve locates points only in undeformed meshes, so the old mesh is rebuilt at its current position.
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
        # The edge function of NGSolve is -1/8 at the midpoint.
        bubbles[edge_kept < 0] = 8 * (vertices[new_edges[edge_kept < 0]].mean(axis=1) - at_middles[:, axis])
    return new


def edges(mesh):
    """Return the two vertices of each edge."""
    return np.array([[v.nr for v in edge.vertices] for edge in mesh.edges])


def same_edges(wanted, known):
    """Return for each pair of vertices the index of the known edge, or -1; also -1 if a vertex is -1."""
    n = known.max() + 1
    keys = known.min(axis=1) * n + known.max(axis=1)
    order = np.argsort(keys)
    sought = np.where(wanted.min(axis=1) < 0, -1, wanted.min(axis=1) * n + wanted.max(axis=1))
    found = order[np.searchsorted(keys[order], sought).clip(max=len(keys) - 1)]
    return np.where(keys[found] == sought, found, -1)
