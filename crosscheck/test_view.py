"""The window of `motet view` in a browser: a coil is dragged, the mesh follows, and is repaired and undone.

    target/venv/bin/python crosscheck/test_view.py MESH PATCH         pictures a second while a patch is dragged
"""
import contextlib
import json
import os
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import pytest

from browser import Page, needs_chromium
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

np = pytest.importorskip("numpy")
package = pytest.importorskip("motet", reason="the package is not installed: ./test does it")
pytestmark = needs_chromium


class Window(Page):
    """The page of a mesh that `motet view` serves."""

    def __init__(self, motet, mesh):
        super().__init__()
        self.program = subprocess.Popen([str(motet), "view", str(mesh), "--no-browser"], stdout=subprocess.PIPE, text=True)
        self.address = self.program.stdout.readline().strip()
        self.seconds = self.open(self.address)
        self.wait(lambda: self.said() != "")
        self.settle()

    def said(self):
        return self.element("state").text

    def get(self, path):
        with urllib.request.urlopen(self.address + path) as answer:
            return answer.read()

    def facts(self):
        return json.loads(self.get("facts"))

    def mesh(self, folder):
        """Return the mesh as it is now."""
        path = Path(folder) / "now.vtu"
        path.write_bytes(self.get("mesh.vtu"))
        return package.read(path)

    def wait(self, is_so, seconds=60):
        end = time.monotonic() + seconds
        while not is_so():
            assert time.monotonic() < end, self.said()
            time.sleep(0.02)

    def previews(self):
        return int(self.js("return document.getElementById('view').dataset.previews ?? 0"))

    @contextlib.contextmanager
    def held(self, x, y):
        """Press the mouse in the middle of the view, and move it by `x` and `y` pixels; release it at the end."""
        ActionChains(self.driver, duration=0).move_to_element(self.element("view")).click_and_hold().perform()
        before = self.previews()
        ActionChains(self.driver, duration=0).move_by_offset(round(x), round(y)).perform()
        if x or y:
            self.wait(lambda: self.previews() > before)
            self.settle()
        yield
        ActionChains(self.driver, duration=0).release().perform()
        self.settle()

    def close(self):
        super().close()
        self.program.kill()
        self.program.wait()


@pytest.fixture(scope="module")
def vessel(tmp_path_factory):
    """An aneurysm with a coil in it, as a file."""
    host = package.mesh(package.shapes.aneurysm(), size="auto").mesh
    path = tmp_path_factory.mktemp("view") / "vessel.vtu"
    package.implant(host, {"coil": package.shapes.coil((0, 2.3, 0), radius=0.5)}, inside="hollow").mesh.save(path)
    return path


@pytest.fixture
def window(motet, vessel):
    window = Window(motet.path, vessel)
    yield window
    window.close()


def places(mesh):
    """Return the positions of the vertices of the coil, in the order of the mesh."""
    label = next(label for label, name in mesh.patch_names.items() if name == "coil")
    cells = mesh.cells("triangle")[mesh.cell_data["patch"][mesh.cell_ids("triangle")] == label]
    return mesh.points[np.unique(cells)]


def test_a_coil_is_dragged_by_hand_and_the_mesh_follows(window, tmp_path):
    first = window.get("mesh.vtu")
    before = window.mesh(tmp_path)
    assert "0 inverted" in window.said()
    window.put("grabbed", "coil")
    picture = window.picture()
    with window.held(10, 0):
        assert window.picture() != picture
        # Nothing is decided before the coil is released.
        assert window.get("mesh.vtu") == first
    short = places(window.mesh(tmp_path)) - places(before)
    assert np.ptp(short, axis=0).max() < 1e-9, "the coil is moved as a whole"
    length = np.linalg.norm(short[0])
    assert length > 0 and "Moved." in window.said()
    window.click("undo")
    assert window.get("mesh.vtu") == first

    # By 0.3, to half a pixel.
    pixels = 10 * 0.3 / length
    with window.held(pixels, 0):
        pass
    after = window.mesh(tmp_path)
    moved = np.linalg.norm((places(after) - places(before))[0])
    assert moved == pytest.approx(0.3, abs=length / 10)
    assert window.facts()["inverted"] == 0 and window.facts()["tets"] == len(after.tets)
    assert window.facts()["eas"]["worst"] == pytest.approx(after.summary().quality.eas.min, abs=1e-6)
    second = window.get("mesh.vtu")

    # Far beyond the wall: it stops before it, and what became bad is repaired.
    with window.held(0, 150):
        assert "bad" in window.said()
    far = window.mesh(tmp_path)
    assert far.n_cells != after.n_cells, "repairs change counts"
    assert window.facts()["inverted"] == 0 and window.facts()["gap"] > 0
    window.click("undo")
    assert window.get("mesh.vtu") == second
    window.click("undo")
    assert window.get("mesh.vtu") == first and not window.element("undo").is_enabled()
    assert window.errors() == []


