"""Runs the example of the Python package with its window saved to a file (writes docs/python.png).

    pip install ./python pyvista
    python docs/python_picture.py
"""
from pathlib import Path

import pyvista

HERE = Path(__file__).resolve().parent
pyvista.OFF_SCREEN = True
plot = pyvista.UnstructuredGrid.plot
pyvista.UnstructuredGrid.plot = lambda grid, **options: plot(grid, **options, screenshot=HERE / "python.png", window_size=(1000, 640))
exec((HERE.parent / "python" / "examples" / "story.py").read_text())
