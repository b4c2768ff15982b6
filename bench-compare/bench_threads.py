"""One thread beside two, verb by verb: whole processes of `motet`, whose files must be the same bytes; then other
programs on one thread and two.

"Limit" comes from two processes of one thread each at the same time: what two cores of this machine can gain, where
work is limited by memory as that of one process is. More cores than the machine has are simulated
(`motet::base::Simulation`): one thread does all tasks, and a clock runs as if each went to the thread that is free first.
"""
import hashlib
import json
import os
import shutil
import statistics
import subprocess
import sys
import time

import numpy as np

import point_sets
from common import DISTURBED, HERE, MOTET, TARGET, busy_seconds, call, own_seconds, seconds_text, table
from mesh_files import merged, read_vtp
from remesh_files import Case

FOLDER = TARGET / "threads"
# Numbers of threads that are simulated.
SIMULATED = (2, 4, 16, 64)
# Exit status of motet where some tets stay bad, as in cases made for it.
LEFT = 4


def shapes():
    """Write motet's own shapes, and the meshes made of them; not timed."""
    FOLDER.mkdir(exist_ok=True, parents=True)
    subprocess.run([MOTET / "examples" / "shapes", FOLDER, "--around", "96"], check=True)
    for words in (["mesh", "aneurysm.vtp", "--size", "0.12", "-o", "vessel.vtu"],
                  ["mesh", "aneurysm.vtp", "--size", "0.06", "-o", "fine.vtu"],
                  ["move", "fine.vtu", "--affine", "1,0.6,0,0,0,1,0,0,0,0,1,0", "-o", "sheared.vtu"]):
        finished(words, FOLDER)


def cases(quick):
    """Return {verb: words of motet}, each of which writes OUT."""
    size = "0.12" if quick else "0.05"
    all_cases = {
        "mesh": ["mesh", "aneurysm.vtp", "--size", size, "-o", "OUT.vtu"],
        "mesh, layers": ["mesh", "aneurysm.vtp", "--size", size, "--layers", "3,0.01,1.2", "-o", "OUT.vtu"],
        "remesh": ["remesh", "sheared.vtu", "-o", "OUT.vtu"],
        "remesh, best": ["remesh", "vessel.vtu", "--goal", "best", "-o", "OUT.vtu"],
        "remesh, sizes": ["remesh", "vessel.vtu", "--sizes", "0.1", "-o", "OUT.vtu"],
        "refine, all": ["refine", "vessel.vtu" if quick else "fine.vtu", "--all", "-o", "OUT.vtu"],
        "refine, near": ["refine", "vessel.vtu", "--near", "loops.vtp=0.2", "--generations", "2", "-o", "OUT.vtu"],
        "implant": ["implant", "block.vtu", "turns.vtp", "-o", "OUT.vtu"],
        "contact": ["contact", "loops.vtp", "aneurysm.vtp", "-o", "OUT.vtp"],
        "move": ["move", "fine.vtu", "--affine", "1,0.1,0,0,0,1,0,0,0,0,1,0", "-o", "OUT.vtu"],
        "convert": ["convert", "fine.vtu", "OUT.vtu"],
    }
    return dict(list(all_cases.items())[:3]) if quick else all_cases


def finished(words, folder):
    """Run motet in a folder; a mesh with bad tets is no error."""
    done = subprocess.run([MOTET / "motet", *words, "-q"], cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, LEFT):
        raise RuntimeError(f"motet {' '.join(words)}: {done.returncode}: {done.stderr.strip()[-200:]}")


