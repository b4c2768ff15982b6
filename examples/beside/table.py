"""The same result with several packages: a sphere of PyVista filled with tets of edge 0.1, of 0.05 near a point.

    python examples/beside/table.py

Runs each script beside this one whose package is installed, and prints how many lines it has (without
comments), what it made, judged by motet, and how long it took in a new process, imports included. The
triangles of the sphere enclose 0.5183; Mmg alone moves them. Near the poles they are narrow, which makes tets
at them bad where they stay. pygalmesh is not among them: it needs CGAL's sources to be installed.
"""
import importlib.util
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).parent
PROBE = """
import sys, motet
scope = {}
exec(open(sys.argv[1]).read(), scope)
mesh = motet.as_mesh(scope["grid"])
mesh = motet.Mesh(mesh.points, mesh.tets)
summary = mesh.summary()
q = summary.quality
print("RESULT", len(mesh.tets), q.eas.bad, *(f"{x:.3f}" for x in (q.distribution.worst, q.distribution.p1, q.distribution.median, q.distribution.mean)), f"{summary.volume:.4f}")
"""


def main():
    head = ["script", "lines", "seconds", "tets", "bad", "worst EAS", "1 %", "median", "mean", "volume"]
    print("| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|")
    for script in sorted(HERE.glob("with_*.py"), key=lambda path: path.stem != "with_motet"):
        name = script.stem.removeprefix("with_")
        lines = [line for line in script.read_text().splitlines() if line.strip() and not line.startswith("#")]
        if importlib.util.find_spec(name) is None:
            row = ["not installed"] + ["-"] * 7
        else:
            with tempfile.TemporaryDirectory() as folder:
                begin = time.perf_counter()
                done = subprocess.run([sys.executable, "-c", PROBE, script.resolve()], cwd=folder, capture_output=True, text=True)
                took = time.perf_counter() - begin
            result = [line for line in done.stdout.splitlines() if line.startswith("RESULT")]
            row = [f"{took:.1f}", *result[0].split()[1:]] if result else [f"failed: {done.stderr.strip()[-80:]}"] + ["-"] * 7
        print(f"| `{script.name}` | {len(lines)} | " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()
