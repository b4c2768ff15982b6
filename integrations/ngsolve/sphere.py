"""Incompressible flow round a sphere that drifts along a channel and swings across it, on a mesh that moves.

    pip install ./python ngsolve
    python integrations/ngsolve/sphere.py [--steps 100] [--size 1.0] [--swing 2.0] [--drift 4.0] [--worn 0.15] [--save end_{}.vtu]

The mesh is moved by motet, which repairs it when its worst tet is below `--worn`; by motet without repair; and by NGSolve's own solution of a
Laplace and of an elasticity equation. The flow is that of `flow.py`. Prints what the steps of each motion took, how the mesh fared, what each
repair did to the flow, and how far drag and lift are apart.
"""
import argparse
import functools
import time
from collections import defaultdict

import numpy as np
from netgen.occ import Box, OCCGeometry, Pnt, Sphere, X
from ngsolve import BilinearForm, Grad, GridFunction, InnerProduct, Sym, TaskManager, Trace, VectorH1, dx, specialcf

import motet
from flow import DT, RAMP, Flow, carried, ramp, to_ngsolve

RADIUS, PERIOD = 0.5, 4.0


def made(size):
    """The channel round the sphere, meshed by netgen, as a `motet.Mesh` whose patches have names."""
    box = Box(Pnt(-2, -2, -2), Pnt(4, 2, 2))
    box.faces.name = "sides"
    ball = Sphere(Pnt(0, 0, 0), RADIUS)
    ball.faces.name, ball.faces.maxh = "sphere", size / 4
    fluid = box - ball
    fluid.faces.Min(X).name, fluid.faces.Max(X).name = "inlet", "outlet"
    mesh = OCCGeometry(fluid).GenerateMesh(maxh=size)
    names = ["inlet", "outlet", "sides", "sphere"]
    labels = np.array([names.index(face.bcname) + 1 for face in mesh.FaceDescriptors()])
    tets, triangles = mesh.Elements3D().NumPy(), mesh.Elements2D().NumPy()
    return motet.Mesh(
        mesh.Coordinates(),
        {"tetra": tets["nodes"][:, [0, 1, 3, 2]] - 1, "triangle": triangles["nodes"] - 1},
        cell_data={"patch": np.concatenate([np.zeros(len(tets), int), labels[triangles["index"] - 1]])},
        patch_names=dict(enumerate(names, 1)),
    )


def path(t, drift, swing):
    """How far the sphere is from its first place."""
    return RADIUS * ramp(t) * np.array([drift * t / PERIOD, swing * np.sin(2 * np.pi * t / PERIOD), 0])


class ByMotet:
    """Certified steps from where the mesh was made or repaired last."""

    def __init__(self, mesh, worn=0.0, start=np.zeros(3)):
        self.mesh, self.worn, self.start = mesh, worn, start
        self.mover = motet.Mover(mesh, smooth=2)
        self.is_sphere = np.isin(self.mover.boundary, mesh.patch_vertices("sphere"))
        self.points = mesh.points.copy()

    def move(self, shift):
        self.shift = shift
        displacement = np.zeros((len(self.is_sphere), 3))
        displacement[self.is_sphere] = shift - self.start
        _, self.certificate = self.mover.advance(displacement, self.points)
        return self.points

    def is_worn(self):
        return self.certificate.worst_eas.value < self.worn

    def repaired(self):
        """The motion from here on, of the mesh repaired where it is, and what the repair changed. The boundary stays to the bit."""
        here = self.mesh.copy()
        here.points = self.points
        changed = motet.remesh(here)
        return ByMotet(changed.mesh, self.worn, self.shift), changed


class BySystem:
    """NGSolve's own: a linear system whose factor is kept, the fastest that it has for this."""

    def __init__(self, mesh, kind):
        self.mesh, self.sphere = mesh, mesh.patch_vertices("sphere")
        space = VectorH1(to_ngsolve(mesh, mesh.points), order=1, dirichlet="inlet|outlet|sides|sphere")
        u, v = space.TnT()
        stiffness = 1 / specialcf.mesh_size**3
        if kind == "elasticity":
            strain, test = Sym(Grad(u)), Sym(Grad(v))
            form = stiffness * (InnerProduct(strain, test) + 0.75 * Trace(strain) * Trace(test)) * dx
        else:
            form = stiffness * InnerProduct(Grad(u), Grad(v)) * dx
        self.matrix = BilinearForm(form).Assemble().mat
        self.inverse = self.matrix.Inverse(space.FreeDofs(), inverse="sparsecholesky")
        self.field = GridFunction(space)

    def move(self, shift):
        values = self.field.vec.FV().NumPy().reshape(3, -1)
        values[:] = 0
        values[:, self.sphere] = shift[:, None]
        self.field.vec.data -= self.inverse * (self.matrix * self.field.vec).Evaluate()
        return self.mesh.points + values.T

    def is_worn(self):
        return False


