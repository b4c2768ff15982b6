"""Long calls report progress, are stopped by exceptions, and let other threads run."""
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import motet
from motet import shapes

BOX = shapes.box((8, 8, 8))
BALL = shapes.sphere_in_box(16)
STENT = shapes.stent(radius=0.2, length=1.0, rings=3)
STENT.points = STENT.points + [0.5, 0.5, 0.2]

LONG = {
    "remesh": (motet.remesh, BOX, {"sizes": 0.03}),
    "mesh": (motet.mesh, shapes.aneurysm(around=64), {"size": 0.05}),
    "implant": (motet.implant, shapes.box((24, 24, 24), high=(1, 1, 1.4)), {"devices": STENT}),
    "refine": (motet.refine, BOX, {"size": 0.02}),
    "mover": (motet.Mover, BALL, {"method": "elastic", "factor_gib": 1.0}),
    "choose": (motet.move, BALL, {"method": "auto", "displacement": 0.4 * np.sin(7 * BALL.points[:, [1, 2, 0]]), "steps": 4}),
}


class Enough(Exception):
    pass


@pytest.mark.parametrize("verb", LONG)
def test_progress_is_reported_and_an_exception_ends_the_call(verb):
    call, mesh, options = LONG[verb]
    before, reports = mesh.copy(), []

    def enough(stage, done, of):
        reports.append((stage, done, of))
        raise Enough

    with pytest.raises(Enough):
        call(mesh, **options, progress=enough)
    [(stage, done, of)] = reports
    assert stage and done >= 0 and (of == 0 or done <= of)
    np.testing.assert_array_equal(mesh.points, before.points)
    np.testing.assert_array_equal(mesh.connectivity, before.connectivity)


def test_results_do_not_depend_on_progress_reports():
    reports = []
    watched = motet.remesh(BOX, sizes=0.06, progress=lambda *report: reports.append(report))
    assert reports and {stage for stage, *_ in reports} <= {
        "splitting long edges", "collapsing short edges", "repairing tets", "removing superfluous vertices", "improving tets",
    }  # fmt: skip
    np.testing.assert_array_equal(watched.mesh.points, motet.remesh(BOX, sizes=0.06).mesh.points)


def test_other_threads_run_during_a_call():
    is_over, n = threading.Event(), 0

    def count():
        nonlocal n
        while not is_over.wait(0.01):
            n += 1

    other = threading.Thread(target=count)
    other.start()
    begin = time.perf_counter()
    motet.remesh(BOX, sizes=0.06)
    seconds = time.perf_counter() - begin
    is_over.set()
    other.join()
    assert n > 20 * seconds


def test_ctrl_c_ends_a_call():
    # If the tests run in the background of a shell, they and their child processes ignore Ctrl-C by default.
    ready = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\nimport motet\nprint('here', flush=True)\n"
    script = ready + "motet.remesh(motet.shapes.box((8, 8, 8)), sizes=0.012)"
    running = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    running.stdout.readline()
    time.sleep(0.5)
    running.send_signal(signal.SIGINT)
    _, errors = running.communicate(timeout=20)
    assert running.returncode != 0 and "KeyboardInterrupt" in errors


def test_a_mover_can_be_used_after_an_interrupted_call():
    mover = motet.Mover(BALL, method="laplace", residual=1e-13)
    far = np.zeros((len(mover.boundary), 3))
    size = np.abs(BALL.points).max()
    far[np.linalg.norm(BALL.points[mover.boundary], axis=1) < 0.9 * size, 0] = 0.9 * size

    def stop(*_):
        raise Enough

    before = signal.signal(signal.SIGALRM, stop)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.15)
        with pytest.raises(Enough):
            while True:
                mover.advance(far)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    near = 0.1 * far
    points, certificate = mover.advance(near)
    assert certificate.complete
    # An iterative solution depends on its initial guess, within the residual.
    np.testing.assert_allclose(points, mover.step(near), atol=1e-11)


SOME = {"surfaces": shapes.aneurysm(around=32), "size": 0.15}


def test_true_shows_a_line_for_each_stage_without_tqdm(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    motet.mesh(**SOME, progress=True)
    shown = capsys.readouterr().err
    assert shown.startswith("\r") and "improving tets" in shown and " %" in shown and shown.endswith("\n")


def test_true_shows_a_bar_of_tqdm_for_each_stage(capsys):
    pytest.importorskip("tqdm")
    motet.mesh(**SOME, progress=True)
    shown = capsys.readouterr().err
    assert "improving tets" in shown and "%|" in shown


def test_stages_are_logged_once_each(caplog):
    with caplog.at_level("INFO", logger="motet"):
        motet.mesh(**SOME)
    stages = [record.getMessage() for record in caplog.records]
    assert "mesh: improving tets" in stages
    assert all(one != other for one, other in zip(stages, stages[1:]))


def test_false_and_none_show_nothing(capsys):
    for progress in (False, None):
        motet.mesh(**SOME, progress=progress)
    assert capsys.readouterr() == ("", "")
