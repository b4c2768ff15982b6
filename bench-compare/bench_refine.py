"""Refinement towards a point, everywhere, and to a size near a coil, by motet and other programs with one
thread."""
import json
import subprocess
import sys

from common import HERE, MOTET, cell, in_turn, reference, seconds_text, table
from refine_files import Case, coil, first_mesh

ROUNDS = 3
LIMIT = 120.0  # time limit of a generation, in seconds
TIMEOUT = 1800.0  # time limit of a process including files, in seconds
POINT, POINT_TEXT, RADIUS, FACTOR = (1.0, 0.0, 0.0), "(1, 0, 0)", 1.2, 0.6
GENERATIONS = 8
DISTANCE, SIZE = 0.05, 0.05  # distance from the surface of the coil, and size of the tets there
# Name in the table: keyword of rivals/refine_python.py, module.
BISECTION = {"MFEM, bisection": ("mfem", "mfem.ser"), "NGSolve, bisection": ("ngsolve", "ngsolve"), "dolfinx, Plaza": ("dolfinx", "dolfinx")}
LOCAL = {**BISECTION, "MFEM, hanging vertices": ("mfem-hanging", "mfem.ser")}
UNIFORM = {"MFEM": ("mfem", "mfem.ser"), "NGSolve": ("ngsolve", "ngsolve"), "dolfinx, Plaza": ("dolfinx", "dolfinx"), "Gmsh": ("gmsh", "gmsh")}


def python_with(module):
    """Return the Python that has a module: this one or the system's (dolfinx is not on PyPI).

    None if neither has it.
    """
    for python in (sys.executable, "/usr/bin/python3"):
        try:
            if subprocess.run([python, "-c", f"import {module}"], capture_output=True).returncode == 0:
                return python
        except OSError:
            pass
    return None


def contenders(case, rivals):
    """Return {name: command}, and the names of programs that are not installed."""
    commands = {"motet": [MOTET / "examples" / "refine_rivals", case.json, case.out("motet")]}
    missing = []
    for name, (keyword, module) in rivals.items():
        if python := python_with(module):
            commands[name] = [python, HERE / "rivals" / "refine_python.py", keyword, case.json, case.out(name)]
        else:
            missing.append(name)
    return commands, missing


def cases(quick):
    """Yield each case, its programs, and the function that prints its table."""
    mesh, limit = first_mesh(quick), LIMIT
    radii = [RADIUS * FACTOR**k for k in range(2 if quick else GENERATIONS)]
    yield Case("local", mesh, len(radii), limit, near=[POINT], radii=radii), LOCAL, local
    yield Case("uniform", mesh, 1 if quick else 3, limit), UNIFORM, uniform
    size, distance = (4 * SIZE, 4 * DISTANCE) if quick else (SIZE, DISTANCE)
    yield Case("coil", mesh, 12, limit, near=coil(), radii=[distance], longest=size, whole=True), LOCAL, near_coil


def run(record, options):
    for case, rivals, shown in cases(options.quick):
        commands, missing = contenders(case, rivals)
        results = in_turn(commands, min(options.rounds, ROUNDS), max(options.limit, TIMEOUT))
        for program, result in results.items():
            if "error" not in result:
                case.measure(program, result)
            record.add(**{**result, "bench": "refine", "case": case.name, "program": program})
        print(f"  refine {case.name}: done", file=sys.stderr, flush=True)
        shown(case, {name: result for name, result in results.items() if "error" not in result})
        print_omitted(results, missing)


def print_omitted(results, missing):
    for name, result in results.items():
        if reason := result.get("error", result.get("stopped")):
            print(f"\nOmitted: {name} ({reason})")
    for name in missing:
        print(f"\nOmitted: {name} (not installed)")


def ratio_to_motet(results, generation, row):
    """Return the seconds of a generation relative to motet's."""
    ours = results.get("motet", {}).get("generations", [])
    return f"{row['seconds'] / ours[generation - 1]['seconds']:.2f}" if generation <= len(ours) else "-"


def shapes(row):
    return [f"{row['tets']:,}", f"{row['worst_to_first']:.3f}", f"{row['median']:.3f}", f"{row['mean_ratio_to_first']:.3f}"]


SHAPES = ["tets", "worst EAS", "median EAS", "worst mean ratio"]


def conformity(row):
    """Describe whether the mesh is conforming and has the right volume."""
    if not row["fills"]:
        return "volume lost"
    return {True: "yes", False: "no", None: "-"}[row["conforming"]]


def generations(case, results):
    """Yield the results of each program by generation, with the number of new tets per second."""
    for name, result in results.items():
        before = len(case.tets)
        for generation, row in enumerate(result["generations"], 1):
            row["new_per_second"] = (row["tets"] - before) / row["seconds"]
            before = row["tets"]
            yield name, result, generation, row


