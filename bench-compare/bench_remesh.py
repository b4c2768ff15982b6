"""Repair of the bad tets of a moved mesh with its boundary kept, by motet and other remeshers with one
thread."""
import sys

from common import HERE, MOTET, TARGET, cell, in_turn, seconds_text, table
from remesh_files import Case, made
from sameness import compared
from tets import BAD, measures, spread

ROUNDS = 3
# Name in the table: keyword of rivals/remesh_python.py.
PYTHON = {
    "Mmg -optim": "mmg",
    "Mmg -optim, one ring": "mmg-local",
    "Gmsh": "gmsh",
    "Gmsh, threshold 0.5": "gmsh-half",
    "Gmsh's Netgen": "gmsh-netgen",
    "Netgen": "netgen",
}
# Name in the table: quality measure and threshold for rivals/remesh_hxt.c; 0.3 is Gmsh's default.
HXT = {"HXT, its measure, 0.3": ("aspect", 0.3), "HXT, EAS, 0.2": ("eas", BAD)}
QUICK = ("Mmg -optim, one ring", "Gmsh", *HXT)  # programs that also process the mesh of a million tets
OURS = {"motet": [], "motet, goal best": ["--goal", "best"]}


def contenders(case, large):
    """Return {name: command} and {name: path of its mesh}."""
    source, raw = case.numpy(), case.raw()
    out = lambda name, end="": case.folder / (name.replace(" ", "_").replace("'", "") + end)
    commands, places = {}, {}
    for name, options in OURS.items():
        places[name] = out(name, ".vtu")
        commands[name] = [MOTET / "examples" / "remesh", case.vtu, places[name], "--threads", 1, "--rounds", 3, *options]
    for name, keyword in PYTHON.items():
        places[name] = out(name, ".npz")
        commands[name] = [sys.executable, HERE / "rivals" / "remesh_python.py", keyword, source, places[name]]
    for name, arguments in HXT.items():
        places[name] = out(name)
        commands[name] = [TARGET / "remesh_hxt", *raw, *arguments, 1, places[name]]
    if large:
        commands = {name: command for name, command in commands.items() if name in (*OURS, *QUICK)}
    else:
        places["CGAL"] = out("CGAL")
        commands["CGAL"] = [TARGET / "remesh_cgal", case.medit(), 1, case.length(), places["CGAL"]]
    return commands, places


def run(record, options):
    for name in ["moved_A"] if options.quick else ["moved_B", "moved_1M"]:
        case = Case(name)
        commands, places = contenders(case, large=name == "moved_1M" or options.quick)
        for path in places.values():
            path.unlink(missing_ok=True)
        results = in_turn(commands, min(options.rounds, ROUNDS), max(options.limit, 300))
        for program, result in results.items():
            if "error" not in result:
                mesh = made(places[program])
                result |= measures(*mesh) | spread(*mesh) | compared(case.points, case.tets, *mesh)
            record.add(**{**result, "bench": "remesh", "mesh": name, "program": program})
        print(f"  remesh {name}: done", file=sys.stderr, flush=True)
        tables(case, results)


def tables(case, results):
    given = measures(case.points, case.tets) | spread(case.points, case.tets)
    print(f"\n## Bad tets of a moved mesh, {case.name}\n")
    print(f"A sphere moved in a box by a Laplace equation (diffusivity 1/volume): {len(case.points):,} vertices, "
          f"{len(case.tets):,} tets, {given['bad']} of them bad (EAS < {BAD:g}).\nOne thread each, boundary kept; "
          "seconds without files; medians of 3 repeats in a process (1 if it takes long) and up to 3 rounds "
          "in turn.\n")
    ours = results["motet"].get("seconds")
    rows = [["before", "", "", "", *columns(given), "", "", "", ""]]
    rows += [line(name, result, ours) for name, result in results.items() if "error" not in result]
    print(table(["program", "version", "seconds", "/motet", "tets", "bad", "inverted", "worst EAS", "1 %", "5 %", "median", "mean", "dihedral",
                 "kept exactly", "kept to 1e-9", "changed", "boundary"], rows))
    for name, result in results.items():
        if "error" in result:
            print(f"\nOmitted: {name} ({result['error']})")
    locality(results["motet"])


def line(name, result, ours):
    return [name, result.get("version", ""), cell(result, seconds_text(result["seconds"])), f"{result['seconds'] / ours:.1f}" if ours else "-",
            *columns(result), f"{result['kept']:.2%}", f"{result['kept_near']:.2%}", f"{result['touched']:,}", result["boundary"]]


def columns(row):
    return [f"{row['tets']:,}", row["bad"], row["inverted"], *(f"{row[key]:.3f}" for key in ("worst", "p1", "p5", "median", "mean")),
            f"{row['least_dihedral']:.1f} to {row['greatest_dihedral']:.1f}"]


def locality(motet):
    """Compare the time of a repair with the minimum work of any repair: adjacency and quality of all tets."""
    parts = [motet.get(key) for key in ("seconds", "adjacency_seconds", "quality_seconds")]
    if all(parts):
        whole, adjacency, quality = parts
        print(f"\nmotet: {seconds_text(whole)} for the repair, {seconds_text(adjacency)} for the adjacency alone, "
              f"{seconds_text(quality)} for the quality alone: {whole / (adjacency + quality):.2f} times their sum.")
