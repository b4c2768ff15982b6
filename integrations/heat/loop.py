"""Heat around a sphere that moves through a box, on a mesh that motet moves and repairs: the loop of all solvers.

The heat equation in conservative arbitrary Lagrangian-Eulerian form (Donea, Giuliani, Halleux 1982), linear
elements, implicit Euler, no flux through any wall: with the test function 1 the scheme keeps the total heat to
rounding, whatever the mesh does.
"""
import argparse
import time

import numpy as np

import motet
from motet import shapes

DIFFUSIVITY, DT = 1.0, 0.05


def run(Heat, solver):
    """Run the loop and print what became of the heat and of the mesh.

    `Heat(tets, points)` is the discretization in a solver on tets, (n, 4), with points, (n_points, 3). Its method
    `step(values, start, end)` returns the temperatures at the points at `end`, given those at `start`, both
    (n_points, 3); `total(values, points)` returns the heat.
    """
    parser = argparse.ArgumentParser(description=f"Heat around a moving sphere in {solver}")
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
    print(f"per step: motet {1e3 * seconds[0] / arguments.steps:.1f} ms, {solver} {1e3 * seconds[1] / arguments.steps:.1f} ms")

