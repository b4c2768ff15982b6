"""Volumes, angles, quality and boundary of tets in numpy."""
import numpy as np

FACETS = np.array([(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)])  # opposite each corner; outward when the tet is positive
EDGES = np.array([(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)])
REGULAR = np.degrees(np.arccos(1 / 3))  # the dihedral angle of the regular tet
BAD = 0.2  # a tet with a smaller EAS is bad


def dot(a, b):
    return np.einsum("ij,ij->i", a, b)


def angle(a, b):
    """Return the angles between vectors, row by row, in degrees."""
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), dot(a, b)))


def volumes(points, tets):
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    return dot(np.cross(b - a, c - a), d - a) / 6


def dihedrals(points, tets):
    """Return the smallest and largest dihedral angle of each tet, in degrees."""
    normals = []
    for facet in FACETS:
        a, b, c = (points[tets[:, i]] for i in facet)
        normals.append(np.cross(b - a, c - a))
    angles = [180 - angle(normals[i], normals[j]) for i, j in EDGES]
    return np.minimum.reduce(angles), np.maximum.reduce(angles)


def facet_angles(points, tets):
    """Return the smallest and largest angle of the four facets of each tet, in degrees."""
    angles = []
    for facet in FACETS:
        for turn in range(3):
            a, b, c = (points[tets[:, i]] for i in np.roll(facet, turn))
            angles.append(angle(b - a, c - a))
    return np.minimum.reduce(angles), np.maximum.reduce(angles)


def eas(points, tets):
    """Return the equi-angle quality: the sign of the volume times 1 - skew, with Verdict's
    `tet_equiangle_skew`."""
    skews = []
    for (least, greatest), best in ((dihedrals(points, tets), REGULAR), (facet_angles(points, tets), 60)):
        skews += [(greatest - best) / (180 - best), (best - least) / best]
    return np.sign(volumes(points, tets)) * (1 - np.maximum.reduce(skews))


def measures(points, tets):
    """Return the numbers of bad and inverted tets, quality and angles."""
    quality, (least, greatest) = eas(points, tets), dihedrals(points, tets)
    return {"tets": len(tets), "bad": int((quality < BAD).sum()), "inverted": int((quality <= 0).sum()),
            "worst": float(quality.min()), "fifth_percentile": float(np.percentile(quality, 5)),
            "least_dihedral": float(least.min()), "fifth_percentile_dihedral": float(np.percentile(least, 5)),
            "greatest_dihedral": float(greatest.max())}


def mean_ratio(points, tets):
    """Return 12 (3 V)^(2/3) over the sum of squared edge lengths, with the sign of V (Liu and Joe 1994)."""
    volume = volumes(points, tets)
    squares = sum(dot(edge, edge) for edge in (points[tets[:, i]] - points[tets[:, j]] for i, j in EDGES))
    return np.sign(volume) * 12 * np.cbrt(3 * np.abs(volume)) ** 2 / squares


def spread(points, tets):
    """Return percentiles and mean of the EAS of all tets, and the mean of their mean ratios."""
    quality = eas(points, tets)
    p1, p5, median = np.percentile(quality, (1, 5, 50))
    return {"worst": float(quality.min()), "p1": float(p1), "p5": float(p5), "median": float(median),
            "mean": float(quality.mean()), "mean_ratio": float(mean_ratio(points, tets).mean())}


def boundary(tets):
    """Return the facets that belong to only one tet, facing outward."""
    facets = tets[:, FACETS].reshape(-1, 3)
    key = np.sort(facets, axis=1).astype(np.int64)
    key = (key[:, 0] << 42) | (key[:, 1] << 21) | key[:, 2]  # up to two million vertices
    _, first, count = np.unique(key, return_index=True, return_counts=True)
    return facets[np.sort(first[count == 1])]
