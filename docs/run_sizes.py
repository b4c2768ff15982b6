"""What a step of `motet run` takes against the size of the mesh: prints the table of run.md, and draws docs/run_sizes.png.

    ./test --setup && target/venv/bin/python -m pip install ./python    (once)
    cargo build --release
    target/venv/bin/python docs/run_sizes.py              (a few minutes, 2 GB of memory and of disk)

A sphere goes three radii towards the wall of its box in six steps. Times are means a step; memory is the most that the process held. Slopes are those of the
line through all sizes, both axes logarithmic: 1 is in proportion to the number of tets.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from time import sleep

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from motet import shapes
from program import binary

HERE = Path(__file__).resolve().parent
# Circles of latitude of the sphere, and layers from it to the box.
SIZES = [(10, 14), (16, 22), (28, 35), (48, 60)]
STAGES = {"motion": "motion", "quality": "quality", "repair": "repair", "setup": "set-up", "total": "step"}
JOB = """
mesh = "box.vtu"
output = "out/box.pvd"
every = 100
[time]
steps = 6
[motion]
smooth = 2
[[motion.move]]
patch = "sphere"
shift = [3, 0, 0]
in_time = "ramp"
"""
COLOURS = {"motion": "#17607a", "quality": "#5fb3b3", "repair": "#e0583f", "set-up": "#c99a3b", "step": "#22303c", "memory": "#7a5c99"}


def measured(folder, n, layers):
    """Tets, seconds of each stage of a step, and bytes that one run takes."""
    shapes.sphere_in_box(n, layers).save(folder / "box.vtu")
    (folder / "job.toml").write_text(JOB)
    held = watched([binary(), "run", "job.toml", "--threads", "2"], folder)
    lines = [json.loads(line) for line in (folder / "out/box.jsonl").read_text().splitlines()][1:]
    times = [json.loads(line)["seconds"] for line in (folder / "out/box.times.jsonl").read_text().splitlines()][1:]
    stages = {name: np.mean([second[key] for second in times]) for key, name in STAGES.items()}
    left = max(line["bad"] for line in lines), max(line["inverted"] for line in lines)
    repaired = sum(change["bad_before"] for line in lines for change in line["changes"])
    print(f"{lines[0]['tets']:,} tets: {sum(bool(line['changes']) for line in lines)} of {len(lines)} steps with a repair, "
          f"bad at most {left[0]}, inverted {left[1]}", flush=True)
    return lines[0]["tets"], stages, held, repaired


def watched(command, folder):
    """The most bytes that a command held, asked for while it runs: what the system tells afterwards counts those of the parent, too."""
    run, held = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL), 0
    while run.poll() is None:
        try:
            status = Path(f"/proc/{run.pid}/status").read_text()
        except OSError:
            continue
        held = max([held] + [1024 * int(line.split()[1]) for line in status.splitlines() if line.startswith("VmHWM")])
        sleep(0.005)
    if run.returncode:
        sys.exit(f"motet run failed with {run.returncode}")
    return held


def slope(tets, values):
    """Of the line of least squares through the logarithms."""
    return np.polyfit(np.log(tets), np.log(values), 1)[0]


def time(seconds):
    return f"{1e3 * seconds:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"


def table(tets, rows, memory, repaired):
    names = ["motion", "quality", "repair", "set-up", "step"]
    yield "| tets | bad ones repaired | " + " | ".join(names) + " | memory |"
    yield "|---" * (len(names) + 3) + "|"
    for n, bad, row, held in zip(tets, repaired, rows, memory):
        yield f"| {n:,} | {bad:,} | " + " | ".join(time(row[name]) for name in names) + f" | {held / 1e6:,.0f} MB |"
    slopes = [slope(tets, repaired)] + [slope(tets, [row[name] for row in rows]) for name in names] + [slope(tets, memory)]
    yield "| slope | " + " | ".join(f"{x:.2f}" for x in slopes) + " |"


def draw(tets, rows, memory):
    plt.rcParams.update({"font.size": 9, "axes.edgecolor": "#22303c", "axes.spines.top": False, "axes.spines.right": False})
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.6), dpi=150)
    for name in ("step", "repair", "set-up", "quality", "motion"):
        values = [row[name] for row in rows]
        left.loglog(tets, values, "o-", color=COLOURS[name], lw=2.2 if name == "step" else 1.4, ms=4)
        left.annotate(f" {name} {slope(tets, values):.2f}", (tets[-1], values[-1]), color=COLOURS[name], va="center", xytext=(4, {"step": 4, "repair": -4}.get(name, 0)), textcoords="offset points")
    right.loglog(tets, np.array(memory) / 1e6, "o-", color=COLOURS["memory"], lw=2.2, ms=4)
    right.annotate(f" memory {slope(tets, memory):.2f}", (tets[-1], memory[-1] / 1e6), color=COLOURS["memory"], va="center", xytext=(4, 0), textcoords="offset points")
    for axes, first, what in ((left, rows[0]["step"], "seconds a step"), (right, memory[0] / 1e6, "MB at most")):
        guide = first * np.array(tets) / tets[0]
        axes.loglog(tets, guide, "--", color="#9aa5ad", lw=1)
        axes.annotate("in proportion", (tets[2], guide[2]), color="#77838c", xytext=(8, -12), textcoords="offset points")
        axes.set(xlabel="tets", title=what)
        axes.set_xlim(tets[0] * 0.7, tets[-1] * 6)
        axes.grid(alpha=0.25, which="major")
    figure.tight_layout()
    figure.savefig(HERE / "run_sizes.png")


def main():
    if len(sys.argv) != 1:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        found = [measured(Path(folder), *size) for size in SIZES]
    tets, rows, memory, repaired = zip(*found)
    print("\n".join(table(tets, rows, memory, repaired)))
    draw(tets, rows, memory)


if __name__ == "__main__":
    main()
