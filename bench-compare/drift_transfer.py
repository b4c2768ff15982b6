"""Errors of transferred fields over a long motion: a rotating paddle, compared with complete remeshing after
each turn.

Fields on points are transferred by both rules.
"""
import json
import subprocess

from common import MOTET, table
from drift_cases import PADDLE_SIZE

NAME = "transfer"
STEPS = 72  # number of steps in a turn
PROGRAM = MOTET / "examples" / "transfer_drift"


def run(record, options, case):
    """Run the paddle's `case`, and for comparison a new mesh after each turn, and as many new meshes as
    changes."""
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
    print_table(turns, rows)


def lines(arguments, folder):
    """Return the objects that the program prints, one per turn."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(" ".join(done.stderr.split())[:200])
    return [json.loads(line) for line in done.stdout.splitlines()]


def print_table(turns, rows):
    print(f"\n## Errors of transferred fields: {NAME}\n")
    print(f"A paddle rotates {turns} times in its box; fields are functions of position, and motion of vertices causes no error. \"Smooth\": L2 error of the field relative\n"
          "to the interpolant on the same mesh, over the norm of the function; \"own\": error of that interpolant. \"Linear\": largest error, relative to the range.\n"
          "\"Density\": largest change of the integral in one change of the mesh; \"contents\": over all.\n")
    header = ["program", "turns", "changes", "linear", "density", "contents", "smooth, 1 turn", "half of the turns", "all", "largest", "own", "/motet"]
    ours = rows["motet, mean"][-1]["smooth"]
    print(table(header, [columns(program, part, ours) for program, part in rows.items()]))


def columns(program, part, ours):
    first, half, last = part[0], part[(len(part) - 1) // 2], part[-1]
    error = lambda key: f"{last[key]:.0e}" if key in last else "-"
    return [program, last["turn"], last["changes"], error("linear"), error("conserved"), error("contents"), f"{first['smooth']:.2e}",
            f"{half['smooth']:.2e}", f"{last['smooth']:.2e}", f"{last['most']:.2e}", f"{last['own']:.2e}", f"{last['smooth'] / ours:.2f}"]
