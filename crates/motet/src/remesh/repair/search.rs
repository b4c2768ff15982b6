//! A search for changes in a mesh that stays as it is meanwhile, so that several threads can search at once.

use std::cell::{RefCell, RefMut};
use std::sync::{Mutex, PoisonError};

use crate::base::{TetId, VertexId};
use crate::kernel::{Change, Complex, Hold, Shell, Star};
use crate::ops::{EdgeRemoval, FaceRemoval, Insertion, Relaxation, Smoothing};
use crate::remesh::repair::Repair;
use crate::remesh::repair::score::{Limits, Score};
use crate::remesh::repair::trial::{Merit, Rules, Trial};
use crate::remesh::report::Operation;

/// Work arrays of searches, and the changes that they find.
#[derive(Debug, Default)]
pub(super) struct Tools {
    /// The search for the change that repairs one bad tet.
    pub(super) repairs: Trial<Score>,
    /// The search for the change that is best by one number.
    pub(super) best: Trial<f64>,
    /// The search for a change that is made if it is possible.
    pub(super) first: Trial<()>,
    pub(super) edge_removal: EdgeRemoval,
    pub(super) face_removal: FaceRemoval,
    pub(super) smoothing: Smoothing,
    pub(super) insertion: Insertion,
    pub(super) relaxation: Relaxation,
    pub(super) star: Star,
    /// The buffer for tets around edges at which no change gains enough.
    pub(super) settled_shells: Vec<TetId>,
    /// Buffers of [`Search::around`].
    shells: Vec<Shell>,
}

/// Tools that nobody uses.
#[derive(Debug, Default)]
pub(super) struct Toolbox(Mutex<Vec<Tools>>);

impl Toolbox {
    /// Tools that nobody uses, new ones if there are none.
    pub(super) fn take(&self) -> Tools {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default()
    }

    pub(super) fn put_back(&self, tools: Tools) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(tools);
    }

    /// Tools for a thread, which are put back in the end.
    pub(super) fn lend(&self) -> LentTools<'_> {
        LentTools { toolbox: self, tools: RefCell::new(self.take()) }
    }
}

/// Tools that a thread has borrowed.
pub(super) struct LentTools<'a> {
    toolbox: &'a Toolbox,
    tools: RefCell<Tools>,
}

impl LentTools<'_> {
    pub(super) fn borrow_mut(&self) -> RefMut<'_, Tools> {
        self.tools.borrow_mut()
    }
}

impl Drop for LentTools<'_> {
    fn drop(&mut self) {
        self.toolbox.put_back(self.tools.take());
    }
}

/// A search in a mesh that is being repaired.
pub(super) struct Search<'a> {
    pub(super) repair: &'a Repair<'a>,
    pub(super) tools: &'a mut Tools,
    /// The worst quality from which a change may leave more bad tets than it found.
    pub(super) worth_more_bad: f64,
    /// Vertices that were read farther away than those of the candidate's tets and neighbours; recorded only
    /// if the search is made ahead.
    reads: Option<Vec<VertexId>>,
}

impl<'a> Search<'a> {
    pub(super) fn new(repair: &'a Repair<'a>, tools: &'a mut Tools) -> Self {
        Self { repair, tools, worth_more_bad: f64::INFINITY, reads: None }
    }

    /// A search whose result is used later.
    pub(super) fn ahead(repair: &'a Repair<'a>, tools: &'a mut Tools) -> Self {
        Self { reads: Some(Vec::new()), ..Self::new(repair, tools) }
    }

    /// The vertices that were read far away, each once.
    pub(super) fn reads(self) -> Vec<VertexId> {
        let mut reads = self.reads.unwrap_or_default();
        reads.sort_unstable();
        reads.dedup();
        reads
    }

    /// Notes that the cavity of the proposal was read.
    pub(super) fn note_cavity(&mut self) {
        let (complex, cavity) = (&self.repair.complex, &self.tools.repairs.proposal.cavity);
        if let Some(reads) = &mut self.reads {
            reads.extend(cavity.iter().flat_map(|&tet| complex.vertices(tet)));
        }
    }

