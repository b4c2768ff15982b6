"""Runs `motet mesh` on files and prints its times as JSON.

usage: mesh_motet.py MOTET RUNS SURFACE OUT.vtu [OPTION...]      options of `motet mesh`

`seconds` are reported by the program, for checking and filling the surface without files. `whole_seconds` is
the median duration of the process.
"""
import json
import statistics
import subprocess
import sys
import time

BUDGET = 3.0  # no call is started after this number of seconds
DONE, NOT_REACHED = 0, 4

motet, runs, source, target, *options = sys.argv[1:]
seconds, whole = [], []
while len(seconds) < int(runs) and sum(seconds) < BUDGET:
    start = time.perf_counter()
    done = subprocess.run([motet, "mesh", source, "-o", target, "--threads", "1", "--json", *options], capture_output=True, text=True)
    whole.append(time.perf_counter() - start)
    if done.returncode not in (DONE, NOT_REACHED):
        line = (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
        print(json.dumps({"error": line.removeprefix("error: ").replace(f"{source}: ", "")[:200]}))
        break
    report = json.loads(done.stdout)
    seconds.append(report["seconds"]["check"] + report["seconds"]["fill"])
else:
    version = subprocess.run([motet, "--version"], capture_output=True, text=True).stdout.split()[-1]
    print(json.dumps({"seconds": seconds, "whole_seconds": statistics.median(whole), "version": version,
                      "complete": done.returncode == DONE, "filled": report["filled"], "improved": report["improved"]}))
