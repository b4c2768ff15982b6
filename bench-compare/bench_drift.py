"""Does a mesh stay the mesh it was? Long motions by `motet run`, and two of them by a loop round Mmg: counts and quality, step by step."""
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

QUICK = 12  # steps of each case
LIMIT = 5.0  # seconds that a step may take, all in all: a mesh that grows in each cycle comes to no end
ROWS = 12  # cycles in the table of cycles, at most
# name in the table: tets with an edge below this part of its size belong to the zone of a repair
RIVALS = {"Mmg loop": 0.0, "Mmg loop, short edges too": 0.55}


def run(record, options):
    found, without, with_transfer = asked(options)
    left_out, results = [f"{name} (no data; MOTET_DATA names the folder)" for name in without], []
    for case in found:
        for program, done in programs(case, options):
            steps = done.get("log", [])
            row = {k: v for k, v in done.items() if k != "log"} | (sums(steps) if steps else {})
            record.add(**row, bench="drift", case=case.name, program=program)
            if steps:
                results.append((case, program, row, steps))
            if "error" in done:
                left_out.append(f"{case.name}, {program} ({done['error']})")
            print(f"  drift {case.name}, {program}: done", file=sys.stderr, flush=True)
    if results:
        tables(results)
    if with_transfer:
        try:
            drift_transfer.run(record, options, next(case for case in cases(options) if case.name == "paddle"))
        except (OSError, RuntimeError) as why:
            left_out.append(f"{drift_transfer.NAME} ({why})")
    for line in left_out:
        print(f"\nLeft out: {line}")


def asked(options):
    """The cases, the names of those without data, and whether fields are looked at, too: that is no case of `motet run`."""
    names = options.cases.split(",") if options.cases else None
    if names is None or drift_transfer.NAME not in names:
        return *chosen(options), names is None
    names.remove(drift_transfer.NAME)
    options = argparse.Namespace(**vars(options) | {"cases": ",".join(names)})
    return *(chosen(options) if names else ([], [])), True


def programs(case, options):
    """Each program's name and what it did: `log` and `status`, or `error`."""
    try:
        case.make()
    except RuntimeError as why:
        yield "motet", {"error": str(why)}
        return
    yield "motet", ours(case, options)
    if case.body:
        for name, short in RIVALS.items():
            yield name, rival(case, options, short)


def limit(case, options):
    """How many steps there are, and how many seconds they may take."""
    steps = min(QUICK if options.quick else case.steps * case.cycles, case.steps * case.cycles)
    return steps, max(options.limit, LIMIT * steps)


def ours(case, options):
    steps, most = limit(case, options)
    command = [MOTET / "motet", "run", "job.toml", "--threads", "1", "--until", str(steps)]
    start, busy, own = time.perf_counter(), busy_seconds(), own_seconds()
    try:
        done = subprocess.run(command, cwd=case.folder, capture_output=True, text=True, timeout=most)
        status, why = done.returncode, (done.stderr.strip().splitlines() or ["?"])[-1][:200]
    except subprocess.TimeoutExpired:
        status = why = f"> {most:g} s"
    others = max(0.0, busy_seconds() - busy - (own_seconds() - own)) / (time.perf_counter() - start)
    log = read_run(case.folder / "out")
    return {"log": log, "status": status, "other_cpu": others} if log else {"error": why, "status": status}


def rival(case, options, short):
    """The same motion from the same mesh, in a process of its own."""
    if not importlib.util.find_spec("mmgpy"):
        return {"error": "no mmgpy"}
    steps, most = limit(case, options)
    points, tets, _ = read_frame(case.folder / case.mesh)
    mesh, job, path = (case.folder / name for name in ("mesh.npz", "mmg.json", "mmg.jsonl"))
    np.savez(mesh, points=points, tets=tets)
    job.write_text(json.dumps(case.body | {"steps": steps, "short": short}))
    path.unlink(missing_ok=True)
    done = call([sys.executable, HERE / "rivals" / "drift_mmg.py", mesh, job, path], most)
    if "error" not in done:
        return {"log": lines(path), "status": done["status"], "other_cpu": done["others"] / done["wall"]}
    log = lines(path)  # what it did until its time was over
    return {"log": log, "status": done["error"]} if log else done


def tables(results):
    print("\n## Does a mesh stay the mesh it was\n")
    print("Long motions, one thread. Vertices, tets, vertices of walls at first, least, most, last. EAS and mean ratio over all tets: their means; "
          "\"1 %\": a hundredth is below. \"Changed\": tets\nthat are no longer there after a step, mean over steps. In brackets: at how many steps quality is known, where not at all of them.\n")
    header = ["case", "program", "steps", "vertices", "tets", "walls", "mean EAS first, last", "least", "1 % last", "mean ratio", "worst ever",
              "bad ever", "inverted", "changed", "a step", "status"]
    print(table(header, [columns(case, program, row) for case, program, row, _ in results]))
    for case, program, _, steps in results:
        ends = cycle_ends(steps, case.steps)
        if len(ends) > 2:
            print(f"\n### {case.name}, {program}: {case.about}\n\nAt the ends of cycles of {case.steps} steps.\n")
            print(table(["cycle", "vertices", "tets", "mean EAS", "5 %", "1 %", "worst", "bad", "mean ratio"],
                        [at_end(*end) for end in some(ends)]))


def columns(case, program, row):
    """A row of the large table."""
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
    """All where they are few; else every second, fifth, tenth, ... and the last."""
    last = ends[-1][0]
    apart = next((n for n in (1, 2, 5, 10, 20, 50, 100, 200, 500) if last / n <= ROWS), 1000)
    return [end for end in ends if end[0] % apart == 0 or end is ends[-1]]
