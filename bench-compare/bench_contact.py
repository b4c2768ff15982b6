"""Distances between a stent lattice and a tube, by motet and other programs on identical input."""
import subprocess
import sys

import numpy as np

from common import HERE, MOTET, TARGET, cell, in_turn, seconds_text, table

# Name in the table: keyword of rivals/contact_python.py, numbers of threads.
BY_VERTEX = {"libigl": ("igl", (1, 2)), "Embree (Open3D, f32)": ("embree", (1, 2)), "VTK static locator": ("vtk-cells", (1,)),
             "VTK implicit distance": ("vtk-implicit", (1,))}
NEAREST = {"FCL": "fcl", "coal": "coal"}
REFITS = ("motet", "parry")  # all others rebuild their trees in each step
# Accuracy of f64, relative to the size of the surfaces.
EXACT = 1e-12
# Targets of the project: ratios to the fastest other program in f64, seconds, and speed-up by a second
# thread.
WANTED = {"cold": 3.0, "step": 5.0, "nearest": 5e-3, "threads": 1.7}


def contenders(folder, quick):
    """Return {(program, threads): command}, and the files to which the programs write distances."""
    runs = 1 if quick else 5
    motet = MOTET / "examples" / "contact_timing"
    found = {("motet", t): [motet, "--threads", t, "--seconds", 0.05 if quick else 0.3, "--distances", prefix(folder, "motet", t)]
             for t in (1, 2)}
    for program, path in (("parry", TARGET / "contact_parry"), ("CGAL", TARGET / "contact_cgal")):
        found |= {(program, t): [path, folder, t, runs, prefix(folder, program, t)] for t in (1, 2) if path.exists()}
    python = [sys.executable, HERE / "rivals" / "contact_python.py"]
    for program, (keyword, threads) in BY_VERTEX.items():
        found |= {(program, t): [*python, keyword, folder, t, runs, prefix(folder, keyword, t)] for t in threads}
    for program, keyword in NEAREST.items():
        found[program, 1] = [*python, keyword, folder, 1, runs, "-"]
    places = {key: command[-1] for key, command in found.items() if key[0] not in NEAREST}
    return found, places


def prefix(folder, name, threads):
    return folder / f"{name}_{threads}t"


def run(record, options):
    folder = TARGET / "contact"
    subprocess.run([MOTET / "examples" / "contact_timing", "--write", folder], check=True)
    commands, places = contenders(folder, options.quick)
    results = in_turn(commands, options.rounds, options.limit)
    differences(folder, places, results)
    for (program, threads), result in results.items():
        record.add(**{**result, "bench": "contact", "program": program, "threads": threads})
    print("  contact: done", file=sys.stderr, flush=True)
    tables(results, commands)


def differences(folder, places, results):
    """Add the largest deviation of each program from the median of all f64 programs, relative to the tube's
    size."""
    corners = np.fromfile(folder / "tube.f64").reshape(-1, 3)
    size = np.linalg.norm(corners.max(0) - corners.min(0))
    for name, end in (("difference", ".f64"), ("difference_step", "_step.f64")):
        found = {key: np.fromfile(f"{places[key]}{end}") for key in places if "error" not in results[key]}
        middle = np.median([d for key, d in found.items() if "f32" not in key[0]], axis=0)
        for key, d in found.items():
            results[key][name] = float(np.abs(d - middle).max() / size)


def tables(results, commands):
    good = {key: result for key, result in results.items() if "error" not in result}
    by_vertex = {key: result for key, result in good.items() if key[0] not in NEAREST}
    motet = good.get(("motet", 1), {})
    print("\n## Distances between two surfaces\n")
    print(f"{motet.get('queries', 0):,} vertices of a stent lattice ({motet.get('inner_triangles', 0):,} triangles) against a tube "
          f"of {motet.get('triangles', 0):,} triangles.\nThe nearest triangle of the tube for every vertex, without previous results. "
          "Difference: largest deviation from the median of all f64 programs, relative to the size of the tube.\n")
    print(table(["program", "version", "threads", "set-up", "query", "both", "/motet", "difference", f"to {EXACT:g}"],
                [[*named(key, result), *times(result, "build_seconds", "cold_seconds", "seconds"),
                  ratio_to_motet(good, key, "seconds"), *exact(result["difference"])] for key, result in by_vertex.items()]))
    print("\nA time step: all points moved by up to 5e-4 in each direction (1 % of the gap). motet and parry refit their trees and "
          "start from\nthe previous results; CGAL rebuilds its tree and starts from the previous results; the others start anew.\n")
    print(table(["program", "threads", "tree", "time", "query", "both", "/motet", "difference", f"to {EXACT:g}"],
                [[*key, "refit" if key[0] in REFITS else "rebuilt", *times(result, "refit_seconds", "warm_seconds", "step_seconds"),
                  ratio_to_motet(good, key, "step_seconds"), *exact(result["difference_step"])] for key, result in by_vertex.items()]))
    nearest(good)
    whole(good)
    wanted(good)
    for (program, threads), result in results.items():
        if "error" in result:
            print(f"\nOmitted: {program}, threads {threads} ({result['error']})")
    for program in ("parry", "CGAL"):
        if (program, 1) not in commands:
            print(f"\nOmitted: {program} (not built)")


