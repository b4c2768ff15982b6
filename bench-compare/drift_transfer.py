"""What changes of the mesh make of fields over a long motion: the paddle that turns, beside a new mesh of everything after each turn; fields on points carried by both rules."""
import json
import subprocess

from common import MOTET, table
from drift_cases import PADDLE_SIZE

NAME = "transfer"
STEPS = 72  # in a turn
PROGRAM = MOTET / "examples" / "transfer_drift"


def run(record, options, case):
    """The row of the paddle's `case`, and those that it is compared with: a new mesh after each turn, and as many of them as the paddle's mesh has had changes."""
    turns = case.cycles
    case.make()
    rows = {}
    for rule in ("mean", "linear"):
        turn = ["turn", case.mesh, "--turns", turns, "--steps", 12 if options.quick else STEPS]
        rows[f"motet, {rule}"] = lines([*turn, "--rule", rule], case.folder)
    each = round(rows["motet, mean"][-1]["changes"] / turns)
    for name, times, rule in (("new mesh each turn", 1, "linear"), ("new mesh each turn", 1, "mean"), ("new mesh each change", each, "linear")):
        anew = ["anew", case.mesh, "--turns", turns, "--each", times, "--size", PADDLE_SIZE]
        rows[f"{name}, {rule}"] = lines([*anew, "--rule", rule], case.folder)
    for program, parts in rows.items():
        for part in parts:
            record.add(**part, bench="drift", case=NAME, program=program)
    tell(turns, rows)


def lines(words, folder):
    """The objects that the program prints, one a turn."""
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(" ".join(done.stderr.split())[:200])
    return [json.loads(line) for line in done.stdout.splitlines()]


def tell(turns, rows):
    print(f"\n## What changes make of fields: {NAME}\n")
    print(f"A paddle turns {turns} times in its box; fields are functions of the place, and moves of vertices make no error. \"Smooth\": L2 error of the field against\n"
          "the interpolant on the same mesh, over the norm of the function; \"own\": of that interpolant against the function. \"Linear\": the largest error, of the range.\n"
          "\"Density\": the integral over one change, at most; \"contents\": over all.\n")
    header = ["program", "turns", "changes", "linear", "density", "contents", "smooth, 1 turn", "half of the turns", "all", "largest", "own", "/motet"]
    ours = rows["motet, mean"][-1]["smooth"]
    print(table(header, [columns(program, part, ours) for program, part in rows.items()]))


def columns(program, part, ours):
    first, half, last = part[0], part[(len(part) - 1) // 2], part[-1]
    off = lambda key: f"{last[key]:.0e}" if key in last else "-"
    return [program, last["turn"], last["changes"], off("linear"), off("conserved"), off("contents"), f"{first['smooth']:.2e}",
            f"{half['smooth']:.2e}", f"{last['smooth']:.2e}", f"{last['most']:.2e}", f"{last['own']:.2e}", f"{last['smooth'] / ours:.2f}"]
