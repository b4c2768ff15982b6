"""Incompressible flow round a sphere that swings across the stream, on a mesh that moves: by motet, or by NGSolve's own solution of a Laplace or an elasticity equation.

    pip install ./python ngsolve
    python integrations/ngsolve/sphere.py [--steps 100] [--size 0.9]

Navier-Stokes in arbitrary Lagrangian-Eulerian form (Donea, Giuliani, Halleux 1982), Taylor and Hood's elements, implicit Euler, convection by the velocity of the step before. The mesh is moved by
`Mesh.SetDeformation` with a field of order 1, whose values are motet's displacements as they are. Prints what the steps of each motion took, and the drag and lift of both.
"""
import argparse
import math
import time

import numpy as np
from netgen.occ import Box, OCCGeometry, Pnt, Sphere, X
from ngsolve import (
    H1, BilinearForm, CoefficientFunction, Grad, GridFunction, InnerProduct, LinearForm, Mesh, Sym, TaskManager, Trace, VectorH1, div, dx, specialcf,
)  # fmt: skip

import motet

RADIUS, VISCOSITY, DT, AMPLITUDE, PERIOD = 0.5, 0.02, 0.02, 0.3, 2.0


def made(size):
    box = Box(Pnt(-2, -2, -2), Pnt(4, 2, 2))
    box.faces.name = "sides"
    ball = Sphere(Pnt(0, 0, 0), RADIUS)
    ball.faces.name, ball.faces.maxh = "sphere", size / 4
    fluid = box - ball
    fluid.faces.Min(X).name, fluid.faces.Max(X).name = "inlet", "outlet"
    return Mesh(OCCGeometry(fluid).GenerateMesh(maxh=size))


def shift(t):
    return AMPLITUDE * math.sin(2 * math.pi * t / PERIOD)


class ByMotet:
    name = "motet"

    def __init__(self, mesh, _space):
        points = np.array([v.point for v in mesh.vertices])
        tets = np.array([[v.nr for v in element.vertices] for element in mesh.Elements()])
        # Which way round NGSolve's tets are is its own affair.
        if motet.Mesh(points, tets).quality("volume").mean() < 0:
            tets = tets[:, [0, 1, 3, 2]]
        self.mesh = motet.Mesh(points, tets)
        self.mover = motet.Mover(self.mesh, smooth=2)
        self.is_sphere = np.linalg.norm(points[self.mover.boundary], axis=1) < RADIUS * 1.01
        self.points = points.copy()

    def move(self, y, field):
        displacement = np.zeros((len(self.mover.boundary), 3))
        displacement[self.is_sphere, 1] = y
        _, certificate = self.mover.advance(displacement, self.points)
        assert certificate.complete
        field.vec.FV().NumPy()[:] = (self.points - self.mesh.points).T.ravel()


class BySystem:
    """A factor of the system that is kept: the fastest that NGSolve has for this."""

    def __init__(self, name, mesh, space):
        self.name = name
        u, v = space.TnT()
        stiffness = 1 / specialcf.mesh_size**3
        if name == "elasticity":
            strain, test = Sym(Grad(u)), Sym(Grad(v))
            form = stiffness * (InnerProduct(strain, test) + 0.75 * Trace(strain) * Trace(test)) * dx
        else:
            form = stiffness * InnerProduct(Grad(u), Grad(v)) * dx
        self.matrix = BilinearForm(form).Assemble().mat
        self.inverse = self.matrix.Inverse(space.FreeDofs(), inverse="sparsecholesky")
        self.mesh = mesh

    def move(self, y, field):
        field.Set(CoefficientFunction((0, y, 0)), definedon=self.mesh.Boundaries("sphere"))
        work = field.vec.CreateVector()
        work.data = self.matrix * field.vec
        field.vec.data -= self.inverse * work


