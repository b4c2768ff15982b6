"""Reproduces table 1 of the paper: times of mesh motion by the Delaunay graph and by pseudo-elasticity.

    target/venv/bin/python examples/paper/table_1.py            (about three minutes)
    target/venv/bin/python examples/paper/table_1.py A B        (only these sizes)

Prints two tables for meshes of four sizes. A sphere in a box moves by half its radius. Each call of `motet
move` is a separate process with one thread. Times are medians of REPEATS calls; a step of the graph is the
median of STEPS steps. Pseudo-elasticity is motet's `--method elastic` with the stiffness 1/volume, with one
step per call, so that iterations do not start from the solution. Set-up times are given for both.
"""
import os
import sys
from statistics import median

from common import motet_json, print_table, work

# Cells along a side of the cubed sphere, and layers from it to the walls: close to the numbers of the paper.
SIZES = {"A": (15, 7), "B": (22, 10), "C": (30, 13), "D": (38, 17)}
REPEATS, STEPS = 5, 21
LAYER = ("--rigid-layer", "1layers", "--rigid-layer-at", "sphere", "--rigid-layer-at", "box")
# Times in the paper, in seconds: set-up without and with a rigid layer, step of the elastic solver, and step
# of the graph without and with a rigid layer.
PAPER = {
    "A": (1.20, 2.21, 4.42, 2.22e-3, 1.25e-3),
    "B": (3.47, 6.14, 15.16, 5.65e-3, 6.66e-3),
    "C": (8.47, 14.0, 35.15, 11.5e-3, 11.6e-3),
    "D": (19.2, 28.9, 78.69, 30.8e-3, 37.7e-3),
}


def made(name):
    """Write the mesh to a file and return its path."""
    from motet import shapes

    path = work(f"table_1_{name}.vtu")
    shapes.sphere_in_box(*SIZES[name]).save(path)
    return path


def calls(path, *options):
    """Return the reports of REPEATS calls that move the sphere."""
    move = ("move", path, "-o", work("table_1_moved.vtu"), "--translate", "sphere=0.5,0,0", "--threads", 1)
    return [motet_json(*move, *options) for _ in range(REPEATS)]


def setup_time(reports):
    return median(one["setup"]["seconds"]["total"] for one in reports)


def step_time(reports):
    """Return the time of a step; the first of several steps in a call, with cold caches, is omitted."""
    return median(median(step["seconds"]["update"] for step in one["steps"][1:] or one["steps"]) for one in reports)


def measured(name):
    """Return the counts of a size, and the times in the order of PAPER, followed by the elastic set-up."""
    path = made(name)
    summary = motet_json("info", path)
    plain, rigid = calls(path, "--steps", STEPS), calls(path, "--steps", STEPS, *LAYER)
    elastic = calls(path, "--steps", 1, "--method", "elastic")
    times = [setup_time(plain), setup_time(rigid), step_time(elastic), step_time(plain), step_time(rigid), setup_time(elastic)]
    return (summary, plain[0]["setup"], rigid[0]["setup"]), times


def count_row(name, counts):
    summary, plain, rigid = counts
    graph = [f"{one[key]:,}" for key in ("graph_nodes", "graph_tets") for one in (plain, rigid)]
    cells = summary["cells"]
    return [name, f"{summary['points']:,}", f"{cells['tetra']:,}", f"{plain['driven']:,}", f"{cells['triangle']:,}", *graph]


def time_row(who, times):
    plain, rigid, elastic, step, step_rigid = times[:5]
    return [*who, *map(duration, (plain, rigid, step, step_rigid, elastic)), f"{elastic / step:,.0f}", f"{elastic / step_rigid:,.0f}"]


def duration(seconds):
    unit, name = next((u for u in ((1.0, "s"), (1e-3, "ms")) if seconds >= u[0]), (1e-6, "us"))
    return f"{seconds / unit:.3g} {name}"


def main():
    names = sys.argv[1:] or list(SIZES)
    found = {name: measured(name) for name in names}
    print(f"load of the machine at the end, {os.cpu_count()} cores: {os.getloadavg()[0]:.1f}\n")
    graph = ["graph nodes", "with a layer", "graph tets", "with a layer"]
    print_table(["size", "vertices", "tets", "on the boundary", "triangles", *graph], [count_row(n, c) for n, (c, _) in found.items()])
    print()
    head = ["size", "", "set-up", "with a layer", "step", "with a layer", "elastic step", "elastic / step", "with a layer"]
    rows = [row for n, (_, t) in found.items() for row in (time_row((n, "2008"), PAPER[n]), time_row((n, "now"), t))]
    print_table(head, rows)
    for name, (_, times) in found.items():
        print(f"{name}: set-up of the elastic body {duration(times[5])}")


if __name__ == "__main__":
    main()
