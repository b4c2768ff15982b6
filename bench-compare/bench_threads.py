"""One thread beside two, verb by verb: whole processes of `motet`, whose files must be the same bytes.

A third row of figures comes from two processes of one thread each at the same time: what two cores of this machine
can gain, where work is limited by memory as that of one process is.
"""
import hashlib
import os
import shutil
import statistics
import subprocess
import sys
import time

import point_sets
from common import MOTET, TARGET, busy_seconds, own_seconds, table

FOLDER = TARGET / "threads"
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
        "refine, near": ["refine", "vessel.vtu", "--near", "loops.vtp=0.2", "--generations", "3", "-o", "OUT.vtu"],
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


def timed(words, threads, n_at_once=1):
    """Return the seconds until `n_at_once` processes have ended, and the hash of the first one's file."""
    begin = time.perf_counter()
    processes = []
    for i in range(n_at_once):
        named = [word.replace("OUT", f"out_{threads}_{i}") for word in words]
        processes.append(subprocess.Popen([MOTET / "motet", *named, "--threads", str(threads), "-q"], cwd=FOLDER,
                                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True))
    for process in processes:
        _, error = process.communicate()
        if process.returncode not in (0, LEFT):
            raise RuntimeError(f"{process.returncode}: {error.strip()[-200:]}")
    seconds = time.perf_counter() - begin
    out = next(word for word in words if word.startswith("OUT")).replace("OUT", f"out_{threads}_0")
    return seconds, hashlib.sha256((FOLDER / out).read_bytes()).hexdigest()


def in_turn(words, rounds):
    """Return medians for one thread, two threads, and two processes of one thread; and whether all bytes agree."""
    seconds, hashes = ([], [], []), set()
    for _ in range(rounds):
        for times, (threads, at_once) in zip(seconds, ((1, 1), (2, 1), (1, 2))):
            took, digest = timed(words, threads, at_once)
            times.append(took)
            hashes.add(digest)
    return [statistics.median(times) for times in seconds], len(hashes) == 1


def triangulated(name, points, rounds):
    """Return what `in_turn` returns, for the example `delaunay`, which prints the seconds of the call alone."""
    path = FOLDER / "points.f64"
    points.astype("<f8").tofile(path)
    seconds, hashes = ([], [], []), set()
    for _ in range(rounds):
        for times, (threads, at_once) in zip(seconds, ((1, 1), (2, 1), (1, 2))):
            out = [FOLDER / f"tets_{i}" for i in range(at_once)]
            commands = [[MOTET / "examples" / "delaunay", path, "--threads", str(threads), "--tets", place] for place in out]
            processes = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for command in commands]
            printed = [process.communicate()[0] for process in processes]
            times.append(max(float(text.split('"seconds":[')[1].split("]")[0]) for text in printed))
            hashes.add(hashlib.sha256(out[0].read_bytes()).hexdigest())
    return [statistics.median(times) for times in seconds], len(hashes) == 1


def run(record, options):
    shapes()
    rounds = min(options.rounds, 5)
    sets = {"Delaunay, 200k on a sphere": point_sets.spiral_sphere(200_000)}
    if not options.quick:
        sets |= {"Delaunay, 1M in a cube": point_sets.cube(1_000_000), "Delaunay, 1M on a sphere": point_sets.spiral_sphere(1_000_000)}
    works = {name: lambda name=name, points=points: triangulated(name, points, rounds) for name, points in sets.items()}
    works |= {name: lambda words=words: in_turn(words, rounds) for name, words in cases(options.quick).items()}
    rows = []
    for name, work in works.items():
        busy, own, begin = busy_seconds(), own_seconds(), time.perf_counter()
        try:
            (one, two, both), same = work()
        except (RuntimeError, OSError) as error:
            rows.append([name, "-", "-", "-", "-", str(error)])
            continue
        others = (busy_seconds() - busy - (own_seconds() - own)) / (time.perf_counter() - begin)
        record.add(bench="threads", verb=name, seconds=one, two_threads=two, two_processes=both, same=same, other_cpu=max(0.0, others))
        rows.append([name, f"{one:.2f}", f"{two:.2f}", f"{one / two:.2f}", f"{2 * one / both:.2f}", "same" if same else "DIFFERENT"])
        print(f"  threads {name}: done", file=sys.stderr, flush=True)
    print("\n## One thread and two\n")
    print(f"Seconds, medians of {rounds} rounds in turn: of the call for Delaunay, of the whole process with reading and writing for all else; "
          f"{len(os.sched_getaffinity(0))} cores.\n\"Limit\": what two processes of one thread each gain at the same time.\n")
    print(table(["work", "1 thread", "2 threads", "1 / 2", "limit", "bytes"], rows))
    shutil.rmtree(FOLDER)
