"""What the scripts of this folder share: where things are, how motet is called, how a sheet of pictures is laid out."""
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
WORK = ROOT / "target" / "paper"
SUFFIX = ".exe" if os.name == "nt" else ""
# The limit of the paper, figure 11: tets with an EAS below it are bad.
BAD = 0.2
COPPER = "#b5652f"
PALE = "#f1f3f5"
# Lines of tets in pictures.
EDGES = dict(show_edges=True, edge_color="#22303c", line_width=0.8, edge_opacity=0.5, ambient=0.65, diffuse=0.4, specular=0.0)

sys.path.append(str(DOCS))


def binary():
    """The program: $MOTET, or the one that `cargo build --release` makes."""
    path = Path(os.environ.get("MOTET") or ROOT / "target" / "release" / f"motet{SUFFIX}")
    if not path.exists():
        sys.exit(f"{path} is not there: cargo build --release, or say in MOTET where it is")
    return path


def motet_json(*words):
    """Calls the program with --json; its report."""
    done = subprocess.run([str(binary()), *map(str, words), "--json"], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        sys.exit(f"motet {' '.join(map(str, words))}: exit status {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def work(name):
    """A file of this name among those that are made on the way."""
    WORK.mkdir(parents=True, exist_ok=True)
    return WORK / name


def patch_triangles(mesh, name):
    """The triangles of a patch, as rows of vertices."""
    label = next(number for number, word in mesh.patch_names.items() if word == name)
    return mesh.triangles[mesh.cell_data["patch"][mesh.cell_ids("triangle")] == label]


def surface(points, triangles, name):
    """A surface of these triangles and no other points, of one patch."""
    import motet

    used, rows = np.unique(triangles, return_inverse=True)
    return motet.Mesh(
        np.asarray(points)[used],
        {"triangle": rows.reshape(-1, 3)},
        cell_data={"patch": np.ones(len(triangles), np.int32)},
        patch_names={1: name},
    )


def grid(mesh, **arrays):
    """The tets of a mesh for drawing, with their EAS and more arrays, a row a tet."""
    import pyvista as pv

    drawn = pv.UnstructuredGrid({pv.CellType.TETRA: mesh.tets}, mesh.points)
    drawn["EAS"] = mesh.quality()[mesh.cell_ids("tetra")]
    for name, values in arrays.items():
        drawn.cell_data[name] = values
    return drawn


def poly(mesh, triangles=None):
    """Triangles of a mesh for drawing: all, or these rows."""
    import pyvista as pv

    rows = mesh.triangles if triangles is None else triangles
    return pv.PolyData.from_regular_faces(mesh.points, rows)


def behind(drawn, axis, at=0.0):
    """The cells of a grid whose middle lies beyond a plane, seen from its lower side."""
    return drawn.extract_cells(drawn.cell_centers().points[:, axis] > at)


def save_sheet(pictures, columns, path, bar=None):
    """Pictures of one size in rows, each with its text below; `bar` draws a scale under all of them."""
    from PIL import Image, ImageDraw
    from pictures import INK, font, save

    width, height = pictures[0][0].size
    rows = -(-len(pictures) // columns)
    foot = 52 if bar else 0
    sheet = Image.new("RGB", (columns * width, rows * (height + 40) + foot), "white")
    draw = ImageDraw.Draw(sheet)
    for i, (picture, text) in enumerate(pictures):
        left, top = i % columns * width, i // columns * (height + 40)
        sheet.paste(picture, (left, top))
        draw.text((left + width // 2, top + height + 8), text, fill=INK, font=font(17), anchor="ma")
    if bar:
        bar(draw, sheet.width // 2 - 180, sheet.height - foot + 6, 360)
    save(sheet, path)


def bar_of(colours, limits, ticks, name):
    """A scale for `save_sheet`."""
    from pictures import INK, font

    def draw_bar(draw, left, top, width):
        for x in range(width):
            colour = tuple(int(255 * c) for c in colours(x / (width - 1))[:3])
            draw.line([(left + x, top), (left + x, top + 12)], fill=colour)
        for value in ticks:
            x = left + int((value - limits[0]) / (limits[1] - limits[0]) * (width - 1))
            draw.text((x, top + 17), f"{value:g}", fill=INK, font=font(14), anchor="ma")
        draw.text((left - 14, top + 6), name, fill=INK, font=font(15), anchor="rm")

    return draw_bar


def quality_bar():
    from pictures import QUALITY, RANGE

    return bar_of(QUALITY, RANGE, (0.0, 0.2, 0.4, 0.6, 0.8), "EAS")


def print_table(head, rows):
    """A table as Markdown has it."""
    for row in (head, ["---"] * len(head), *rows):
        print("| " + " | ".join(map(str, row)) + " |")
