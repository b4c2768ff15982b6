//! Floor 7: triangle surfaces made even, within a distance of what they were.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | features | `features` | borders of labels, rims, creases and corners stay where they are |
//! | passes | `adapt` | long edges split, short ones collapsed, edges flipped, vertices moved |
//! | changes | `work`, `sheet` | proposed, checked, made |
//! | fit | `fit` | vertices moved across the surface, so that it keeps its volume |
//! | parts | `parts` | of a surface that stays for the most part, only the rest is worked on |
//! | distance | `original`, `cover` | both ways, for each change |
//! | crossings | `near` | none is made |
//! | smoothing | `smooth` | noise removed before, if requested |
//! | origins | `places` | where the new surface lies on the given one |

mod adapt;
mod cover;
mod features;
mod fit;
mod lines;
mod near;
mod original;
mod parts;
mod places;
mod sheet;
mod smooth;
mod work;

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle::{area, middles};
use crate::geometry::vector::{LARGEST, in_range};
use crate::spatial::{Closest, NearestTriangle};
use features::Features;
use original::Original;
pub use places::{Labelled, Place, Places, places};
pub(crate) use sheet::{Change, Sheet};
pub use smooth::smooth;
use work::Work;

/// How a surface is made even.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The requested edge lengths: one for all points of the surface, or one for each.
    pub sizes: Vec<f64>,
    /// How far the new surface may stray from the given one, and that from the new one.
    pub distance: f64,
    /// Edges whose triangles meet at more than this angle, in degrees, are creases, which stay unless a
    /// triangle would be narrow for them. 0 is flat.
    pub feature_angle: f64,
    /// How much sizes may grow per unit of distance.
    pub growth: f64,
    /// For each point of the surface, whether it stays; edges between two points that stay are kept. Empty if
    /// none has to.
    pub held: Vec<bool>,
    /// Whether the room inside is to be filled with tets: sizes are then smaller between walls that are near
    /// each other.
    pub is_for_tets: bool,
}

impl Options {
    /// # Errors
    /// When a length is not above 0, or the angle or the growth is out of its range.
    fn check(&self, n_points: usize) -> Result<()> {
        let is_length = |x: f64| x > 0.0 && x <= LARGEST;
        if !is_length(self.distance) {
            let what = format!(
                "the distance of an adapted surface must be above 0 and at most {LARGEST:.0e}; got {}",
                self.distance
            );
            return Err(Error::options(what).remedy("a thousandth of the extent is a good start"));
        }
        if !(0.0..=180.0).contains(&self.feature_angle) {
            return Err(Error::options(format!(
                "the feature angle must be in [0, 180]; got {}",
                self.feature_angle
            )));
        }
        if !is_length(self.growth) {
            return Err(Error::options(format!("the growth of sizes must be above 0; got {}", self.growth)));
        }
        if self.sizes.len() != 1 && self.sizes.len() != n_points {
            return Err(Error::options(format!("{} sizes for {n_points} points", self.sizes.len())));
        }
        if !self.held.is_empty() && self.held.len() != n_points {
            let what = format!("{} marks of points that stay for {n_points} points", self.held.len());
            return Err(Error::options(what));
        }
        Ok(())
    }
}

/// A surface made even.
#[derive(Clone, Debug)]
pub struct Adapted {
    /// All points: those of the given surface, where they are now or were last, then new ones.
    pub points: Vec<Point>,
    /// The triangles.
    pub triangles: Vec<[VertexId; 3]>,
    /// The label of each triangle.
    pub labels: Vec<u32>,
    /// The length of edges at each point: as requested, or shorter where the distance requires it, and
    /// growing from there.
    pub sizes: Vec<f64>,
}

/// Makes a surface even. Triangles keep their side and their label; labels are numbers from 0 on. Where
/// triangles of the given surface cross, those of the new one do as well; it has no other crossings.
///
/// # Errors
/// When an option is out of its range, or a point is not finite.
pub fn adapt(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    labels: &[u32],
    options: &Options,
    threads: &Threads,
) -> Result<Adapted> {
    options.check(points.len())?;
    let used = triangles.as_flattened().iter().map(|v| v.index());
    if let Some(v) = used.clone().find(|&v| !in_range(points[v])) {
        return Err(Error::input("a coordinate is not finite or too large").at(format!("point {v}")));
    }
    let of_points = |v: usize| options.sizes[if options.sizes.len() == 1 { 0 } else { v }];
    let at_points: Vec<f64> = (0..points.len()).map(of_points).collect();
    if let Some(v) = used.clone().find(|&v| !(at_points[v] > 0.0 && at_points[v].is_finite())) {
        return Err(
            Error::options(format!("a size must be above 0; got {}", at_points[v])).at(format!("point {v}"))
        );
    }
    let expected = expected(points, triangles, &at_points);
    if expected > MAX_TRIANGLES {
        let what = format!(
            "a size of {} requires about {expected:.1e} triangles; at most {MAX_TRIANGLES:.0e} are allowed",
            at_points.iter().copied().fold(f64::INFINITY, f64::min)
        );
        return Err(Error::options(what).remedy("give a larger size"));
    }
    match options.held.contains(&true) {
        true => parts::adapt(points, triangles, labels, options, threads),
        false => adapt_whole(points, triangles, labels, options, threads),
    }
}

