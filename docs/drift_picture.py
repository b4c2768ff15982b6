"""Counts and mean quality over long motions: draws docs/drift.png from the logs of `bench-compare/run drift`.

    bench-compare/run drift
    target/venv/bin/python docs/drift_picture.py

Each line is a case of that benchmark, as far as its run went: how many vertices, and the mean EAS, beside those of the first mesh.
"""
import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).resolve().parent
RUNS = HERE.parent / "bench-compare" / "target" / "drift"
COLOURS = {"paddle": "#17607a", "paddle-delaunay": "#5fb3b3", "channel": "#e0583f", "ellipsoid": "#c99a3b", "bar": "#7a5c99", "flap": "#22303c",
           "ventricle": "#8a9a5b", "cube": "#b5838d"}


def log(case):
    path = RUNS / case / "out" / "run.jsonl"
    if not path.is_file():
        return []
    return [json.loads(line) for line in path.read_text().splitlines()]


def main():
    figure, (counts, means) = plt.subplots(1, 2, figsize=(11, 4.2), sharex=True)
    for case, colour in COLOURS.items():
        steps = log(case)
        if not steps or "quality" not in steps[0]:
            continue
        at = [step["step"] for step in steps]
        counts.plot(at, [step["points"] / steps[0]["points"] for step in steps], color=colour, lw=1.2, label=case)
        means.plot(at, [step["quality"]["mean"] for step in steps], color=colour, lw=1.2, label=case)
    counts.axhline(1, color="#bbbbbb", lw=0.8, zorder=0)
    counts.set(xlabel="step", ylabel="vertices, as a part of the first", ylim=(0.9, 1.1))
    means.set(xlabel="step", ylabel="mean EAS", ylim=(0.4, 0.8))
    means.legend(fontsize=8, ncol=2, frameon=False)
    for axes in (counts, means):
        axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(HERE / "drift.png", dpi=110)


if __name__ == "__main__":
    main()
