"""Reproduces table 2 of the paper: the limits below which a tet is of type I, II, III or IV (prints a table).

    target/venv/bin/python examples/paper/table_2.py

For each type there is a family of tets that degenerate with one parameter. Bisection finds the parameter at
which motet's classification changes; the measure at this parameter is evaluated here, independently of motet.
Lengths are relative to the mean edge length of the tet.
"""
from itertools import combinations

import numpy as np
from common import BAD, print_table

PAIRS = (((0, 1), (2, 3)), ((0, 2), (1, 3)), ((0, 3), (1, 2)))
NAMES = ("I", "II", "III", "IV", "other")
# Measures and limits of the paper.
PAPER = {"I": ("edge to edge", 0.18), "II": ("node to edge", 0.21), "III": ("EAS, foot within the facet", BAD), "IV": ("shortest edge", 0.2)}
# Distance from the limit of the tets that are shown below and above it.
BESIDE = 0.001
# Above the quality of all tets except the regular one, so that good tets are classified as well.
ALL = 0.99


def mean_edge(p):
    return np.mean([np.linalg.norm(p[i] - p[j]) for i, j in combinations(range(4), 2)])


def edge_to_edge(p):
    """Return the least distance between the lines of two opposite edges, relative to the mean edge length."""
    normals = [np.cross(p[b] - p[a], p[d] - p[c]) for (a, b), (c, d) in PAIRS]
    gaps = [abs(n @ (p[c] - p[a])) / np.linalg.norm(n) for n, ((a, _), (c, _)) in zip(normals, PAIRS)]
    return min(gaps) / mean_edge(p)


def node_to_edge(p):
    """Return the least distance of a vertex from the line of another edge, relative to the mean
    edge length."""
    def distance(v, i, j):
        edge = p[j] - p[i]
        return np.linalg.norm(np.cross(p[v] - p[i], edge)) / np.linalg.norm(edge)

    return min(distance(v, i, j) for i, j in combinations(range(4), 2) for v in range(4) if v not in (i, j)) / mean_edge(p)


def shortest_edge(p):
    return min(np.linalg.norm(p[i] - p[j]) for i, j in combinations(range(4), 2)) / mean_edge(p)


def equi_angle(p):
    """Return 1 minus Verdict's equi-angle skew, from dihedral angles (ideal 70.53 degrees) and facet angles
    (60)."""
    def angle(u, v):
        return np.degrees(np.arccos(u @ v / np.linalg.norm(u) / np.linalg.norm(v)))

    def across(i, j, k, m):
        axis = (p[j] - p[i]) / np.linalg.norm(p[j] - p[i])
        return angle(*[(p[q] - p[i]) - ((p[q] - p[i]) @ axis) * axis for q in (k, m)])

    regular = np.degrees(np.arccos(1.0 / 3.0))
    dihedral = [across(*edge, *[v for v in range(4) if v not in edge]) for edge in combinations(range(4), 2)]
    plane = [angle(p[j] - p[i], p[k] - p[i]) for i in range(4) for j, k in combinations([v for v in range(4) if v != i], 2)]
    skews = [max((max(a) - best) / (180.0 - best), (best - min(a)) / best) for a, best in ((dihedral, regular), (plane, 60.0))]
    return 1.0 - max(skews)


def sliver(h):
    """Return a tet with two opposite edges that cross at their midpoints at a distance `h`."""
    return np.array([[-1, 0, 0], [1, 0, 0], [0, -1, h], [0, 1, h]], float)


def spade(h):
    """Return a tet with a vertex at a distance `h` from an edge, near its midpoint."""
    return np.array([[-1, 0, 0], [1, 0, 0], [0, 0.9, 0.9], [0.1, -h, 0]], float)


def cap(h):
    """Return a tet with a vertex at a height `h` above the centre of a facet."""
    return np.array([[1, 0, 0], [-0.5, 0.75**0.5, 0], [-0.5, -(0.75**0.5), 0], [0, 0, h]], float)


def needle(h):
    """Return a tet with a vertex at a distance `h` from another one, and five long edges."""
    return np.array([[1, 0, 0], [-0.5, 0.75**0.5, 0], [-0.5, -(0.75**0.5), 0], [1 - h / 2, 0, h * 0.75**0.5]], float)


FAMILIES = {"I": (sliver, edge_to_edge), "II": (spade, node_to_edge), "III": (cap, equi_angle), "IV": (needle, shortest_edge)}


def classified(points, kind):
    """Return motet's classification of a tet: a type, other, or good.

    Type III contains the bad tets that are of no other type, so its limit is that of bad tets.
    """
    import motet

    # With positive orientation.
    tet = [0, 1, 2, 3] if np.linalg.det(points[1:] - points[0]) > 0 else [1, 0, 2, 3]
    types = motet.remesh(motet.Mesh(points, np.array([tet])), min_eas=BAD if kind == "III" else ALL, threads=1).report.before.types
    return next((name for name, count in zip(NAMES, types) if count), "good")


def bisected(is_below, low, high):
    """Return the number at which a predicate changes from true to false."""
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_below(middle) else (low, middle)
    return 0.5 * (low + high)


def row(kind):
    make, measure = FAMILIES[kind]
    name, limit = PAPER[kind]
    changes = bisected(lambda h: classified(make(h), kind) == kind, 1e-6, 1.0)
    beside = [bisected(lambda h, x=limit + off: measure(make(h)) < x, 1e-6, 1.0) for off in (-BESIDE, BESIDE)]
    results = [f"{measure(make(h)):.3f}: {classified(make(h), kind)}" for h in beside]
    return [kind, name, f"< {limit:g}", f"< {measure(make(changes)):.6f}", *results]


def main():
    head = ["type", "measure", "paper", "motet", "just below", "just above"]
    print_table(head, [row(kind) for kind in FAMILIES])


if __name__ == "__main__":
    main()
