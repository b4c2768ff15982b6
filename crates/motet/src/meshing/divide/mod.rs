//! Divides surfaces coarser than the size inside: flat facets keep their planes, creases stay edges, and
//! triangles become as regular as both allow.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | facets | `facets` | triangles of one patch in one plane, exactly or up to rounding |
//! | creases | `refine` | divided into parts of about the size |
//! | triangles | `refine`, `triangulation` | Delaunay refinement in the plane |

mod facets;
mod refine;
mod triangulation;

use serde::Serialize;

use self::facets::Facets;
use self::triangulation::Triangulation;
use super::interior;
use super::sheet::Sheet;
use super::surfaces::Surfaces;
use crate::base::{Error, Result, Threads, VertexId};
use crate::geometry::triangle::area;
use crate::geometry::vector::distance;

/// The largest expected number of triangles.
const MAX_TRIANGLES: f64 = 2e7;

/// The largest number of points inserted, as a multiple of the expected number of triangles: where facets are
/// far narrower than the size, more points than expected are needed.
const MAX_POINTS_PER_TRIANGLE: usize = 16;

/// The numbers of triangles before and after a surface was divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Divided {
    /// Triangles of the surfaces before, those that two surfaces share counted once.
    pub before: usize,
    /// Triangles of the surfaces after they were divided, those that two surfaces share counted once.
    pub after: usize,
}

/// Divides the triangles of surfaces so that edges are about as long as `size`. The shape of the surfaces is
/// kept to rounding.
///
/// # Errors
/// When there would be far too many triangles.
pub(super) fn divide(surfaces: &Surfaces, size: f64, threads: &Threads) -> Result<(Surfaces, Divided)> {
    let watch = threads.watch();
    watch.report_and_check("dividing the surface", 0, 0)?;
    interior::check(&surfaces.points, size)?;
    let expected = expected(surfaces, size);
    if expected > MAX_TRIANGLES {
        let what = format!(
            "a size of {size} requires about {expected:.1e} triangles; at most {MAX_TRIANGLES:.0e} are \
             allowed"
        );
        return Err(Error::options(what).remedy("give a larger size"));
    }
    let sheet = Sheet::of(surfaces);
    let before = sheet.triangles.len();
    let Some(Facets { facet_of, planes, labels }) = Facets::find(&surfaces.points, &sheet) else {
        return Ok((surfaces.clone(), Divided { before, after: before }));
    };
    let mut triangulation = Triangulation::new(surfaces.points.clone(), sheet.triangles, facet_of, planes);
    triangulation.make_delaunay();
    refine::divide_creases(&mut triangulation, size, watch)?;
    refine::refine(&mut triangulation, size, MAX_POINTS_PER_TRIANGLE * expected as usize, watch)?;
    let after = triangulation.triangles.len();
    let Triangulation { points, triangles, facet_of, .. } = triangulation;
    let of = triangles.into_iter().zip(&facet_of).map(|(t, &facet)| (t, &labels[facet as usize][..]));
    Ok((surfaces.with_sheet(points, of), Divided { before, after }))
}

/// Estimates the number of triangles: regular ones over the area, and those at divided creases.
fn expected(surfaces: &Surfaces, size: f64) -> f64 {
    let even = 0.25 * 3f64.sqrt() * size * size;
    let of = |t: &[VertexId; 3]| {
        let [a, b, c] = t.map(|v| surfaces.points[v.index()]);
        let around = distance(a, b) + distance(b, c) + distance(c, a);
        1.0 + area([a, b, c]) / even + around / size
    };
    surfaces.triangles.iter().map(of).sum()
}
