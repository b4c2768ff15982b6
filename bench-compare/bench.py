"""Runs the requested benchmarks; called by `bench-compare/run`, which installs what they need."""
import argparse
import datetime
import subprocess
import sys

import bench_contact
import bench_corpus
import bench_delaunay
import bench_drift
import bench_files
import bench_implant
import bench_mesh
import bench_motion
import bench_quality
import bench_refine
import bench_remesh
import bench_threads
from common import DISTURBED, ROOT, TARGET, Record, machine

BENCHES = {"delaunay": bench_delaunay, "motion": bench_motion, "files": bench_files, "remesh": bench_remesh,
           "contact": bench_contact, "refine": bench_refine, "mesh": bench_mesh, "corpus": bench_corpus, "implant": bench_implant, "quality": bench_quality,
           "drift": bench_drift, "threads": bench_threads}


def parsed_options():
    parser = argparse.ArgumentParser(prog="bench-compare/run", description="compares motet with other programs on the same input")
    parser.add_argument("benches", nargs="*", help=f"{', '.join(BENCHES)} (default: all)")
    parser.add_argument("--rounds", type=int, default=5, help="number of rounds in which all programs run (default 5)")
    parser.add_argument("--largest", type=int, default=1_000_000, help="largest point set of the Delaunay benchmark")
    parser.add_argument("--sizes", default="ABCD", help="which of the paper's four models (default ABCD)")
    parser.add_argument("--surfaces", help="surfaces of the mesh or corpus benchmark, separated by commas (default: all)")
    parser.add_argument("--programs", help="programs of the corpus benchmark by parts of their names, separated by commas (default: all)")
    parser.add_argument("--cases", help="cases of the drift benchmark, separated by commas (default: all)")
    parser.add_argument("--turns", type=int, help="turns of rotating bodies in the drift benchmark (default 3; 6 for the bar)")
    parser.add_argument("--cycles", type=int, help="cycles of periodic motions in the drift benchmark (default by case, 3 to 20)")
    parser.add_argument("--limit", type=float, default=120.0, help="time limit for one call of a program, in seconds")
    parser.add_argument("--openfoam", action="store_true", help="also install OpenFOAM (it is used if installed)")
    parser.add_argument("--quick", action="store_true", help="one round, small sizes")
    parser.add_argument("--out", help="file to which JSON lines are appended (default: a new bench-compare/target/results.jsonl)")
    options = parser.parse_args()
    unknown = set(options.benches) - set(BENCHES)
    if unknown:
        parser.error(f"unknown benchmark {', '.join(sorted(unknown))}; known: {', '.join(BENCHES)}")
    if options.quick:
        options.rounds, options.largest, options.sizes = 1, min(options.largest, 20_000), "A"
    return options


def revision():
    done = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--dirty"], capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def main():
    options = parsed_options()
    path = options.out or TARGET / "results.jsonl"
    if not options.out:
        path.unlink(missing_ok=True)
    record = Record(path)
    here = {**machine(), "revision": revision(), "date": datetime.date.today().isoformat()}
    record.add(bench="machine", **here)
    print(f"# motet {here['revision']} compared with other programs, {here['date']}\n")
    print(f"{here['processor']}, {here['cores']} cores, {here['memory_gib']} GiB, {here['system']}. "
          "Motet: release profile, generic target without flags for this processor.")
    print(f"\nA star marks a measurement during which other programs used more than {DISTURBED:g} of a core.")
    sys.stdout.flush()
    for name in options.benches or BENCHES:
        BENCHES[name].run(record, options)
        sys.stdout.flush()
    disturbed = [r for r in record.rows if r.get("other_cpu", 0) > DISTURBED]
    print(f"\n{len(disturbed)} of {sum('other_cpu' in r for r in record.rows)} measurements were disturbed. JSON lines: {path}")


if __name__ == "__main__":
    main()
