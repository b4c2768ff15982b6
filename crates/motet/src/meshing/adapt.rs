//! Replaces the triangles of surfaces by even ones, within a distance.

use std::collections::BTreeMap;

use serde::Serialize;

use super::sheet::{Label, Sheet};
use super::sizes::{Grading, Sizes};
use super::surfaces::Surfaces;
use crate::base::{Result, Threads};
use crate::geometry::triangle::area;
use crate::mesh::largest_extent;
use crate::spatial::bounding_box;
use crate::surface;

/// The default distance, over the largest extent of the surfaces.
const DISTANCE_OVER_EXTENT: f64 = 1e-3;

/// What became of surfaces that were adapted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Adapted {
    /// Triangles of the surfaces before, those that two surfaces share counted once.
    pub before: usize,
    /// Triangles of the adapted surfaces, those that two surfaces share counted once.
    pub after: usize,
    /// How far the surfaces were allowed to stray, in the unit of the surface.
    pub allowed: f64,
    /// The largest distance of the adapted surfaces from the given ones, measured at vertices, middles of
    /// edges and centroids.
    pub to_given: f64,
    /// The largest distance of the given surfaces from the adapted ones, measured at such places.
    pub from_given: f64,
}

/// Why surfaces are not as near as requested, with the largest distance of the new ones from the given ones
/// and of these from the new ones; `None` if they are.
pub(super) fn strayed([to_given, from_given]: [f64; 2], allowed: f64) -> Option<String> {
    (to_given.max(from_given) > allowed).then(|| {
        format!(
            "the new surface is up to {to_given:.3e} from the given one, and that up to {from_given:.3e} from it; {allowed:.3e} was allowed"
        )
    })
}

/// What a wrap has lost: so many triangles; `None` if there are none.
pub(super) fn lost(n: usize) -> Option<String> {
    (n > 0).then(|| format!("{n} triangles of walls or gaps thinner than the distance of the wrap were lost"))
}

/// How surfaces are adapted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adapting {
    /// How far the surfaces may stray, in their unit; `None`: a thousandth of their largest extent. Default:
    /// `None`.
    pub distance: Option<f64>,
    /// Edges whose triangles meet at more than this angle, in degrees, are creases, which stay. Default: 40.
    pub feature_angle: f64,
}

impl Adapting {
    /// How far these surfaces may stray.
    pub(super) fn allowed(&self, surfaces: &Surfaces) -> f64 {
        let used = surfaces.triangles.as_flattened().iter().map(|v| surfaces.points[v.index()]);
        let extent = largest_extent(bounding_box(used));
        self.distance.unwrap_or(DISTANCE_OVER_EXTENT * extent)
    }
}

impl Default for Adapting {
    fn default() -> Self {
        Self { distance: None, feature_angle: 40.0 }
    }
}

/// Gives surfaces even triangles, with edges as long as `sizes` requests, shorter where the distance requires
/// it. Returns the surfaces, and the sizes of edges inside, which grow from those of the surfaces.
///
/// # Errors
/// When the distance is not a length, or the angle not in [0, 180].
///
/// `held`: for each point, whether it stays; empty if none has to. `is_for_tets`: whether the room inside is
/// to be filled.
pub(super) fn adapt(
    surfaces: &Surfaces,
    sizes: Option<&Sizes>,
    adapting: &Adapting,
    held: &[bool],
    is_for_tets: bool,
    threads: &Threads,
) -> Result<(Surfaces, Option<Sizes>, Adapted)> {
    let distance = adapting.allowed(surfaces);
    let sheet = Sheet::of(surfaces);
    let mut numbers = BTreeMap::<&[Label], u32>::new();
    let labels: Vec<u32> = sheet
        .labels
        .iter()
        .map(|labels| {
            let next = numbers.len() as u32;
            *numbers.entry(labels).or_insert(next)
        })
        .collect();
    let mut of_number: Vec<&[Label]> = vec![&[]; numbers.len()];
    numbers.iter().for_each(|(labels, number)| of_number[*number as usize] = labels);
    let grading = match sizes {
        Some(Sizes::Graded(grading)) => grading.clone(),
        Some(Sizes::Uniform(size)) => Grading { largest: Some(*size), ..Grading::default() },
        None => Grading::default(),
    };
    let requested = match (&grading.at_points, grading.largest) {
        (Some(at_points), largest) => {
            at_points.iter().map(|size| size.min(largest.unwrap_or(f64::INFINITY))).collect()
        }
        (None, Some(largest)) => vec![largest],
        (None, None) => vec![mean_edge(surfaces, &sheet)],
    };
    let options = surface::Options {
        sizes: requested,
        distance,
        feature_angle: adapting.feature_angle,
        growth: grading.growth,
        held: held.to_vec(),
        is_for_tets,
    };
    let adapted = surface::adapt(&surfaces.points, &sheet.triangles, &labels, &options, threads)?;
    let [to_given, from_given] = surface::distances(
        [(&surfaces.points, &sheet.triangles), (&adapted.points, &adapted.triangles)],
        threads,
    );
    let report = Adapted {
        before: sheet.triangles.len(),
        after: adapted.triangles.len(),
        allowed: distance,
        to_given,
        from_given,
    };
    let of = adapted.triangles.iter().zip(&adapted.labels).map(|(t, &label)| (*t, of_number[label as usize]));
    let inside = sizes.map(|_| Sizes::Graded(Grading { at_points: Some(adapted.sizes.clone()), ..grading }));
    Ok((surfaces.with_sheet(adapted.points.clone(), of), inside, report))
}

/// The length of the edges of as many even triangles of the same area.
fn mean_edge(surfaces: &Surfaces, sheet: &Sheet) -> f64 {
    let area: f64 = sheet.triangles.iter().map(|t| area(t.map(|v| surfaces.points[v.index()]))).sum();
    (area / sheet.triangles.len().max(1) as f64 * 4.0 / 3f64.sqrt()).sqrt()
}