def flow(mesh, motion_of, steps):
    """Forces on the sphere, and the seconds of motion and of flow."""
    space = VectorH1(mesh, order=1, dirichlet="inlet|outlet|sides|sphere")
    now, before = GridFunction(space), GridFunction(space)
    begin = time.perf_counter()
    motion = motion_of(mesh, space)
    setup = time.perf_counter() - begin
    velocities = VectorH1(mesh, order=2, dirichlet="inlet|sides|sphere")
    both = velocities * H1(mesh, order=1)
    (u, p), (v, q) = both.TnT()
    state, old = GridFunction(both), GridFunction(both)
    state.components[0].Set(CoefficientFunction((1, 0, 0)), definedon=mesh.Boundaries("inlet|sides"))
    grid = GridFunction(space)
    forces, moving, solving = [], 0.0, 0.0
    for k in range(1, steps + 1):
        old.vec.data = state.vec
        before.vec.data = now.vec
        begin = time.perf_counter()
        motion.move(shift(k * DT), now)
        moving += time.perf_counter() - begin
        begin = time.perf_counter()
        grid.vec.data = 1 / DT * (now.vec - before.vec)
        mesh.SetDeformation(now)
        stream = old.components[0] - grid
        form = BilinearForm(both)
        form += (1 / DT * u * v + VISCOSITY * InnerProduct(Grad(u), Grad(v)) + (Grad(u) * stream) * v - div(v) * p - div(u) * q - 1e-10 * p * q) * dx
        form.Assemble()
        right = LinearForm(1 / DT * old.components[0] * v * dx).Assemble()
        wall = (shift(k * DT) - shift((k - 1) * DT)) / DT
        state.components[0].Set(CoefficientFunction((1, 0, 0)), definedon=mesh.Boundaries("inlet|sides"))
        fixed = GridFunction(velocities)
        fixed.Set(mesh.BoundaryCF({"inlet": (1, 0, 0), "sides": (1, 0, 0), "sphere": (0, wall, 0)}, default=(0, 0, 0)), definedon=mesh.Boundaries("inlet|sides|sphere"))
        state.components[0].vec.data = fixed.vec
        residual = right.vec.CreateVector()
        residual.data = right.vec - form.mat * state.vec
        state.vec.data += form.mat.Inverse(both.FreeDofs(), inverse="pardiso") * residual
        # The force is what the equation lacks at the sphere's degrees of freedom.
        residual.data = right.vec - form.mat * state.vec
        total = []
        for axis in (0, 1):
            test = GridFunction(velocities)
            unit = tuple(float(axis == i) for i in range(3))
            test.Set(CoefficientFunction(unit), definedon=mesh.Boundaries("sphere"))
            whole = GridFunction(both)
            whole.components[0].vec.data = test.vec
            total.append(InnerProduct(residual, whole.vec))
        forces.append(total)
        mesh.UnsetDeformation()
        solving += time.perf_counter() - begin
    return np.array(forces), setup, moving / steps, solving / steps


def main():
    words = argparse.ArgumentParser()
    words.add_argument("--steps", type=int, default=100)
    words.add_argument("--size", type=float, default=1.0)
    asked = words.parse_args()
    mesh = made(asked.size)
    print(f"{mesh.nv} vertices, {mesh.ne} tets, {asked.steps} steps of {DT}")
    results = {}
    with TaskManager():
        for name, motion in [("motet", ByMotet), ("Laplace", lambda *w: BySystem("Laplace", *w)), ("elasticity", lambda *w: BySystem("elasticity", *w))]:
            forces, setup, moving, solving = results[name] = flow(mesh, motion, asked.steps)
            print(f"{name}: set-up {1e3 * setup:.1f} ms, a motion {1e3 * moving:.2f} ms, a flow step {1e3 * solving:.0f} ms; mean drag {forces[:, 0].mean():.5f}, last {forces[-1, 0]:.5f}", flush=True)
    for name in ("Laplace", "elasticity"):
        apart = np.abs(results["motet"][0] - results[name][0]).max(axis=0) / np.abs(results[name][0]).max(axis=0)
        print(f"motet and {name}: drag apart by {100 * apart[0]:.2f} %, lift by {100 * apart[1]:.2f} % of the largest")


if __name__ == "__main__":
    main()
