"""Prints the tables of refine-long.md.

    python docs/refine_long.py DATA BALL_IN_BOX [--processes N] [--only TEXT]

Runs the example `refine_long` (built with --release) on real and random meshes. DATA is the folder of real
meshes, BALL_IN_BOX a mesh file. A row describes the last generation, or the extremes over the steps of a
front. Takes two minutes on two idle cores.
"""
import argparse
import concurrent.futures
import pathlib
import re
import subprocess

EXAMPLE = pathlib.Path(__file__).resolve().parent.parent / "target/release/examples/refine_long"
MESHES = {
    "ball in a box": None,
    "aorta": "copyleft/lifev_aorta_fluid_30K.mesh",
    "abdominal aneurysm": "tetmeshes/pescio_AbdominalAorticAneurysm.msh",
    "pipe, lumen": "tetmeshes/sv_ale_pipe/lumen.vtu",
    "pipe, wall": "tetmeshes/sv_ale_pipe/wall.vtu",
    "pipe with layers": "tetmeshes/sv_boundary_layer_pipe/lumen.vtu",
    "pipe, two regions": "tetmeshes/ambit_pipe_fsi/pipe_fsi_domain.vtu",
    "3,008 random points": "random:3000",
    "500 random points": "random:500",
    "screw": "bad_tets/polyfem_screw.msh",
}
NINE = [name for name in MESHES if not name.startswith("500")]
# The headings of the two tables, and their rows: table, mesh, and options of the call.
TOWARDS = "| mesh | tets | towards | generation | tets | worst / first | median | worst mean ratio / first | below 0.9 | promoted | sweeps | without: tets | worst / first | price |"
FRONTS = "| mesh | front | depth | most tets | least worst / first | below 0.9, at most | promoted, at most | sweeps, at most | without: most tets | least worst / first | price | taken back in |"
START = {"screw": ["--start", "300"]}
ROWS = [("towards", mesh, ["--towards", what, *START.get(mesh, [])]) for what in ("point", "line", "surface") for mesh in NINE]
ROWS += [("fronts", mesh, ["--front", front, "--generations", str(depth)]) for mesh, front, depth in (
    ("ball in a box", "plane", 1), ("ball in a box", "plane", 2), ("aorta", "sphere", 1), ("3,008 random points", "plane", 1),
    ("3,008 random points", "plane", 2), ("500 random points", "plane", 2))]
ROWS += [("towards", mesh, ["--towards", "scattered", "--generations", "4"]) for mesh in ("ball in a box", "aorta", "3,008 random points", "screw")]


def numbers(line):
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    return dict(zip(["step", "marked", "tets", "worst", "median", "ratio", "below", "roots", "promoted", "cut", "sweeps", "seconds", "mb", "free_tets", "free_worst"],
                    map(float, cells)))


def price(row):
    more = 100 * (row["tets"] / row["free_tets"] - 1)
    return f"{more:.1f} %" if more < 20 else f"{more:.0f} %"


def below(rows):
    most = max(rows, key=lambda row: row["below"])
    return f"{most['below']:.0f} in {most['roots']:.0f}" if most["below"] else "0"


def row(job):
    table, mesh, options, file = job
    done = subprocess.run([EXAMPLE, file, *options], capture_output=True, text=True)
    lines = done.stdout.splitlines()
    rows = [numbers(line) for line in lines if re.match(r"\| \d", line)]
    if not rows or done.returncode == 2:
        return table, f"| {mesh} | {' '.join(options)} | failed: {done.stderr.strip()} |"
    n_first = int(re.search(r": (\d+) tets", lines[0])[1])
    if table == "towards":
        last = rows[-1]
        cells = [mesh, f"{n_first:,}", options[1], f"{last['step']:.0f}", f"{last['tets']:,.0f}", f"{last['worst']:.3f}", f"{last['median']:.3f}", f"{last['ratio']:.3f}", below(rows),
                 f"{last['promoted']:,.0f}", f"{last['sweeps']:.0f}", f"{last['free_tets']:,.0f}", f"{last['free_worst']:.3f}", price(last)]
    else:
        largest = max(rows, key=lambda row: row["tets"])
        back = re.search(r"all taken back in (\d+) step", done.stdout)[1]
        cells = [mesh, options[1], options[3], f"{largest['tets']:,.0f}", f"{min(row['worst'] for row in rows):.3f}", below(rows), f"{max(row['promoted'] for row in rows):,.0f}",
                 f"{max(row['sweeps'] for row in rows):.0f}", f"{max(row['free_tets'] for row in rows):,.0f}", f"{min(row['free_worst'] for row in rows):.3f}", price(largest),
                 f"{back} step{'s' if back != '1' else ''}"]
    if "BROKEN" in done.stdout:
        cells.append("BROKEN")
    return table, f"| {' | '.join(cells)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("ball_in_box", type=pathlib.Path)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--only", default="")
    call = parser.parse_args()
    file = {mesh: call.ball_in_box if where is None else where if where.startswith("random") else call.data / where for mesh, where in MESHES.items()}
    jobs = [(table, mesh, options, file[mesh]) for table, mesh, options in ROWS if call.only in f"{mesh} {' '.join(options)}"]
    before = None
    with concurrent.futures.ThreadPoolExecutor(call.processes) as pool:
        for table, line in pool.map(row, jobs):
            if table != before:
                heading = TOWARDS if table == "towards" else FRONTS
                print(f"\n{heading}\n|{'---|' * (heading.count('|') - 1)}")
                before = table
            print(line, flush=True)


if __name__ == "__main__":
    main()
