//! Recording what is overwritten, and undoing it.

use crate::kernel::complex::Complex;
use crate::kernel::journal::{Entry, Journal, Mark};

impl Complex {
    /// Starts to record what is overwritten, if that has not begun, and marks this moment.
    pub fn mark(&mut self) -> Mark {
        self.journal.is_open = true;
        Mark(self.journal.entries.len())
    }

    /// Discards the journal and all marks: nothing that has happened can be undone any more.
    pub fn forget(&mut self) {
        self.journal = Journal::default();
    }

    #[inline(always)]
    pub(super) fn note(&mut self, entry: impl FnOnce(&Self) -> Entry) {
        if self.journal.is_open {
            let entry = entry(self);
            self.journal.entries.push(entry);
        }
    }

    /// Undoes everything that was committed since `mark`: every array is as it was then, to the bit.
    ///
    /// Panics if `mark` does not belong to this journal.
    pub fn undo(&mut self, Mark(mark): Mark) {
        assert!(mark <= self.journal.entries.len(), "a mark of another journal");
        for entry in self.journal.entries.drain(mark..).rev().collect::<Vec<_>>() {
            self.take_back(entry);
        }
    }

    fn take_back(&mut self, entry: Entry) {
        match entry {
            Entry::Tet(t, record) => {
                self.set_vertices(t, record.vertices);
                self.tets.set_links(t, record.links);
                self.regions[t.index()] = record.region;
                self.qualities.restore(t, record.quality);
                self.provenance.set_new(t, record.is_new);
            }
            Entry::Vertex(v, record) => {
                self.vertices.set_point(v, record.point);
                self.vertices.set_hold(v, record.hold);
                self.provenance.set_origin(v, record.origin);
            }
            Entry::Wall(w, wall) => _ = self.walls.set(w, wall),
            Entry::Link(half, link) => self.tets.set_link(half, link),
            Entry::VertexToTet(v, t) => self.tets.set_tet_of(v, t),
            Entry::TetSlots(n) => {
                self.tets.truncate(n);
                self.regions.truncate(n);
                self.qualities.truncate(n);
                self.provenance.truncate_tets(n);
            }
            Entry::VertexSlots(n) => {
                self.vertices.truncate(n);
                self.provenance.truncate_vertices(n);
                self.tets.resize_vertices(n);
                self.overlaps.resize(n);
            }
            Entry::WallSlots(n) => self.walls.truncate(n),
            Entry::TookTet(t) => self.tets.put_back_slot(t),
            Entry::TookVertex(v) => self.vertices.free_slot(v),
            Entry::TookWall(w) => self.walls.put_back_slot(w),
            Entry::FreedTet => self.tets.keep_last_freed(),
            Entry::FreedVertex => self.vertices.keep_last_freed(),
            Entry::FreedWall => self.walls.keep_last_freed(),
            Entry::RemovedTriangle => self.provenance.restore_triangle(),
            Entry::Line(edge, line) => drop(self.lines.set(edge, line)),
            Entry::RemovedLine => drop(self.lines.removed.pop()),
        }
    }
}
