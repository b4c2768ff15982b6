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
                let i = t.index();
                self.set_vertices(t, record.vertices);
                self.tets.set_links(t, record.links);
                self.regions[i] = record.region;
                self.qualities[i].set(record.quality);
                self.is_new[i] = record.is_new;
            }
            Entry::Vertex(v, record) => {
                self.points[v.index()] = record.point;
                self.holds[v.index()] = record.hold;
                self.vertex_is_changed[v.index()] = record.is_new;
                self.vertex_is_inserted[v.index()] = record.is_inserted;
            }
            Entry::Wall(w, wall) => self.walls[w.index()] = wall,
            Entry::Link(half, link) => self.tets.set_link(half, link),
            Entry::VertexToTet(v, t) => self.tets.set_tet_of(v, t),
            Entry::TetSlots(n) => {
                self.tets.truncate(n);
                self.regions.truncate(n);
                self.qualities.truncate(n);
                self.is_new.truncate(n);
            }
            Entry::VertexSlots(n) => {
                self.points.truncate(n);
                self.holds.truncate(n);
                self.vertex_is_changed.truncate(n);
                self.vertex_is_inserted.truncate(n);
                self.tets.resize_vertices(n);
                self.vertex_to_n_tets.truncate(n);
            }
            Entry::WallSlots(n) => self.walls.truncate(n),
            Entry::TookTet(t) => self.tets.put_back_slot(t),
            Entry::TookVertex(v) => self.free_vertices.push(v),
            Entry::TookWall(w) => self.free_walls.push(w),
            Entry::FreedTet => self.tets.keep_last_freed(),
            Entry::FreedVertex => drop(self.free_vertices.pop()),
            Entry::FreedWall => drop(self.free_walls.pop()),
            Entry::RemovedTriangle => drop(self.removed_triangles.pop()),
            Entry::Line(edge, line) => drop(self.lines.set(edge, line)),
            Entry::RemovedLine => drop(self.lines.removed.pop()),
        }
    }
}