def test_escape_puts_back_what_is_dragged(window):
    first, picture = window.get("mesh.vtu"), window.thumbnail()
    window.put("grabbed", "coil")
    ActionChains(window.driver, duration=0).move_to_element(window.element("view")).click_and_hold().move_by_offset(25, 0).perform()
    window.wait(lambda: window.previews() > 0)
    window.element("view").send_keys(Keys.ESCAPE)
    window.settle()
    ActionChains(window.driver, duration=0).release().perform()
    window.settle()
    assert window.get("mesh.vtu") == first
    assert np.abs(np.subtract(window.thumbnail(), picture)).max() < 60
    assert window.errors() == []


def test_everything_can_be_done_by_keyboard(window, tmp_path):
    before = places(window.mesh(tmp_path))
    window.put("grabbed", "coil")
    window.put("by-x", "0.1")
    window.put("by-z", "-0.05")
    window.click("shift")
    moved = places(window.mesh(tmp_path)) - before
    assert np.allclose(moved, (0.1, 0, -0.05), atol=1e-9)
    assert window.violations() == [] and window.errors() == []


def test_the_view_turns_where_nothing_is_grabbed(window):
    first, picture = window.get("mesh.vtu"), window.picture()
    window.put("grabbed", "none")
    ActionChains(window.driver, duration=0).move_to_element(window.element("view")).click_and_hold().move_by_offset(60, 20).release().perform()
    window.settle()
    assert window.picture() != picture and window.previews() == 0
    assert window.get("mesh.vtu") == first


def test_the_saved_page_works_alone(window, tmp_path):
    (tmp_path / "page.html").write_bytes(window.get("page.html"))
    page = Page()
    try:
        page.open(tmp_path / "page.html")
        assert page.colours()[1] > 0.05 and page.requests() == [] and page.errors() == []
        assert page.js("return document.getElementById('live')") is None
    finally:
        page.close()


def test_a_notebook_shows_the_window_and_has_the_mesh(vessel):
    mesh = package.read(vessel)
    with package.view(mesh) as view:
        assert view.url in view._repr_html_()
        with urllib.request.urlopen(view.url + "facts") as answer:
            names = [patch["name"] for patch in json.load(answer)["patches"]]
        assert "coil" in names
        question = json.dumps({"patch": "coil", "by": [0.1, 0, 0]}).encode()
        with urllib.request.urlopen(view.url + "move", data=question) as answer:
            assert json.load(answer)["inverted"] == 0
        assert np.allclose(places(view.mesh) - places(mesh), (0.1, 0, 0), atol=1e-9)
    with pytest.raises(OSError):
        urllib.request.urlopen(view.url, timeout=5)


def measure(mesh, patch, n=40):
    """Print how fast the picture follows while a patch is dragged, and what the program takes of that."""
    folder = Path(os.environ.get("MOTET_BIN_DIR") or Path(__file__).resolve().parent.parent / "target" / "release")
    window = Window(folder / "motet", mesh)
    try:
        facts = window.facts()
        print(f"{mesh}: {facts['tets']} tets, opened in {window.seconds:.2f} s")
        window.put("grabbed", patch)
        with window.held(1, 0):
            before, start, spent = window.previews(), time.monotonic(), []
            for k in range(n):
                ActionChains(window.driver, duration=0).move_by_offset(1 if k % 20 < 10 else -1, 0).perform()
                spent.append(float(window.said().split()[-2]))
            seconds = time.monotonic() - start
            pictures = window.previews() - before
        print(f"{pictures / seconds:.1f} pictures a second; the program takes {np.median(spent):.1f} ms of each (median)")
        start = time.monotonic()
        window.click("undo")
        print(f"undone in {time.monotonic() - start:.2f} s")
    finally:
        window.close()


if __name__ == "__main__":
    measure(*sys.argv[1:3])
