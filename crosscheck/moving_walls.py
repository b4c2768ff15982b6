"""Move three real meshes by series of surfaces, and read the resulting series of volumes with PyVista.

    cargo build --release && target/venv/bin/python crosscheck/moving_walls.py [OUT]

(a) left heart: the boundary values of another program's mesh displacement, scaled by 50, compared with the
    volume displacement of that program;
(b) vessel: the radius of the wall changes by 20 %, inlet and outlet slide in their planes;
(c) vessel with thin cells at the wall: motion as in (b), with and without a rigid layer.

The series are written to OUT (default: a temporary folder) for ParaView. Needs the real meshes (MOTET_DATA).
"""
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pyvista as pv

ROOT = Path(__file__).resolve().parent.parent
DATA = Path(os.environ.get("MOTET_DATA") or ROOT.parent / "shared" / "data")
MOTET = Path(os.environ.get("MOTET_BIN_DIR") or ROOT / "target" / "release") / "motet"
STEPS = 20


def write_series(path, surface, steps, displacement):
    """Write a PVD series of `surface` displaced by `displacement(k)` at time k/STEPS, with its
    point arrays."""
    path.parent.mkdir(parents=True, exist_ok=True)
    entries = []
    for k in steps:
        frame = surface.copy()
        frame.points = np.asarray(surface.points, dtype=np.float64) + displacement(k)
        name = f"{path.stem}_{k:04d}.vtp"
        frame.save(path.with_name(name))
        entries.append(f'<DataSet timestep="{k / STEPS!r}" part="0" file="{name}"/>')
    path.write_text(f'<VTKFile type="Collection" version="0.1"><Collection>{"".join(entries)}</Collection></VTKFile>')


def move(mesh, wall, out, *options, code=0):
    """Run `motet move`; return its report and the duration of the whole run in seconds."""
    out.parent.mkdir(parents=True, exist_ok=True)
    call = [MOTET, "move", mesh, "-o", out, "--displacement", wall, *options, "--json"]
    begin = time.perf_counter()
    done = subprocess.run(list(map(str, call)), capture_output=True, text=True)
    seconds = time.perf_counter() - begin
    print("  $ " + " ".join(map(str, ["motet", *call[1:]])).replace(str(DATA), "DATA").replace(str(ROOT) + "/", ""))
    assert done.returncode == code, f"exit status {done.returncode}\n{done.stderr}"
    return json.loads(done.stdout), seconds


def frames(pvd):
    """Yield the times and meshes of a series as PyVista reads them."""
    reader = pv.get_reader(pvd)
    for t in reader.time_values:
        reader.set_active_time_value(t)
        yield t, reader.read()[0]


def print_summary(report, seconds, pvd):
    """Print quality and timings; return the times and meshes of the series."""
    worst = min(step["worst_eas"]["value"] for step in report["steps"])
    inverted = max(step["inverted"] for step in report["steps"])
    update = np.median([step["seconds"]["update"] for step in report["steps"]])
    print(f"  {report['points']} points, {report['cells']} cells, {len(report['steps'])} steps; "
          f"worst EAS {report['before']['worst_eas']['value']:.4f} initially, {worst:.4f} over all steps; "
          f"largest number of inverted cells {inverted}")
    print(f"  set-up {report['seconds']['setup']:.3f} s, median update {1e3 * update:.2f} ms, "
          f"update and certificate of all steps {report['seconds']['move']:.3f} s, "
          f"whole run {seconds:.2f} s")
    read = list(frames(pvd))
    assert len(read) == len(report["steps"]) and all(m.n_points == report["points"] for _, m in read)
    print(f"  PyVista reads {len(read)} steps, t = {read[0][0]:g} to {read[-1][0]:g}, arrays {read[0][1].array_names}")
    return read


def left_heart(out):
    print("(a) moving_wall/ambit_la_lv: boundary values of aledisp_2 x 50, in 20 steps")
    source = DATA / "moving_wall/ambit_la_lv/lalv_domain_with_aledisp.vtu"
    mesh = pv.read(source)
    given = 50 * np.asarray(mesh["aledisp_2"], dtype=np.float64)
    surface = mesh.extract_surface(pass_pointid=True, algorithm="dataset_surface")
    surface.clear_cell_data()
    on_wall = np.asarray(surface["vtkOriginalPointIds"])
    write_series(out / "a/wall.pvd", surface, range(1, STEPS + 1), lambda k: given[on_wall] * k / STEPS)
    report, seconds = move(source, out / "a/wall.pvd", out / "a/moved.pvd")
    last = print_summary(report, seconds, out / "a/moved.pvd")[-1][1]
    difference = np.linalg.norm(np.asarray(last["displacement"]) - given, axis=1)
    inside = np.setdiff1d(np.arange(mesh.n_points), on_wall)
    largest = np.linalg.norm(given, axis=1).max()
    print(f"  largest displacement {largest:.4f} mm; largest difference from the file's own volume displacement: "
          f"{difference[inside].max():.4f} mm inside ({difference[inside].max() / largest:.1%} of it; mean "
          f"{difference[inside].mean():.4f}), {difference[on_wall].max():.1e} on the wall")
    return seconds


