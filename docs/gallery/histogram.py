"""Quality before and after

The vertices inside a mesh were thrown about. The histogram shows the quality of all tets before, after a repair of the
bad ones, and with all of them made as good as possible.
"""
import matplotlib.pyplot as plt
import numpy as np

import motet
from motet import shapes

shaken = motet.mesh(shapes.aneurysm(), size="auto").mesh
inside = np.setdiff1d(np.arange(shaken.n_points), shaken.triangles)
shaken.points[inside] += np.random.default_rng(1).normal(scale=0.08, size=(len(inside), 3))
repaired = motet.remesh(shaken).mesh
best = motet.remesh(shaken, goal="best").mesh

figure, axes = plt.subplots(figsize=(9, 5), layout="constrained")
for mesh, text in ((shaken, "before"), (repaired, "repaired"), (best, 'goal="best"')):
    eas = mesh.quality()[mesh.cell_ids("tetra")]
    worst, p1, median = np.percentile(eas, [0, 1, 50])
    label = f"{text}: worst {worst:.2f}, 1 % {p1:.2f}, median {median:.2f}, mean {eas.mean():.2f}"
    axes.hist(eas, bins=np.linspace(-0.8, 1, 73), histtype="step", linewidth=2, label=label)
axes.axvspan(-0.8, 0.2, color="red", alpha=0.1, label="bad; inverted below 0")
axes.set(xlabel="EAS", ylabel="tets", xlim=(-0.8, 1))
axes.legend(loc="upper left", frameon=False)
figure.savefig("histogram.png", dpi=120)
