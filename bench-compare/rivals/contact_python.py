"""Measures distances between two surfaces with a library from PyPI, and prints seconds as JSON.

usage: contact_python.py igl|embree|vtk-cells|vtk-implicit FOLDER THREADS RUNS DISTANCES    all vertices of one surface
       contact_python.py fcl|coal                          FOLDER THREADS RUNS DISTANCES    only the nearest points

In a step the tree is rebuilt: most libraries cannot refit trees, or not from Python. Input lists of a
library's own type are filled before the time is measured.
"""
import json
import os
import statistics
import sys
import time
from importlib.metadata import version

import numpy as np

NAME, FOLDER, THREADS, RUNS, DISTANCES = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]), sys.argv[5]
STEPS = 8  # number of steps in the folder


def points(name):
    return np.fromfile(f"{FOLDER}/{name}.f64").reshape(-1, 3)


def triangles(name):
    return np.fromfile(f"{FOLDER}/{name}.u32", np.uint32).reshape(-1, 3)


TUBE, LATTICE = triangles("tube"), triangles("lattice")


class Igl:
    package = "libigl"

    def __init__(self):
        os.environ["IGL_NUM_THREADS"] = str(THREADS)
        import igl
        self.new, self.triangles = getattr(igl, "AABB", None) or igl.AABB_f64_3, TUBE.astype(np.int64)

    def prepared(self, tube, queries):
        return tube, queries

    def build(self, tube, _):
        tree = self.new()
        tree.init(tube, self.triangles)
        return tree

    def query(self, tree, tube, queries):
        found = tree.squared_distance(tube, self.triangles, queries)
        return np.sqrt(found[0] if isinstance(found, tuple) else found)


class Embree:
    package = "open3d-cpu"

    def __init__(self):
        import open3d
        self.o3d, self.tensor = open3d, open3d.core.Tensor

    def prepared(self, tube, queries):
        return self.tensor(tube.astype(np.float32)), self.tensor(queries.astype(np.float32))

    def build(self, tube, queries):
        scene = self.o3d.t.geometry.RaycastingScene(nthreads=THREADS)
        scene.add_triangles(tube, self.tensor(TUBE))
        scene.compute_distance(queries[:1], nthreads=THREADS)  # the first query builds the tree
        return scene

    def query(self, scene, _, queries):
        return scene.compute_distance(queries, nthreads=THREADS).numpy().astype(float)


class Vtk:
    package = "vtk"

    def __init__(self):
        import vtk
        from vtk.util import numpy_support
        vtk.vtkSMPTools.Initialize(THREADS)
        self.vtk, self.support = vtk, numpy_support

    def prepared(self, tube, queries):
        vtk, support = self.vtk, self.support
        surface, places, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
        places.SetData(support.numpy_to_vtk(tube, deep=True))
        surface.SetPoints(places)
        cells.SetData(support.numpy_to_vtkIdTypeArray(np.arange(0, TUBE.size + 1, 3), deep=True),
                      support.numpy_to_vtkIdTypeArray(TUBE.astype(np.int64).ravel(), deep=True))
        surface.SetPolys(cells)
        return surface, queries


class VtkCells(Vtk):
    def build(self, surface, _):
        locator = self.vtk.vtkStaticCellLocator()
        locator.SetDataSet(surface)
        locator.BuildLocator()
        return locator

    def query(self, locator, _, queries):
        vtk = self.vtk
        place, cell, sub, squared = [0.0] * 3, vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
        generic = vtk.vtkGenericCell()
        found = np.empty(len(queries))
        for i, query in enumerate(queries.tolist()):  # VTK has no query for several points
            locator.FindClosestPoint(query, place, generic, cell, sub, squared)
            found[i] = squared.get()
        return np.sqrt(found)


class VtkImplicit(Vtk):
    def prepared(self, tube, queries):
        surface, queries = super().prepared(tube, queries)
        return surface, self.support.numpy_to_vtk(queries, deep=True)

    def build(self, surface, _):
        distance = self.vtk.vtkImplicitPolyDataDistance()
        distance.SetInput(surface)
        return distance

    def query(self, distance, _, queries):
        found = self.vtk.vtkDoubleArray()
        distance.FunctionValue(queries, found)
        return np.abs(self.support.vtk_to_numpy(found))


