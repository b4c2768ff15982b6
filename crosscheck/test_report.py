"""Pages of `motet report` in a browser: they need no network, and each control changes the picture."""
import json
import re
import time

import pytest

from browser import Page, needs_chromium
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

pytestmark = needs_chromium


@pytest.fixture
def page():
    page = Page()
    yield page
    page.close()


@pytest.fixture(scope="module")
def moved(motet, sphere):
    """The path of a page of a series, with the report of the motion."""
    folder = sphere[0]
    motet("report", folder / "moved.pvd", folder / "move.json", "-o", folder / "moved.html", "--title", "A sphere moves")
    return folder / "moved.html"


def test_each_control_changes_the_picture_without_network_requests(page, moved):
    page.open(moved)
    assert "A sphere moves" in page.driver.title
    n_colours, drawn = page.colours()
    assert n_colours > 8 and drawn > 0.1
    before = {page.picture()}

    def changed(what):
        picture = page.picture()
        assert picture not in before, f"{what} changed nothing"
        before.add(picture)

    arrays = page.js("return [...document.getElementById('array').options].map(o => [o.value, o.text])")
    patch = next(value for value, name in arrays if name == "patch")
    page.put("array", patch)
    changed("colouring by patch")
    assert page.js("return document.querySelectorAll('#scale li').length") >= 2
    page.put("array", arrays[0][0])
    page.put("cut", 1)
    changed("a cut across y")
    for place in (300, 420):
        page.put("part", place, "input")
        changed("moving the cut")
    page.put("mode", "slice")
    changed("a clean slice")
    page.click("flip")
    changed("the other side")
    page.click("edges")
    changed("no edges")
    page.put("frame", 10, "input")
    changed("the last frame")
    assert "time 10" in page.element("time").text
    page.click("bad")
    changed("bad tets")
    assert page.red() > 20
    page.put("high", 0.5)
    changed("another range")
    ActionChains(page.driver).move_to_element(page.element("view")).click_and_hold().move_by_offset(90, 40).release().perform()
    page.settle()
    changed("turning by the mouse")
    page.element("view").send_keys(Keys.ARROW_LEFT)
    page.settle()
    changed("turning by a key")
    page.element("view").send_keys("+")
    page.settle()
    changed("zooming by a key")
    page.js("document.querySelector('[data-look=\"+x\"]').click()")
    page.settle()
    changed("looking along x")
    assert page.errors() == []
    assert page.requests() == []


def test_what_is_inside_is_seen_through_what_is_around_it(page, moved):
    page.open(moved)
    assert page.opacities() == {"box": 20, "sphere": 100}
    start = page.picture()
    page.part("sphere", visible=False)
    assert page.picture() != start, "the sphere is not seen through the box"
    page.part("sphere", visible=True)
    assert page.picture() == start
    page.part("box", opacity=100)
    opaque = page.picture()
    page.part("sphere", visible=False)
    assert page.picture() == opaque, "an opaque box hides the sphere"
    page.part("box", visible=False)
    assert page.colours()[1] < 0.01, "nothing is left"
    page.click("opaque")
    assert page.picture() == start and page.opacities() == {"box": 20, "sphere": 100}
    # With the box open, what was hidden is also cut.
    page.part("box", visible=False)
    page.put("cut", 1)
    page.put("mode", "slice")
    assert page.colours()[1] > 0.01
    assert page.errors() == []


def test_a_link_shows_the_same_again(page, moved):
    page.open(moved)
    at_first = page.thumbnail()
    arrays = page.js("return [...document.getElementById('array').options].map(o => [o.value, o.text])")
    page.put("array", next(value for value, name in arrays if name == "length of displacement"))
    page.put("high", 2)
    page.put("frame", 7, "input")
    page.put("cut", 0)
    page.put("part", 400, "input")
    page.put("mode", "slice")
    page.click("flip")
    page.click("edges")
    page.click("arrows")
    page.part("box", opacity=35)
    page.element("view").send_keys(Keys.ARROW_LEFT, Keys.ARROW_UP, "+", "+", Keys.SHIFT + Keys.ARROW_RIGHT)
    page.settle()
    page.click("copy")
    _until(lambda: page.element("done").text == "Link copied.")
    picture, address = page.thumbnail(), page.js("return location.href")
    page.driver.get("about:blank")
    page.driver.get(address)
    page.settle()
    # The link has five digits of the camera.
    assert _difference(page.thumbnail(), picture) < 0.5 < 5 < _difference(at_first, picture)
    assert page.opacities() == {"box": 35, "sphere": 100}
    shown = page.js("return ['frame', 'high', 'cut', 'part', 'mode'].map((id) => document.getElementById(id).value)")
    assert shown == ["7", "2", "0", "400", "slice"]
    assert page.js("return ['flip', 'edges', 'arrows'].map((id) => document.getElementById(id).checked)") == [True, False, True]
    # A link to what is not there, and one that says nothing, show the page as it is at first.
    for link in ["#input=7&frame=-1&array=99&range=2,1&camera=" + ",".join(["0"] * 12) + "&cut=5,1,slice,2&part=1,7,x", "#s1"]:
        page.driver.get("about:blank")
        page.driver.get(moved.as_uri() + link)
        page.settle()
        assert page.colours()[1] > 0.1 and page.element("frame").get_attribute("value") == "0"
    assert page.errors() == []


