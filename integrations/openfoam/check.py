#!/usr/bin/env python3
"""Runs the case by moveDynamicMesh and pimpleFoam, serial and on two processes, with `delaunayGraph`: the points have to be the same to round-off. Then clocks a step of it and
of displacementLaplacian.

    integrations/openfoam/check.py FOLDER [--time [CELLS]]     FOLDER: that of libmotetMotionSolver.so; CELLS: along an edge of the box, 64 if not said

Needs OpenFOAM's programs and mpirun. The runs go into FOLDER/run.
"""
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
END = "0.2"


class Case:
    """A copy of the case."""

    def __init__(self, folder, library, cells=32, solver="delaunayGraph"):
        self.folder = folder
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(HERE / "case", folder)
        self.environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
        paths = [str(library), self.environment.get("LD_LIBRARY_PATH", "")]
        self.environment["LD_LIBRARY_PATH"] = ":".join(filter(None, paths))
        # What mpirun asks for where the user is root, as in containers.
        self.environment |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        self.change("system/blockMeshDict", r"\(32 32 32\)", f"({cells} {cells} {cells})")
        coefficients = "diffusivity inverseVolume;" if solver != "delaunayGraph" else ""
        self.change("constant/dynamicMeshDict", "motionSolver delaunayGraph;", f"motionSolver {solver}; {coefficients}")
        for words in (["blockMesh"], ["topoSet"], ["subsetMesh", "-overwrite", "fluid", "-patch", "body"]):
            self.run(*words)

    def change(self, file, old, new):
        path = self.folder / file
        text, n = re.subn(old, new, path.read_text())
        assert n == 1, f"{file}: no {old}"
        path.write_text(text)

    def run(self, *words, processes=1):
        command = list(words)
        if processes > 1:
            command = ["mpirun", "-np", str(processes), "--oversubscribe", *words, "-parallel"]
        begin = time.perf_counter()
        done = subprocess.run(command, cwd=self.folder, env=self.environment, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} in {self.folder}: exit status {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
        return time.perf_counter() - begin, done.stdout

    def points(self, when=END):
        text = (self.folder / when / "polyMesh" / "points").read_text()
        rows = re.findall(r"^\(([^()\s]+) ([^()\s]+) ([^()\s]+)\)$", text, re.M)
        return [tuple(map(float, row)) for row in rows]


def farthest(a, b):
    assert len(a) == len(b) > 0
    return max(abs(x - y) for p, q in zip(a, b) for x, y in zip(p, q))


def compare(folder, library, program):
    serial = Case(folder / f"{program}_serial", library)
    start = serial.points("constant")
    _, output = serial.run(program)
    parallel = Case(folder / f"{program}_parallel", library)
    parallel.run("decomposePar")
    parallel.run(program, processes=2)
    parallel.run("reconstructPar", "-latestTime")
    moved, apart = farthest(start, serial.points()), farthest(serial.points(), parallel.points())
    nodes = re.search(r"delaunayGraph: (\d+) nodes", output)[1]
    print(f"{program}: {nodes} nodes, points moved by {moved:.3g} at most; on 2 processes they are {apart:.1e} apart")
    assert moved > 0.1 and apart < 1e-12


def clock(folder, library, cells):
    """Seconds of a set-up and of a step: a run of one step, and what four more take."""
    seconds = {}
    for solver in ("delaunayGraph", "displacementLaplacian"):
        case = Case(folder / f"time_{solver}", library, cells, solver)
        case.change("system/controlDict", "writeInterval 20;", "writeInterval 1000;")
        took = []
        for steps in (1, 5):
            case.change("system/controlDict", r"endTime [0-9.]+;", f"endTime {0.01 * steps};")
            took.append(min(case.run("moveMesh")[0] for _ in range(3)))
        seconds[solver] = (took[0], (took[1] - took[0]) / 4)
    n = len(Case(folder / "time_delaunayGraph", library, cells).points("constant"))
    for solver, (first, step) in seconds.items():
        print(f"{solver}: {n} points, start, set-up and first step {first:.2f} s, each further step {step:.3f} s")
    print(f"a step of displacementLaplacian takes {seconds['displacementLaplacian'][1] / seconds['delaunayGraph'][1]:.1f} times as long")


def main(words):
    library = Path(words[0]).resolve()
    folder = library / "run"
    if "--time" in words:
        rest = words[words.index("--time") + 1 :]
        return clock(folder, library, int(rest[0]) if rest else 64)
    compare(folder, library, "moveDynamicMesh")
    compare(folder, library, "pimpleFoam")


if __name__ == "__main__":
    main(sys.argv[1:] or sys.exit(__doc__))
