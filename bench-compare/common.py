"""Helpers of the benchmarks: machine data, programs run in turn, medians and tables.

A contender is a command that prints one JSON object on its last line, with at least `seconds`: one number per
repeat (or the median of many repeats), measured inside the program without start-up and reading of files.
"""
import json
import os
import platform
import signal
import statistics
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
TARGET = HERE / "target"
MOTET = Path(os.environ.get("MOTET_BIN_DIR") or ROOT / "target" / "release")
# A run counts as disturbed if other programs used more than this fraction of one core.
DISTURBED = 0.1


def machine():
    """Return the processor, number of cores, memory and system, without which measurements are
    meaningless."""
    model = platform.processor()
    try:
        for line in open("/proc/cpuinfo"):
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    except (OSError, ValueError):
        memory = 0.0
    cores = len(os.sched_getaffinity(0))
    return {"processor": model, "cores": cores, "memory_gib": round(memory, 1),
            "system": f"{platform.system()} {platform.release()}"}


def busy_seconds():
    """Return the CPU seconds used by all programs since the machine started."""
    try:
        user, nice, system, _idle, _wait, irq, softirq, _steal = map(
            int, Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9])
    except (OSError, ValueError):
        return 0.0
    return (user + nice + system + irq + softirq) / os.sysconf("SC_CLK_TCK")


class Record:
    """Results, written to a file as JSON lines and kept for the tables."""

    def __init__(self, path):
        self.file = open(path, "a")
        self.rows = []

    def add(self, **row):
        row = {k: float(f"{v:.6g}") if isinstance(v, float) else v for k, v in row.items()}
        self.rows.append(row)
        self.file.write(json.dumps(row) + "\n")
        self.file.flush()

    def of(self, **wanted):
        """Return the first row with the given values, or None."""
        return next((r for r in self.rows if all(r.get(k) == v for k, v in wanted.items())), None)


def own_seconds():
    """Return the CPU seconds of this process and of its finished children."""
    used = os.times()
    return used.user + used.system + used.children_user + used.children_system


def call(command, limit):
    """Run a contender once and return its JSON object, or {"error": reason}.

    Adds `peak_mib`, `wall`, and `others`: CPU seconds used by other programs during the run.
    """
    start, busy, own = time.perf_counter(), busy_seconds(), own_seconds()
    process = subprocess.Popen([sys.executable, "-c", _WRAPPER, *map(str, command)], text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
    try:
        out, err = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return {"error": f"> {limit:g} s"}
    if process.returncode != 0:
        return {"error": (err.strip().splitlines() or ["?"])[-1][:200]}
    result = json.loads(out)
    result["wall"] = time.perf_counter() - start
    result["others"] = max(0.0, busy_seconds() - busy - (own_seconds() - own))
    return result


# Runs a command in a small process of its own and adds the peak memory of that process's children.
_WRAPPER = """
import json, resource, subprocess, sys
done = subprocess.run(sys.argv[1:], stdout=subprocess.PIPE, text=True)
if done.returncode: sys.exit(f"{sys.argv[1]} ended with {done.returncode}: {' '.join(done.stdout[-200:].split())}")
result = json.loads(done.stdout.strip().splitlines()[-1])
result["peak_mib"] = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
print(json.dumps(result))
"""


def in_turn(contenders, rounds, limit=300.0):
    """Run the contenders {name: command} in turn for several rounds, so that disturbances affect all of them.

    Returns {name: result}: the JSON object of the last round, in which `seconds` is the median over all
    repeats of all rounds and other `..._seconds` are medians over the rounds, with `best`, `runs`,
    `peak_mib`, and `other_cpu` (cores used by other programs). A contender that fails is not run again; its
    result is {"error": reason}.
    """
    results = {name: [] for name in contenders}
    for _ in range(rounds):
        for name, command in contenders.items():
            if not (results[name] and "error" in results[name][-1]):
                results[name].append(call(command, limit))
    return {name: combine(parts) for name, parts in results.items()}


def combine(parts):
    """Combine the rounds of a contender to one result."""
    failed = next((p for p in parts if "error" in p), None)
    if failed:
        return failed
    listed = lambda value: value if isinstance(value, list) else [value]
    seconds = [s for p in parts for s in listed(p["seconds"])]
    whole = {key: statistics.median(p[key] for p in parts) if key.endswith("_seconds") else value
             for key, value in parts[-1].items()}
    del whole["wall"], whole["others"]
    whole.update(seconds=statistics.median(seconds), best=min(seconds), runs=len(seconds),
                 peak_mib=min(p["peak_mib"] for p in parts),
                 other_cpu=sum(p["others"] for p in parts) / sum(p["wall"] for p in parts))
    return whole


def reference(name="results.jsonl"):
    """Return measurements of another machine, or an empty list if their folder does not exist."""
    path = Path(os.environ.get("MOTET_REFERENCE") or ROOT.parent / "shared" / "bench" / name)
    if not path.is_file():
        return []
    return [json.loads(line) for line in path.read_text().splitlines() if line.strip()]


def seconds_text(seconds):
    """Format a time with three digits in a suitable unit."""
    if seconds is None:
        return "-"
    for factor, unit in ((1, "s"), (1e3, "ms"), (1e6, "us")):
        if seconds * factor >= 1:
            return f"{seconds * factor:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def cell(result, text):
    """Return a table cell: the text, with a star if the run was disturbed, or the reason for a missing
    result."""
    if result is None:
        return "-"
    if "error" in result:
        return result["error"] if result["error"].startswith(">") else "failed"
    return text + ("*" if result.get("other_cpu", 0.0) > DISTURBED else "")


def table(header, rows):
    """Return a Markdown table with aligned columns."""
    cells = [list(map(str, header)), *[list(map(str, r)) for r in rows]]
    width = [max(len(r[i]) for r in cells) for i in range(len(header))]
    line = lambda r: "| " + " | ".join(c.ljust(w) for c, w in zip(r, width)) + " |"
    return "\n".join([line(cells[0]), "|" + "|".join("-" * (w + 2) for w in width) + "|", *map(line, cells[1:])])