def test_arrows_are_there_for_vectors_only(page, moved):
    page.open(moved)
    assert not page.element("arrow-row").is_displayed()
    arrays = page.js("return [...document.getElementById('array').options].map(o => [o.value, o.text])")
    page.put("array", next(value for value, name in arrays if name == "length of displacement"))
    page.put("frame", 10, "input")
    assert page.element("arrow-row").is_displayed()
    assert "in units of the mesh" in page.element("scale").text
    without = page.picture()
    page.click("arrows")
    drawn = page.picture()
    assert drawn != without
    page.part("sphere", visible=False)
    page.part("box", visible=False)
    assert page.colours()[1] < 0.01, "arrows of what is hidden are hidden"
    assert page.errors() == []


def test_two_meshes_are_shown_side_by_side(page, motet, sphere, tmp_path):
    folder = sphere[0]
    motet("report", folder / "moved.pvd", folder / "box.vtu", "-o", tmp_path / "two.html")
    page.open(tmp_path / "two.html")
    half = """
        const view = document.getElementById("view"), copy = document.createElement("canvas");
        [copy.width, copy.height] = [view.width / 2, view.height];
        copy.getContext("2d").drawImage(view, -arguments[0] * view.width / 2, 0);
        return copy.toDataURL();"""
    page.put("beside", 1)
    assert page.element("names").text.split() == ["moved.pvd", "box.vtu"]
    left, right = page.js(half, 0), page.js(half, 1)
    page.put("frame", 10, "input")
    assert page.js(half, 0) != left and page.js(half, 1) == right, "only the series moves"
    for change in (lambda: page.element("view").send_keys(Keys.ARROW_LEFT), lambda: page.put("cut", 0), lambda: page.part("box", opacity=60)):
        left, right = page.js(half, 0), page.js(half, 1)
        change()
        page.settle()
        assert page.js(half, 0) != left and page.js(half, 1) != right, "both follow"
    page.put("beside", -1)
    assert page.element("names").text == ""
    assert page.errors() == []


def test_frames_are_saved_as_a_video_and_the_picture_as_png(page, moved, tmp_path):
    page.open(moved)
    page.downloads(tmp_path)
    page.click("save")
    _until(lambda: list(tmp_path.glob("*.png")))
    page.click("video")
    _until(lambda: "Video of" in page.element("done").text)
    _until(lambda: list(tmp_path.glob("*.webm")))
    film = (tmp_path / "moved.pvd.webm").read_bytes()
    assert film[:4] == bytes.fromhex("1a45dfa3") and len(film) > 5000
    assert page.element("frame").get_attribute("value") == "0"
    # A second press ends it.
    page.click("video")
    time.sleep(0.5)
    page.click("video")
    _until(lambda: page.element("video").text == "Save video")
    assert page.errors() == []


def test_without_a_recorder_the_button_for_videos_says_why(page, moved):
    page.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": "delete window.MediaRecorder"})
    page.open(moved)
    assert not page.element("video").is_enabled() and "MediaRecorder" in page.element("video").get_attribute("title")


def test_every_control_has_a_name_and_is_reached_by_the_tab_key(page, moved):
    page.open(moved)
    controls = page.driver.find_elements("css selector", "#viewer :is(input, select, button, canvas)")
    wanted = [control for control in controls if control.is_displayed() and control.is_enabled()]
    assert len(wanted) > 25
    assert all(control.accessible_name for control in wanted)
    reached = set()
    for _ in range(3 * len(wanted)):
        page.driver.switch_to.active_element.send_keys(Keys.TAB)
        reached.add(page.driver.switch_to.active_element)
    assert all(control in reached for control in wanted)
    assert page.violations() == []


def _difference(a, b):
    """The mean difference of two lists of colours, of 255."""
    return sum(abs(x - y) for x, y in zip(a, b)) / len(a)


