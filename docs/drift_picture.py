"""Draws numbers of vertices and mean quality over long motions (writes docs/drift.png).

    bench-compare/run drift --cases flap,ventricle,cube --cycles 50
    bench-compare/run drift --cases paddle
    motet run job.toml --threads 1              in bench-compare/target/drift/paddle, with steps = 7200 and
                                                degrees = 36000 in job.toml
    target/venv/bin/python docs/drift_picture.py

Reads the logs of `bench-compare/run drift`. Each line is a case of that benchmark: the number of vertices
relative to the initial number, and the mean EAS, at the end of each turn or cycle. Bands show the minimum and
maximum of all steps within a turn or cycle.
"""
import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).resolve().parent
RUNS = HERE.parent / "bench-compare" / "target" / "drift"
# Name: number of steps in a turn or cycle, and colour.
CASES = {"paddle": (72, "#17607a"), "flap": (24, "#e0583f"), "ventricle": (25, "#8a9a5b"), "cube": (24, "#c99a3b")}


def log(case):
    path = RUNS / case / "out" / "run.jsonl"
    if not path.is_file():
        return []
    return [json.loads(line) for line in path.read_text().splitlines()]


def draw(axes, values, steps, colour, label):
    """Draw the values at the ends of cycles, and a band from the minimum to the maximum within each cycle."""
    n = (len(values) - 1) // steps
    ends = [values[k * steps] for k in range(n + 1)]
    within = [values[k * steps:(k + 1) * steps + 1] for k in range(n)]
    at = [k + 0.5 for k in range(n)]
    axes.fill_between(at, [min(part) for part in within], [max(part) for part in within], color=colour, alpha=0.18, lw=0)
    axes.plot(range(n + 1), ends, color=colour, lw=1.4, label=label)


def main():
    figure, (counts, means) = plt.subplots(1, 2, figsize=(11, 4.2), sharex=True)
    for case, (steps, colour) in CASES.items():
        lines = log(case)
        if not lines:
            continue
        draw(counts, [line["points"] / lines[0]["points"] for line in lines], steps, colour, case)
        eas = [line["quality"]["mean"] for line in lines]
        draw(means, eas, steps, colour, case)
        ends = eas[::steps]
        half = len(ends) // 2
        print(f"{case}: {len(eas) - 1} steps, {min(line['points'] for line in lines)} to {max(line['points'] for line in lines)} vertices;"
              f" mean EAS {sum(eas) / len(eas):.3f} over all steps, least {min(eas):.3f};"
              f" at the ends of cycles {min(ends[1:]):.3f} to {max(ends[1:]):.3f}, of the first half {sum(ends[1:half + 1]) / half:.3f}, of the last {sum(ends[-half:]) / half:.3f};"
              f" last change in step {max((line['step'] for line in lines if line['changes']), default=0)}")
    counts.axhline(1, color="#bbbbbb", lw=0.8, zorder=0)
    counts.set(xlabel="turns or cycles", ylabel="vertices, as a part of those at first", ylim=(0.95, 1.05))
    means.set(xlabel="turns or cycles", ylabel="mean EAS", ylim=(0.45, 0.8))
    means.legend(frameon=False, ncol=4, loc="lower right")
    for axes in (counts, means):
        axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(HERE / "drift.png", dpi=110)


if __name__ == "__main__":
    main()
