"""`motet implant` called as a user calls it: files in, a mesh file out, JSON out.

usage: implant_motet.py MOTET RUNS OUT.vtu WORD...      WORDs for `motet implant`: host, devices, options

`seconds` are the program's own, without reading and writing. `whole_seconds` is the median of the process from its start to its end,
`cpu_seconds` are those of the processor meanwhile.
"""
import json
import resource
import statistics
import subprocess
import sys
import time

BUDGET = 10.0  # no call is begun after so many seconds of work
DONE, NOT_REACHED = 0, 4

motet, runs, target, *words = sys.argv[1:]


def used():
    of_children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return of_children.ru_utime + of_children.ru_stime


seconds, whole, cpu = [], [], []
while len(seconds) < int(runs) and sum(seconds) < BUDGET:
    start, before = time.perf_counter(), used()
    done = subprocess.run([motet, "implant", *words, "-o", target, "--threads", "1", "--json"], capture_output=True, text=True)
    whole.append(time.perf_counter() - start)
    cpu.append(used() - before)
    if done.returncode not in (DONE, NOT_REACHED):
        said = (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
        print(json.dumps({"error": said.removeprefix(f"error: {words[0]}: ")[:200]}))
        break
    said = json.loads(done.stdout)
    seconds.append(said["seconds"]["total"] - said["seconds"]["read"] - said["seconds"]["write"])
else:
    version = subprocess.run([motet, "--version"], capture_output=True, text=True).stdout.split()[-1]
    devices = said["report"]["devices"]
    print(json.dumps({"seconds": seconds, "whole_seconds": statistics.median(whole), "cpu_seconds": statistics.median(cpu),
                      "version": version, "complete": said["complete"], "unforced": said["unforced"],
                      "regions": [region for device in devices for region in device["regions"]],
                      "at_walls": sum(device["triangles_at_walls"] for device in devices),
                      "outside": sum(device["triangles_outside"] for device in devices)}))
