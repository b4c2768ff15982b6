"""Makes the pictures of the gallery: runs its scripts without a window.

    python docs/site/draw.py FOLDER [NAME...]        all pictures that are older than their scripts or motet; or these
"""
import contextlib
import os
import runpy
import sys
import time
from pathlib import Path

import matplotlib
import motet
import pyvista as pv
from PIL import Image, ImageChops, ImageOps
from vtkmodules.vtkCommonCore import vtkLogger

SCRIPTS = sorted((Path(__file__).resolve().parent.parent / "gallery").glob("*.py"))
MARGIN = 16


def draw(script, folder, size=(960, 640)):
    """Run a script in a folder, and return the picture that it writes there, without its empty margins.

    What the script prints is in NAME.txt beside it.
    """
    set_theme(size)
    with contextlib.chdir(folder), open(f"{script.stem}.txt", "w", encoding="utf-8") as printed, contextlib.redirect_stdout(printed):
        runpy.run_path(str(script), run_name="__main__")
    picture = Path(folder) / f"{script.stem}.png"
    if not picture.exists():
        raise FileNotFoundError(f"{script.name} wrote no {picture.name}")
    trim(picture)
    return picture


def set_theme(size):
    """Let PyVista and Matplotlib draw without a window; with an upright colour bar whose title and labels do not overlap."""
    matplotlib.use("Agg")
    pv.OFF_SCREEN = True
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # without a display it warns of that
    theme = pv.global_theme
    theme.window_size = list(size)
    theme.anti_aliasing = "ssaa"
    theme.font.family, theme.font.title_size, theme.font.label_size, theme.font.fmt = "arial", 18, 16, "%.2g"
    theme.colorbar_orientation = "vertical"
    bar = theme.colorbar_vertical
    bar.position_x, bar.position_y, bar.width, bar.height = 0.87, 0.25, 0.06, 0.5


def trim(path):
    """Make the empty margins of a picture equal and narrow."""
    image = Image.open(path).convert("RGB")
    box = ImageChops.difference(image, Image.new("RGB", image.size, "white")).getbbox()
    if box is None:
        raise ValueError(f"{path.name} is empty")
    ImageOps.expand(image.crop(box), MARGIN, "white").save(path, optimize=True)


def is_current(script, picture):
    sources = [script, Path(__file__), *Path(motet.__file__).parent.glob("_motet*")]
    return picture.exists() and all(picture.stat().st_mtime > source.stat().st_mtime for source in sources)


def main(folder, names):
    os.makedirs(folder, exist_ok=True)
    for script in SCRIPTS:
        if script.stem in names or not (names or is_current(script, Path(folder) / f"{script.stem}.png")):
            start = time.monotonic()
            picture = draw(script, folder)
            print(f"{picture}: {picture.stat().st_size // 1024} kB, {time.monotonic() - start:.1f} s", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
