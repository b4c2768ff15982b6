"""Long motions: meshes, and jobs for `motet run`."""
import os
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from common import MOTET, ROOT, TARGET
from drift_shapes import along_x, box, cylinder, ellipsoid, sheet, write_frames, write_stl

DATA = Path(os.environ.get("MOTET_DATA") or ROOT.parent / "shared" / "data") / "moving_wall" / "bivme_lv"
FRAMES = 120  # approximate maximum number of frames written in a run
TURNS = 3  # default number of turns of rotating bodies


@dataclass
class Case:
    """A mesh and a job. Rotations are uniform over all cycles; all other motions are periodic."""
    name: str
    about: str
    steps: int  # number of steps in a cycle
    cycles: int
    motion: str  # the keys of [motion], and the sections after it
    fill: object  # function that creates mesh.vtu and other files of the job in a folder
    mesh: str = "mesh.vtu"
    turn: dict = None  # patch, axis, centre
    body: dict = None  # for Mmg: a rigid body in a box
    folder: Path = field(init=False)

    def __post_init__(self):
        self.folder = TARGET / "drift" / self.name

    @property
    def every(self):
        """Number of steps between frames, such that ends of cycles are frames; in a long run only these."""
        per_cycle = min(6, FRAMES // self.cycles, self.steps)
        return next(n for n in range(self.steps // max(per_cycle, 1), self.steps + 1) if self.steps % n == 0)

    def make(self):
        """Create the folder of the case, replacing an existing one."""
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.fill(self.folder)
        (self.folder / "job.toml").write_text(self.job())

    def job(self):
        steps, periods = (self.steps * self.cycles, 1) if self.turn else (self.steps, self.cycles)
        return (f'mesh = "{self.mesh}"\noutput = "out/run.pvd"\nevery = {self.every}\n'
                f"[time]\nsteps = {steps}\nperiods = {periods}\n[motion]\n{self.motion}{self.turning()}")

    def turning(self):
        if not self.turn:
            return ""
        entries = ", ".join(f"{key} = {value}" for key, value in self.turn.items() if key != "patch")
        return (f'[[motion.move]]\npatch = "{self.turn["patch"]}"\nin_time = "ramp"\n'
                f"turn = {{ {entries}, degrees = {360 * self.cycles} }}\n")


def motet(folder, *arguments):
    """Run motet in a folder; exit status 4 (bad tets are left) is not an error."""
    done = subprocess.run([MOTET / "motet", *map(str, arguments), "-q"], cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, 4):
        raise RuntimeError(" ".join(done.stderr.split())[:200])


def filled(*arguments, **surfaces):
    """Return a function that writes surfaces to a folder and fills them.

    Patches are named after the files.
    """
    def fill(folder):
        for name, triangles in surfaces.items():
            write_stl(folder / f"{name}.stl", triangles)
        motet(folder, "mesh", *arguments, "-o", "mesh.vtu", "--surface", "keep")
    return fill


PADDLE_SIZE = 0.25
PADDLE = {"walls": box((4, 4, 2), (16, 16, 8)), "paddle": box((2, 0.25, 0.75), (16, 2, 6))}
SPHERE = {"walls": box((6, 2, 2), (30, 10, 10), (1.5, 0, 0)), "sphere": ellipsoid((0.5,) * 3, 8)}
EGG = {"walls": ellipsoid((2,) * 3, 10), "egg": ellipsoid((1.2, 0.8, 0.6), 10)}
CUP = {"cup": cylinder(4, 5, 6, 7), "interface": box((5, 1.2, 1.6), (7, 2, 2), (0, 0, 2))}
# Rounded, so that both have exactly the same vertices where the flap meets the floor.
FLAP = {"walls": box((1.6, 2, 4), (8, 10, 20)).round(9), "flap": sheet((0, -1, -0.6), (0, 1.2, 0), (0, 0, 1.2), (6, 6)).round(9)}
TUBE = along_x(cylinder(5, 60, 3, 34))
CUBE = box((2, 2, 2), (10, 10, 10))
HOLE = ["--hole", "0,0,0"]

fill_paddle = filled("walls.stl", "paddle.stl", *HOLE, "--size", PADDLE_SIZE, **PADDLE)
fill_sphere = filled("walls.stl", "sphere.stl", *HOLE, "--size", 0.2, "--growth", 0.3, **SPHERE)
fill_egg = filled("walls.stl", "egg.stl", *HOLE, "--size", 0.35, "--growth", 0.3, **EGG)
fill_cup = filled("cup.stl", "interface.stl", "--seed", "0,0,0.2=fluid", "--seed", "0,0,2=solid", "--size", 0.8, **CUP)
fill_flap = filled("walls.stl", "--membrane", "flap.stl", "--size", 0.2, **FLAP)


def measured_walls(surface, size, place, count):
    """Return a function that fills a surface, and writes frames of its moving walls."""
    def fill(folder):
        filled("walls.stl", "--size", size, walls=surface)(folder)
        write_frames(folder, "walls", surface, place, count)
    return fill


def squeezed(points, phase):
    """Squeeze a tube by 90 %, at a position that moves from x = 15 to 45."""
    x = points[:, 0]
    depth = 0.9 * min(1, 4 * phase, 4 * (1 - phase))
    centre = 15 + 30 * min(max(2 * phase - 0.5, 0), 1)
    narrower = 1 - depth * np.exp(-((x - centre) / 5) ** 2) * np.clip(x / 5, 0, 1) * np.clip((60 - x) / 5, 0, 1)
    return points * np.stack([np.ones(len(x)), narrower, narrower], axis=1)


def twisted(points, phase):
    """Twist a cube by 90 degrees between bottom and top, to both sides."""
    angle = np.radians(45) * np.sin(2 * np.pi * phase) * points[:, 2]
    x, y, z = points.T
    return np.stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y, z], axis=1)


def ventricle(folder):
    """Create the case of docs/run.md without the coil."""
    motet(folder, "cap", *sorted(DATA.glob("patient1_LV_ENDOCARDIAL_*.vtk")), "-o", "wall.pvd", "--period", 1)
    motet(folder, "mesh", "wall_0000.vtu", "-o", "filled.vtu", "--size", 4)
    motet(folder, "remesh", "filled.vtu", "-o", "mesh.vtu", "--surface", "adapt", "--distance", 0.3)


METHOD = 'method = "{}"\nsmooth = 2\n'
BODIES = METHOD.format("bodies")
SHIFT = BODIES + '[[motion.move]]\npatch = "sphere"\nshift = [3, 0, 0]\nin_time = '
INSIDE = 'inside = ["interface"]\n'
FOLLOW = 'surfaces = "{}.pvd"\nmatch = "{}"\nsmooth = 2\n'
BEND = """method = "guided"
smooth = 4
within_walls = true
fixed = ["walls"]
inside = ["flap"]
[[motion.move]]
patch = "flap"
bend = { hinge = [0, -1, 0], along = [0, 1, 0], towards = [1, 0, 0], length = 1.2, degrees = 84 }
in_time = "swing"
"""
Z = {"axis": [0, 0, 1], "centre": [0, 0, 0]}
IN_BOX = {"half": [1, 0.125, 0.375], "radius": 0, "low": [-2, -2, -1], "high": [2, 2, 1], "turn": 5, "shift": 0}
IN_CHANNEL = {"half": [0, 0, 0], "radius": 0.5, "low": [-1.5, -1, -1], "high": [4.5, 1, 1], "turn": 0, "shift": 0.05}


def cases(options):
    """Return all cases, with the numbers of turns and cycles of the options."""
    turns, cycles = options.turns or TURNS, lambda usual: options.cycles or usual
    paddle, bar = {"patch": "paddle", **Z}, {"patch": "interface", **Z, "centre": [0, 0, 2]}
    return [
        Case("paddle", "a paddle rotates in a box", 72, turns, BODIES, fill_paddle, turn=paddle, body=IN_BOX),
        Case("paddle-delaunay", "a paddle rotates in a box, method delaunay", 72, turns, METHOD.format("delaunay"), fill_paddle, turn=paddle),
        Case("channel", "a sphere moves six radii along a channel", 60, 1, SHIFT + '"ramp"\n', fill_sphere, body=IN_CHANNEL),
        Case("channel-back", "a sphere moves along a channel and back", 120, cycles(10), SHIFT + "[[0, 0], [0.5, 1], [1, 0]]\n", fill_sphere),
        Case("ellipsoid", "an ellipsoid rotates in a ball, about none of its principal axes", 72, turns, BODIES, fill_egg,
             turn={"patch": "egg", "axis": [1, 1, 1], "centre": [0, 0, 0]}),
        Case("bar", "a meshed bar rotates in a cup", 30, options.turns or 6, 'smooth = 2\n' + INSIDE, fill_cup, turn=bar),
        Case("bar-bodies", "a meshed bar rotates in a cup, method bodies", 30, options.turns or 6, BODIES + INSIDE, fill_cup, turn=bar),
        Case("tube", "a tube is squeezed to a tenth of its width", 16, cycles(20), FOLLOW.format("walls", "position"),
             measured_walls(TUBE, 1.745, squeezed, 16)),
        Case("flap", "a flap bends to both sides, nearly to the walls", 24, cycles(20), BEND, fill_flap),
        Case("ventricle", "a ventricle with a measured wall", 25, cycles(3),
             FOLLOW.format("wall", "nearest") + '[repair]\nsurface = "adapt"\ndistance = 0.3\n', ventricle),
        Case("cube", "a cube is twisted to both sides", 24, cycles(10), FOLLOW.format("walls", "position"),
             measured_walls(CUBE, 0.2, twisted, 24)),
    ]


def chosen(options):
    """Return the requested cases, and the names of those without data."""
    known = {case.name: case for case in cases(options)}
    names = options.cases.split(",") if options.cases else list(known)
    if unknown := set(names) - set(known):
        raise SystemExit(f"unknown case {', '.join(sorted(unknown))}; known: {', '.join(known)}")
    without = {"ventricle"} if not DATA.is_dir() else set()
    return [known[name] for name in names if name not in without], [name for name in names if name in without]