def heading(case, title, text):
    print(f"\n## {title}\n")
    print(f"{len(case.tets):,} tets, worst EAS {case.first['worst']:.3f}, median {case.first['median']:.3f}. {text}\n"
          "Worst EAS and worst mean ratio are relative to the initial mesh. One thread each; medians of up to "
          f"{ROUNDS} rounds in turn.\n")


def local(case, results):
    heading(case, "Refinement towards a point", f"Generation k divides the tets with a centroid closer to {POINT_TEXT} than "
            f"{RADIUS:g} {FACTOR:g}^(k-1).")
    rows = [[name, result["version"], generation, *shapes(row), cell(result, seconds_text(row["seconds"])),
             ratio_to_motet(results, generation, row), f"{row['new_per_second'] / 1e6:.2f} M", conformity(row)]
            for name, result, generation, row in generations(case, results)]
    print(table(["program", "version", "generation", *SHAPES, "seconds", "/motet", "new tets/s", "conforming"], rows))
    memory(results)
    best_of_others(results)
    print_reference("W6-local")


def memory(results):
    if rows := results.get("motet", {}).get("generations"):
        print(f"\nmotet stores {rows[-1]['memory_per_tet']:.0f} bytes per tet in addition to the mesh.")


def best_of_others(results):
    """Compare motet with the best of the conforming programs, in the last generation that all completed."""
    good = {name: result["generations"] for name, result in results.items()}
    last = min(map(len, good.values()), default=0)
    rivals = {name: rows[last - 1] for name, rows in good.items() if name in BISECTION}
    if "motet" not in good or not rivals:
        return
    ours, best = good["motet"][last - 1], lambda key, pick: pick(row[key] for row in rivals.values())
    rows = [["tets", f"{ours['tets']:,}", f"{best('tets', min):,}"],
            *[[what, f"{ours[key]:.3f}", f"{best(key, max):.3f}"] for what, key in (
                ("worst EAS", "worst_to_first"), ("median EAS", "median"), ("worst mean ratio", "mean_ratio_to_first"))],
            ["seconds", seconds_text(ours["seconds"]), seconds_text(best("seconds", min))],
            ["new tets/s", f"{ours['new_per_second'] / 1e6:.2f} M", f"{best('new_per_second', max) / 1e6:.2f} M"]]
    print(f"\nGeneration {last}, motet compared with the best conforming program in each row:\n")
    print(table(["quantity", "motet", "best"], rows))


def uniform(case, results):
    heading(case, "Refinement everywhere", "All tets, each generation.")
    rows = [[name, result["version"], generation, *shapes(row), cell(result, seconds_text(row["seconds"])), ratio_to_motet(results, generation, row),
             f"{row['new_per_second'] / 1e6:.2f} M", conformity(row)]
            for name, result, generation, row in generations(case, results)]
    print(table(["program", "version", "generation", *SHAPES, "seconds", "/motet", "new tets/s", "conforming"], rows))
    print("\nPeak memory over all generations: "
          + ", ".join(f"{name} {result['peak_mib']:,.0f} MiB" for name, result in results.items()) + ".")
    print_reference("W6-uniform")


def near_coil(case, results):
    rule = json.loads(case.json.read_text())
    heading(case, "Refinement to a size near a coil", f"Until no tet has an edge above {rule['longest']:g} and a bounding ball "
            f"about its centroid closer than {rule['radii'][0]:g} to the\nvertices of the surface of a coil (wire of radius 0.05, five turns).")
    ours = results.get("motet", {})
    rows = []
    for name, result in results.items():
        row = result["generations"][-1]
        over = lambda value, own: f"{value / own:.2f}" if own else "-"
        own = ours["generations"][-1]["tets"] if ours else None
        rows.append([name, result["version"], len(result["generations"]), *shapes(row), over(row["tets"], own),
                     cell(result, seconds_text(result["seconds"])), over(result["seconds"], ours.get("seconds")), conformity(row)])
    print(table(["program", "version", "generations", *SHAPES, "/motet", "seconds", "/motet", "conforming"], rows))


def print_reference(work):
    """Print measurements of the reference machine, with the same mesh and marks and one run each."""
    rows = [[r["peer"], r["version"], r["generation"], f"{r['tets']:,}", f"{r['q_ratio']:.3f}", f"{r['q_median']:.3f}", seconds_text(r["seconds"])]
            for r in reference() if r["work"].startswith(work) and "q_ratio" in r and "q_measure" not in r]
    if rows:
        print("\nOn the reference machine (another run, another machine), one run each:\n")
        print(table(["program", "version", "generation", "tets", "worst EAS", "median EAS", "seconds"], rows))
