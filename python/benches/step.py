"""Times a step of a mover from Python and from Rust alternately, on 158,000 vertices.

    pip install ./python && cargo build --release -p motet --example motion_timing
    python python/benches/step.py target/release/examples/motion_timing
"""
import json
import statistics
import subprocess
import sys
import time

import numpy as np

import motet

ROUNDS, SECONDS = 7, 1.0

mesh = motet.shapes.sphere_in_box(38, 17)
mover = motet.Mover(mesh)
at = mover.reference[mover.boundary]
displacement = np.where((np.linalg.norm(at, axis=1) < 1.01)[:, None], (0.3, 0.0, 0.0), 0.0)
out = np.empty_like(mover.reference)


def python():
    seconds = []
    end = time.perf_counter() + SECONDS
    while time.perf_counter() < end:
        begin = time.perf_counter()
        mover.step(displacement, out)
        seconds.append(time.perf_counter() - begin)
    return statistics.median(seconds)


def rust():
    call = subprocess.run([sys.argv[1], "38,17", "--seconds", str(SECONDS)], capture_output=True, text=True, check=True)
    return json.loads(call.stdout)["seconds"]


pairs = [(python(), rust()) for _ in range(ROUNDS)]
of_python, of_rust = (statistics.median(column) for column in zip(*pairs))
ratio = statistics.median(a / b for a, b in pairs)
print(f"{mesh.n_points} points, {len(at)} on the boundary: Python {1e6 * of_python:.0f} us, Rust {1e6 * of_rust:.0f} us, ratio {ratio:.3f} (median of {ROUNDS})")
