"""Devices put into a mesh, one conforming mesh out: motet beside meshers that fill both surfaces anew."""
import sys

from common import HERE, MOTET, call, cell, combine, seconds_text, table
from bench_mesh import in_words
from implant_files import cases

ROUNDS = 3
LIMIT = 150.0  # seconds that a process may take
QUICK = 10.0  # what takes longer runs once
OURS = "motet"
# name in the table: word for rivals/implant_python.py
RIVALS = {"TetGen -pq1.2Y": "tetgen", "TetGen -pq1.2/14Y": "tetgen-angles", "Gmsh": "gmsh", "Gmsh HXT": "gmsh-hxt", "fTetWild": "ftetwild",
          "Mmg level set": "mmg"}
# What motet wants to reach with the coil in the box.
SECONDS, DIHEDRAL = 1.5, 10.0


def run(record, options):
    found, missing = cases(options.quick)
    results = {}
    for case in found:
        results[case.name] = finished(record, case, in_turn(commands(case), min(options.rounds, ROUNDS), max(options.limit, LIMIT)))
        print(f"  {case.name}: done", file=sys.stderr, flush=True)
    show(found, results)
    aims(next(iter(results.values()))[OURS])
    for name in missing:
        print(f"\nLeft out: {name} (no file; MOTET_DATA names the folder of real meshes)")


def commands(case):
    ours = [sys.executable, HERE / "implant_motet.py", MOTET / "motet", 1, case.out(OURS, ".vtu"), case.host, *case.devices, *case.words]
    rival = lambda name, word: [sys.executable, HERE / "rivals" / "implant_python.py", word, 1, case.npz, case.out(name, ".npz")]
    return {OURS: ours} | {name: rival(name, word) for name, word in RIVALS.items()}


def in_turn(commands, rounds, limit):
    """All once, then again what was quick or is motet."""
    parts = {name: [] for name in commands}
    for _ in range(rounds):
        for name, command in commands.items():
            before = parts[name]
            if not before or "error" not in before[-1] and (name == OURS or before[-1]["wall"] < QUICK):
                before.append(call(command, limit))
    return {name: combine(part) for name, part in parts.items()}


def finished(record, case, results):
    """Results with what the meshes are worth; recorded."""
    for name, result in results.items():
        if "error" in result:
            result["error"] = in_words(result["error"])
        else:
            result |= case.measured(case.out(name, ".vtu" if name == OURS else ".npz"), result.get("regions"))
        record.add(**{**result, "bench": "implant", "case": case.name, "program": name})
    return results


HEADER = ["done", "seconds", "file to file", "CPU", "tets", "bad", "worst dihedral", "triangles kept", "surfaces apart", "host kept"]


def show(found, all_results):
    print("\n## Devices put into a mesh\n")
    print(f"One thread each; medians of up to {ROUNDS} runs in turn, one of what takes longer than {QUICK:g} s.\n")
    rows = []
    for case in found:
        for name, result in all_results[case.name].items():
            rows.append([case.name, f"{name} {result.get('version', '')}".strip(), *line(result)])
    print(table(["case", "program", *HEADER], rows))
    print()
    for case in found:
        print(f"- {case.name}: host of {len(case.host_tets):,} tets, {case.host_bad:,} of them bad, {len(case.surface):,} triangles around it; "
              f"{len(case.device):,} triangles of devices{walls(all_results[case.name][OURS])}.")


def walls(result):
    """What the wall does to a device that goes through it."""
    at_walls, outside = result.get("at_walls", 0), result.get("outside", 0)
    return f", of which {at_walls:,} meet the wall and {outside:,} lie outside and are cut off" if at_walls + outside else ""


def line(result):
    if "error" in result:
        return [f"failed: {result['error']}", *["-"] * (len(HEADER) - 1)]
    bad = f"{result['bad']:,}" + (f", {result['unforced']:,} not forced" if "unforced" in result and result["bad"] else "")
    apart = "-" if result["apart"] is None else "0" if result["apart"] == 0 else f"{result['apart']:.2g}"
    return ["yes" if result.get("complete", True) else "in part", cell(result, seconds_text(result["seconds"])), seconds_text(result["whole_seconds"]),
            seconds_text(result["cpu_seconds"]),
            f"{result['tets']:,}", bad, f"{result['least_dihedral']:.2g}", triangles(result), apart, f"{100 * result['host_kept']:.3g} %"]


def triangles(result):
    found, whole = result["triangles_found"], result["triangles"]
    return "all" if found == whole else f"{found:,} of {whole:,}" if found else "none"


def aims(result):
    if "error" in result:
        return print(f"\nAims: not reached, motet {result['error']}")
    said = {f"file to file under {SECONDS} s": result["whole_seconds"] < SECONDS,
            "all triangles kept": result["triangles_found"] == result["triangles"],
            "no bad tet that is not forced": result["unforced"] == 0,
            f"worst dihedral angle at least {DIHEDRAL:g} degrees": result["least_dihedral"] >= DIHEDRAL}
    print("\nAims for the coil in the box: " + "; ".join(f"{aim}: {'reached' if is_so else 'NOT reached'}" for aim, is_so in said.items()) + ".")
