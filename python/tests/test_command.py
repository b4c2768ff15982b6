"""The command line installed with the package."""
import os
import re
import subprocess
import sys

import pytest

import motet
from motet import shapes

MOTET = [sys.executable, "-m", "motet"]


def run(*arguments, **options):
    return subprocess.run([*MOTET, *map(str, arguments)], capture_output=True, text=True, timeout=60, **options)


def test_the_installed_command_runs_like_the_package(tmp_path):
    assert run("--version").stdout == f"motet {motet.__version__}\n"
    shapes.aneurysm().save(tmp_path / "vessel.vtp")
    done = run("mesh", tmp_path / "vessel.vtp", "-o", tmp_path / "mesh.vtu")
    assert done.returncode == 0 and done.stdout and not done.stderr
    assert motet.read(tmp_path / "mesh.vtu").summary().volume == pytest.approx(motet.mesh(shapes.aneurysm()).mesh.summary().volume)


def test_exit_statuses_tell_errors_apart(tmp_path):
    shapes.box().save(tmp_path / "box.vtu")
    assert run("info", tmp_path / "box.vtu", "--json").returncode == 0
    assert run("info").returncode == 2 and "Usage" in run("info").stderr
    assert run("info", tmp_path / "none.vtu").returncode == 3
    (tmp_path / "wing.h5m").write_bytes(b"")
    assert "meshio convert wing.h5m" in run("info", tmp_path / "wing.h5m").stderr


def test_errors_for_foreign_formats_suggest_a_converter(tmp_path):
    for name, content, what in [
        ("a.ugrid", b"", "UGRID"), ("a.h5m", b"", "MOAB"), ("a.xdmf2", b"<Xdmf>", "XDMF"), ("a.mdpa", b"", "Kratos"),
    ]:  # fmt: skip
        (tmp_path / name).write_bytes(content)
        with pytest.raises(motet.InputError, match=what) as error:
            motet.read(tmp_path / name)
        assert "meshio convert" in error.value.remedy


@pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals")
def test_a_terminal_shows_the_stage_and_the_remaining_time(tmp_path):
    import pty

    shapes.ball(6, 6).save(tmp_path / "ball.vtu")
    leader, follower = pty.openpty()
    arguments = ["remesh", tmp_path / "ball.vtu", "-o", tmp_path / "fine.vtu", "--sizes", "0.1", "--surface", "adapt"]
    with subprocess.Popen([*MOTET, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=follower) as call:
        os.close(follower)
        drawn = b""
        while True:
            try:
                more = os.read(leader, 65536)
            except OSError:  # signals the end of a pseudo-terminal
                break
            if not more:
                break
            drawn += more
        assert call.wait(60) in (0, 4)
    os.close(leader)
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", drawn.decode(errors="replace"))
    assert "remeshing: " in text
    parts = re.findall(r"remeshing: ([a-z ]+), (\d+) of (\d+)", text)
    assert parts and all(int(done) <= int(of) for _, done, of in parts)
    # A remaining time is shown only beside a counted stage.
    assert all(re.search(r"\d+ of \d+, $", text[: at.start()]) for at in re.finditer(r"\d+ (s|min|h) left", text))
