"""A round trip through formats

A mesh is written in twelve formats and read again. The bars are the sizes of the files. All formats bring back each point
and each tet bit for bit; those in red lose the names of patches, and say so.
"""
import warnings
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import motet
from motet import shapes

warnings.simplefilter("ignore")  # what a format cannot hold; `save` returns the sentences as well
mesh = motet.mesh(shapes.aneurysm(), size="auto").mesh
sizes, colours = [], []
extensions = ["vtkhdf", "vtu", "xdmf", "cgns", "meshb", "mesh", "su2", "vol", "msh", "inp", "vtk", "unv"]
for extension in extensions:
    folder = Path("formats") / extension
    folder.mkdir(parents=True, exist_ok=True)
    lost = mesh.save(folder / f"mesh.{extension}")
    print(extension, *lost, sep="; ")
    back = motet.read(folder / f"mesh.{extension}")
    assert np.array_equal(back.points, mesh.points) and np.array_equal(back.tets, mesh.tets)
    sizes.append(sum(file.stat().st_size for file in folder.iterdir()) / 1e6)
    colours.append("steelblue" if set(back.patch_names.values()) == {"wall", "inlet", "outlet"} else "tomato")
figure, axes = plt.subplots(figsize=(9, 5), layout="constrained")
axes.bar_label(axes.barh([f".{extension}" for extension in extensions], sizes, color=colours), fmt="%.2f", padding=4)
axes.invert_yaxis()
axes.set(xlabel="MB", title=f"{len(mesh.tets)} tets, {mesh.n_points} points", xlim=(0, 2.4))
figure.savefig("round_trip.png", dpi=110)
