"""Makes the pictures of the gallery: runs its scripts without a window.

    python docs/site/pictures.py FOLDER [NAME...]        all pictures, or these
"""
import contextlib
import os
import runpy
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import pyvista as pv  # noqa: E402

SCRIPTS = sorted((Path(__file__).resolve().parent.parent / "gallery").glob("*.py"))


def draw(script, folder, size=(960, 640)):
    """Run a script in a folder and return the picture that it writes there."""
    set_theme(size)
    with contextlib.chdir(folder):
        runpy.run_path(str(script), run_name="__main__")
    picture = Path(folder) / f"{script.stem}.png"
    if not picture.exists():
        raise FileNotFoundError(f"{script.name} wrote no {picture.name}")
    return picture


def set_theme(size):
    """Let PyVista draw without a window, with an upright colour bar whose title and labels do not overlap."""
    pv.OFF_SCREEN = True
    theme = pv.global_theme
    theme.window_size = list(size)
    theme.anti_aliasing = "ssaa"
    theme.font.family, theme.font.title_size, theme.font.label_size, theme.font.fmt = "arial", 18, 16, "%.2g"
    theme.colorbar_orientation = "vertical"
    bar = theme.colorbar_vertical
    bar.position_x, bar.position_y, bar.width, bar.height = 0.87, 0.25, 0.06, 0.5


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    os.makedirs(sys.argv[1], exist_ok=True)
    for script in SCRIPTS:
        if script.stem in sys.argv[2:] or not sys.argv[2:]:
            print(draw(script, sys.argv[1]))
