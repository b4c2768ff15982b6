"""The log of a run as a chart

`motet run` takes a sphere through its box for two periods. `motet.read_log` reads its log into a data frame of pandas,
with a row for each step.
"""
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt

import motet
from motet import shapes

shapes.sphere_in_box(6, 6).save("box.vtu")
motion = '[[motion.move]]\npatch = "sphere"\nshift = [3.5, 0, 0]\nin_time = "beat"\n'
Path("job.toml").write_text(f'mesh = "box.vtu"\noutput = "out/box.pvd"\n\n[time]\nsteps = 10\nperiods = 2\n\n{motion}')
subprocess.run([sys.executable, "-m", "motet", "run", "job.toml", "-q"], check=True)
log = motet.read_log("out/box.jsonl")

figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(9, 5.5), layout="constrained")
for name, label in (("mean", "mean"), ("median", "median"), ("p1", "1 % below"), ("worst", "worst")):
    above.plot(log.time, log[f"quality.{name}"], marker=".", label=label)
above.axhspan(0, 0.2, color="red", alpha=0.1)
above.set(ylabel="EAS", ylim=(0, 1))
above.legend(ncols=4, frameon=False)
below.step(log.time, log.tets, where="mid", color="black")
below.plot(log.time[log.changes > 0], log.tets[log.changes > 0], "o", color="tomato", label="steps that changed the mesh")
below.set(xlabel="time in periods", ylabel="tets")
below.legend(frameon=False)
figure.savefig("log.png", dpi=110)
