"""Surfaces that nobody here chose, filled as they are and with their triangles made even, by motet and other meshers."""
import os
import statistics
import subprocess
import sys
from pathlib import Path

import numpy as np

from bench_mesh import ours, rival, short_error
from common import ROOT, call, seconds_text, table
from mesh_files import Case
from tets import boundary, dihedrals, eas, volumes

SIZE, DISTANCE = 0.02, 0.001  # of the largest extent
PLACES = 20_000  # where the distance of each surface is measured, besides its vertices
EXTENSIONS = {".stl", ".obj", ".ply", ".vtp", ".vtk", ".off", ".glb"}
ADAPT = ["--repair", "--surface", "adapt"]
# Name in the table: options of `motet mesh`, with numbers as fractions of the extent; or keyword of rivals/mesh_python.py.
KEPT = {"motet": [], "motet --repair": ["--repair"], "TetGen -pY": "tetgen-keep"}
ADAPTED, WRAPPED = "motet --surface adapt", "motet, wrapped where refused"
EVEN = {ADAPTED: [*ADAPT, "--size", SIZE, "--distance", DISTANCE],
        WRAPPED: [*ADAPT, "--size", SIZE, "--distance", DISTANCE / 2, "--wrap", DISTANCE / 2], "TetGen -pq1.2/14a": "tetgen-divide",
        "MeshLab, TetGen -pq1.2/14aY": "meshlab-tetgen", "Gmsh": "gmsh-adapt", "fTetWild": "ftetwild"}


def run(record, options):
    folder = Path(os.environ.get("MOTET_CORPUS") or ROOT.parent / "shared" / "corpus")
    files = sorted((path for path in folder.rglob("*") if path.suffix in EXTENSIONS), key=lambda path: path.name)
    if options.surfaces:
        files = [path for path in files if path.stem in options.surfaces.split(",")]
    if options.quick:
        files = files[:2]
    if not files:
        print("\nNo surfaces: set MOTET_CORPUS to their folder, or name some that are there.")
        return
    of = (options.programs or "").split(",")
    kept, even = ({name: what for name, what in programs.items() if any(part in name for part in of)} for programs in (KEPT, EVEN))
    results = {}
    for path in files:
        results[path.name] = of_surface(record, path, kept | even, options.limit)
        print(f"  corpus {path.name}", file=sys.stderr, flush=True)
    print("\n## Surfaces of others\n")
    print(f"One run of each, one thread; {options.limit:g} s at most. Size {SIZE:g} and distance {DISTANCE:g} of the largest extent. Valid: all tets are positive,\n"
          "their boundary is closed and, without repairs, every triangle of the surface is a facet. Near: the boundary and the surface are within the distance of each\n"
          f"other, measured by libigl at vertices and {PLACES:,} random places (holes that are closed and walls inside are far).")
    for title, programs in ("as they are", kept), ("with even triangles", even):
        print(f"\n### Filled {title}\n")
        summary(results, programs)
        print()
        details(results, programs)


def of_surface(record, path, programs, limit):
    """Run all programs on a surface. Returns their results by name, or the reason why there are none."""
    try:
        case = Case("corpus", path, 0.0)
    except subprocess.CalledProcessError:
        return "not read by motet"
    if len(case.triangles) == 0:
        return "no triangles"
    extent = float(np.ptp(case.points, axis=0).max())
    case.size, case.distance = SIZE * extent, DISTANCE * extent
    np.savez(case.npz, points=case.points, triangles=case.triangles, distance=case.distance)
    results = {}
    for name, what in programs.items():
        if name == WRAPPED and "error" not in results.get(ADAPTED, {"error": ""}):
            results[name] = results[ADAPTED]
            continue
        if isinstance(what, str):
            result, end = call(rival(case, name, what, case.size, runs=1), limit), ".npz"
        else:
            words = [word * extent if isinstance(word, float) else word for word in what]
            result, end = call(ours(case, name, words), limit), ".vtu"
        if "error" in result:
            result = {"error": short_error(result["error"])}
        else:
            result |= measured(case, case.out(name, end), name in KEPT and "--repair" not in what)
            result["seconds"] = float(np.ravel(result["seconds"])[0])
        record.add(**{"bench": "corpus", "surface": path.name, "program": name, **result})
        results[name] = result
    return results


