"""Moves a rigid body in a box and keeps the mesh good by repeated remeshing with Mmg, with one thread.

usage: drift_mmg.py MESH.npz JOB.json LOG.jsonl      MESH: points, tets; LOG: one line per step, as in `motet run`

JOB contains the body, a box around the origin with half sides `half`, rounded by `radius`; the surrounding
box from `low` to `high`; the motion per step, `turn` degrees about z and `shift` along x; the number of
`steps`; and `short`: tets with an edge below this fraction of its size also belong to the zone.

The sizes of the first mesh and the walls are kept. The strain is restricted to a layer near the body: points
are rigid up to a fraction of the way to the box, and fixed beyond another one. Mmg may change tets below an
EAS and one ring around them; all others are required.
"""
import json
import sys
import time
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from sameness import compared
from tets import BAD, EDGES, boundary, eas, spread, volumes

LAYER = (0.1, 0.3)
LIMIT = 0.3
LONGER = 1.06  # ratio of the requested size to the mean edge length that it gives
SMALLEST_PART = 1 / 64  # smallest fraction of a step
NEIGHBOURS = 24
SAME_PLACE = 1e-6


class Stuck(Exception):
    pass


class Course:
    """The position of the body after a number of steps, and of the points that follow it."""

    def __init__(self, job):
        self.half, self.low, self.high = (np.array(job[key], float) for key in ("half", "low", "high"))
        self.radius, self.turn, self.shift = job["radius"], np.radians(job["turn"]), job["shift"]

    def moved(self, points, steps):
        """Move points rigidly by a number of steps, which may differ between points: first rotation, then
        translation."""
        angle = self.turn * steps
        c, s = np.cos(angle), np.sin(angle)
        x, y, z = points.T
        return np.stack([c * x - s * y + self.shift * steps, s * x + c * y, z + 0 * angle], axis=1)

    def distances(self, points, at):
        """Return the distances of points from the body and from the box."""
        outside = np.maximum(np.abs(self.moved(points, -at)) - self.half, 0)
        body = np.maximum(np.linalg.norm(outside, axis=1) - self.radius, 0)
        return body, np.maximum(np.minimum(points - self.low, self.high - points).min(axis=1), 0)

    def share(self, points, at):
        """Return the share of the body's motion at each point: 1 near the body, 0 far away, smooth in
        between."""
        body, wall = self.distances(points, at)
        t = np.clip((body / np.maximum(body + wall, 1e-30) - LAYER[0]) / (LAYER[1] - LAYER[0]), 0, 1)
        return 1 - t * t * (3 - 2 * t)


class Sizes:
    """Edge lengths of the first mesh as a function of the distances from body and box."""

    def __init__(self, points, tets, course):
        edges = np.unique(np.sort(tets[:, EDGES].reshape(-1, 2), axis=1), axis=0)
        length = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        count = np.bincount(edges.ravel(), minlength=len(points))
        self.lengths = np.bincount(edges.ravel(), np.repeat(length, 2), len(points)) / count
        self.course, self.tree = course, cKDTree(np.stack(course.distances(points, 0.0), axis=1))

    def at(self, points, at):
        distance, near = self.tree.query(np.stack(self.course.distances(points, at), axis=1), k=NEIGHBOURS)
        weight = 1 / (distance + 0.03) ** 2
        return LONGER * (weight * self.lengths[near]).sum(axis=1) / weight.sum(axis=1)