def started(words):
    """Start a program; its streams are read by `ended`."""
    return subprocess.Popen(words, cwd=FOLDER, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def ended(process):
    """Return standard output and standard error of a program that has ended well."""
    printed, error = process.communicate()
    if process.returncode not in (0, LEFT):
        raise RuntimeError(f"{process.returncode}: {error.strip()[-200:]}")
    return printed, error


class Verb:
    """A verb of the command line; its time is that of the whole process."""

    def __init__(self, words):
        self.words = words
        self.ending = next(word for word in words if word.startswith("OUT")).removeprefix("OUT")

    def command(self, number, *options):
        return [MOTET / "motet", *[word.replace("OUT", f"out_{number}") for word in self.words], *options, "-q"]

    def seconds(self, threads, n_at_once):
        """Return the seconds until `n_at_once` processes have ended, and the path of the first one's file."""
        begin = time.perf_counter()
        processes = [started(self.command(i, "--threads", str(threads))) for i in range(n_at_once)]
        for process in processes:
            ended(process)
        return time.perf_counter() - begin, FOLDER / f"out_0{self.ending}"

    def simulated(self, threads):
        """Return the seconds that so many threads would have taken."""
        begin = time.perf_counter()
        _, error = ended(started(self.command(0, "--simulate-threads", str(threads))))
        return time.perf_counter() - begin - float(error.split("saved: ")[1].split()[0])


class Triangulation:
    """The example `delaunay`, which prints the seconds of the call alone."""

    def __init__(self, name, points):
        self.path = FOLDER / f"{name.replace(' ', '_').replace(',', '')}.f64"
        points.astype("<f8").tofile(self.path)

    def command(self, number, *options):
        return [MOTET / "examples" / "delaunay", self.path, *options, "--tets", FOLDER / f"tets_{number}"]

    def seconds(self, threads, n_at_once):
        """Return the seconds of the slowest of `n_at_once` processes, and the path of the first one's tets."""
        processes = [started(self.command(i, "--threads", str(threads))) for i in range(n_at_once)]
        return max(json.loads(ended(process)[0])["seconds"][0] for process in processes), FOLDER / "tets_0"

    def simulated(self, threads):
        """Return the seconds that so many threads would have taken."""
        return json.loads(ended(started(self.command(0, "--simulate-threads", str(threads))))[0])["seconds"][0]


def in_turn(work, rounds):
    """Return medians for one thread, two threads, two processes of one thread, and each number of simulated threads;
    and whether all bytes agree."""
    measured, simulated, hashes = ([], [], []), [[] for _ in SIMULATED], set()
    for _ in range(rounds):
        for times, (threads, at_once) in zip(measured, ((1, 1), (2, 1), (1, 2))):
            took, path = work.seconds(threads, at_once)
            times.append(took)
            hashes.add(hashlib.sha256(path.read_bytes()).hexdigest())
        for times, threads in zip(simulated, SIMULATED):
            times.append(work.simulated(threads))
    return [statistics.median(times) for times in (*measured, *simulated)], len(hashes) == 1


def works(quick):
    """Return {name: work}."""
    sets = {"Delaunay, 200k on a sphere": point_sets.spiral_sphere(200_000)}
    if not quick:
        sets |= {"Delaunay, 1M in a cube": point_sets.cube(1_000_000), "Delaunay, 1M on a sphere": point_sets.spiral_sphere(1_000_000)}
    found = {name: Triangulation(name, points) for name, points in sets.items()}
    return found | {name: Verb(words) for name, words in cases(quick).items()}


def rivals(found, quick):
    """Return {(work, program): command for a number of threads}."""
    python = [sys.executable, HERE / "rivals" / "mesh_python.py"]
    points, triangles = merged(*read_vtp(FOLDER / "aneurysm.vtp"))
    np.savez(FOLDER / "aneurysm.npz", points=points, triangles=triangles)
    size = cases(quick)["mesh"][3]
    mesher = lambda keyword: lambda t: [*python, keyword, size, 1, FOLDER / "aneurysm.npz", FOLDER / "rival.npz", t]
    commands = {("mesh", "Gmsh HXT"): mesher("gmsh-hxt"), ("mesh", "Gmsh, Delaunay"): mesher("gmsh")}
    if (TARGET / "delaunay_cgal").exists():
        for name, work in found.items():
            if isinstance(work, Triangulation):
                # 0 is CGAL's sequential triangulation, which needs no locks.
                commands[name, "CGAL"] = lambda t, path=work.path: [TARGET / "delaunay_cgal", path, t if t > 1 else 0, 1]
    if not quick and (TARGET / "remesh_hxt").exists():
        case = Case("moved_1M")
        raw, source = case.raw(), case.numpy()
        commands["remesh, 1M moved tets", "HXT's optimiser"] = lambda t: [TARGET / "remesh_hxt", *raw, "eas", 0.2, t, FOLDER / "rival"]
        mmg = [sys.executable, HERE / "rivals" / "remesh_python.py", "mmg-local", source, FOLDER / "rival.npz"]
        commands["remesh, 1M moved tets", "Mmg, one ring (has one thread)"] = lambda t: mmg
    return commands


def run(record, options):
    shapes()
    rounds = min(options.rounds, 5)
    found = works(options.quick)
    rows = []
    for name, work in found.items():
        busy, own, begin = busy_seconds(), own_seconds(), time.perf_counter()
        try:
            (one, two, both, *simulated), same = in_turn(work, rounds)
        except (RuntimeError, OSError) as error:
            rows.append([name, *["-"] * (6 + len(SIMULATED)), str(error)])
            continue
        others = (busy_seconds() - busy - (own_seconds() - own)) / (time.perf_counter() - begin)
        record.add(bench="threads", verb=name, seconds=one, two_threads=two, two_processes=both, same=same, other_cpu=max(0.0, others),
                   **{f"simulated_{n}": took for n, took in zip(SIMULATED, simulated)})
        star = "*" if others > DISTURBED else ""
        rows.append([name, f"{one:.2f}{star}", f"{two:.2f}", f"{one / two:.2f}", f"{2 * one / both:.2f}", f"{two / simulated[0] - 1:+.0%}",
                     *[f"{one / took:.2f}" for took in simulated], "same" if same else "DIFFERENT"])
        print(f"  threads {name}: done", file=sys.stderr, flush=True)
    print("\n## One thread and two\n")
    print(f"Seconds, medians of {rounds} rounds in turn: of the call for Delaunay, of the whole process with reading and writing for all else; "
          f"{len(os.sched_getaffinity(0))} cores.\n\"Limit\": what two processes of one thread each gain at the same time. "
          "\"Off\": two threads beside two simulated ones.\nThe last columns: how many times as fast simulated threads are as one. "
          "The simulation knows neither shared caches and memory nor the waking of threads.\n")
    print(table(["work", "1 thread", "2 threads", "1 / 2", "limit", "off", *[f"{n} simulated" for n in SIMULATED], "bytes"], rows))
    compared(record, rivals(found, options.quick), rounds, options.limit)
    shutil.rmtree(FOLDER)


def compared(record, commands, rounds, limit):
    """Run the other programs on one thread and two, and print their times."""
    rows = []
    for (work, program), command in commands.items():
        results = {t: [call(command(t), limit) for _ in range(rounds)] for t in (1, 2)}
        failed = next((result["error"] for runs in results.values() for result in runs if "error" in result), None)
        if failed:
            rows.append([work, program, "-", "-", "-", failed])
            continue
        one, two = (statistics.median(np.concatenate([np.ravel(result["seconds"]) for result in results[t]])) for t in (1, 2))
        record.add(bench="threads", verb=work, program=program, seconds=one, two_threads=two)
        rows.append([work, program, seconds_text(one), seconds_text(two), f"{one / two:.2f}", ""])
        print(f"  threads {program}: done", file=sys.stderr, flush=True)
    print(f"\n## Other programs on one thread and two\n\nSeconds of the call, without files; medians of {rounds} rounds.\n")
    print(table(["work", "program", "1 thread", "2 threads", "1 / 2", ""], rows))