class Fcl:
    package = "python-fcl"

    def __init__(self):
        import fcl
        self.fcl = fcl

    def prepared(self, tube, lattice):
        return tube, lattice

    def build(self, tube, lattice):
        return [self.body(tube, TUBE), self.body(lattice, LATTICE)]

    def body(self, points, triangles):
        model = self.fcl.BVHModel()
        model.beginModel(len(triangles), len(points))
        model.addSubModel(points, triangles)
        model.endModel()
        return self.fcl.CollisionObject(model, self.fcl.Transform())

    def query(self, bodies, *_):
        return self.fcl.distance(*bodies, self.fcl.DistanceRequest(), self.fcl.DistanceResult())


class Coal:
    package = "coal"

    def __init__(self):
        import coal
        self.coal, self.rest = coal, coal.Transform3s()
        self.triangles = [self.triangle_list(t) for t in (TUBE, LATTICE)]

    def triangle_list(self, triangles):
        kind = getattr(self.coal, "Triangle32", None) or self.coal.Triangle
        made = (getattr(self.coal, "StdVec_Triangle32", None) or self.coal.StdVec_Triangle)()
        made.extend(kind(*t) for t in triangles.tolist())
        return made

    def prepared(self, tube, lattice):
        both = self.coal.StdVec_Vec3s(), self.coal.StdVec_Vec3s()
        both[0].extend(list(tube)), both[1].extend(list(lattice))
        return both

    def build(self, *both):
        return [self.body(points, triangles) for points, triangles in zip(both, self.triangles)]

    def body(self, points, triangles):
        model = self.coal.BVHModelOBBRSS()
        model.beginModel(len(triangles), len(points))
        model.addSubModel(points, triangles)
        model.endModel()
        return model

    def rebuild(self, bodies, *both):
        for body, points in zip(bodies, both):
            body.beginReplaceModel()
            body.replaceSubModel(points)
            body.endReplaceModel(False, False)  # refitting makes queries ten times slower, or takes longer than this
        return bodies

    def query(self, bodies, *_):
        tube, lattice = bodies
        return self.coal.distance(tube, self.rest, lattice, self.rest, self.coal.DistanceRequest(), self.coal.DistanceResult())


def timed(work, *arguments):
    start = time.perf_counter()
    result = work(*arguments)
    return time.perf_counter() - start, result


def main():
    library = {"igl": Igl, "embree": Embree, "vtk-cells": VtkCells, "vtk-implicit": VtkImplicit, "fcl": Fcl, "coal": Coal}[NAME]()
    rest = library.prepared(points("tube"), points("lattice"))
    building, querying, moving, warm = [], [], [], []
    for _ in range(RUNS):
        seconds, tree = timed(library.build, *rest)
        building.append(seconds)
        seconds, found = timed(library.query, tree, *rest)
        querying.append(seconds)
    at_rest = found
    for step in range(STEPS):
        moved = library.prepared(points(f"tube_{step}"), points(f"lattice_{step}"))
        is_kept = hasattr(library, "rebuild")
        seconds, tree = timed(library.rebuild, tree, *moved) if is_kept else timed(library.build, *moved)
        moving.append(seconds)
        seconds, found = timed(library.query, tree, *moved)
        warm.append(seconds)
    out = {"seconds": [a + b for a, b in zip(building, querying)], "build_seconds": statistics.median(building),
           "cold_seconds": statistics.median(querying), "refit_seconds": statistics.median(moving),
           "warm_seconds": statistics.median(warm), "version": version(library.package),
           "step_seconds": statistics.median(a + b for a, b in zip(moving, warm))}
    if NAME in ("fcl", "coal"):
        out |= {"distance": float(at_rest), "distance_step": float(found)}
    else:
        at_rest.tofile(f"{DISTANCES}.f64")
        found.tofile(f"{DISTANCES}_step.f64")
    print(json.dumps(out))


if __name__ == "__main__":
    main()
