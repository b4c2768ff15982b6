"""Implantation of devices into a mesh, by motet and by meshers that fill both surfaces anew."""
import sys

from common import HERE, MOTET, call, cell, combine, seconds_text, table
from bench_mesh import short_error
from implant_files import cases

ROUNDS = 3
LIMIT = 150.0  # time limit of a process, in seconds
QUICK = 10.0  # programs that take longer, in seconds, run once
OURS = "motet"
# Name in the table: keyword of rivals/implant_python.py.
RIVALS = {"TetGen -pq1.2Y": "tetgen", "TetGen -pq1.2/14Y": "tetgen-angles", "Gmsh": "gmsh", "Gmsh HXT": "gmsh-hxt", "fTetWild": "ftetwild",
          "Mmg level set": "mmg"}
# Targets for the coil in the box: seconds, and degrees.
SECONDS, DIHEDRAL = 1.5, 10.0


def run(record, options):
    found, missing = cases(options.quick)
    results = {}
    for case in found:
        results[case.name] = finished(record, case, in_turn(commands(case), min(options.rounds, ROUNDS), max(options.limit, LIMIT)))
        print(f"  {case.name}: done", file=sys.stderr, flush=True)
    show(found, results)
    targets(next(iter(results.values()))[OURS])
    for name in missing:
        print(f"\nOmitted: {name} (no file: set MOTET_DATA to the folder of real meshes)")


def commands(case):
    ours = [sys.executable, HERE / "implant_motet.py", MOTET / "motet", 1, case.out(OURS, ".vtu"), case.host, *case.devices, *case.options]
    rival = lambda name, keyword: [sys.executable, HERE / "rivals" / "implant_python.py", keyword, 1, case.npz, case.out(name, ".npz")]
    return {OURS: ours} | {name: rival(name, keyword) for name, keyword in RIVALS.items()}


def in_turn(commands, rounds, limit):
    """Run all commands once, then repeat motet and those that are quick."""
    parts = {name: [] for name in commands}
    for _ in range(rounds):
        for name, command in commands.items():
            before = parts[name]
            if not before or "error" not in before[-1] and (name == OURS or before[-1]["wall"] < QUICK):
                before.append(call(command, limit))
    return {name: combine(part) for name, part in parts.items()}


def finished(record, case, results):
    """Add the quality of the meshes to the results, and record them."""
    for name, result in results.items():
        if "error" in result:
            result["error"] = short_error(result["error"])
        else:
            result |= case.measured(case.out(name, ".vtu" if name == OURS else ".npz"), result.get("regions"))
        record.add(**{**result, "bench": "implant", "case": case.name, "program": name})
    return results


HEADER = ["complete", "seconds", "whole process", "CPU", "tets", "bad", "worst dihedral", "triangles kept", "surface distance", "host kept"]


def show(found, all_results):
    print("\n## Implantation of devices\n")
    print(f"One thread each; medians of up to {ROUNDS} runs in turn, or a single run if it takes longer than {QUICK:g} s.\n")
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
    """Describe the triangles of devices at and outside the wall."""
    at_walls, outside = result.get("at_walls", 0), result.get("outside", 0)
    return f", of which {at_walls:,} meet the wall and {outside:,} lie outside and are cut off" if at_walls + outside else ""


def line(result):
    if "error" in result:
        return [f"failed: {result['error']}", *["-"] * (len(HEADER) - 1)]
    bad = f"{result['bad']:,}" + (f", {result['unforced']:,} not forced" if "unforced" in result and result["bad"] else "")
    apart = "-" if result["apart"] is None else "0" if result["apart"] == 0 else f"{result['apart']:.2g}"
    return ["yes" if result.get("complete", True) else "no", cell(result, seconds_text(result["seconds"])), seconds_text(result["whole_seconds"]),
            seconds_text(result["cpu_seconds"]),
            f"{result['tets']:,}", bad, f"{result['least_dihedral']:.2g}", triangles(result), apart, f"{100 * result['host_kept']:.3g} %"]


def triangles(result):
    found, whole = result["triangles_found"], result["triangles"]
    return "all" if found == whole else f"{found:,} of {whole:,}" if found else "none"


def targets(result):
    if "error" in result:
        return print(f"\nTargets: not reached, motet {result['error']}")
    reached = {f"whole process under {SECONDS} s": result["whole_seconds"] < SECONDS,
            "all triangles kept": result["triangles_found"] == result["triangles"],
            "no bad tet that is not forced": result["unforced"] == 0,
            f"worst dihedral angle at least {DIHEDRAL:g} degrees": result["least_dihedral"] >= DIHEDRAL}
    print("\nTargets for the coil in the box: " + "; ".join(f"{target}: {'reached' if yes else 'NOT reached'}" for target, yes in reached.items()) + ".")
