"""Closed surfaces of vessels and devices filled with tets, as they are and with a size and quality: motet beside the meshers there are."""
import math
import sys

from common import HERE, MOTET, call, cell, in_turn, seconds_text, table
from mesh_files import calibrated, surfaces

ROUNDS = 3
RUNS = 3  # repeats in a process, fewer where they take long
LIMIT = 120.0  # seconds that a process may take, and all that look for a size together
# name in the table: words for `motet mesh`
OURS = {"motet --delaunay": ["--delaunay"], "motet": []}
# name in the table: word for rivals/mesh_python.py
PLAIN = {"TetGen -p": "tetgen", "TetGen -pY": "tetgen-keep"}
# the same, the size that is tried first over motet's, and how many are tried until there are as many tets as motet's (0: that one is taken)
SIZED = {"TetGen -pq1.2/14aVY": ("tetgen-quality", 1.3, 6), "Gmsh": ("gmsh", 0.8, 6), "Gmsh HXT": ("gmsh-hxt", 0.8, 6), "fTetWild": ("ftetwild", 1.0, 0)}
ONCE = ("fTetWild",)  # takes minutes: one round


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
        print(f"\nLeft out: {name} (no file; MOTET_DATA names the folder of real meshes)")


def ours(case, name, words):
    return [sys.executable, HERE / "mesh_motet.py", MOTET / "motet", RUNS, case.vtp, case.out(name, ".vtu"), *words]


def rival(case, name, word, size, runs=RUNS):
    return [sys.executable, HERE / "rivals" / "mesh_python.py", word, size, runs, case.npz, case.out(name, ".npz")]


def filled(case, rounds, limit):
    """No points inside but those that are needed."""
    commands = {name: ours(case, name, words) for name, words in OURS.items()}
    commands |= {name: rival(case, name, word, case.size) for name, word in PLAIN.items()}
    return in_turn(commands, rounds, limit)


def with_size(case, rounds, limit):
    """Motet with the case's size, the others with sizes that give about as many tets."""
    name = "motet --size"
    results = in_turn({name: ours(case, name, ["--size", case.size])}, rounds, limit)
    report = results[name].get("improved")
    target = report["after"]["tets"] if report else None
    commands, sizes = {}, {}
    for other, (word, first, tries) in SIZED.items():
        sizes[other], why = size_for(case, other, word, target, first * case.size, tries, limit)
        if sizes[other]:
            commands[other] = rival(case, other, word, sizes[other])
        else:
            results[other] = {"error": why}
    quick = {other: command for other, command in commands.items() if other not in ONCE}
    results |= in_turn(quick, rounds, limit)
    results |= in_turn({other: commands[other] for other in ONCE if other in commands}, 1, limit)
    results[name]["size"] = case.size
    for other, size in sizes.items():
        results[other]["size"] = size
    return {other: results[other] for other in (name, *SIZED)}


def size_for(case, name, word, target, first, tries, limit):
    """The size that a program is to be asked for; None and the reason where it fails at the first. Not clocked."""
    spent, why = 0.0, ["?"]

    def count(size):
        nonlocal spent
        if spent > limit:
            return None
        result = call(rival(case, name, word, size, runs=1), limit)
        spent += result.get("wall", 0.0)
        why[0] = result.get("error")
        return result.get("tets")

    if target is None or tries == 0:  # nothing to come near to
        return first, None
    return calibrated(count, target, first, tries), why[0]


def finished(record, case, part, results):
    """Results with what the meshes are worth; recorded."""
    for name, result in results.items():
        if "error" in result:
            result["error"] = in_words(result["error"])
        else:
            result |= case.measured(case.out(name, ".vtu" if name.startswith("motet") else ".npz"))
        record.add(**{**result, "bench": "mesh", "part": part, "surface": case.name, "program": name})
    return results


def in_words(error):
    """Why a program failed, in few words."""
    if error.startswith(">"):
        return f"not ready after {error[2:]}"
    if " ended with " in error:
        status = error.split(" ended with ")[1].split(":")[0]
        return f"crashed, signal {status[1:]}" if status.startswith("-") else f"ended with {status}"
    return error if len(error) <= 60 else error[:57] + "..."


def tables(cases, plain, sized):
    print("\n## Closed surfaces filled\n")
    print("Constrained Delaunay tets alone, no points inside but those that are needed. `motet --delaunay` and `TetGen -p` may put points on the\n"
          "surface's edges, `motet` and `TetGen -pY` may not.\n")
    show(cases, plain, [], lambda case, result: [])
    print("\n## Closed surfaces filled, with a size\n")
    print("Edges inside about so long as the size, tets good as far as each program takes care of that; the others are asked for sizes with which they make\n"
          "about as many tets as motet. Size: over motet's, and of TetGen the regular tet's with the limit of volume.\n")
    show(cases, sized, ["size"], lambda case, result: [f"{result['size'] / case.size:.2f}" if result.get("size") else "-"])


HEADER = ["done", "seconds", "/motet", "whole process", "tets", "worst EAS", "5 % EAS", "bad", "inverted", "least dihedral", "5 % dihedral", "triangles kept"]


def show(cases, all_results, more, extra):
    print("One thread each; seconds of the mesher's call alone, without files; medians of up to 3 repeats in a process, "
          f"up to {ROUNDS} rounds in turn ({', '.join(ONCE)}: one).\n")
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
    return ["yes" if result.get("complete", True) else "in part",
            cell(result, seconds_text(result["seconds"])), f"{result['seconds'] / first:.2f}" if first else "-", seconds_text(whole),
            f"{result['tets']:,}", f"{result['worst']:.2g}", f"{result['fifth_percentile']:.3f}", f"{result['bad']:,}", result["inverted"],
            f"{result['least_dihedral']:.2g}", f"{result['fifth_percentile_dihedral']:.1f}", kept(result)]


def kept(result):
    """Whether the surface is there to the bit, and nothing beside it."""
    if result["triangles_found"] == result["triangles"]:
        return "all" if result["triangles_extra"] == 0 else f"all, {result['triangles_extra']:,} beside"
    share = math.floor(1000 * result["triangles_found"] / result["triangles"]) / 10
    return f"{result['triangles_found']:,} ({share:g} %)"