def nearest(good):
    print("\nOnly the nearest points of both surfaces, over all pairs of triangles; one thread. CGAL, libigl, Open3D and VTK"
          "\nhave no such query.\n")
    rows = []
    for program in ("motet", *NEAREST):
        if result := good.get((program, 1)):
            ours = program == "motet"
            keys = ("contact_new_seconds", "nearest_cold_seconds", "contact_refit_seconds", "nearest_warm_seconds") if ours else (
                "build_seconds", "cold_seconds", "refit_seconds", "warm_seconds")
            first, second = ("nearest_distance", "nearest_distance_step") if ours else ("distance", "distance_step")
            rows.append([program, result["version"], *times(result, *keys[:2]), "refit" if program in REFITS else "rebuilt",
                         *times(result, *keys[2:]), f"{result[first]:.15g}", f"{result[second]:.15g}"])
    print(table(["program", "version", "set-up", "first query", "tree in a step", "time", "query", "distance", "after the steps"], rows))


def whole(good):
    print("\nAll of motet's `Contact`: signed gaps of all vertices of both surfaces, nearest points and warnings, which no other program has.\n")
    keys = ("contact_new_seconds", "measure_cold_seconds", "contact_refit_seconds", "measure_seconds")
    print(table(["threads", "set-up", "first measurement", "refit in a step", "measurement"],
                [[t, *times(good["motet", t], *keys)] for t in (1, 2) if ("motet", t) in good]))


def wanted(good):
    if ("motet", 1) not in good:
        return
    ours = good["motet", 1]
    rows = []
    for what, key in (("cold", "seconds"), ("step", "step_seconds")):
        for threads in (1, 2):
            name, theirs = fastest(good, key, threads)
            if name and ("motet", threads) in good:
                rows.append([f"{what}, threads {threads}: {name} / motet", f"{theirs / good['motet', threads][key]:.2f}", WANTED[what]])
    built = {key: {"step_seconds": r["seconds" if key[0] in REFITS else "step_seconds"]} for key, r in good.items()}
    for threads in (1, 2):
        name, theirs = fastest(built, "step_seconds", threads)
        if name and ("motet", threads) in good:
            rows.append([f"step, threads {threads}: {name}, rebuilt / motet",
                         f"{theirs / good['motet', threads]['step_seconds']:.2f}", WANTED["step"]])
    rows.append(["nearest points in a step, without refit", seconds_text(ours["nearest_warm_seconds"]),
                 "< " + seconds_text(WANTED["nearest"])])
    if two := good.get(("motet", 2)):
        for what, key in (("first query", "cold_seconds"), ("query in a step", "warm_seconds"), ("set-up and query", "seconds"),
                          ("refit and query", "step_seconds"), ("complete step", "measure_seconds")):
            rows.append([f"{what}: threads 1 / 2", f"{ours[key] / two[key]:.2f}", WANTED["threads"]])
    print("\nCompared with the fastest other program in f64:\n")
    print(table(["quantity", "value", "target"], rows))


def fastest(good, key, threads):
    rivals = {program: r[key] for (program, t), r in good.items()
              if t == threads and program != "motet" and "f32" not in program and program not in NEAREST}
    return min(rivals.items(), key=lambda pair: pair[1], default=(None, None))


def ratio_to_motet(good, key, quantity):
    ours = good.get(("motet", key[1]), {}).get(quantity)
    return f"{good[key][quantity] / ours:.2f}" if ours else "-"


def named(key, result):
    return key[0], result["version"], key[1]


def times(result, *keys):
    return [cell(result, seconds_text(result[key])) for key in keys]


def exact(difference):
    return f"{difference:.1e}", "yes" if difference <= EXACT else "no"
