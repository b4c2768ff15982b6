//! Tries ways of joining triangles to flat facets one after the other, until all triangles are kept and every
//! tet has a volume.

use super::Filled;
use super::flats::FlatFacets;
use super::grown::GrownFacets;
use super::levels::Levels;
use super::recovery::{Order, Unrecovered};
use super::sites::Sites;
use crate::base::{Point, Result, Threads, VertexId};

/// The largest number of ways of joining triangles that are tried.
const ATTEMPTS: usize = 6;

/// How often an attempt is restarted in another order, where only exactly coplanar triangles are joined.
const RETRIES: usize = 8;

/// How often an attempt is restarted in another order, where triangles coplanar only up to rounding are
/// joined. Joining triangles differently helps more often than another order does.
const RETRIES_ROUNDED: usize = 2;

/// Returns the best result of `fill` on flat facets. Each attempt changes how triangles are joined where the
/// previous one has failed.
///
/// # Errors
/// When no attempt fills the surfaces: the error of the first attempt. When the watch stops the work.
pub(super) fn best(
    sites: &Sites,
    triangles: &[[VertexId; 3]],
    rounding: Point,
    threads: &Threads,
    fill: impl Fn(&FlatFacets, &Order<'_>) -> Result<Filled, Unrecovered>,
) -> Result<Filled> {
    let grown = GrownFacets::find(sites, triangles, rounding);
    let mut levels = Levels::new(triangles, &grown);
    let mut flats = FlatFacets::find(sites, triangles, &levels);
    let attempt = |levels: &Levels, flats: &FlatFacets| {
        let max_retries = if levels.has_rounded() { RETRIES_ROUNDED } else { RETRIES };
        Order::with_retries(max_retries, threads, |order| fill(flats, order))
    };
    let mut best = attempt(&levels, &flats);
    let mut failed = failures(&best, &levels, triangles);
    for n_left in (0..ATTEMPTS - 1).rev() {
        let is_stopped = best.as_ref().is_err_and(|unrecovered| unrecovered.what.is_none());
        // With each triangle on its own all its edges are present, perhaps in pieces.
        let may_separate = faults(&best).0;
        let next = std::iter::from_fn(|| {
            let has_changed =
                if n_left > 0 { levels.advance(&failed) } else { may_separate && levels.separate_all() };
            has_changed.then(|| FlatFacets::find(sites, triangles, &levels))
        })
        .find(|next| next.creases != flats.creases);
        let Some(next) = next.filter(|_| !is_stopped) else { break };
        flats = next;
        let filled = attempt(&levels, &flats);
        failed = failures(&filled, &levels, triangles);
        let is_stopped = filled.as_ref().is_err_and(|unrecovered| unrecovered.what.is_none());
        if is_stopped || faults(&filled) < faults(&best) {
            best = filled;
        }
    }
    best.map_err(|unrecovered| unrecovered.error)
}

/// The triangles for which another way of joining may help.
fn failures(filled: &Result<Filled, Unrecovered>, levels: &Levels, triangles: &[[VertexId; 3]]) -> Vec<u32> {
    match filled {
        Ok(filled) => filled.failed(triangles),
        Err(unrecovered) => unrecovered.what.map(|part| levels.near(part)).unwrap_or_default(),
    }
}

/// The shortcomings of an attempt, in order of importance: whether it failed or left flat facets whose
/// triangles differ from those given; the number of facets in excess of triangles; and the number of tets
/// without volume.
fn faults(filled: &Result<Filled, Unrecovered>) -> (bool, usize, usize) {
    let of = |filled: &Filled| {
        let surface = &filled.surface;
        (!surface.unrestored.is_empty(), filled.n_in_pieces(), surface.flat_tets.len())
    };
    filled.as_ref().map_or((true, usize::MAX, usize::MAX), of)
}
