"""Numbers of vertices and quality over long motions, by `motet run` and, for two motions, by a
loop with Mmg."""
import argparse
import importlib.util
import json
import subprocess
import sys
import time

import numpy as np

import drift_transfer
from common import HERE, MOTET, busy_seconds, call, cell, own_seconds, table
from drift_cases import cases, chosen
from drift_log import cycle_ends, lines, read_frame, read_run, sums

QUICK = 12  # number of steps of each case with --quick
LIMIT = 5.0  # mean seconds that a step may take; a mesh that grows in each cycle would never finish
ROWS = 12  # largest number of cycles in a table of cycles
# Name in the table: tets with an edge below this fraction of its size belong to the zone of a repair.
RIVALS = {"Mmg loop": 0.0, "Mmg loop, short edges too": 0.55}


def run(record, options):
    found, without, with_transfer = requested(options)
    omitted, results = [f"{name} (no data: set MOTET_DATA to the folder of real meshes)" for name in without], []
    for case in found:
        for program, done in programs(case, options):
            steps = done.get("log", [])
            row = {k: v for k, v in done.items() if k != "log"} | (sums(steps) if steps else {})
            record.add(**row, bench="drift", case=case.name, program=program)
            if steps:
                results.append((case, program, row, steps))
            if "error" in done:
                omitted.append(f"{case.name}, {program} ({done['error']})")
            print(f"  drift {case.name}, {program}: done", file=sys.stderr, flush=True)
    if results:
        tables(results)
    if with_transfer:
        try:
            drift_transfer.run(record, options, next(case for case in cases(options) if case.name == "paddle"))
        except (OSError, RuntimeError) as error:
            omitted.append(f"{drift_transfer.NAME} ({error})")
    for line in omitted:
        print(f"\nOmitted: {line}")


def requested(options):
    """Return the cases, the names of those without data, and whether to run `drift_transfer`, which is not a
    case."""
    names = options.cases.split(",") if options.cases else None
    if names is None or drift_transfer.NAME not in names:
        return *chosen(options), names is None
    names.remove(drift_transfer.NAME)
    options = argparse.Namespace(**vars(options) | {"cases": ",".join(names)})
    return *(chosen(options) if names else ([], [])), True


def programs(case, options):
    """Yield the name and the result of each program: `log` and `status`, or `error`."""
    try:
        case.make()
    except RuntimeError as error:
        yield "motet", {"error": str(error)}
        return
    yield "motet", ours(case, options)
    if case.body:
        for name, short in RIVALS.items():
            yield name, rival(case, options, short)


def limit(case, options):
    """Return the number of steps, and their time limit in seconds."""
    steps = min(QUICK if options.quick else case.steps * case.cycles, case.steps * case.cycles)
    return steps, max(options.limit, LIMIT * steps)


def ours(case, options):
    steps, most = limit(case, options)
    command = [MOTET / "motet", "run", "job.toml", "--threads", "1", "--until", str(steps)]
    start, busy, own = time.perf_counter(), busy_seconds(), own_seconds()
    try:
        done = subprocess.run(command, cwd=case.folder, capture_output=True, text=True, timeout=most)
        status, error = done.returncode, (done.stderr.strip().splitlines() or ["?"])[-1][:200]
    except subprocess.TimeoutExpired:
        status = error = f"> {most:g} s"
    others = max(0.0, busy_seconds() - busy - (own_seconds() - own)) / (time.perf_counter() - start)
    log = read_run(case.folder / "out")
    return {"log": log, "status": status, "other_cpu": others} if log else {"error": error, "status": status}


def rival(case, options, short):
    """Run the motion of a case with Mmg, from the same mesh, in a separate process."""
    if not importlib.util.find_spec("mmgpy"):
        return {"error": "mmgpy is not installed"}
    steps, most = limit(case, options)
    points, tets, _ = read_frame(case.folder / case.mesh)
    mesh, job, path = (case.folder / name for name in ("mesh.npz", "mmg.json", "mmg.jsonl"))
    np.savez(mesh, points=points, tets=tets)
    job.write_text(json.dumps(case.body | {"steps": steps, "short": short}))
    path.unlink(missing_ok=True)
    done = call([sys.executable, HERE / "rivals" / "drift_mmg.py", mesh, job, path], most)
    if "error" not in done:
        return {"log": lines(path), "status": done["status"], "other_cpu": done["others"] / done["wall"]}
    log = lines(path)  # the steps within the time limit
    return {"log": log, "status": done["error"]} if log else done


def tables(results):
    print("\n## Long motions\n")
    print("One thread. Numbers of vertices, tets and wall vertices: first, minimum, maximum, last. EAS and mean ratio are means over all tets; "
          "\"1 %\" is a percentile. \"Changed\": fraction of\ntets that a step removes, mean over steps. In brackets: the number of steps with known quality, if fewer than all.\n")
    header = ["case", "program", "steps", "vertices", "tets", "walls", "mean EAS first, last", "min", "1 % last", "mean ratio", "worst of all",
              "most bad", "inverted", "changed", "per step", "status"]
    print(table(header, [columns(case, program, row) for case, program, row, _ in results]))
    for case, program, _, steps in results:
        ends = cycle_ends(steps, case.steps)
        if len(ends) > 2:
            print(f"\n### {case.name}, {program}: {case.about}\n\nAt the ends of cycles of {case.steps} steps.\n")
            print(table(["cycle", "vertices", "tets", "mean EAS", "5 %", "1 %", "worst", "bad", "mean ratio"],
                        [at_end(*end) for end in some(ends)]))


def columns(case, program, row):
    """Return a row of the table of all cases."""
    four = lambda key: " ".join(f"{row[f'{key}_{when}']:,}" for when in ("first", "least", "most", "last"))
    known = "" if row["qualities"] == row["steps"] + 1 else f" ({row['qualities']})"
    return [case.name, program, row["steps"], four("points"), four("tets"), f"{row['walls_first']:,} {row['walls_last']:,}",
            f"{row['mean_first']:.3f} {row['mean_last']:.3f}", f"{row['mean_least']:.3f}{known}", f"{row['p1_last']:.3f}",
            f"{row['ratio_first']:.3f} {row['ratio_last']:.3f}", f"{row['worst_ever']:.3f}", row["bad_ever"], row["inverted_ever"],
            f"{row['changed']:.1%}", cell(row, f"{row['seconds']:.2f} s"), row["status"]]


def at_end(cycle, step):
    quality = step["quality"]
    return [cycle, f"{step['points']:,}", f"{step['tets']:,}", f"{quality['mean']:.3f}", f"{quality['p5']:.3f}", f"{quality['p1']:.3f}",
            f"{quality['worst']:.3f}", step["bad"], f"{quality['mean_ratio']:.3f}"]


def some(ends):
    """Return all ends of cycles if they are few, otherwise every second, fifth, tenth, ... and the last."""
    last = ends[-1][0]
    stride = next((n for n in (1, 2, 5, 10, 20, 50, 100, 200, 500) if last / n <= ROWS), 1000)
    return [end for end in ends if end[0] % stride == 0 or end is ends[-1]]
