//! A record of overwritten values, in order, so that changes can be undone to the bit.

use crate::base::{Point, TetId, VertexId};
use crate::kernel::hold::Hold;
use crate::kernel::lines::Line;
use crate::kernel::link::{HalfFacet, Link, Wall, WallId};
use crate::kernel::provenance::Origin;
use crate::kernel::qualities::QualityRecord;

/// One recorded value.
#[derive(Clone, Copy, Debug)]
pub(super) enum Entry {
    Tet(TetId, TetRecord),
    Vertex(VertexId, VertexRecord),
    Wall(WallId, Wall),
    Link(HalfFacet, Link),
    VertexToTet(VertexId, TetId),
    TetSlots(usize),
    VertexSlots(usize),
    WallSlots(usize),
    TookTet(TetId),
    TookVertex(VertexId),
    TookWall(WallId),
    FreedTet,
    FreedVertex,
    FreedWall,
    RemovedTriangle,
    Line([VertexId; 2], Option<Line>),
    RemovedLine,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct TetRecord {
    pub(super) vertices: [VertexId; 4],
    pub(super) links: [Link; 4],
    pub(super) region: i32,
    pub(super) quality: QualityRecord,
    pub(super) is_new: bool,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct VertexRecord {
    pub(super) point: Point,
    pub(super) hold: Hold,
    pub(super) origin: Origin,
}

/// The entries; they are recorded while the journal is open.
#[derive(Clone, Debug, Default)]
pub(super) struct Journal {
    pub(super) is_open: bool,
    pub(super) entries: Vec<Entry>,
}

/// A moment that [`undo`](crate::kernel::Complex::undo) can return to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Mark(pub(super) usize);
