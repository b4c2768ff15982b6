"""Draws the picture of docs/view.md: a coil is dragged to the wall of an aneurysm.

    ./test --setup && target/venv/bin/python -m pip install ./python    (once; needs Chromium)
    cargo build --release
    target/venv/bin/python docs/view_picture.py           (writes docs/view.png)
"""
import sys
import tempfile
from pathlib import Path

import motet
from program import binary

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "crosscheck"))
from test_view import ActionChains, Window  # noqa: E402


def vessel(path):
    """Write an aneurysm with a coil in it."""
    host = motet.mesh(motet.shapes.aneurysm(), size="auto").mesh
    motet.implant(host, {"coil": motet.shapes.coil((0, 2.3, 0), radius=0.5)}, inside="hollow").mesh.save(path)


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "vessel_with_coil.vtu"
        vessel(path)
        window = Window(binary(), path)
        window.driver.set_window_size(1400, 700)
        window.put("grabbed", "coil")
        for _ in range(4):
            ActionChains(window.driver).send_keys_to_element(window.element("view"), "+").perform()
        with window.held(25, 45):
            window.driver.save_screenshot(str(HERE / "view.png"))
        print(window.said())
        window.close()


if __name__ == "__main__":
    main()
