"""Mesh motion at the paper's four sizes, with and without a rigid layer, by motet, a C loop, SciPy and linear
solvers."""
import sys
import time

import numpy as np

import openfoam
from common import HERE, MOTET, TARGET, busy_seconds, call, cell, combine, in_turn, own_seconds, reference
from common import seconds_text, table
from meshes import sphere_in_box, vtu

# Table 1 of the paper, in seconds: volume vertices, tets, boundary vertices, boundary triangles, elastic
# step; then, without and with a rigid layer, graph vertices, graph tets, set-up and Delaunay step. The
# printed number of graph tets of C with a layer lacks a digit ("14166"; about 99,000 would fit the other
# models).
PAPER = {
    "A": (10_203, 52_774, 2_700, 5_392, 4.421, (2_700, 7_811, 1.20, 2.22e-3), (5_400, 25_273, 2.21, 1.25e-3)),
    "B": (32_102, 175_181, 5_704, 11_400, 15.16, (5_704, 16_497, 3.47, 5.65e-3), (11_408, 52_450, 6.14, 6.66e-3)),
    "C": (72_655, 403_054, 10_854, 21_700, 35.15, (10_854, 31_549, 8.47, 11.5e-3), (21_708, None, 14.0, 11.6e-3)),
    "D": (157_887, 968_185, 16_947, 33_886, 78.69, (16_947, 49_462, 19.2, 30.8e-3), (33_894, 154_615, 28.9, 37.7e-3)),
}
LAYERS = ("no layer", "rigid layer")
BIG = 1 << 30  # bytes, more than any cache
LARGE = "56,64"  # motet's built-in sphere in a box with 1.2 M vertices, whose update exceeds the caches
LARGE_INSIDE = 1_185_408
BUDGET = 0.5  # seconds for which an update is repeated in one turn
SOLVE_LIMIT = 600.0  # time limit for the set-up and some steps of a linear system, in seconds
FACTOR = 8  # memory limit of motet's factorization, in GiB
# Programs that solve a linear system in each step: threads, solver, and ratio to a C loop on another machine.
SOLVERS = {
    "NGSolve, elastic": (2, "conjugate gradients, diagonal, 1e-8", 38_000),
    "pyamg, elastic": (1, "conjugate gradients, smoothed aggregation, 1e-8", None),
    "PARDISO, elastic": (2, "factor kept", None),
    "motet, elastic": (2, "conjugate gradients, two levels, 1e-8", None),
    "motet, elastic, factor": (1, "factor kept", None),
    "OpenFOAM, displacementSBRStress": (1, "conjugate gradients, incomplete Cholesky, relTol 0.01", None),
    "OpenFOAM, displacementLaplacian": (1, "conjugate gradients, incomplete Cholesky, relTol 0.01", 8_000),
    "NGSolve, laplace": (2, "conjugate gradients, multigrid, 1e-8", None),
    "pyamg, laplace": (1, "conjugate gradients, Ruge-Stueben, 1e-8", None),
    "PARDISO, laplace": (2, "factor kept", 2_800),
    "motet, laplace": (2, "conjugate gradients, two levels, 1e-8", None),
    "motet, laplace, factor": (1, "factor kept", None),
}


