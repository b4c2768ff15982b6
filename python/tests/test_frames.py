"""Reports and logs as data frames."""
import json
import subprocess
import sys

import numpy as np
import pytest

import motet
from motet import shapes

pandas = pytest.importorskip("pandas")

JOB = """
mesh = "box.vtu"
output = "swing/out.pvd"
[time]
period = 1.0
steps = 4
[[motion.move]]
patch = "sphere"
shift = [0.4, 0.1, 0.0]
in_time = "swing"
"""


def test_a_report_is_a_row():
    report = motet.remesh(shapes.sphere_in_box(), goal="best").report
    frame = report.to_frame()
    assert len(frame) == 1
    assert frame["after.quality.mean"][0] == report.after.quality.mean
    assert frame["operations.smoothing"][0] == report.operations.smoothing


def test_reports_of_steps_are_rows():
    moving = motet.MovingMesh(shapes.sphere_in_box())
    still = np.zeros_like(moving.driven_places)
    reports = [moving.advance(k, still) for k in (1.0, 2.0, 3.0)]
    frame = motet.to_frame(reports)
    assert list(frame["time"]) == [1.0, 2.0, 3.0]
    assert list(frame["quality.mean"]) == [step.quality.mean for step in reports]


def test_a_log_has_a_row_for_each_step(tmp_path):
    shapes.sphere_in_box().save(tmp_path / "box.vtu")
    (tmp_path / "swing.toml").write_text(JOB)
    subprocess.run([sys.executable, "-m", "motet", "run", "swing.toml", "-q"], cwd=tmp_path, check=True)
    frame = motet.read_log(tmp_path / "swing" / "out.pvd")
    assert list(frame.index) == [0, 1, 2, 3, 4]
    assert list(frame["time"]) == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert (frame["seconds.total"] >= 0).all() and (frame["quality.worst"] > 0).all()
    assert [len(changes) for changes in frame["change_list"]] == list(frame["changes"])
    log = tmp_path / "swing" / "out.jsonl"
    lines = log.read_text().splitlines()
    assert frame["tets"].tolist() == [json.loads(line)["tets"] for line in lines]
    # A run that goes on writes steps again, and its last line may not have ended.
    log.write_text("\n".join([*lines, lines[2], lines[3][:20]]))
    assert list(motet.read_log(log).index) == [0, 1, 2, 3, 4]
    log.write_text("[1]\n")
    with pytest.raises(motet.InputError, match="line 1: not a step of a log"):
        motet.read_log(log)
    with pytest.raises(motet.FileError, match="no.jsonl"):
        motet.read_log(tmp_path / "no.pvd")