def measured(case, path, is_kept):
    """Return the quality of a mesh, its distances from the surface, and what makes it invalid."""
    from remesh_files import made
    from sameness import surface_lost

    points, tets = made(path)
    size = volumes(points, tets)
    if size.sum() < 0:  # TetGen's tets have the opposite orientation
        tets, size = tets[:, [1, 0, 2, 3]], -size
    quality, (least, _) = eas(points, tets), dihedrals(points, tets)
    p1, median = np.percentile(quality, (1, 50))
    result = {"tets": len(tets), "bad": int((quality < 0.2).sum()), "worst": float(quality.min()), "p1": float(p1), "median": float(median),
              "mean": float(quality.mean()), "least_dihedral": float(least.min()), "p5_dihedral": float(np.percentile(least, 5)),
              "volume": float(size.sum())}
    faults = []
    if (size <= 0).any():
        faults.append(f"{int((size <= 0).sum())} tets not positive")
    facets = boundary(tets)
    edges, times = np.unique(np.sort(facets[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0, return_counts=True)
    if (times % 2).any():
        faults.append(f"{int((times % 2).sum())} open edges")
    if is_kept:
        lost = surface_lost(case.points, case.triangles, points, tets)
        if lost:
            faults.append(f"{lost} triangles lost")
    else:
        surfaces = (case.points, case.triangles), (points, facets)
        result["distances"] = [farthest(*surfaces[way], *surfaces[1 - way]) / case.distance for way in (0, 1)]
    return {**result, "fault": ", ".join(faults)}


def farthest(points, triangles, others, to):
    """Return the largest distance of places of a surface from another."""
    import igl

    corners = points[triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    random = np.random.default_rng(1)
    chosen = random.choice(len(triangles), PLACES, p=areas / areas.sum())
    shares = random.dirichlet((1, 1, 1), PLACES)
    places = np.concatenate([points[np.unique(triangles)], np.einsum("ij,ijk->ik", shares, corners[chosen])])
    return float(np.sqrt(igl.point_mesh_squared_distance(places, others, np.ascontiguousarray(to))[0].max()))


def summary(results, programs):
    runs = [result for result in results.values() if not isinstance(result, str)]
    everyone = [run for run in runs if all(is_valid(run[name]) for name in programs)]
    rows = []
    for name in programs:
        of = [run[name] for run in runs]
        made, valid, same = [r for r in of if "error" not in r], [r for r in of if is_valid(r)], [run[name] for run in everyone]
        middle = lambda key, of=same: f"{statistics.median(r[key] for r in of):.3g}" if of else "-"
        near = sum(max(r.get("distances", [0])) <= 1 for r in valid)
        rows.append([name, len(of), len(valid), near, len(made) - len(valid), len(of) - len(made), sum(r["bad"] == 0 for r in valid), sum(r["bad"] for r in valid),
                     middle("seconds", valid), middle("seconds"), middle("tets"), middle("mean"), middle("p1"), middle("least_dihedral"), middle("p5_dihedral")])
    header = ["program", "surfaces", "valid", "near", "invalid", "refused or failed", "without bad tets", "bad tets", "median seconds of valid"]
    print(table([*header, f"seconds of the {len(everyone)} that all have", "tets", "mean EAS", "1 % EAS", "least dihedral", "5 % dihedral"], rows))


def is_valid(result):
    return "error" not in result and not result["fault"]


def details(results, programs):
    rows = []
    for surface, of in results.items():
        if isinstance(of, str):
            rows.append([surface, "all", of, *["-"] * 9])
            continue
        for name in programs:
            result = of[name]
            if "error" in result:
                rows.append([surface, name, result["error"], *["-"] * 9])
            else:
                numbers = [f"{result[key]:.3g}" for key in ("worst", "p1", "median", "mean", "least_dihedral")]
                far = f"{max(result['distances']):.2f}" if "distances" in result else "-"
                rows.append([surface, name, result["fault"] or "valid", far, seconds_text(result["seconds"]), f"{result['tets']:,}", result["bad"], *numbers])
    print(table(["surface", "program", "result", "of the distance", "seconds", "tets", "bad", "worst EAS", "1 %", "median", "mean", "least dihedral"], rows))