def beat(k):
    """Return the relative growth of the radius at step k: a sine of amplitude 20 %."""
    return 0.2 * np.sin(2 * np.pi * k / STEPS) if k % STEPS else 0.0


def radially(points):
    return np.column_stack([points[:, 0], points[:, 1], np.zeros(len(points))])


def pipe(folder, name, out, *options):
    source = DATA / "tetmeshes" / folder
    wall = pv.read(source / "lumen_wall.vtp")
    radial = radially(np.asarray(wall.points, dtype=np.float64))
    write_series(out / "wall.pvd", wall, range(STEPS + 1), lambda k: beat(k) * radial)
    caps = [option for cap in ("inlet", "outlet") for option in ("--patch", f"{cap}={source}/lumen_{cap}.vtp", "--slide", cap)]
    report, seconds = move(source / "lumen.vtu", out / "wall.pvd", out / f"{name}.pvd", *caps, *options)
    read = print_summary(report, seconds, out / f"{name}.pvd")
    first, last = read[0][1].points, read[-1][1].points
    print(f"  after the whole beat every point is exactly at its initial position: {np.array_equal(first, last)}")
    for cap in ("inlet", "outlet"):
        ids = np.asarray(pv.read(source / f"lumen_{cap}.vtp")["GlobalNodeID"]) - 1
        z = np.array([m.points[ids, 2] for _, m in read])
        radius = [np.linalg.norm(m.points[ids, :2], axis=1).max() for _, m in read]
        print(f"  {cap}: deviation from its plane {np.abs(z - z[0]).max():.1e}, radius {min(radius):.3f} to {max(radius):.3f}")
    return read, seconds


def vessel(out):
    print("(b) tetmeshes/sv_ale_pipe: radius +-20 % in 20 steps, inlet and outlet sliding")
    return pipe("sv_ale_pipe", "moved", out / "b")[1]


def layer_thickness(mesh, wall_ids, reference=None):
    """Return the distance from each wall vertex to its nearest neighbour off the wall, and these edges.

    With `reference`, the edges of an earlier call are measured.
    """
    if reference is None:
        tets = mesh.cells_dict[10]
        edges = np.unique(np.sort(np.vstack([tets[:, [i, j]] for i in range(4) for j in range(i)]), axis=1), axis=0)
        on_wall = np.zeros(mesh.n_points, dtype=bool)
        on_wall[wall_ids] = True
        edges = edges[on_wall[edges[:, 0]] != on_wall[edges[:, 1]]]
        flip = on_wall[edges[:, 1]]
        edges[flip] = edges[flip][:, ::-1]
        length = np.linalg.norm(mesh.points[edges[:, 0]] - mesh.points[edges[:, 1]], axis=1)
        order = np.lexsort([length, edges[:, 0]])
        edges = edges[order]
        reference = edges[np.r_[True, edges[1:, 0] != edges[:-1, 0]]]
    length = np.linalg.norm(np.asarray(mesh.points)[reference[:, 0]] - mesh.points[reference[:, 1]], axis=1)
    return length, reference


def boundary_layer(out):
    print("(c) tetmeshes/sv_boundary_layer_pipe: radius +-20 % in 20 steps, with and without a rigid layer")
    ids = np.asarray(pv.read(DATA / "tetmeshes/sv_boundary_layer_pipe/lumen_wall.vtp")["GlobalNodeID"]) - 1
    total = 0.0
    for name, options in (("free", []), ("layer", ["--rigid-layer", "0.35"])):
        read, seconds = pipe("sv_boundary_layer_pipe", name, out / "c", *options)
        before, reference = layer_thickness(read[0][1], ids)
        variant = "with --rigid-layer 0.35" if options else "without a rigid layer"
        print(f"  first layer {variant}: thickness before {before.min():.4f} to {before.max():.4f}, mean {before.mean():.4f}")
        for k in (STEPS // 4, 3 * STEPS // 4):
            after, _ = layer_thickness(read[k][1], ids, reference)
            print(f"    at radius {1 + beat(k):.2f}: {after.min():.4f} to {after.max():.4f}, mean {after.mean():.4f}; "
                  f"largest change {np.abs(after / before - 1).max():.2%}")
        total += seconds
    return total


def main():
    if not DATA.is_dir():
        sys.exit(f"no real meshes at {DATA}: set MOTET_DATA")
    with tempfile.TemporaryDirectory() as temporary:
        out = Path(sys.argv[1] if len(sys.argv) > 1 else temporary)
        seconds = [left_heart(out), vessel(out), boundary_layer(out)]
        print(f"total time of motet: {sum(seconds):.2f} s ({', '.join(f'{s:.2f}' for s in seconds)})")


if __name__ == "__main__":
    main()
