"""Common cells of two tet meshes, or of a surface and its mesh, with coordinates compared exactly and to
1e-9."""
import numpy as np

from tets import FACETS, boundary

NEAR = 1e-9


def matched(old, new):
    """Return for each new point the old one within 1e-9 (-1 for none), and whether they are exactly equal."""
    from scipy.spatial import cKDTree

    distance, row = cKDTree(old).query(new, distance_upper_bound=NEAR)
    found = np.isfinite(distance)
    row = np.where(found, row, -1)
    to_the_bit = found & (old[row].view(np.int64) == new.view(np.int64)).all(axis=1)
    return row, to_the_bit


def shared(old, new):
    """Count the rows of `new` that are rows of `old`, regardless of the order within a row."""
    rows = np.sort(np.concatenate([np.unique(np.sort(part, axis=1), axis=0) for part in (old, new)]), axis=1)
    _, count = np.unique(rows, axis=0, return_counts=True)
    return int((count > 1).sum())


def kept(old, new, row, to_the_bit):
    """Count the old cells that are among the new ones exactly, and to 1e-9."""
    return [shared(old, row[new[keep[new].all(axis=1)]]) for keep in (to_the_bit, row >= 0)]


def compared(old_points, old_tets, points, tets):
    """Return the shares of old tets kept exactly and to 1e-9, the number of changed tets, and the boundary's
    accuracy."""
    row, to_the_bit = matched(old_points, np.ascontiguousarray(points, np.float64))
    bits, near = kept(old_tets, tets, row, to_the_bit)
    old_facets, facets = boundary(old_tets), boundary(tets)
    facet_bits, facet_near = kept(old_facets, facets, row, to_the_bit)
    whole = len(old_facets) if len(old_facets) == len(facets) else -1
    edge = "exact" if facet_bits == whole else "to 1e-9" if facet_near == whole else "changed"
    return {"kept": bits / len(old_tets), "kept_near": near / len(old_tets), "touched": len(old_tets) - near, "boundary": edge}


def surface_kept(old_points, triangles, points, tets):
    """Count the triangles that are exactly facets of the boundary, and the other facets of the boundary."""
    row, to_the_bit = matched(old_points, np.ascontiguousarray(points, np.float64) + 0.0)  # no negative zeros
    facets = boundary(tets)
    found, _ = kept(triangles, facets, row, to_the_bit)
    return found, len(facets) - found


def surface_lost(old_points, triangles, points, tets):
    """Count the triangles that are no facet, neither of the boundary nor between tets, exactly."""
    row, to_the_bit = matched(old_points, np.ascontiguousarray(points, np.float64) + 0.0)
    return len(triangles) - kept(triangles, tets[:, FACETS].reshape(-1, 3), row, to_the_bit)[0]
