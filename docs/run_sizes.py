"""Measures time and memory of `motet run` by mesh size (prints the tables of run.md, writes
docs/run_sizes.png).

    ./test --setup && target/venv/bin/python -m pip install ./python    (once)
    cargo build --release
    target/venv/bin/python docs/run_sizes.py              (a few minutes, 2 GB of memory and of disk)

A sphere moves by three radii towards the wall of its box in six steps. Meshes grow in two ways: more boxes
side by side in one mesh, so that the work per tet is constant; and finer meshes of one box, where a larger
fraction needs repair. Interior vertices are displaced randomly, because rows of equal tets would become bad,
and be repaired, together. Times are means per step; memory is the maximum of the process. Slopes are those of
regression lines in logarithmic axes; 1 means proportional to the number of tets.
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
from motet import Mesh, shapes
from program import binary

HERE = Path(__file__).resolve().parent
# Number of cells along a side of the cubed sphere, and 1.4 times as many layers from it to the box.
COARSEST = (10, 14)
FINER = [COARSEST, (16, 22), (27, 38), (46, 64)]
COPIES = [1, 4, 20, 99]
# Largest random displacement, relative to the shortest edge at a vertex.
SHAKEN = 0.15
# Distance between boxes; the width of a box is 10.
APART = 12.0
STEPS = 6
STAGES = {"motion": "motion", "quality": "quality", "repair": "repair", "setup": "set-up", "total": "step"}
JOB = f"""
mesh = "box.vtu"
output = "out/box.pvd"
every = 100
[time]
steps = {STEPS}
[motion]
smooth = 2
[[motion.move]]
patch = "sphere"
shift = [3, 0, 0]
in_time = "ramp"
[repair]
improve_below = 0
"""
COLOURS = {"motion": "#17607a", "quality": "#5fb3b3", "repair": "#e0583f", "set-up": "#c99a3b", "step": "#22303c", "memory": "#7a5c99"}


def shaken(mesh):
    """Displace the interior vertices of a mesh randomly, with a fixed seed."""
    points, tets = np.array(mesh.points), mesh.tets
    shortest = np.full(len(points), np.inf)
    for i, j in zip(*np.triu_indices(4, 1)):
        length = np.linalg.norm(points[tets[:, i]] - points[tets[:, j]], axis=1)
        np.minimum.at(shortest, tets[:, i], length)
        np.minimum.at(shortest, tets[:, j], length)
    shortest[mesh.triangles.ravel()] = 0.0
    mesh.points = points + SHAKEN * shortest[:, None] * np.random.default_rng(0).uniform(-1, 1, points.shape)
    return mesh


def copies(one, n):
    """Return a mesh of `n` copies side by side, in the smallest cube."""
    side = int(np.ceil(n ** (1 / 3) - 1e-9))
    places = APART * np.array(list(np.ndindex(side, side, side))[:n])
    first = len(one.points) * np.arange(n)[:, None, None]
    cells = [(kind, (first + rows).reshape(-1, rows.shape[1])) for kind, rows in (("tetra", one.tets.astype(np.int64)), ("triangle", one.triangles.astype(np.int64)))]
    # All tets precede the triangles, in the original mesh and in the copies.
    n_tets = len(one.tets)
    labels = {name: np.concatenate([np.tile(values[:n_tets], n), np.tile(values[n_tets:], n)]) for name, values in one.cell_data.items()}
    points = (places[:, None] + one.points).reshape(-1, 3)
    return Mesh(points, cells, cell_data=labels, patch_names=one.patch_names, region_names=one.region_names)


def measured(folder, mesh):
    """Run a job; return the number of tets, and the times, memory and number of changed tets per step."""
    mesh.save(folder / "box.vtu")
    (folder / "job.toml").write_text(JOB)
    memory = watched([binary(), "run", "job.toml", "--threads", "2"], folder)
    lines = [json.loads(line) for line in (folder / "out/box.jsonl").read_text().splitlines()][1:]
    times = [json.loads(line)["seconds"] for line in (folder / "out/box.times.jsonl").read_text().splitlines()][1:]
    row = {name: np.mean([second[key] for second in times]) for key, name in STAGES.items()}
    changes = [change for line in lines for change in line["changes"]]
    row["memory"] = memory
    row["changed"] = sum(change["tets_before"] * (1 - change["kept_share"]) for change in changes) / STEPS
    left = max(line["bad"] for line in lines), max(line["inverted"] for line in lines)
    print(f"{lines[0]['tets']:,} tets: {sum(bool(line['changes']) for line in lines)} of {len(lines)} steps with a repair, "
          f"{sum(change['bad_before'] for change in changes):,} bad tets repaired, at most {left[0]} left, {left[1]} inverted", flush=True)
    return lines[0]["tets"], row


def watched(command, folder):
    """Run a command and return its peak memory in bytes.

    The memory is sampled during the run, because the resource usage of finished children includes the
    parent's.
    """
    run, peak = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL), 0
    while run.poll() is None:
        try:
            status = Path(f"/proc/{run.pid}/status").read_text()
        except OSError:
            continue
        peak = max([peak] + [1024 * int(line.split()[1]) for line in status.splitlines() if line.startswith("VmHWM")])
        sleep(0.005)
    if run.returncode:
        sys.exit(f"motet run failed with {run.returncode}")
    return peak


def slope(xs, ys):
    """Return the slope of the least-squares line through the logarithms."""
    return np.polyfit(np.log(xs), np.log(ys), 1)[0]


def time(seconds):
    return f"{1e3 * seconds:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"


def table(tets, rows):
    names = list(STAGES.values())
    yield "| tets | changed a step | " + " | ".join(names) + " | memory |"
    yield "|---" * (len(names) + 3) + "|"
    for n, row in zip(tets, rows):
        yield f"| {n:,} | {row['changed']:,.0f} | " + " | ".join(time(row[name]) for name in names) + f" | {row['memory'] / 1e6:,.0f} MB |"
    yield "| slope | " + " | ".join(f"{slope(tets, [row[name] for row in rows]):.2f}" for name in ["changed", *names, "memory"]) + " |"
    yield f"A step against the tets changed in it: slope {slope([row['changed'] for row in rows], [row['step'] for row in rows]):.2f}"


def draw(sequences):
    plt.rcParams.update({"font.size": 9, "axes.edgecolor": "#22303c", "axes.spines.top": False, "axes.spines.right": False})
    figure, panels = plt.subplots(1, 3, figsize=(11.5, 3.6), dpi=130)
    for axes, (title, (tets, rows)) in zip(panels, sequences.items()):
        for name in ("step", "repair", "set-up", "quality", "motion"):
            values = [row[name] for row in rows]
            axes.loglog(tets, values, "o-", color=COLOURS[name], lw=2.2 if name == "step" else 1.4, ms=4)
            axes.annotate(f" {name} {slope(tets, values):.2f}", (tets[-1], values[-1]), color=COLOURS[name], va="center", xytext=(4, {"step": 5, "repair": -5, "quality": 4, "motion": -4}.get(name, 0)), textcoords="offset points")
        guide(axes, tets, rows[0]["step"], f"seconds a step, {title}")
    for dashes, (title, (tets, rows)) in zip(("o-", "s:"), sequences.items()):
        values = np.array([row["memory"] for row in rows]) / 1e6
        panels[2].loglog(tets, values, dashes, color=COLOURS["memory"], lw=2.2, ms=4)
        panels[2].annotate(f" {title} {slope(tets, values):.2f}", (tets[-1], values[-1]), color=COLOURS["memory"], va="center", xytext=(4, {"o-": 5, "s:": -5}[dashes]), textcoords="offset points")
    guide(panels[2], tets, rows[0]["memory"] / 1e6, "MB at most")
    figure.tight_layout()
    figure.savefig(HERE / "run_sizes.png")


def guide(axes, tets, first, title):
    """Draw a line of proportional growth, and the labels of a panel."""
    values = first * np.array(tets) / tets[0]
    axes.loglog(tets, values, "--", color="#9aa5ad", lw=1)
    axes.annotate("in proportion", (tets[1], values[1]), color="#77838c", xytext=(-62, 16), textcoords="offset points")
    axes.set(xlabel="tets", title=title)
    axes.set_xlim(tets[0] * 0.7, tets[-1] * 8)
    axes.grid(alpha=0.25, which="major")


def main():
    if len(sys.argv) != 1:
        sys.exit(__doc__)
    one = shaken(shapes.sphere_in_box(*COARSEST))
    meshes = {"more of the same": (copies(one, n) for n in COPIES), "finer": (shaken(shapes.sphere_in_box(*size)) for size in FINER)}
    sequences = {}
    with tempfile.TemporaryDirectory() as folder:
        for title, some in meshes.items():
            print(f"{title}:", flush=True)
            sequences[title] = list(zip(*(measured(Path(folder), mesh) for mesh in some)))
    for title, (tets, rows) in sequences.items():
        print(f"\n{title}:\n" + "\n".join(table(tets, rows)))
    draw(sequences)


if __name__ == "__main__":
    main()
