//! Points inside, for sizes that grow from the surface: a lattice of nested cubes.
//!
//! Cubes are divided until they fit their sizes, and so that neighbours differ by one level at most; the
//! points are the corners and middles of undivided cubes. Where neighbours are alike this is a body-centred
//! cubic lattice, as for uniform sizes; where they are not, the tets between are halves and quarters of those
//! of the lattice (Labelle and Shewchuk 2007, *Isosurface stuffing*), and points of different levels are no
//! closer to each other than half a side of the smaller cube.

use super::interior::{CLEARANCE, EDGE_OVER_SIDE};
use super::octree::{Grid, Octree};
use super::shadow::Shadow;
use super::size_field::SizeField;
use super::sizes::Grading;
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle::{self, area};
use crate::mesh::{bounds, largest_extent, mean_edge_lengths};

/// Edges of undivided cubes are within this factor of their sizes.
const SIZE_FACTOR: f64 = std::f64::consts::SQRT_2;

/// The largest expected number of points near the surface, checked at once; the number inside is checked on
/// the way.
const MAX_POINTS: f64 = 5e7;

/// Checks that sizes do not require too many points at the surface.
///
/// # Errors
/// When they do.
pub(super) fn check(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    at_corners: &[[f64; 3]],
    grading: &Grading,
) -> Result<()> {
    let size = |at: &[f64; 3]| (at.iter().sum::<f64>() / 3.0).min(grading.largest.unwrap_or(f64::INFINITY));
    let corners = |t: [VertexId; 3]| t.map(|v| points[v.index()]);
    let both = || triangles.iter().zip(at_corners);
    let expected: f64 = both().map(|(t, at)| area(corners(*t)) / (size(at) * size(at))).sum();
    if expected <= MAX_POINTS {
        return Ok(());
    }
    let what = format!(
        "these sizes require {expected:.1e} points at the surface; at most {MAX_POINTS:.0e} are allowed"
    );
    let least = both().min_by(|x, y| size(x.1).total_cmp(&size(y.1)));
    let at = least.map_or_else(String::new, |(t, at)| {
        let [x, y, z] = triangle::centroid(corners(*t));
        format!("{x}, {y}, {z}, where the size is {}", size(at))
    });
    Err(Error::input(what).at(at).remedy("give larger sizes"))
}

/// Returns lattice points between the surfaces, with edges as long as the sizes.
///
/// # Errors
/// When there would be too many.
pub(super) fn lattice(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    field: &SizeField<'_>,
    threads: &Threads,
) -> Result<Vec<Point>> {
    let ends = bounds(points).unwrap_or_default();
    let shadow = Shadow::new(points, triangles);
    let is_to_be_divided = |grid: &Grid, cube| {
        let edge = grid.bounds(cube)[1][0] - grid.bounds(cube)[0][0];
        shadow.may_hold(grid.bounds(cube))
            && edge * EDGE_OVER_SIDE > SIZE_FACTOR * field.at(grid.middle(cube))
    };
    let tree = Octree::new(Grid::new(ends, first_side(ends, field))?, is_to_be_divided, threads)?;
    let leaves = tree.leaves();
    let is_between = threads.map(leaves.len(), |i| shadow.may_hold(tree.grid.bounds(leaves[i])));
    let leaves: Vec<_> =
        leaves.into_iter().zip(is_between).filter(|(_, is)| *is).map(|(cube, _)| cube).collect();
    let mut found = tree.corners(&leaves);
    found.extend(leaves.iter().map(|&cube| tree.grid.middle(cube)));
    let is_away = threads.map(found.len(), |i| !field.is_near(found[i], CLEARANCE * field.at(found[i])));
    Ok(found.into_iter().zip(is_away).filter(|(_, away)| *away).map(|(p, _)| p).collect())
}

/// The side of the largest cubes, chosen so that the cubes of some level fit the largest size, or if there is
/// none, the median size of the triangles.
fn first_side(ends: [Point; 2], field: &SizeField<'_>) -> f64 {
    let longest = largest_extent(ends);
    if let Some(largest) = field.largest() {
        return largest.min(longest) / EDGE_OVER_SIDE;
    }
    let side = field.median() / EDGE_OVER_SIDE;
    side * (longest / side).log2().ceil().max(0.0).exp2()
}

/// Returns lattice points in the space between triangles, which need not be closed: edges are as long as
/// those of the triangles, and grow with distance from them.
///
/// # Errors
/// When there would be too many.
pub(crate) fn points_between(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    grading: &Grading,
    threads: &Threads,
) -> Result<Vec<Point>> {
    let lengths = mean_edge_lengths(points, triangles.iter().copied());
    let at_corners: Vec<[f64; 3]> = triangles.iter().map(|t| t.map(|v| lengths[v.index()])).collect();
    check(points, triangles, &at_corners, grading)?;
    lattice(points, triangles, &SizeField::new(points, triangles, at_corners, grading, threads), threads)
}
