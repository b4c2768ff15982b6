"""How good the meshes are that each method of motion leaves: a sphere that shifts and turns, a flap that bends."""
import subprocess
import sys

from common import MOTET, TARGET
from meshes import build, flap_in_channel, linear, written

# Cell sizes at the sphere and at the walls, exponent of the grading: about 32,000 and 10,000 vertices.
SPHERES = {"sphere_32k": (0.0901, 0.4305, 1.07), "sphere_10k": (0.1309, 0.6255, 1.0)}
SWEEPS = (0, 2, 4)


def run(record, options):
    spheres = ["sphere_10k"] if options.quick else list(SPHERES)
    cases = {name: lambda name=name: build(*SPHERES[name], growth=linear) for name in spheres}
    cases["flap"] = flap_in_channel
    print("\n## What motion leaves\n\nBad tets (EAS below 0.2), inverted ones in brackets, the smallest dihedral angle of the others in degrees; "
          "seconds of a step, one thread. In steps: a tenth of a radius or five degrees at a time, set-up included.")
    for name, made in cases.items():
        path = written(name, made, TARGET)
        for sweeps in SWEEPS:
            command = [MOTET / "examples" / "motion_quality", path, "--smooth", str(sweeps)]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            print(f"\n### {name}, {sweeps} sweeps of smoothing\n\n{done.stdout}")
            record.add(bench="quality", mesh=name, sweeps=sweeps, table=done.stdout)
            print(f"  quality {name}, {sweeps} sweeps: done", file=sys.stderr, flush=True)