class Moving:
    def __init__(self, points, tets, job):
        self.points, self.tets, self.course, self.short = points, tets, Course(job), job["short"]
        self.sizes = Sizes(points, tets, self.course)
        self.walls = np.unique(boundary(tets))  # ids of the vertices on walls, with their initial positions
        self.first = points[self.walls]
        self.on_body = self.course.distances(self.first, 0.0)[0] < SAME_PLACE

    def wall_places(self, at):
        return np.where(self.on_body[:, None], self.course.moved(self.first, at), self.first)

    def placed(self, start, end):
        """Return all vertices after a part of a step, exact on the walls."""
        share = self.course.share(self.points, start)
        c = self.course
        # Relative to the current position of the body.
        shifted = np.array([c.shift * start, 0, 0])
        points = c.moved(self.points - shifted, share * (end - start)) + shifted
        points[self.walls] = self.wall_places(end)
        return points

    def step(self, number):
        """Do a step, in parts if a tet would be inverted; return the changes of the mesh."""
        at, end, changes = number - 1.0, float(number), []
        while at < end:
            part = end - at
            while volumes(moved := self.placed(at, at + part), self.tets).min() <= 0:
                part /= 2
                if part < SMALLEST_PART:
                    raise Stuck
            self.points, at = moved, at + part
            changes += self.repair(at)
        return changes

    def zone(self, sizes):
        """Return the tets that may change: those that are bad or too small, and one ring around them."""
        chosen = eas(self.points, self.tets) < LIMIT
        if self.short:
            for i, j in EDGES:
                a, b = self.tets[:, i], self.tets[:, j]
                length = np.linalg.norm(self.points[a] - self.points[b], axis=1)
                chosen |= length < self.short * (sizes[a] + sizes[b]) / 2
        near = np.zeros(len(self.points), bool)
        near[self.tets[chosen]] = True
        return near[self.tets].any(axis=1)

    def repair(self, at):
        sizes = self.sizes.at(self.points, at)
        zone = self.zone(sizes)
        if not zone.any():
            return []
        old_points, old_tets = self.points, self.tets
        self.points, self.tets = remeshed(old_points, old_tets, sizes, zone)
        places = self.wall_places(at)
        distance, self.walls = cKDTree(self.points).query(places)
        if distance.max() > SAME_PLACE or len(np.unique(boundary(self.tets))) != len(places):
            raise Stuck
        self.points[self.walls] = places  # Mmg scales meshes, which causes rounding errors
        return [(old_points, old_tets, self.points, self.tets)]


def remeshed(points, tets, sizes, zone):
    import mmgpy

    mesh, triangles = mmgpy.MmgMesh3D(), boundary(tets)
    mesh.set_mesh_size(vertices=len(points), tetrahedra=len(tets), triangles=len(triangles))
    mesh.set_vertices(points)
    mesh.set_tetrahedra(tets.astype(np.int32), np.ones(len(tets), np.int32))
    mesh.set_triangles(triangles.astype(np.int32), np.ones(len(triangles), np.int32))
    mesh.set_field("metric", sizes.reshape(-1, 1))
    mesh.set_required_tetrahedra(np.flatnonzero(~zone).astype(np.int32))
    mesh.set_required_vertices(np.unique(tets[~zone]).astype(np.int32))
    mesh.remesh(verbose=-1, nosurf=1)
    return mesh.get_vertices().copy(), mesh.get_tetrahedra().astype(np.int64)


def line(number, moving, changes, seconds):
    """Return a line of the log, as in `motet run`."""
    quality = eas(moving.points, moving.tets)
    # The comparison of meshes is not timed.
    shares = [{"kept_share": compared(*change)["kept_near"], "tets_before": len(change[1]), "tets_after": len(change[3])} for change in changes]
    return {"step": number, "points": len(moving.points), "tets": len(moving.tets), "worst": {"eas": float(quality.min())},
            "bad": int((quality < BAD).sum()), "inverted": int((quality <= 0).sum()), "changes": shares, "seconds": seconds,
            "quality": spread(moving.points, moving.tets), "wall_points": len(moving.walls)}


def main():
    mesh, job, log = sys.argv[1:]
    given, job = np.load(mesh), json.loads(Path(job).read_text())
    moving, status, whole = Moving(given["points"], given["tets"], job), 0, 0.0
    with open(log, "w") as file:
        for number in range(job["steps"] + 1):
            start = time.perf_counter()
            try:
                changes = moving.step(number) if number else []
            except Stuck:
                status = 4  # the exit status of motet for an incomplete step
                break
            seconds = time.perf_counter() - start
            whole += seconds
            file.write(json.dumps(line(number, moving, changes, seconds)) + "\n")
            file.flush()
    print(json.dumps({"seconds": whole, "status": status}))


main()
