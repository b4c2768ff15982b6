"""How good the meshes are that each method of motion leaves: a sphere that shifts and turns, a flap and a vessel that bend, a measured wall."""
import subprocess
import sys

import layers
from common import MOTET, TARGET
from meshes import build, flap_in_channel, linear, written
from walls import branched_vessel, ventricle

# Cell sizes at the sphere and at the walls, exponent of the grading: about 32,000 and 10,000 vertices, and 18,500 with cells of one size.
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
    print("\n## What motion leaves\n\nBad tets (EAS below 0.2), inverted ones in brackets, the smallest dihedral angle of the others in degrees; the worst EAS, and "
          "that which a twentieth does not reach; seconds of a step, one thread. In steps: a tenth of a radius, five degrees or a frame at a time, set-up "
          "included. In legs: so, but a radius, 45 degrees or four frames.")
    for name, motion, path in cases:
        for sweeps in SWEEPS[motion]:
            command = [MOTET / "examples" / "motion_quality", path, "--motion", motion, "--smooth", str(sweeps)]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            print(f"\n### {name}, {sweeps} sweeps of smoothing\n\n{done.stdout}", flush=True)
            record.add(bench="quality", mesh=name, sweeps=sweeps, table=done.stdout)
            print(f"  quality {name}, {sweeps} sweeps: done", file=sys.stderr, flush=True)
    layers.run()