class Model:
    """One of the four sizes: its mesh, and the results of all programs."""

    def __init__(self, name):
        self.name = name
        self.points, self.tets, self.sphere, self.walls = sphere_in_box(name, TARGET)
        self.boundary = len(self.sphere) + len(self.walls)
        self.inside = len(self.points) - self.boundary
        self.folder = TARGET / f"motion_{name}"
        self.results = {}

    def measure(self, record, options):
        loop, scipy = TARGET / "motion_loop", [sys.executable, HERE / "rivals" / "motion_scipy.py"]
        mesh = TARGET / f"sphere_in_box_{self.name}.npz"
        self.add(record, {"SciPy set-up": combine([call([*scipy, "prepare", mesh, self.folder], options.limit)])})
        path = vtu(self.name, TARGET)
        arrays = [self.folder / "ids.u32", self.folder / "weights.f64", self.folder / "boundary.f64"]
        contenders = {f"motet {layer} {t}t": motet(path, layer, t) for layer in LAYERS for t in (1, 2)}
        contenders |= {f"C loop {t}t": [loop, "update", *arrays, t, BUDGET] for t in (1, 2)}
        same = [self.folder / name for name in ("all_ids.u32", "all_weights.f64", "displacement.f64", "from.f64")]
        contenders |= {f"C same {t}t": [loop, "move", *same, t, BUDGET] for t in (1, 2)}
        contenders["SciPy update"] = [*scipy, "update", self.folder, BUDGET]
        for t in (1, 2):
            contenders[f"copy {t}t"] = [loop, "copy", 72 * self.inside, t, BUDGET]
            contenders[f"copy big {t}t"] = [loop, "copy", BIG, t, BUDGET]
        self.add(record, in_turn(contenders, options.rounds, options.limit))
        for program, (threads, _, _) in SOLVERS.items():
            name, equation, *factor = program.split(", ")
            if name == "OpenFOAM":
                result = self.foam(options, equation) if openfoam.available() else {"error": "not installed"}
            elif name == "motet":
                kept = ["--factor", FACTOR] if factor else []
                result = combine([call([*motet(path, LAYERS[0], threads), "--method", equation, *kept], SOLVE_LIMIT)])
            else:
                rival = [sys.executable, HERE / "rivals" / "motion_python.py", name.lower(), equation, mesh, threads]
                result = combine([call(rival, SOLVE_LIMIT)])
            self.add(record, {program: result})

    def add(self, record, results):
        for program, result in results.items():
            record.add(**{**result, "bench": "motion", "model": self.name, "program": program})
        self.results |= results

    def foam(self, options, solver):
        busy, own, start = busy_seconds(), own_seconds(), time.perf_counter()
        try:
            rounds = min(options.rounds, 3)
            step = openfoam.step_seconds(TARGET / "foam", self.points, self.tets, self.sphere, 0.5, rounds, solver)
        except Exception as error:  # OpenFOAM is optional, so its errors must not stop the others
            return {"error": str(error)[-200:]}
        others = (busy_seconds() - busy) - (own_seconds() - own)
        return {"seconds": step, "other_cpu": max(0.0, others) / (time.perf_counter() - start), "version": "1912"}

    def seconds(self, program, key="seconds"):
        return self.results.get(program, {}).get(key)


def motet(path, layer, threads):
    rigid = ["--rigid-layer"] if layer == "rigid layer" else []
    return [MOTET / "examples" / "motion_timing", path, "--threads", threads, "--seconds", BUDGET, *rigid]


def run(record, options):
    models = []
    for name in options.sizes:
        models.append(Model(name))
        models[-1].measure(record, options)
        print(f"  motion {name}: done", file=sys.stderr, flush=True)
    print("\n## Mesh motion, sphere in a box at the paper's four sizes\n")
    print(f"Medians over {options.rounds} rounds in turn.")
    setups(models)
    updates(models)
    if "D" in options.sizes:
        large(record, models[-1], options)
    steps(models)
    solvers(models)
    paper(models)


def setups(models):
    """Print the set-up times: boundary, graph, and a tet with four weights for each vertex."""
    rows = []
    for m in models:
        for layer, theirs in zip(LAYERS, PAPER[m.name][5:]):
            one, two = (m.results[f"motet {layer} {t}t"] for t in (1, 2))
            ours = one.get("setup_seconds")
            rows.append([f"{m.name}, {layer}", f"{len(m.points):,}", f"{m.boundary:,}", f"{one.get('graph_tets', 0):,}",
                         shown(one, ours), shown(two, two.get("setup_seconds")),
                         shown(m.results["SciPy set-up"]) if layer == LAYERS[0] else "",
                         over(m.seconds("SciPy set-up"), ours) if layer == LAYERS[0] else "",
                         seconds_text(theirs[2]), over(theirs[2], ours, 0),
                         "< 250 ms" if m.name == "D" and layer == LAYERS[0] else ""])
    print("\nSet-up: boundary, graph, and a tet with four weights for every other vertex.\n")
    print(table(["model", "vertices", "boundary", "graph tets", "motet 1t", "motet 2t", "SciPy", "SciPy/motet",
                 "paper", "paper/motet", "target"], rows))