class Run:
    """The flow with one motion, to the end or to where the mesh tangles."""

    def __init__(self, mesh, motion_of):
        self.seconds, self.forces, self.worst_eas, self.tangled = defaultdict(list), [], 1.0, None
        self.motion = self.clocked("set-up", motion_of, mesh)
        self.flow = Flow(mesh)
        self.repairs, self.unrepaired = [], None

    def clocked(self, what, call, *given):
        begin = time.perf_counter()
        result = call(*given)
        self.seconds[what].append(time.perf_counter() - begin)
        return result

    def step(self, t, shift, wall):
        """Goes on to the time `t`; false where the mesh tangles on the way."""
        points = self.clocked("motion", self.motion.move, shift)
        there = motet.Mesh(points, self.motion.mesh.tets)
        self.worst_eas = min(self.worst_eas, there.quality().min())
        if there.quality("volume").min() <= 0:
            self.tangled = f"tangled at step {len(self.forces) + 1}, {(there.quality('volume') <= 0).sum()} tets inverted"
            return False
        self.forces.append(self.clocked("flow", self.flow.step, points, t, wall))
        if self.unrepaired:
            # The same step on the mesh that was not repaired says what the repair did to the drag.
            motion, flow = self.unrepaired
            self.repairs[-1]["drag"] = self.forces[-1][0] - flow.step(motion.move(shift), t, wall)[0]
            self.unrepaired = None
        if self.motion.is_worn():
            self.repair()
        return True

    def repair(self):
        self.unrepaired = self.motion, self.flow
        divergence = self.flow.divergence()
        self.motion, changed = self.clocked("repair", self.motion.repaired)
        self.flow = self.clocked("transfer", carried, self.flow, changed.mesh, changed.history)
        summary = {"step": len(self.forces), "bad": changed.report.before.bad, "left": changed.report.after.bad, "kept": changed.report.kept_share}
        self.repairs.append({**summary, "divergence": self.flow.divergence() / divergence, "drag": np.nan})

    def show(self, name):
        ms = {what: 1e3 * np.median(each) for what, each in self.seconds.items()}
        drag = np.array(self.forces)[:, 0]
        print(f"{name}: {len(drag)} steps, {self.tangled or 'not tangled'}; worst EAS {self.worst_eas:.3f}; last drag {drag[-1]:.5f}")
        print(f"  ms: {', '.join(f'{what} {each:.2f}' for what, each in ms.items())}; all flow steps {sum(self.seconds['flow']):.1f} s")
        for one in self.repairs:
            print(
                f"  step {one['step']}: {one['bad']} bad tets, {one['left']} left, {100 * one['kept']:.1f} % of the tets kept;"
                f" divergence times {one['divergence']:.4f}, next drag changed by {one['drag']:.5f}"
            )


def compare(first, other):
    """How far drag and lift are apart, once the flow has started, while both meshes are valid: in parts of their mean size."""
    n, begin = min(len(first.forces), len(other.forces)), round(RAMP / DT)
    if n <= begin:
        return "tangled before the flow has started"
    ours, theirs = [np.array(run.forces)[begin:n, :2] for run in (first, other)]
    apart = 100 * np.abs(ours - theirs) / np.abs(ours).mean(axis=0)
    (drag, lift), (most_drag, most_lift) = apart.mean(axis=0), apart.max(axis=0)
    return f"steps {begin + 1} to {n}: drag apart by {drag:.2f} % in the mean, {most_drag:.2f} % at most; lift by {lift:.2f} %, {most_lift:.2f} %"


def main():
    words = argparse.ArgumentParser()
    words.add_argument("--steps", type=int, default=100)
    words.add_argument("--size", type=float, default=1.0, help="edges far from the sphere; a quarter of it at the sphere")
    words.add_argument("--swing", type=float, default=2.0, help="to each side, in radii")
    words.add_argument("--drift", type=float, default=4.0, help="along the channel in 100 steps, in radii")
    words.add_argument("--worn", type=float, default=0.15, help="the EAS of the worst tet below which motet repairs")
    words.add_argument("--save", help="where the last meshes go; {} is the motion's name")
    options = words.parse_args()
    mesh = made(options.size)
    print(f"{mesh.n_points} vertices, {len(mesh.tets)} tets, {options.steps} steps of {DT}")
    motions = {
        "motet": functools.partial(ByMotet, worn=options.worn),
        "unrepaired": ByMotet,
        "Laplace": functools.partial(BySystem, kind="Laplace"),
        "elasticity": functools.partial(BySystem, kind="elasticity"),
    }
    runs = {}
    with TaskManager():
        for name, motion_of in motions.items():
            run = runs[name] = Run(mesh, motion_of)
            for k in range(1, options.steps + 1):
                shift, before = [path(DT * i, options.drift, options.swing) for i in (k, k - 1)]
                if not run.step(k * DT, shift, (shift - before) / DT):
                    break
            run.show(name)
            if run is not runs["motet"]:
                print(f"  beside motet, {compare(runs['motet'], run)}", flush=True)
            if options.save:
                last = run.motion.mesh.copy()
                last.points = run.flow.points()
                last.save(options.save.format(name))


if __name__ == "__main__":
    main()
