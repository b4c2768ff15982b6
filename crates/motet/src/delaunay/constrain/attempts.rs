//! One way after another to join triangles to flat facets, until all triangles are kept and every tet has a volume.

use super::Filled;
use super::flats::{Flats, Grown};
use super::levels::Levels;
use super::sites::Sites;
use super::unmade::{Order, Unmade};
use crate::base::{Point, Result, VertexId, Watch};

/// So often at most.
const ATTEMPTS: usize = 6;

/// So often one attempt may begin anew in another order.
const RETRIES: usize = 8;

/// The same where facets are flat but for rounding: another way of joining is better than another order.
const RETRIES_ROUNDED: usize = 2;

/// The best of what `fill` makes of flat facets. Each attempt changes how triangles are joined where the one before has failed.
///
/// # Errors
/// The one of the first attempt, where none makes anything; and when the watch says stop.
pub(super) fn best(
    sites: &Sites,
    triangles: &[[VertexId; 3]],
    rounding: Point,
    watch: &Watch,
    fill: impl Fn(&Flats, &Order) -> Result<Filled, Unmade>,
) -> Result<Filled> {
    let grown = Grown::find(sites, triangles, rounding);
    let mut levels = Levels::new(triangles, &grown);
    let mut flats = Flats::find(sites, triangles, &levels);
    let mut best: Option<Result<Filled>> = None;
    for n_left in (0..ATTEMPTS).rev() {
        let most = if levels.has_rounded() { RETRIES_ROUNDED } else { RETRIES };
        let filled = Order::retried(most, watch, |order| fill(&flats, order));
        let failed = match &filled {
            Ok(filled) => filled.failed(triangles),
            Err(Unmade { what, .. }) => what.map(|part| levels.at(part)).unwrap_or_default(),
        };
        let is_stopped = filled.as_ref().is_err_and(|unmade| unmade.what.is_none());
        let filled = filled.map_err(|unmade| unmade.error);
        if is_stopped {
            return filled;
        }
        if best.as_ref().is_none_or(|best| faults(&filled) < faults(best)) {
            best = Some(filled);
        }
        // With each triangle for itself all its edges are there, if in pieces.
        let is_good = best.as_ref().is_some_and(|best| !faults(best).0);
        let is_other = loop {
            let has_changed = match n_left {
                2.. => levels.go_on(&failed),
                1 if !is_good => levels.part_all(),
                _ => false,
            };
            if !has_changed {
                break false;
            }
            let next = Flats::find(sites, triangles, &levels);
            if next.creases != flats.creases {
                flats = next;
                break true;
            }
        };
        if !is_other {
            break;
        }
    }
    best.unwrap_or_else(|| unreachable!("there is one attempt at least"))
}

/// What an attempt falls short by: whether flat facets have other triangles than were given, or there is nothing at all; how many facets there are more than
/// triangles; and how many tets have no volume.
fn faults(filled: &Result<Filled>) -> (bool, usize, usize) {
    let of =
        |filled: &Filled| (!filled.unrestored.is_empty(), filled.n_in_pieces(), filled.flat_tets().count());
    filled.as_ref().map_or((true, usize::MAX, usize::MAX), of)
}
