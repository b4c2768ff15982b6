"""Cases of the refinement benchmark in the formats of all programs, and measures of the results."""
import json
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from common import MOTET, TARGET
from meshes import build, linear
from tets import boundary, dot, eas, mean_ratio, volumes

CHUNK = 200_000  # number of tets measured at once
PACKED = 2**21  # number of vertices from which on `boundary` cannot be used
EVERYWHERE = {"near": None, "radii": [0.0], "longest": 0.0, "whole": False}


def first_mesh(quick):
    """Return the sphere in a box with 29,273 tets, or a coarse one if `quick`."""
    path = TARGET / f"refine_first{'_quick' if quick else ''}.npz"
    if not path.exists():
        points, tets = build(0.4, 1.6, 1.0, growth=linear) if quick else build(0.16, 0.8, 1.0, growth=linear)
        np.savez(path, points=points, tets=tets)
    kept = np.load(path)
    return kept["points"], kept["tets"]


class Case:
    """A mesh, a rule that marks tets, and a folder with both."""

    def __init__(self, name, mesh, generations, limit, near=None, **rule):
        self.name, self.folder = name, TARGET / f"refine_{name}"
        self.folder.mkdir(exist_ok=True)
        for path in self.folder.iterdir():
            path.unlink()
        self.points, self.tets = mesh
        self.points.tofile(self.folder / "first.points")
        self.tets.astype(np.uint32).tofile(self.folder / "first.tets")
        boundary(self.tets).astype(np.uint32).tofile(self.folder / "boundary.u32")
        if near is not None:
            np.asarray(near, np.float64).tofile(self.folder / "near.f64")
            rule["near"] = "near.f64"
        self.json = self.folder / "case.json"
        self.json.write_text(json.dumps({**EVERYWHERE, **rule, "generations": generations, "limit": limit}))
        self.first = measured(self.points, self.tets)

    def out(self, program):
        return self.folder / "".join(letter if letter.isalnum() else "_" for letter in program)

    def measure(self, program, result):
        """Add quality and seconds to the rows of the generations, and delete the meshes."""
        out = self.out(program)
        for generation, row in enumerate(result["generations"], 1):
            paths = [f"{out}_{generation}.{end}" for end in ("points", "tets")]
            points = np.fromfile(paths[0]).reshape(-1, 3)
            tets = np.fromfile(paths[1], np.uint32).reshape(-1, 4)
            row |= measured(points, tets, self.first)
            row["seconds"] = result.pop(f"generation_{generation}_seconds")
            for path in paths:
                os.unlink(path)
        stop = out.with_name(out.name + ".stop")
        if stop.exists():
            generation, reason = stop.read_text().split(maxsplit=1)
            result["stopped"] = f"generation {generation}: {reason}"


def coil():
    """Return the points on the surface of motet's coil."""
    path = TARGET / "refine_coil.f64"
    subprocess.run([MOTET / "examples" / "refine_rivals", "--coil", path], check=True)
    return np.fromfile(path).reshape(-1, 3)


def in_chunks(work, points, tets):
    """Evaluate a measure of all tets with memory that does not grow with the mesh."""
    parts = [tets[i:i + CHUNK] for i in range(0, len(tets), CHUNK)]
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        # A negative tet has the shape of its mirror image.
        return np.concatenate(list(pool.map(lambda part: np.abs(work(points, part)), parts)))


def measured(points, tets, first=None):
    """Return the quality, also relative to the first mesh, and whether volume and conformity are preserved,
    if known."""
    quality, ratio = in_chunks(eas, points, tets), in_chunks(mean_ratio, points, tets)
    found = {"tets": len(tets), "worst": float(quality.min()), "median": float(np.median(quality)), "worst_mean_ratio": float(ratio.min()),
             "volume": float(in_chunks(volumes, points, tets).sum())}
    if len(points) < PACKED:
        a, b, c = (points[corner] for corner in boundary(tets).T)
        normals = np.cross(b - a, c - a)
        found["area"] = float(np.sqrt(dot(normals, normals)).sum() / 2)
    if first:
        found["worst_to_first"] = found["worst"] / first["worst"]
        found["mean_ratio_to_first"] = found["worst_mean_ratio"] / first["worst_mean_ratio"]
        close = lambda key: abs(found[key] / first[key] - 1) < 1e-9
        found["fills"] = close("volume")
        # At hanging vertices, a facet and its four parts belong to one tet each, as if on the boundary.
        found["conforming"] = close("area") if "area" in found else None
    return found