def updates(models):
    """Print the times of a step, and compare them with the memory bandwidth."""
    rows = []
    for m in models:
        for layer in LAYERS:
            one, two = (m.results[f"motet {layer} {t}t"] for t in (1, 2))
            a, b = one.get("seconds"), two.get("seconds")
            moved, n = one.get("bytes", 0), one.get("vertices", 1)
            rows.append([f"{m.name}, {layer}", shown(one), shown(two), over(a, b), nanoseconds(a, n),
                         f"{moved / n:.0f}", f"{moved / a / 1e9:.1f}" if a else "-",
                         *[percent(moved, m.results[f"motet {layer} {t}t"].get("seconds"), speed(m, f"copy{big} {t}t"))
                           for big in (" big", "") for t in (1, 2)],
                         shown(m.results["C loop 1t"]), shown(m.results["C loop 2t"]),
                         nanoseconds(m.seconds("C loop 1t"), m.inside), over(m.seconds("C loop 1t"), a),
                         over(m.seconds("C loop 2t"), b), shown(m.results["C same 1t"]), shown(m.results["C same 2t"]),
                         over(m.seconds("C same 1t"), a), over(m.seconds("C same 2t"), b), shown(m.results["SciPy update"]),
                         over(m.seconds("SciPy update"), a)])
    print("\nUpdate: all points from the displacement of the boundary. The C loops (`gcc -O3 -march=native`):"
          "\n`C` computes only the inner vertices, by positions instead of displacements, with 72 bytes each; `C same` does the same as motet,"
          "\nall vertices by displacements, with 96 bytes each. B/v: bytes that motet must move per vertex of the mesh. Shares are relative to the"
          "\nspeed of a plain copy in the same run: `memory` of 1 GiB, `cache` of as many bytes as the C loop moves.\n")
    print(table(["model", "motet 1t", "motet 2t", "1t/2t", "ns/v", "B/v", "GB/s", "of memory 1t", "2t", "of cache 1t", "2t",
                 "C 1t", "C 2t", "C ns/v", "C/motet 1t", "2t", "C same 1t", "2t", "C same/motet 1t", "2t", "SciPy", "SciPy/motet"], rows))
    print("\nCopy (read + write), GB/s:\n")
    print(table(["model", "bytes", "1t", "2t", "1 GiB 1t", "2t"],
                [[m.name, f"{72 * m.inside:,}", *[f"{speed(m, c):.1f}" for c in ("copy 1t", "copy 2t", "copy big 1t", "copy big 2t")]]
                 for m in models]))


def large(record, model, options):
    """Print the times of an update that exceeds the caches; the C loop repeats the weights of D."""
    files = []
    for name, kind, width in (("ids", np.uint32, 4), ("weights", np.float64, 4)):
        rows = np.fromfile(next(model.folder.glob(f"{name}.*")), kind).reshape(-1, width)
        files.append(TARGET / f"large_{name}")
        np.resize(rows, (LARGE_INSIDE, width)).tofile(files[-1])
    loop = TARGET / "motion_loop"
    contenders = {}
    for t in (1, 2):
        contenders[f"motet {t}t"] = motet(LARGE, LAYERS[0], t)
        contenders[f"C loop {t}t"] = [loop, "update", *files, model.folder / "boundary.f64", t, BUDGET]
        contenders[f"copy {t}t"] = [loop, "copy", BIG, t, BUDGET]
    results = in_turn(contenders, min(options.rounds, 3), options.limit)
    for program, result in results.items():
        record.add(**{**result, "bench": "motion", "model": "large", "program": program})
    rows = []
    for t in (1, 2):
        ours, loop, copy = (results[f"{name} {t}t"] for name in ("motet", "C loop", "copy"))
        n, moved, a = (ours.get(k) for k in ("vertices", "bytes", "seconds"))
        if not a or not loop.get("seconds") or not copy.get("seconds"):
            continue
        bandwidth = BIG / copy["seconds"] / 1e9
        rows.append([f"{t}", f"{n:,}", shown(ours), nanoseconds(a, n), f"{moved / n:.0f}", f"{moved / a / 1e9:.1f}",
                     f"{bandwidth:.1f}", f"{moved / a / 1e9 / bandwidth:.0%}", "80%",
                     nanoseconds(loop["seconds"], LARGE_INSIDE), f"{72 * LARGE_INSIDE / loop['seconds'] / 1e9:.1f}",
                     over(loop["seconds"] / LARGE_INSIDE, a / n)])
    print("\nUpdate of a mesh larger than the caches (the C loop has as many inner vertices, with repeated weights of D).\n")
    print(table(["threads", "vertices", "motet", "ns/v", "B/v", "GB/s", "copy GB/s", "share", "target", "C ns/v", "C GB/s",
                 "C/motet per vertex"], rows))


def steps(models):
    """Print the times of a rebuilt graph with one step, and of one step of OpenFOAM's
    displacementLaplacian."""
    sizes = {"A": 9_921, "B": 31_874, "C": 75_813, "D": 157_535}
    known = {r["size"]: r["seconds"] for r in reference() if r["work"] == "W2-step" and r["seconds"]
             and r["peer"] == "openfoam-displacementLaplacian" and r.get("reltol") == 0.01}
    rows = []
    for m in models:
        ours = [m.seconds(f"motet {LAYERS[0]} {t}t", "rebuild_seconds") for t in (1, 2)]
        foam, other = m.results.get("OpenFOAM, displacementLaplacian"), known.get(sizes[m.name])
        rows.append([m.name, *map(seconds_text, ours), shown(foam) if foam else "not installed",
                     over(foam and foam.get("seconds"), ours[0], 1), seconds_text(other), over(other, ours[0], 1), "8"])
    print("\nRebuilding graph and weights plus one step, compared with one step of OpenFOAM's displacementLaplacian"
          "\n(PCG, relTol 0.01, diffusivity 1/volume; one thread; motion along x only).\n")
    print(table(["model", "motet 1t", "motet 2t", "OpenFOAM here", "OpenFOAM/motet", "OpenFOAM, reference machine", "ratio",
                 "target"], rows))


