"""Runs the benches that are asked for; `bench-compare/run` sets up what they need and calls this."""
import argparse
import datetime
import subprocess
import sys

import bench_contact
import bench_delaunay
import bench_drift
import bench_files
import bench_implant
import bench_mesh
import bench_motion
import bench_quality
import bench_refine
import bench_remesh
from common import DISTURBED, ROOT, TARGET, Record, machine

BENCHES = {"delaunay": bench_delaunay, "motion": bench_motion, "files": bench_files, "remesh": bench_remesh,
           "contact": bench_contact, "refine": bench_refine, "mesh": bench_mesh, "implant": bench_implant, "quality": bench_quality,
           "drift": bench_drift}


def words():
    parser = argparse.ArgumentParser(prog="bench-compare/run", description="motet beside its rivals on the same input")
    parser.add_argument("benches", nargs="*", help=f"{', '.join(BENCHES)} (default: all)")
    parser.add_argument("--rounds", type=int, default=5, help="how often each program's turn comes (default 5)")
    parser.add_argument("--largest", type=int, default=1_000_000, help="largest point set of the Delaunay bench")
    parser.add_argument("--sizes", default="ABCD", help="which of the paper's four models (default ABCD)")
    parser.add_argument("--surfaces", help="which surfaces of the mesh bench, with commas between (default: all)")
    parser.add_argument("--cases", help="which cases of the drift bench, with commas between (default: all)")
    parser.add_argument("--turns", type=int, help="turns of what turns in the drift bench (default 3; 6 of the bar)")
    parser.add_argument("--cycles", type=int, help="cycles of what goes there and back in it (default: each case's own, 3 to 20)")
    parser.add_argument("--limit", type=float, default=120.0, help="seconds that one call of a program may take")
    parser.add_argument("--openfoam", action="store_true", help="install OpenFOAM too (it is used when it is there)")
    parser.add_argument("--quick", action="store_true", help="one round, small sizes")
    parser.add_argument("--out", help="JSON lines (default: bench-compare/target/results.jsonl, begun anew)")
    options = parser.parse_args()
    unknown = set(options.benches) - set(BENCHES)
    if unknown:
        parser.error(f"no bench called {', '.join(sorted(unknown))}; there are {', '.join(BENCHES)}")
    if options.quick:
        options.rounds, options.largest, options.sizes = 1, min(options.largest, 20_000), "A"
    return options


def revision():
    done = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--dirty"], capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def main():
    options = words()
    path = options.out or TARGET / "results.jsonl"
    if not options.out:
        path.unlink(missing_ok=True)
    record = Record(path)
    here = {**machine(), "revision": revision(), "date": datetime.date.today().isoformat()}
    record.add(bench="machine", **here)
    print(f"# motet {here['revision']} beside its rivals, {here['date']}\n")
    print(f"{here['processor']}, {here['cores']} cores, {here['memory_gib']} GiB, {here['system']}. "
          "Motet: release profile, plain target, no flags for this processor.")
    print(f"\nA star marks a figure during which other programs kept more than {DISTURBED:g} of a core busy.")
    sys.stdout.flush()
    for name in options.benches or BENCHES:
        BENCHES[name].run(record, options)
        sys.stdout.flush()
    stolen = [r for r in record.rows if r.get("other_cpu", 0) > DISTURBED]
    print(f"\n{len(stolen)} of {sum('other_cpu' in r for r in record.rows)} figures were disturbed. JSON lines: {path}")


if __name__ == "__main__":
    main()
