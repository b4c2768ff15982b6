"""A page to hand on

`motet report` writes one HTML page that works offline: a view to turn, cut and play, histograms, charts and tables. The
picture is the page in Chromium.
"""
import shutil
import subprocess
import sys
from pathlib import Path

import motet
from motet import shapes

moved = motet.move(shapes.sphere_in_box(8, 6), translate={"sphere": (3, 0, 0)}).mesh
moved.save("moved.vtu")
motet.remesh(moved).mesh.save("repaired.vtu")
words = ["moved.vtu", "repaired.vtu", "-o", "report.html", "--title", "A sphere has moved: before and after the repair"]
subprocess.run([sys.executable, "-m", "motet", "report", *words, "-q"], check=True)

browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
flags = "--headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --window-size=1200,1000 --virtual-time-budget=8000"
page = Path("report.html").resolve().as_uri()
subprocess.run([browser, *flags.split(), "--screenshot=report.png", page], check=True, stderr=subprocess.DEVNULL)
