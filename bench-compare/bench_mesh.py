"""Meshing of closed surfaces of vessels and devices, without and with interior points, by motet and other
meshers."""
import math
import sys

from common import HERE, MOTET, call, cell, in_turn, seconds_text, table
from mesh_files import calibrated, surfaces

ROUNDS = 3
RUNS = 3  # repeats in a process, fewer if they take long
LIMIT = 120.0  # time limit in seconds, for a process, and for all that search for one size
# Name in the table: options of `motet mesh`.
OURS = {"motet --delaunay": ["--delaunay"], "motet": []}
# Name in the table: keyword of rivals/mesh_python.py.
PLAIN = {"TetGen -p": "tetgen", "TetGen -pY": "tetgen-keep"}
# Name in the table: keyword, first size relative to motet's, and number of trials to match motet's number of
# tets (0: none).
SIZED = {"TetGen -pq1.2/14aVY": ("tetgen-quality", 1.3, 6), "Gmsh": ("gmsh", 0.8, 6), "Gmsh HXT": ("gmsh-hxt", 0.8, 6), "fTetWild": ("ftetwild", 1.0, 0)}
ONCE = ("fTetWild",)  # one round, since it takes minutes


def run(record, options):
    rounds, limit = min(options.rounds, ROUNDS), max(options.limit, LIMIT)
    cases, missing = surfaces(options.quick, options.surfaces)
    plain, sized = {}, {}
    for case in cases:
        plain[case.name] = finished(record, case, "plain", filled(case, rounds, limit))
        print(f"  mesh {case.name}: filled", file=sys.stderr, flush=True)
        sized[case.name] = finished(record, case, "sized", with_size(case, rounds, limit))
        print(f"  mesh {case.name}: filled with a size", file=sys.stderr, flush=True)
    tables({case.name: case for case in cases}, plain, sized)
    for name in missing:
        print(f"\nOmitted: {name} (no file: set MOTET_DATA to the folder of real meshes)")


def ours(case, name, options):
    return [sys.executable, HERE / "mesh_motet.py", MOTET / "motet", RUNS, case.vtp, case.out(name, ".vtu"), *options]


def rival(case, name, keyword, size, runs=RUNS):
    return [sys.executable, HERE / "rivals" / "mesh_python.py", keyword, size, runs, case.npz, case.out(name, ".npz")]


def filled(case, rounds, limit):
    """Run all programs without interior points, except those that are required."""
    commands = {name: ours(case, name, options) for name, options in OURS.items()}
    commands |= {name: rival(case, name, keyword, case.size) for name, keyword in PLAIN.items()}
    return in_turn(commands, rounds, limit)


def with_size(case, rounds, limit):
    """Run motet with the size of the case, and the others with sizes that give about as many tets."""
    name = "motet --size"
    results = in_turn({name: ours(case, name, ["--size", case.size])}, rounds, limit)
    report = results[name].get("improved")
    target = report["after"]["tets"] if report else None
    commands, sizes = {}, {}
    for other, (keyword, first, tries) in SIZED.items():
        sizes[other], error = size_for(case, other, keyword, target, first * case.size, tries, limit)
        if sizes[other]:
            commands[other] = rival(case, other, keyword, sizes[other])
        else:
            results[other] = {"error": error}
    quick = {other: command for other, command in commands.items() if other not in ONCE}
    results |= in_turn(quick, rounds, limit)
    results |= in_turn({other: commands[other] for other in ONCE if other in commands}, 1, limit)
    results[name]["size"] = case.size
    for other, size in sizes.items():
        results[other]["size"] = size
    return {other: results[other] for other in (name, *SIZED)}


def size_for(case, name, keyword, target, first, tries, limit):
    """Return the size to request from a program, or None and the error if it fails at once. Not timed."""
    spent, error = 0.0, ["?"]

    def count(size):
        nonlocal spent
        if spent > limit:
            return None
        result = call(rival(case, name, keyword, size, runs=1), limit)
        spent += result.get("wall", 0.0)
        error[0] = result.get("error")
        return result.get("tets")

    if target is None or tries == 0:  # no number of tets to match
        return first, None
    return calibrated(count, target, first, tries), error[0]


def finished(record, case, part, results):
    """Add the quality of the meshes to the results, and record them."""
    for name, result in results.items():
        if "error" in result:
            result["error"] = short_error(result["error"])
        else:
            result |= case.measured(case.out(name, ".vtu" if name.startswith("motet") else ".npz"))
        record.add(**{**result, "bench": "mesh", "part": part, "surface": case.name, "program": name})
    return results


def short_error(error):
    """Return a short description of the error of a program."""
    if error.startswith(">"):
        return f"not finished after {error[2:]}"
    if " ended with " in error:
        status = error.split(" ended with ")[1].split(":")[0]
        return f"crashed, signal {status[1:]}" if status.startswith("-") else f"ended with {status}"
    return error if len(error) <= 60 else error[:57] + "..."


def tables(cases, plain, sized):
    print("\n## Closed surfaces filled\n")
    print("Constrained Delaunay tets, with interior points only where required. `motet --delaunay` and `TetGen -p` may insert points on\n"
          "edges of the surface, `motet` and `TetGen -pY` may not.\n")
    show(cases, plain, [], lambda case, result: [])
    print("\n## Closed surfaces filled, with a size\n")
    print("Interior edges about as long as the size, with the quality optimisation of each program; sizes of the others are chosen such that they make\n"
          "about as many tets as motet. Size: relative to motet's; for TetGen that of the regular tet with the largest allowed volume.\n")
    show(cases, sized, ["size"], lambda case, result: [f"{result['size'] / case.size:.2f}" if result.get("size") else "-"])


HEADER = ["complete", "seconds", "/motet", "whole process", "tets", "worst EAS", "5 % EAS", "bad", "inverted", "least dihedral", "5 % dihedral", "triangles kept"]


def show(cases, all_results, more, extra):
    print("One thread each; seconds of the meshing, without files; medians of up to 3 repeats in a process and "
          f"up to {ROUNDS} rounds in turn (one for {', '.join(ONCE)}).\n")
    rows = []
    for surface, results in all_results.items():
        first = next(iter(results.values())).get("seconds")
        for name, result in results.items():
            rows.append([surface, f"{name} {result.get('version', '')}".strip(), *extra(cases[surface], result), *line(result, first)])
    print(table(["surface", "program", *more, *HEADER], rows))
    print(f"\nSurfaces: {'; '.join(f'{name}, {len(case.triangles):,} triangles, size {case.size:g}' for name, case in cases.items())}.")


def line(result, first):
    if "error" in result:
        return [f"failed: {result['error']}", *["-"] * (len(HEADER) - 1)]
    whole = result.get("whole_seconds")
    return ["yes" if result.get("complete", True) else "no",
            cell(result, seconds_text(result["seconds"])), f"{result['seconds'] / first:.2f}" if first else "-", seconds_text(whole),
            f"{result['tets']:,}", f"{result['worst']:.2g}", f"{result['fifth_percentile']:.3f}", f"{result['bad']:,}", result["inverted"],
            f"{result['least_dihedral']:.2g}", f"{result['fifth_percentile_dihedral']:.1f}", kept(result)]


def kept(result):
    """Describe how many triangles of the surface are facets of the mesh exactly, and how many others there
    are."""
    if result["triangles_found"] == result["triangles"]:
        return "all" if result["triangles_extra"] == 0 else f"all, {result['triangles_extra']:,} more"
    share = math.floor(1000 * result["triangles_found"] / result["triangles"]) / 10
    return f"{result['triangles_found']:,} ({share:g} %)"