def _until(is_so, seconds=30):
    end = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < end, "it does not happen"
        time.sleep(0.05)


def test_charts_follow_a_series_that_plays(page, moved):
    page.open(moved)
    first = page.picture()
    cursor = "return document.querySelector('[data-view] .chart .cursor').getAttribute('x1')"
    place, bars = page.js(cursor), page.js("return document.getElementById('eas-0').innerHTML")
    page.click("play")
    end = time.monotonic() + 30
    while page.js("return document.getElementById('frame').value") in ("0", "1"):
        assert time.monotonic() < end, "the series does not play"
        time.sleep(0.05)
    page.click("play")
    frame = page.js("return document.getElementById('frame').value")
    time.sleep(0.6)
    assert page.js("return document.getElementById('frame').value") in (frame, str(int(frame) + 1)), "the series is not paused"
    page.settle()
    assert page.picture() != first
    assert page.js(cursor) != place
    assert page.js("return document.getElementById('eas-0').innerHTML") != bars
    assert page.errors() == []


def test_the_page_agrees_with_motet_info(page, moved, motet):
    page.open(moved)
    eas = motet.json("info", moved.parent / "moved_0010.vtu")["quality"]["eas"]
    rows = page.js("return [...document.querySelectorAll('tbody')[0].rows].map(r => [...r.cells].map(c => c.textContent))")
    head = page.js("return [...document.querySelectorAll('thead')[0].rows[0].cells].map(c => c.textContent)")
    last = dict(zip(head, rows[-1]))
    assert int(last["bad"].replace("\u202f", "")) == eas["bad"]
    assert float(last["worst EAS"]) == pytest.approx(eas["min"], rel=1e-3)
    assert int(last["at cell"]) == eas["worst_cell"]


def test_one_page_shows_a_volume_a_surface_and_a_log(page, motet, example, tmp_path):
    example("shapes").run(tmp_path)
    (tmp_path / "run.jsonl").write_text("".join(
        json.dumps({"step": k, "least_gap": 1 / (k + 1), "seconds": {"graph": 0.1, "check": 0.2 + k}, "odd": [{}, 1]}) + "\n"
        for k in range(5)))
    motet("report", tmp_path / "ball.vtu", tmp_path / "aneurysm.vtp", tmp_path / "run.jsonl", "-o", tmp_path / "all.html")
    page.open(tmp_path / "all.html")
    first = page.picture()
    page.put("input", 1)
    assert page.picture() != first and page.colours()[1] > 0.02
    text = page.js("return document.body.innerText")
    assert "least_gap" in text and "seconds by stage" in text
    assert page.errors() == [] and page.requests() == []


# Cuts each frame with the script of the page: the area and bounds of the slice, and the bounds of the whole
# cells.
CUT = """
const done = arguments[arguments.length - 1], [name, axis, part] = arguments;
(async () => {
  const area = ({ places: p, count }) => {
    let sum = 0;
    for (let i = 0; i < count; i++) {
      const at = (c, k) => p[9 * i + 3 * c + k], side = (c) => [0, 1, 2].map((k) => at(c, k) - at(0, k));
      const [u, v] = [side(1), side(2)];
      sum += Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
    }
    return sum;
  };
  const box = ({ places: p, count }) => {
    const low = [Infinity, Infinity, Infinity], high = low.map((x) => -x);
    for (let i = 0; i < 9 * count; i++) {
      low[i % 3] = Math.min(low[i % 3], p[i]);
      high[i % 3] = Math.max(high[i % 3], p[i]);
    }
    return [...low, ...high];
  };
  const results = [], none = { skin: null, inside: null, isOnPoints: false };
  for (const frame of window.parts.manifest.inputs.find((input) => input.name === name).frames) {
    const loaded = await window.parts.loadFrame(frame, []), { low, step } = frame.skin;
    const wanted = low[axis] + part * 1048575 * step[axis], planes = loaded.inside.planes[axis];
    const nearer = (a, b) => (Math.abs(b - wanted) < Math.abs(a - wanted) ? b : a);
    const at = planes.length ? planes.reduce(nearer) : wanted, cut = { axis, at, sign: 1, mode: "slice" };
    const cells = window.parts.crinkle(loaded, none, { ...cut, mode: "cells" }, () => 1);
    const slice = window.parts.slice(loaded, none, cut, () => 1);
    results.push({ frame: frame.frame, at, slice: area(slice), box: box(slice), cells: box(cells) });
  }
  done(results);
})().catch((error) => done(String(error)));"""


