//! The cavity: all tets in conflict with the newcomer, found from the first one outward in waves.
//!
//! A wave first spreads from all tets found so far to their unseen neighbours, then tests those. Either
//! loop appends without branching (write, then advance by 0 or 1): the outcome of a test is a coin toss, which a
//! branch would get wrong every other time. Next to a plain stack this took 14 % less time on 20,000 points
//! and a third of the mispredictions.

use super::conflict::{IN, Newcomer, OUT, PENDING, in_conflict};
use super::store::Store;
use crate::base::Point;
use pulp::Simd;

/// A facet between the cavity and the rest.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Facet {
    /// Positive together with a point inside the cavity in front; infinity last.
    pub(super) vertices: [u32; 3],
    /// The link to the tet outside.
    pub(super) outer: u32,
}

/// Working space, kept from one insertion to the next.
#[derive(Debug, Default)]
pub(super) struct Cavity {
    /// Tets in conflict; later the slots for the new tets.
    pub(super) tets: Vec<u32>,
    pub(super) facets: Vec<Facet>,
    queue: Vec<u32>,
}

impl Cavity {
    /// Collects the tets in conflict, given the `first`, and the facets around them.
    #[inline(always)]
    pub(super) fn dig<S: Simd>(
        &mut self,
        simd: S,
        store: &mut Store,
        points: &[Point],
        first: u32,
        new: Newcomer,
    ) {
        self.tets.clear();
        self.tets.push(first);
        store.gauges[first as usize].mark = new.mark() + IN;
        let mut spread = 0;
        while spread < self.tets.len() {
            let queued = self.spread(store, spread, new.mark());
            spread = self.tets.len();
            self.test(simd, store, points, queued, new);
        }
        self.enclose(store, new.mark() + OUT);
    }

    /// Queues the unseen neighbours of tets from place `from` on; answers how many.
    #[inline(always)]
    fn spread(&mut self, store: &mut Store, from: usize, mark: u32) -> usize {
        let room = 4 * (self.tets.len() - from);
        if self.queue.len() < room {
            self.queue.resize(2 * room, 0);
        }
        let queue = &mut self.queue[..room];
        let (tets, gauges) = (&store.tets[..], &mut store.gauges[..]);
        let mut queued = 0;
        for &tet in &self.tets[from..] {
            for link in tets[tet as usize].links {
                let neighbor = link >> 2;
                let seen = &mut gauges[neighbor as usize].mark;
                queue[queued] = neighbor;
                queued += usize::from(*seen < mark);
                *seen = (*seen).max(mark + PENDING);
            }
        }
        queued
    }

    /// Tests the queued tets and appends those in conflict.
    #[inline(always)]
    fn test<S: Simd>(&mut self, simd: S, store: &mut Store, points: &[Point], queued: usize, new: Newcomer) {
        let mut end = self.tets.len();
        self.tets.resize(end + queued, 0);
        for &tet in &self.queue[..queued] {
            let conflict = in_conflict(simd, store, points, tet, new);
            store.gauges[tet as usize].mark = new.mark() + if conflict { IN } else { OUT };
            self.tets[end] = tet;
            end += usize::from(conflict);
        }
        self.tets.truncate(end);
    }

    /// Collects the facets between tets of the cavity and tets marked `out`.
    #[inline(always)]
    fn enclose(&mut self, store: &Store, out: u32) {
        let room = 4 * self.tets.len();
        if self.facets.len() < room {
            self.facets.resize(room, Facet::default());
        }
        let (tets, gauges, facets) = (&store.tets[..], &store.gauges[..], &mut self.facets[..]);
        let mut n = 0;
        for &tet in &self.tets {
            let record = &tets[tet as usize];
            for (vertices, outer) in record.facets().into_iter().zip(record.links) {
                facets[n] = Facet { vertices, outer };
                n += usize::from(gauges[(outer >> 2) as usize].mark == out);
            }
        }
        self.facets.truncate(n);
    }
}
