"""What a long motion left of a mesh: the log of `motet run`, a line a step, in the same form for rivals, and sums over it."""
import json

import numpy as np

from tets import spread

TRIANGLE, TET = 5, 10  # as VTK counts them


def read_frame(path):
    """Points, tets, and triangles of walls of a VTU file."""
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
    """A program that was ended may have left its last line cut."""
    whole = path.read_text().rpartition("\n")[0] if path.exists() else ""
    return [json.loads(line) for line in whole.splitlines()]


def read_run(folder):
    """The steps of a run from step 0 on. Where the log has no `quality` (older programs), it comes from the frames that there are."""
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
    """Of the tets before a change, the part that is gone after it; summed over the changes of a step. The share in a log of motet is one of all cells,
    so of wall triangles, too, nearly all of which stay."""
    return sum((1 - change["kept_share"]) * (1 + triangles / change["tets_before"]) for change in step["changes"])


def sums(steps):
    """The columns of the table, from the steps with step 0."""
    known = [step["quality"] for step in steps if "quality" in step]
    walls = [step["wall_points"] for step in steps if "wall_points" in step]
    gone, triangles = steps[1:] or steps, steps[0].get("triangles", 0)
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
        "changed": float(np.mean([changed(step, triangles) for step in gone])), "seconds": float(np.mean([step["seconds"] for step in gone]))}


def cycle_ends(steps, per_cycle):
    """The steps at which a cycle ends, with the number of the cycle."""
    return [(step["step"] // per_cycle, step) for step in steps if step["step"] % per_cycle == 0 and "quality" in step]
