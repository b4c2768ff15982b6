"""Runs `motet implant` on files and prints its times as JSON.

usage: implant_motet.py MOTET RUNS OUT.vtu ARGUMENT...      arguments of `motet implant`: host, devices, options

`seconds` are reported by the program, without files. `whole_seconds` is the median duration of the process,
and `cpu_seconds` the median of its CPU time.
"""
import json
import resource
import statistics
import subprocess
import sys
import time

BUDGET = 10.0  # no call is started after this number of seconds
DONE, NOT_REACHED = 0, 4

motet, runs, target, *arguments = sys.argv[1:]


def used():
    of_children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return of_children.ru_utime + of_children.ru_stime


seconds, whole, cpu = [], [], []
while len(seconds) < int(runs) and sum(seconds) < BUDGET:
    start, before = time.perf_counter(), used()
    done = subprocess.run([motet, "implant", *arguments, "-o", target, "--threads", "1", "--json"], capture_output=True, text=True)
    whole.append(time.perf_counter() - start)
    cpu.append(used() - before)
    if done.returncode not in (DONE, NOT_REACHED):
        error = (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
        print(json.dumps({"error": error.removeprefix(f"error: {arguments[0]}: ")[:200]}))
        break
    report = json.loads(done.stdout)
    seconds.append(report["seconds"]["total"] - report["seconds"]["read"] - report["seconds"]["write"])
else:
    version = subprocess.run([motet, "--version"], capture_output=True, text=True).stdout.split()[-1]
    devices = report["report"]["devices"]
    print(json.dumps({"seconds": seconds, "whole_seconds": statistics.median(whole), "cpu_seconds": statistics.median(cpu),
                      "version": version, "complete": report["complete"], "unforced": report["unforced"],
                      "regions": [region for device in devices for region in device["regions"]],
                      "at_walls": sum(device["triangles_at_walls"] for device in devices),
                      "outside": sum(device["triangles_outside"] for device in devices)}))
