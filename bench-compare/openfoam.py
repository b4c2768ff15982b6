"""Measures a mesh motion step of OpenFOAM's displacementLaplacian or displacementSBRStress (solid-body
rotation stress).

`moveMesh` only moves the mesh. Its own timer is too coarse, so the time of a step is the difference between a
run of several steps and a run of one, divided by the number of additional steps.
"""
import os
import shutil
import subprocess
import time

import numpy as np

STEPS = 4
LIMIT = 400.0

HEADER = 'FoamFile {{ version 2.0; format ascii; class {kind}; location "{folder}"; object {name}; }}\n'

# A loose tolerance in SOLUTION is the usual choice, and the fastest found.
CONTROL = """application moveMesh; startFrom startTime; startTime 0; stopAt endTime; endTime {steps}; deltaT 1;
writeControl timeStep; writeInterval 1000; writeFormat ascii; writePrecision 16; timeFormat general;
runTimeModifiable no;
"""
SCHEMES = """ddtSchemes { default Euler; } gradSchemes { default Gauss linear; }
divSchemes { default Gauss linear; } laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; } snGradSchemes { default corrected; }
"""
SOLUTION = """solvers { "cellDisplacement.*" { solver PCG; preconditioner DIC; tolerance 1e-12; relTol 0.01; } }
PIMPLE { nNonOrthogonalCorrectors 0; }
"""
DYNAMIC = """dynamicFvMesh dynamicMotionSolverFvMesh; motionSolverLibs (fvMotionSolvers);
motionSolver {solver}; diffusivity {diffusivity};
{solver}Coeffs {{ diffusivity {diffusivity}; }}
"""
# Solvers and their diffusivities. displacementSBRStress divides by zero with 1/volume: its coupling of the
# coordinates is explicit.
SOLVERS = {"displacementLaplacian": "inverseVolume", "displacementSBRStress": "uniform"}
DISPLACEMENT = """dimensions [0 1 0 0 0 0 0]; internalField uniform (0 0 0);
boundaryField {{
  ball {{ type uniformFixedValue; uniformValue table ((0 (0 0 0)) ({last} ({travel} 0 0))); value uniform (0 0 0); }}
  walls {{ type fixedValue; value uniform (0 0 0); }}
}}
"""


def available():
    return shutil.which("moveMesh") is not None


def write(case, folder, name, kind, body):
    place = case / folder
    place.mkdir(parents=True, exist_ok=True)
    (place / name).write_text(HEADER.format(kind=kind, folder=folder, name=name) + body)


def foam_list(rows):
    return f"{len(rows)}\n(\n" + "\n".join(rows) + "\n)\n"


def faces_of(tets):
    """Return OpenFOAM's faces with owners and neighbours: inner ones in upper-triangular order, then outer
    ones."""
    corners = tets[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)  # outward
    cell = np.repeat(np.arange(len(tets)), 4)
    key = np.sort(corners, axis=1)
    order = np.lexsort((cell, *key.T))
    key, corners, cell = key[order], corners[order], cell[order]
    first = np.flatnonzero((key[1:] == key[:-1]).all(axis=1))  # twice in a row: shared by two cells
    shared = np.zeros(len(key), bool)
    shared[first] = shared[first + 1] = True
    owner, neighbour = cell[first], cell[first + 1]
    by_cell = np.lexsort((neighbour, owner))
    inner = corners[first][by_cell]
    return inner, owner[by_cell], neighbour[by_cell], corners[~shared], cell[~shared]


def write_mesh(case, points, tets, ball):
    inner, owner, neighbour, outer, outer_owner = faces_of(tets)
    on_ball = np.isin(outer, ball).all(axis=1)
    parts = [(outer[m], outer_owner[m]) for m in (on_ball, ~on_ball)]
    faces = np.vstack([inner, *[p[0] for p in parts]])
    owners = np.concatenate([owner, *[p[1] for p in parts]])
    folder = "constant/polyMesh"
    write(case, folder, "points", "vectorField", foam_list([f"({x!r} {y!r} {z!r})" for x, y, z in points.tolist()]))
    write(case, folder, "faces", "faceList", foam_list([f"3({a} {b} {c})" for a, b, c in faces.tolist()]))
    write(case, folder, "owner", "labelList", foam_list(list(map(str, owners.tolist()))))
    write(case, folder, "neighbour", "labelList", foam_list(list(map(str, neighbour.tolist()))))
    n_ball = len(parts[0][0])
    write(case, folder, "boundary", "polyBoundaryMesh",
          f"2\n(\nball {{ type wall; nFaces {n_ball}; startFace {len(inner)}; }}\n"
          f"walls {{ type wall; nFaces {len(outer) - n_ball}; startFace {len(inner) + n_ball}; }}\n)\n")


def seconds_of(case, steps, travel):
    write(case, "system", "controlDict", "dictionary", CONTROL.format(steps=steps))
    write(case, "0", "pointDisplacement", "pointVectorField", DISPLACEMENT.format(last=1 + STEPS, travel=travel))
    environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
    start = time.perf_counter()
    done = subprocess.run(["moveMesh", "-case", str(case)], capture_output=True, text=True, timeout=LIMIT,
                          env=environment)
    seconds = time.perf_counter() - start
    if done.returncode != 0:
        raise RuntimeError((done.stdout + done.stderr)[-300:])
    return seconds


def step_seconds(case, points, tets, ball, travel, rounds, solver="displacementLaplacian"):
    """Return the seconds of one step, as the minimum over `rounds`.

    The ball moves by `travel` along x in total.
    """
    shutil.rmtree(case, ignore_errors=True)
    write_mesh(case, points, tets, ball)
    write(case, "system", "fvSchemes", "dictionary", SCHEMES)
    write(case, "system", "fvSolution", "dictionary", SOLUTION)
    write(case, "constant", "dynamicMeshDict", "dictionary", DYNAMIC.format(solver=solver, diffusivity=SOLVERS[solver]))
    one = min(seconds_of(case, 1, travel) for _ in range(rounds))
    many = min(seconds_of(case, 1 + STEPS, travel) for _ in range(rounds))
    return (many - one) / STEPS
