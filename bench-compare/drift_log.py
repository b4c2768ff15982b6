"""Logs of long motions, by `motet run` and in the same form by other programs, and summaries of them."""
import json

import numpy as np

from tets import spread

TRIANGLE, TET = 5, 10  # VTK's numbers


def read_frame(path):
    """Read the points, tets and wall triangles of a VTU file."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    begins, kinds = vtk_to_numpy(grid.GetCells().GetOffsetsArray())[:-1], vtk_to_numpy(grid.GetCellTypes())
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).astype(np.int64)
    of_kind = lambda kind, n: corners[begins[kinds == kind][:, None] + np.arange(n)]
    return vtk_to_numpy(grid.GetPoints().GetData()).astype(np.float64), of_kind(TET, 4), of_kind(TRIANGLE, 3)


def lines(path):
    """Read the complete lines of a log; the last line of a terminated program may be incomplete."""
    whole = path.read_text().rpartition("\n")[0] if path.exists() else ""
    return [json.loads(line) for line in whole.splitlines()]


def read_run(folder):
    """Return the steps of a run from step 0 on. If the log has no `quality`, it is measured in the frames."""
    pairs = zip(lines(folder / "run.jsonl"), lines(folder / "run.times.jsonl"))
    steps = [step | {"seconds": times["seconds"]["total"]} for step, times in pairs]
    if steps and (folder / "run.state.vtu").exists():
        steps[-1].setdefault("file", "run.state.vtu")  # the mesh after the last step
    framed = [step for step in steps if "file" in step]
    ends = [step["step"] for step in (framed[:1] + framed[-1:])]
    for step in framed:
        is_end = step["step"] in ends
        if is_end or "quality" not in step:
            points, tets, walls = read_frame(folder / step["file"])
            step.setdefault("quality", spread(points, tets))
            step["wall_points"], step["triangles"] = len(np.unique(walls)), len(walls)
    return steps


def changed(step, triangles):
    """Return the fraction of tets removed by a change, summed over the changes of a step.

    The share in a log of motet is relative to all cells, including wall triangles, of which nearly all are
    kept.
    """
    return sum((1 - change["kept_share"]) * (1 + triangles / change["tets_before"]) for change in step["changes"])


def sums(steps):
    """Return the columns of the table from all steps, including step 0."""
    known = [step["quality"] for step in steps if "quality" in step]
    walls = [step["wall_points"] for step in steps if "wall_points" in step]
    made, triangles = steps[1:] or steps, steps[0].get("triangles", 0)
    worst = [step["worst"]["eas"] for step in steps if step.get("worst")]
    counts = {key: [step[key] for step in steps] for key in ("points", "tets")}
    result = {f"{key}_{when}": of(count) for key, count in counts.items()
              for when, of in (("first", lambda c: c[0]), ("least", min), ("most", max), ("last", lambda c: c[-1]))}
    return result | {
        "steps": len(steps) - 1, "qualities": len(known), "walls_first": walls[0], "walls_last": walls[-1],
        "mean_first": known[0]["mean"], "mean_last": known[-1]["mean"], "mean_least": min(q["mean"] for q in known),
        "p1_last": known[-1]["p1"], "ratio_first": known[0]["mean_ratio"], "ratio_last": known[-1]["mean_ratio"],
        "worst_ever": min(worst), "bad_ever": max(step["bad"] for step in steps),
        "inverted_ever": max(step["inverted"] for step in steps),
        "changed": float(np.mean([changed(step, triangles) for step in made])), "seconds": float(np.mean([step["seconds"] for step in made]))}


def cycle_ends(steps, per_cycle):
    """Return the steps at which cycles end, with the numbers of the cycles."""
    return [(step["step"] // per_cycle, step) for step in steps if step["step"] % per_cycle == 0 and "quality" in step]
