//! Searches made ahead by several threads, with the results of one thread.
//!
//! A pass goes through candidates in their order: it searches for a change at each, and makes it. The search
//! takes nearly all the time and only reads, so threads make those for a block of candidates at once, in the
//! mesh as it is at the beginning of the block. What they found is used in order, as long as nothing has
//! changed that the search has read; where something has, it is made again. So each search has the result
//! that it would have at its turn, and the mesh does not depend on the number of threads. Deterministic
//! reservations (Blelloch, Fineman, Gibbons, Shun 2012, *Internally deterministic parallel algorithms can be
//! fast*) also do not depend on it, but make another mesh than one thread.

use crate::base::{Result, TetId, VertexId};
use crate::kernel::Behind;
use crate::remesh::repair::Repair;
use crate::remesh::repair::search::{Search, Tools};

/// A block is the number of candidates divided by this: the smaller it is, the fewer searches are made in
/// vain.
const BLOCKS: usize = 64;
/// The least and the most candidates of a block.
const BLOCK: [usize; 2] = [64, 4096];
/// How many candidates a thread takes at a time.
const RUN: usize = 2;

/// A pass over candidates.
pub(super) trait Pass: Sync {
    /// Where a change is searched for.
    type Candidate: Copy + Sync;
    /// What a search finds.
    type Found: Send + PartialEq + std::fmt::Debug;

    /// Searches for a change at a candidate.
    fn search(&self, search: &mut Search, candidate: Self::Candidate) -> Self::Found;

    /// Whether a search would find the same as it did at the time `since`: nothing that it read has changed.
    fn is_current(
        &self,
        repair: &Repair,
        candidate: Self::Candidate,
        found: &Self::Found,
        since: u32,
    ) -> bool;

    /// Brings what was found up to date, so that it is what a search would find now: the change inserts the
    /// vertex that is the next one now.
    fn update(&self, repair: &Repair, candidate: Self::Candidate, found: &mut Self::Found);

    /// Makes the change that was found, or records that there is none.
    fn act(&mut self, repair: &mut Repair, tools: &mut Tools, candidate: Self::Candidate, found: Self::Found);

    /// Takes a new candidate, made by a change, that comes before the next one.
    fn first(&mut self, _next: Self::Candidate) -> Option<Self::Candidate> {
        None
    }
}

/// What a search made ahead found.
struct Ahead<F> {
    found: F,
    /// Vertices far from the candidate that it read.
    reads: Vec<VertexId>,
}

impl Repair<'_> {
    /// Makes a pass over candidates, in their order.
    pub(super) fn make<P: Pass>(
        &mut self,
        pass: &mut P,
        stage: &'static str,
        candidates: &[P::Candidate],
    ) -> Result<()> {
        let length = (candidates.len() / BLOCKS).clamp(BLOCK[0], BLOCK[1]);
        let mut tools = self.toolbox.take();
        for (i, block) in candidates.chunks(length).enumerate() {
            let since = self.changes.now();
            let mut ahead = self.search_ahead(pass, block).into_iter();
            for (j, &candidate) in block.iter().enumerate() {
                self.threads.watch().report_and_check(stage, i * length + j, candidates.len())?;
                while let Some(first) = pass.first(candidate) {
                    let found = self.search_now(pass, first, None, &mut tools);
                    pass.act(self, &mut tools, first, found);
                }
                let known = ahead.next().flatten().filter(|Ahead { found, reads }| {
                    pass.is_current(self, candidate, found, since)
                        && reads.iter().all(|&v| self.changes.none_since(v, since))
                });
                let found = self.search_now(pass, candidate, known, &mut tools);
                pass.act(self, &mut tools, candidate, found);
            }
        }
        self.toolbox.put_back(tools);
        Ok(())
    }

    /// What a search finds now, which is what it is known to find, if that is known.
    fn search_now<P: Pass>(
        &self,
        pass: &P,
        candidate: P::Candidate,
        known: Option<Ahead<P::Found>>,
        tools: &mut Tools,
    ) -> P::Found {
        let mut search = Search::new(self, tools);
        let Some(Ahead { mut found, .. }) = known else { return pass.search(&mut search, candidate) };
        pass.update(self, candidate, &mut found);
        debug_assert_eq!(found, pass.search(&mut search, candidate), "a search made ahead finds the same");
        found
    }

    /// Whether a search reads no more than its candidate and what it notes. In a tangled mesh, it looks for
    /// tets that overlap. Where walls move, new vertices may lie outside the mesh as it was given, and their
    /// sizes depend on what else was removed.
    fn is_local(&self) -> bool {
        let is_graded = self.sizing.as_ref().is_some_and(|sizing| sizing.field.is_graded());
        !(self.complex.is_tangled() || is_graded && self.surface.is_some())
    }

    /// The searches of a block made by several threads; nothing if there is one, or if they are not local.
    fn search_ahead<P: Pass>(&self, pass: &P, block: &[P::Candidate]) -> Vec<Option<Ahead<P::Found>>> {
        if self.threads.count() < 2 || block.len() < 2 * RUN || !self.is_local() {
            return Vec::new();
        }
        let mut all: Vec<_> = block.iter().map(|_| None).collect();
        self.threads.fill(
            &mut all,
            RUN,
            || self.toolbox.lend(),
            |tools, start, some| {
                for (found, &candidate) in some.iter_mut().zip(&block[start..]) {
                    let mut tools = tools.borrow_mut();
                    let mut search = Search::ahead(self, &mut tools);
                    *found =
                        Some(Ahead { found: pass.search(&mut search, candidate), reads: search.reads() });
                }
            },
        );
        all
    }

    /// Whether nothing has changed since a time at the vertices of a tet, nor at the vertices behind its
    /// facets.
    pub(super) fn is_unchanged(&self, tet: TetId, since: u32) -> bool {
        let complex = &self.complex;
        let is_old = |v: VertexId| self.changes.none_since(v, since);
        complex.is_alive(tet)
            && complex.vertices(tet).into_iter().all(is_old)
            && (0..4).all(|facet| match complex.behind(tet, facet) {
                Behind::Tet(half) => is_old(complex.vertices(half.tet())[half.facet()]),
                Behind::Wall(_) => true,
            })
    }
}
