"""Mesh quality by method of motion: a translated and rotated sphere, a flap and a vessel that bend, a
measured wall."""
import subprocess
import sys

import layers
from common import MOTET, TARGET
from meshes import build, flap_in_channel, linear, written
from walls import branched_vessel, ventricle

# Cell sizes at the sphere and at the walls, and exponent of the grading. The meshes have about 32,000 and
# 10,000 vertices, and 18,500 with uniform cells.
SPHERES = {"sphere_32k": (0.0901, 0.4305, 1.07), "sphere_10k": (0.1309, 0.6255, 1.0), "sphere_uniform": (0.36, 0.36, 1.0)}
SWEEPS = {"sphere": (0, 2, 4), "flap": (0, 2, 16), "vessel": (0, 2), "frames": (0, 2)}


def run(record, options):
    spheres = ["sphere_10k"] if options.quick else list(SPHERES)
    cases = [(name, "sphere", written(name, lambda name=name: build(*SPHERES[name], growth=linear), TARGET)) for name in spheres]
    cases.append(("flap", "flap", written("flap", flap_in_channel, TARGET)))
    cases.append(("vessel", "vessel", written("vessel", branched_vessel, TARGET)))
    measured = ventricle()
    if measured:
        cases.append(("ventricle", "frames", measured))
    else:
        print("  quality ventricle: skipped, no data (MOTET_DATA)", file=sys.stderr)
    print("\n## Mesh quality after motion\n\nBad tets (EAS below 0.2), with inverted ones in brackets; smallest dihedral angle of the others in degrees; worst EAS and "
          "5 % percentile; seconds of a step, one thread. In steps: a tenth of a radius, five degrees or one frame at a time, including set-up. "
          "In legs: a radius, 45 degrees or four frames at a time.")
    for name, motion, path in cases:
        for sweeps in SWEEPS[motion]:
            command = [MOTET / "examples" / "motion_quality", path, "--motion", motion, "--smooth", str(sweeps)]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            print(f"\n### {name}, {sweeps} sweeps of smoothing\n\n{done.stdout}", flush=True)
            record.add(bench="quality", mesh=name, sweeps=sweeps, table=done.stdout)
            print(f"  quality {name}, {sweeps} sweeps: done", file=sys.stderr, flush=True)
    layers.run()
