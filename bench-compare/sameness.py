"""What two tet meshes, or a surface and its filling, have in common: corners compared bit by bit, and to 1e-9."""
import numpy as np

from tets import boundary

NEAR = 1e-9


def matched(old, new):
    """For each new point the old one at its place (-1: none within 1e-9), and whether they agree to the bit."""
    from scipy.spatial import cKDTree

    distance, row = cKDTree(old).query(new, distance_upper_bound=NEAR)
    found = np.isfinite(distance)
    row = np.where(found, row, -1)
    to_the_bit = found & (old[row].view(np.int64) == new.view(np.int64)).all(axis=1)
    return row, to_the_bit


def shared(old, new):
    """How many rows of `new` are rows of `old`; the order within a row does not count."""
    rows = np.sort(np.concatenate([np.unique(np.sort(part, axis=1), axis=0) for part in (old, new)]), axis=1)
    _, count = np.unique(rows, axis=0, return_counts=True)
    return int((count > 1).sum())


def kept(old, new, row, to_the_bit):
    """Of the old cells, how many are among the new ones to the bit, and how many to 1e-9."""
    return [shared(old, row[new[keep[new].all(axis=1)]]) for keep in (to_the_bit, row >= 0)]


def compared(old_points, old_tets, points, tets):
    """Shares of the old tets kept to the bit and to 1e-9, tets touched, and how exact the boundary is."""
    row, to_the_bit = matched(old_points, np.ascontiguousarray(points, np.float64))
    bits, near = kept(old_tets, tets, row, to_the_bit)
    old_facets, facets = boundary(old_tets), boundary(tets)
    facet_bits, facet_near = kept(old_facets, facets, row, to_the_bit)
    whole = len(old_facets) if len(old_facets) == len(facets) else -1
    edge = "exact" if facet_bits == whole else "to 1e-9" if facet_near == whole else "changed"
    return {"kept": bits / len(old_tets), "kept_near": near / len(old_tets), "touched": len(old_tets) - near, "boundary": edge}


def surface_kept(old_points, triangles, points, tets):
    """How many of the triangles are facets of the boundary, to the bit, and how many facets it has beyond these."""
    row, to_the_bit = matched(old_points, np.ascontiguousarray(points, np.float64) + 0.0)  # no negative zeros
    facets = boundary(tets)
    found, _ = kept(triangles, facets, row, to_the_bit)
    return found, len(facets) - found