/// Makes a checked surface even, all of it at once.
fn adapt_whole(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    labels: &[u32],
    options: &Options,
    threads: &Threads,
) -> Result<Adapted> {
    let of_points = |v: usize| options.sizes[if options.sizes.len() == 1 { 0 } else { v }];
    let at_points: Vec<f64> = (0..points.len()).map(of_points).collect();
    let expected = expected(points, triangles, &at_points);
    let max_triangles = MANY.max(MAX_OVER_EXPECTED * (triangles.len() + expected as usize));
    let original = Original::new(points, triangles, labels, SHARE * options.distance, threads);
    let sheet = Sheet::new(points.to_vec(), triangles.to_vec(), labels.to_vec());
    let features = Features::of(&sheet, options.feature_angle, original.distance);
    let mut work = Work::new(sheet, features, original, at_points.clone(), max_triangles, threads);
    work.hold(&options.held);
    work.is_for_tets = options.is_for_tets;
    let is_uniform = options.sizes.len() == 1;
    let sizes = |work: &Work<'_>, label: u32, p: Point| match is_uniform {
        true => options.sizes[0],
        false => work
            .original
            .near(label, p, f64::INFINITY)
            .map_or(f64::INFINITY, |found| work.original.value(label, &found, &at_points)),
    };
    work.adapt(sizes, options.growth)?;
    let Work { sheet, sizes, .. } = work;
    let kept: Vec<u32> = sheet.existing().collect();
    Ok(Adapted {
        triangles: kept.iter().map(|&t| sheet.triangle(t)).collect(),
        labels: kept.iter().map(|&t| sheet.label(t)).collect(),
        points: sheet.points,
        sizes,
    })
}

/// The largest expected number of triangles.
const MAX_TRIANGLES: f64 = 2e7;

/// The largest number of triangles, over those given and those expected.
const MAX_OVER_EXPECTED: usize = 16;

/// So many triangles are always allowed: of a part that is thin beside the size, few are expected.
const MANY: usize = 1_000_000;

/// The number of even triangles of these sizes on a surface.
fn expected(points: &[Point], triangles: &[[VertexId; 3]], sizes: &[f64]) -> f64 {
    let of = |t: &[VertexId; 3]| {
        let size = t.iter().map(|v| sizes[v.index()]).sum::<f64>() / 3.0;
        area(t.map(|v| points[v.index()])) / (0.25 * 3f64.sqrt() * size * size)
    };
    triangles.iter().map(of).sum()
}

/// The fraction of the allowed distance that changes may use, since distances are measured at samples.
const SHARE: f64 = 0.75;

/// The largest distance of each of two surfaces from the other, as measured by [`farthest`].
pub fn distances(surfaces: [(&[Point], &[[VertexId; 3]]); 2], threads: &Threads) -> [f64; 2] {
    let [first, second] = surfaces;
    let of = |(points, triangles): (&[Point], _), (others, other): (&[Point], &[[VertexId; 3]])| {
        farthest(points, triangles, &NearestTriangle::new(others, other, threads), threads)
    };
    [of(second, first), of(first, second)]
}

/// The largest distance of triangles from a surface: at corners, middles of edges and centroids.
pub fn farthest(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    surface: &NearestTriangle,
    threads: &Threads,
) -> f64 {
    let corners = || triangles.iter().map(|t| t.map(|v| points[v.index()]));
    let places: Vec<Point> = corners().flatten().chain(corners().flat_map(middles)).collect();
    let found = surface.closest_all(&places, None, threads);
    let far = |found: Option<Closest>| found.map_or(f64::INFINITY, |found| found.distance_squared.sqrt());
    found.into_iter().map(far).fold(0.0, f64::max)
}
