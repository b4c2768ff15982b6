"""Delaunay tetrahedralisation of points by motet, CGAL, TetGen, Gmsh and Qhull on the same files."""
import shutil
import sys

from common import HERE, MOTET, TARGET, cell, in_turn, reference, seconds_text, table
from point_sets import point_sets

# Target ratios to CGAL, with one thread each; there are no targets for the other sets.
WANTED = {"cube 1,000,000": 2.2, "surface D": 3.5, "surface D turned": 3.5, "surface 200k": 3.0,
          "surface 200k turned": 3.0, "grid 50^3": 1.6}


def contenders(name, group, path, n, runs):
    """Return {label: command} for all programs that can process this set in reasonable time."""
    motet = MOTET / "examples" / "delaunay"
    cgal = TARGET / "delaunay_cgal"
    python = [sys.executable, HERE / "rivals" / "delaunay_python.py"]
    found = {f"motet {t}t": [motet, path, "--threads", t, "--runs", runs] for t in (1, 2)}
    if cgal.exists():
        found["CGAL 1t"] = [cgal, path, 0, runs]
        found["CGAL 2t"] = [cgal, path, 2, runs]
    if shutil.which("tetgen"):
        found["TetGen"] = [*python, "tetgen", path, 1]
    if group != "adversarial":
        found["Gmsh"] = [*python, "gmsh", path, 1]
    # Qhull takes quadratic time for coplanar points: minutes for the larger surfaces.
    if (group == "cube" and n <= 100_000) or (group == "surface" and n < 7_000):
        found["Qhull"] = [*python, "qhull", path, 1]
    return found


def run(record, options):
    folder = TARGET / "points"
    folder.mkdir(parents=True, exist_ok=True)
    labels = ["motet 1t", "motet 2t", "CGAL 1t", "CGAL 2t", "TetGen", "Gmsh", "Qhull"]
    times, counts = [], []
    for group, name, points in point_sets(TARGET, options.largest):
        n = len(points)
        path = folder / (name.replace(" ", "_").replace(",", "") + ".f64")
        points.tofile(path)
        runs = 1 if n > 150_000 else 3 if n > 20_000 else 7
        results = in_turn(contenders(name, group, path, n, runs), options.rounds, limit=options.limit)
        for label, result in results.items():
            record.add(bench="delaunay", set=name, points=n, program=label, **result)
        times.append([name, f"{n:,}", *[shown(results.get(label)) for label in labels],
                      ratio(results, "CGAL 1t", "motet 1t"), WANTED.get(name, ""),
                      ratio(results, "CGAL 2t", "motet 2t"), ratio(results, "motet 1t", "motet 2t")])
        counts.append([name, *[tets(results.get(label)) for label in labels if label != "motet 2t"],
                       *[memory(results.get(label), n) for label in ("motet 1t", "CGAL 1t", "TetGen")]])
        print(f"  {name}: done", file=sys.stderr, flush=True)
    print("\n## Delaunay tetrahedralisation of points\n")
    print(f"Seconds, medians over {options.rounds} rounds in turn; CPU seconds for TetGen. CGAL/motet above 1: motet"
          " is faster.\n")
    print(table(["set", "points", *labels, "CGAL/motet 1t", "target", "CGAL/motet 2t", "motet 1t/2t"], times))
    print("\nTets, and peak memory of the whole program in bytes per point, including the input:\n")
    print(table(["set", *[label.removesuffix(" 1t") + " tets" for label in labels if label != "motet 2t"],
                 "motet B/pt", "CGAL B/pt", "TetGen B/pt"], counts))
    print_reference()


def shown(result):
    return cell(result, seconds_text(result and result.get("seconds")))


def ratio(results, theirs, ours):
    a, b = results.get(theirs, {}).get("seconds"), results.get(ours, {}).get("seconds")
    return f"{a / b:.2f}" if a and b else "-"


def tets(result):
    return f"{result['tets']:,}" if result and "tets" in result else "-"


def memory(result, n):
    return f"{result['peak_mib'] * 2**20 / n:,.0f}" if result and "peak_mib" in result and n >= 10_000 else "-"


def print_reference():
    """Print measurements of the reference machine, which include geogram (in no package registry)."""
    rows = [[r["peer"], r.get("algorithm", ""), r.get("threads", 1), seconds_text(r["seconds"]), f"{r['tets']:,}"]
            for r in reference() if r["work"] == "W1a-cube" and r["size"] == 1_000_000 and r["seconds"]]
    if rows:
        print("\nUniform 1M on the reference machine (another run, another machine):\n")
        print(table(["program", "algorithm", "threads", "seconds", "tets"], rows))