@pytest.fixture(scope="module")
def demo(motet, tmp_path_factory):
    """The folder written by `motet demo`."""
    folder = tmp_path_factory.mktemp("demo")
    motet("demo", folder, timeout=900)
    return folder


@pytest.mark.parametrize("name", ["aneurysm", "dissection"])
def test_cuts_of_each_frame_of_the_demo_agree_with_vtk(page, demo, tmp_path, name):
    pyvista = pytest.importorskip("pyvista")
    # Make the functions of the page accessible to the test.
    text, end = (demo / "report.html").read_text(), "\n})();\n</script>"
    assert text.count(end) == 1
    opened = text.replace(end, "\nwindow.parts = { manifest, loadFrame, slice, crinkle };" + end)
    (tmp_path / "open.html").write_text(opened)
    page.open(tmp_path / "open.html")
    page.driver.set_script_timeout(300)
    files = [demo / reader for reader in _files(demo / f"{name}.pvd")]
    for axis in (0, 2):
        results = page.driver.execute_async_script(CUT, f"{name}.pvd", axis, 0.47)
        assert isinstance(results, list) and len(results) == len(files), results
        for frame in results:
            grid = pyvista.read(files[frame["frame"]])
            volume = grid.extract_cells(grid.celltypes == pyvista.CellType.TETRA)
            normal, origin = [0.0, 0.0, 0.0], list(volume.center)
            normal[axis], origin[axis] = 1.0, frame["at"]
            cut, where = volume.slice(normal=normal, origin=origin), f"{name}, frame {frame['frame']}"
            assert frame["slice"] == pytest.approx(cut.area, rel=1e-3), where
            size = volume.length
            bounds = [cut.bounds[i] for i in (0, 2, 4, 1, 3, 5)]
            assert frame["box"] == pytest.approx(bounds, abs=1e-4 * size), where
            # Whole cells at the cut lie within the bounds of the mesh.
            outside = [volume.bounds[i] for i in (0, 2, 4, 1, 3, 5)]
            assert all(a >= b - 1e-4 * size for a, b in zip(frame["cells"][:3], outside[:3])), where
            assert all(a <= b + 1e-4 * size for a, b in zip(frame["cells"][3:], outside[3:])), where
    assert page.errors() == []


def _files(series):
    return re.findall(r'file="([^"]+)"', series.read_text())


def test_a_page_of_a_million_tets_opens_within_seconds_and_its_budget(page, motet, sphere, tmp_path):
    motet("refine", sphere[0] / "box.vtu", "-o", tmp_path / "fine.vtu", "--all", timeout=900)
    report = motet.json("report", tmp_path / "fine.vtu", "-o", tmp_path / "fine.html", timeout=900)
    size = (tmp_path / "fine.html").stat().st_size
    assert report["payload_bytes"] <= report["budget_bytes"] and size == report["bytes"] < 25e6
    assert report["inputs"][0]["whole"] == 1
    assert page.open(tmp_path / "fine.html") < 30
    assert page.colours()[1] > 0.1
    before = page.picture()
    page.put("cut", 0)
    for place in (250, 600):
        start = time.monotonic()
        page.put("part", place, "input")
        assert time.monotonic() - start < 15
        assert page.picture() != before
        before = page.picture()
    # With a fifth of the budget the page contains planes instead of all cells, and says so.
    report = motet.json("report", tmp_path / "fine.vtu", "-o", tmp_path / "small.html", "--budget", 6, timeout=900)
    assert report["payload_bytes"] <= 6e6 and report["inputs"][0]["cut"] == 1
    page.open(tmp_path / "small.html")
    page.put("cut", 0)
    assert "planes along each axis" in page.element("note").text
    assert page.colours()[1] > 0.1
    assert page.errors() == []


def test_without_webgl_the_page_shows_tables_and_charts(moved):
    page = Page("--disable-3d-apis")
    try:
        page.open(moved)
        assert page.element("no-view").is_displayed() and not page.element("viewer").is_displayed()
        assert page.js("return document.querySelectorAll('tbody tr').length") > 10
        assert page.element("eas-0").is_displayed()
    finally:
        page.close()


def test_without_scripts_the_page_shows_tables_and_charts(moved):
    page = Page("--blink-settings=scriptEnabled=false")
    try:
        page.driver.get(moved.as_uri())
        texts = [e.text for e in page.driver.find_elements("css selector", "noscript, summary, figcaption")]
        assert any("Certificate of each frame" in text for text in texts)
        assert any("EAS (quality of a tet): worst, 1 % and mean" in text for text in texts)
        assert not page.element("viewer").is_displayed()
    finally:
        page.close()
