"""Reads and writes VTU files with VTK, and prints seconds as JSON.

usage: files_vtk.py make FILE N            a box of 6 N^3 tets with arrays, written uncompressed
       files_vtk.py read FILE RUNS
       files_vtk.py write FILE OUT none|zlib RUNS
"""
import json
import sys
import time

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray


def box(n):
    """Return the points and tets of a slightly distorted box of n^3 cubes with six tets each."""
    line = np.linspace(0.0, 1.0, n + 1)
    points = np.stack(np.meshgrid(line, line, line, indexing="ij"), -1).reshape(-1, 3)
    points += 0.2 / n * np.sin(points[:, [1, 2, 0]] * 7.0)
    id_of = np.arange((n + 1) ** 3).reshape([n + 1] * 3)
    corner = lambda i, j, k: id_of[i:n + i, j:n + j, k:n + k].ravel()
    tets = []
    for path in ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)):  # one tet per path from 000 to 111
        at, walk = [0, 0, 0], []
        for axis in (None, *path):
            if axis is not None:
                at[axis] = 1
            walk.append(corner(*at))
        odd = path in ((0, 2, 1), (1, 0, 2), (2, 1, 0))
        tets.append(np.column_stack([walk[i] for i in ((0, 2, 1, 3) if odd else (0, 1, 2, 3))]))
    return points, np.stack(tets, axis=1).reshape(-1, 4)


def grid_of(points, tets):
    grid = vtk.vtkUnstructuredGrid()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(places)
    cells = vtk.vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, 4 * len(tets) + 1, 4), deep=True),
                  numpy_to_vtkIdTypeArray(tets.ravel(), deep=True))
    grid.SetCells(vtk.VTK_TETRA, cells)
    velocity = numpy_to_vtk(np.cos(points * 3.0), deep=True)
    velocity.SetName("velocity")
    grid.GetPointData().AddArray(velocity)
    part = numpy_to_vtk((np.arange(len(tets)) % 7).astype(np.int32), deep=True)
    part.SetName("part")
    grid.GetCellData().AddArray(part)
    return grid


def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def write(grid, path, compression):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path)
    writer.SetInputData(grid)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    if compression == "none":
        writer.SetCompressorTypeToNone()
    else:
        writer.SetCompressorTypeToZLib()
    if writer.Write() != 1:
        sys.exit(f"VTK could not write {path}")


def clocked(call, runs):
    seconds = []
    for _ in range(runs):
        start = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - start)
    return seconds


verb, *arguments = sys.argv[1:]
if verb == "make":
    grid = grid_of(*box(int(arguments[1])))
    write(grid, arguments[0], "none")
    seconds = []
elif verb == "read":
    grid = read(arguments[0])
    seconds = clocked(lambda: read(arguments[0]), int(arguments[1]))
else:
    grid = read(arguments[0])
    seconds = clocked(lambda: write(grid, arguments[1], arguments[2]), int(arguments[3]))
print(json.dumps({"seconds": seconds, "version": vtk.vtkVersion.GetVTKVersion(), "points": grid.GetNumberOfPoints(),
                  "cells": grid.GetNumberOfCells()}))