def solvers(models):
    """Print the times of programs that solve a linear system in each step, also relative to motet's steps."""
    known = {m.name: [m.results[f"motet {layer} 2t"] for layer in LAYERS] for m in models}
    rows = []
    for program, (threads, how, reached) in SOLVERS.items():
        row = [program, threads, how]
        for m in models:
            result = m.results.get(program)
            step, setup = ((result or {}).get(key) for key in ("seconds", "setup_seconds"))
            if program.endswith("factor") and step and not result["setup"]["factor_bytes"]:
                row += [f"factorization above {FACTOR} GiB", "-", "-", "-", "-"]
                continue
            row += [cell(result, seconds_text(setup)), shown(result)]
            row += [over(step, r.get("seconds"), 0) for r in known[m.name]]
            row.append(over(step, known[m.name][0].get("rebuild_seconds"), 1))
        largest = models[-1]
        row += [over(largest.seconds(program), largest.seconds("C loop 2t"), 0), f"{reached:,}" if reached and largest.name == "D" else ""]
        rows.append(row)
    head = [f"{m.name} {column}" for m in models for column in ("set-up", "step", "ratio", "rigid layer", "rebuilt")]
    print("\nSteps that solve a linear system, compared with motet's (two threads). `ratio`: to the update without a layer; `rigid layer`: to"
          "\nthe update with one; `rebuilt`: to graph, weights and a step together (target: 30). `C loop`: of the largest model, to the C loop on two"
          "\nthreads; `reached`: that ratio on the machine of the target. The sphere moves along x, so the iterated Laplace equations"
          "\nare solved only for x, except by motet.\n")
    print(table(["program", "threads", "solver", *head, "C loop", "reached"], rows))


def paper(models):
    """Print table 1 of the paper row by row, each cell as `paper / here`."""
    columns = [(m, layer, PAPER[m.name], PAPER[m.name][5 + i], m.results[f"motet {layer} 1t"])
               for m in models for i, layer in reversed(list(enumerate(LAYERS)))]
    pair = lambda a, b: f"{a} / {b}"
    count = lambda v: "?" if v is None else f"{v:,}"
    solved = lambda m: m.seconds("NGSolve, elastic")
    factor = lambda slow, fast: f"{slow / fast:,.0f}" if slow and fast else "-"
    rows = [
        ["volume nodes", *[pair(count(p[0]), count(len(m.points))) for m, _, p, _, _ in columns]],
        ["volume elements", *[pair(count(p[1]), count(len(m.tets))) for m, _, p, _, _ in columns]],
        ["boundary nodes", *[pair(count(p[2]), count(m.boundary)) for m, _, p, _, _ in columns]],
        ["boundary elements", *[pair(count(p[3]), count(2 * m.boundary - 8)) for m, _, p, _, _ in columns]],
        ["Delaunay nodes", *[pair(count(q[0]), count(r.get("graph_nodes"))) for _, _, _, q, r in columns]],
        ["Delaunay elements", *[pair(count(q[1]), count(r.get("graph_tets"))) for _, _, _, q, r in columns]],
        ["total Delaunay setup time", *[pair(seconds_text(q[2]), seconds_text(r.get("setup_seconds"))) for _, _, _, q, r in columns]],
        ["computational timestep: elastic",
         *[pair(seconds_text(p[4]), seconds_text(solved(m))) for m, _, p, _, _ in columns]],
        ["computational timestep: Delaunay", *[pair(seconds_text(q[3]), seconds_text(r.get("seconds"))) for _, _, _, q, r in columns]],
        ["speed increase factor", *[pair(factor(p[4], q[3]), factor(solved(m), r.get("seconds"))) for m, _, p, q, r in columns]],
    ]
    print("\nTable 1 of the paper, row by row, each cell `paper / here` (here with one thread, and with NGSolve on two threads"
          "\nfor elasticity).\n")
    print(table(["", *[f"{m.name}{' rigid' if layer == LAYERS[1] else ''}" for m, layer, *_ in columns]], rows))


def shown(result, seconds=None):
    return cell(result, seconds_text(seconds or (result and result.get("seconds"))))


def over(slow, fast, digits=2):
    return f"{slow / fast:,.{digits}f}" if slow and fast else "-"


def nanoseconds(seconds, n):
    return f"{seconds / n * 1e9:.2f}" if seconds else "-"


def speed(model, program):
    """Return the speed of a copy in GB/s."""
    size = BIG if "big" in program else 72 * model.inside
    return size / model.seconds(program) / 1e9


def percent(moved, seconds, gigabytes):
    return f"{moved / seconds / 1e9 / gigabytes:.0%}" if seconds else "-"