    pub(super) fn complex(&self) -> &'a Complex {
        &self.repair.complex
    }

    /// Gathers the tets of a vertex in [`Tools::star`].
    pub(super) fn gather(&mut self, vertex: VertexId) {
        self.tools.star.gather(&self.repair.complex, vertex);
    }

    /// Calls `act` with a buffer for the tets around an edge.
    pub(super) fn with_shell<T>(&mut self, act: impl FnOnce(&mut Self, &mut Shell) -> T) -> T {
        let mut shell = self.tools.shells.pop().unwrap_or_default();
        let result = act(self, &mut shell);
        self.tools.shells.push(shell);
        result
    }

    /// Calls `act` with the tets around the edge from `a` to `b` of a tet.
    pub(super) fn around<T>(
        &mut self,
        tet: TetId,
        [a, b]: [VertexId; 2],
        act: impl FnOnce(&mut Self, &Shell) -> T,
    ) -> T {
        self.with_shell(|search, shell| {
            shell.walk(search.complex(), tet, a, b);
            act(search, shell)
        })
    }

    /// The constraint on a vertex that lies on an edge with the tets `shell` around it.
    pub(super) fn hold_on(&self, shell: &Shell, edge: [VertexId; 2]) -> Hold {
        let complex = self.complex();
        match &self.repair.surface {
            _ if complex.line(edge[0], edge[1]).is_some() => Hold::Edge,
            _ if shell.is_free() => Hold::Free,
            Some(surface) if surface.is_smooth(complex, edge, shell) => Hold::Surface,
            _ => Hold::Edge,
        }
    }

    /// Whether the constraint on vertex `removed` lets it be collapsed into `kept`: along the surface, or
    /// along a feature.
    pub(super) fn may_collapse(&mut self, tet: TetId, removed: VertexId, kept: VertexId) -> bool {
        let complex = self.complex();
        let hold = complex.hold(removed);
        let Some(surface) = &self.repair.surface else { return hold == Hold::Free };
        if hold == Hold::Free || hold == Hold::Fixed {
            return hold == Hold::Free;
        }
        let edge = [removed, kept];
        self.around(tet, edge, |_, shell| {
            let is_line = complex.line(removed, kept).is_some();
            let is_feature = || !surface.is_smooth(complex, edge, shell);
            is_line || !shell.walls.is_empty() && (hold == Hold::Surface || is_feature())
        })
    }

    /// The quality that the next proposal for a bad tet has to exceed.
    pub(super) fn bar(&self, tet: TetId) -> f64 {
        self.tools.repairs.bar(self.complex().quality(tet), self.repair.target)
    }

    /// Offers the proposal for the bad tet whose repair is searched for.
    pub(super) fn offer(&mut self, operation: Operation) {
        let Self { repair, tools, worth_more_bad, .. } = self;
        if repair.touches_kept(&tools.repairs.proposal) {
            return;
        }
        let complex = &repair.complex;
        let limits = Limits { target: repair.target, worth_more_bad: *worth_more_bad };
        let rules = Rules::of(complex).near(repair.surface.as_ref()).fit(repair.sizes());
        tools.repairs.offer(rules, |proposal, best| {
            let score = Score::of_better(complex, proposal, best, limits)?;
            Some(Merit { operation, score, bar: complex.worst_of(&proposal.cavity) })
        });
    }
}

impl Repair<'_> {
    /// Whether a change removes a tet that is to stay.
    pub(super) fn touches_kept(&self, change: &Change) -> bool {
        !self.kept.is_empty() && change.cavity.iter().any(|&t| self.is_kept(t))
    }
}

/// Whether a tet exists and has an edge.
pub(super) fn has_edge(complex: &Complex, tet: TetId, ends: [VertexId; 2]) -> bool {
    complex.is_alive(tet) && ends.iter().all(|v| complex.vertices(tet).contains(v))
}
