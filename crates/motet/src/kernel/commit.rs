//! The changes of a complex made, as they were checked.

use crate::base::{TetId, VertexId};
use crate::kernel::change::{Fill, NewLine, NewWall, VertexChange};
use crate::kernel::check::{Checked, FillFacet, Joint};
use crate::kernel::complex::Complex;
use crate::kernel::journal::{Entry, TetRecord, VertexRecord};
use crate::kernel::lines::{Line, rising};
use crate::kernel::link::{HalfFacet, Link, NO_TRIANGLE, Wall, WallId};
use crate::kernel::provenance::Origin;
use crate::kernel::tets::{FREE, NO_TET};

impl Complex {
    /// Makes a checked change. `inserted` gets the ids of the tets of the fill, in their order.
    pub fn commit(&mut self, checked: Checked, inserted: &mut Vec<TetId>) {
        let Checked { change, joints, lost_walls, lost_lines } = checked;
        self.commit_vertex(change.vertex);
        inserted.clear();
        for (i, fill) in change.fill.iter().enumerate() {
            let slot = match change.cavity.get(i) {
                Some(&tet) => tet,
                None => self.take_tet_slot(),
            };
            self.write_tet(slot, fill);
            inserted.push(slot);
        }
        for &tet in change.cavity.iter().skip(change.fill.len()) {
            self.free_tet(tet);
        }
        for wall in lost_walls {
            self.free_wall(wall);
        }
        lost_lines.into_iter().for_each(|edge| self.remove_line(edge));
        change.lines.iter().for_each(|new| self.add_line(new));
        for joint in joints {
            self.commit_joint(joint, inserted);
        }
        for (fill, &tet) in change.fill.iter().zip(inserted.iter()) {
            fill.vertices.into_iter().for_each(|v| self.set_tet_of(v, tet));
        }
        if let VertexChange::Remove(v) = change.vertex {
            self.set_tet_of(v, NO_TET);
            self.vertices.free_slot(v);
            self.note(|_| Entry::FreedVertex);
        }
    }

    fn commit_vertex(&mut self, change: VertexChange) {
        match change {
            VertexChange::None | VertexChange::Remove(_) => {}
            VertexChange::Insert(point, hold) => {
                let vertex = self.take_vertex_slot();
                self.note_vertex(vertex);
                self.vertices.set_point(vertex, point);
                self.vertices.set_hold(vertex, hold);
                self.provenance.set_origin(vertex, Origin::Inserted);
            }
            VertexChange::Move(vertex, point) => {
                self.note_vertex(vertex);
                self.vertices.set_point(vertex, point);
                self.provenance.set_moved(vertex);
            }
        }
    }

    fn note_vertex(&mut self, v: VertexId) {
        self.note(|c| {
            let record = VertexRecord { point: c.point(v), hold: c.hold(v), origin: c.provenance.origin(v) };
            Entry::Vertex(v, record)
        });
    }

    fn write_tet(&mut self, tet: TetId, fill: &Fill) {
        self.note_tet(tet);
        self.set_vertices(tet, fill.vertices);
        self.regions[tet.index()] = fill.region;
        self.qualities.set(tet, fill.quality);
        self.provenance.set_new(tet, true);
    }

    pub(super) fn free_tet(&mut self, tet: TetId) {
        self.note_tet(tet);
        self.overlaps.replace(self.vertices(tet), FREE);
        self.tets.remove(tet);
        self.qualities.remove(tet);
        self.provenance.set_new(tet, true);
        self.note(|_| Entry::FreedTet);
    }

    /// Sets the vertices of a slot, and updates the number of tets of each vertex.
    pub(super) fn set_vertices(&mut self, tet: TetId, vertices: [VertexId; 4]) {
        self.overlaps.replace(self.vertices(tet), vertices);
        self.tets.set_vertices(tet, vertices);
    }

    fn note_tet(&mut self, tet: TetId) {
        self.note(|c| {
            let record = TetRecord {
                vertices: c.vertices(tet),
                links: c.tets.links(tet),
                region: c.region(tet),
                quality: c.qualities.record(tet),
                is_new: c.provenance.is_new(tet),
            };
            Entry::Tet(tet, record)
        });
    }

    fn commit_joint(&mut self, joint: Joint, inserted: &[TetId]) {
        let half = |part: FillFacet| HalfFacet::new(inserted[part.tet as usize], usize::from(part.facet));
        match joint {
            Joint::Inner([x, y]) => {
                self.tets.set_link(half(x), Link::tet(half(y)));
                self.tets.set_link(half(y), Link::tet(half(x)));
            }
            Joint::Outer(x, outside) => {
                self.tets.set_link(half(x), Link::tet(outside));
                self.note(|c| Entry::Link(outside, c.tets.link(outside)));
                self.tets.set_link(outside, Link::tet(half(x)));
            }
            Joint::AtWall(x, wall, before) => {
                let mut sides = self.wall(wall).sides;
                sides[usize::from(sides[0] != before)] = half(x);
                self.set_wall(wall, Wall { sides, ..*self.wall(wall) });
            }
            Joint::InnerWall(sides, wall) => {
                self.set_wall(wall, Wall { sides: sides.map(half), ..*self.wall(wall) });
            }
            Joint::NewWall(x, y, new) => self.add_wall([half(x), y.map_or(HalfFacet::NONE, half)], new),
            Joint::Exposed(outside, x, new) => self.add_wall([outside, x.map_or(HalfFacet::NONE, half)], new),
        }
    }

    pub(super) fn add_wall(&mut self, sides: [HalfFacet; 2], new: NewWall) {
        let id = self.take_wall_slot();
        self.set_wall(id, Wall { sides, patch: new.patch, triangle: new.triangle, is_new: true });
    }

    /// Sets a wall, and the links of the tets at it.
    fn set_wall(&mut self, id: WallId, wall: Wall) {
        self.note(|c| Entry::Wall(id, *c.wall(id)));
        self.walls.set(id, wall);
        for side in wall.sides.into_iter().filter(|side| !side.is_none()) {
            self.note(|c| Entry::Link(side, c.tets.link(side)));
            self.tets.set_link(side, Link::wall(id));
        }
    }

    pub(super) fn free_wall(&mut self, id: WallId) {
        self.note(|c| Entry::Wall(id, *c.wall(id)));
        let wall = self.walls.remove(id);
        self.note(|_| Entry::FreedWall);
        if !wall.is_new && wall.triangle != NO_TRIANGLE {
            self.provenance.remove_triangle(wall.triangle);
            self.note(|_| Entry::RemovedTriangle);
        }
    }

    fn remove_line(&mut self, edge: [VertexId; 2]) {
        let was = self.lines.set(edge, None);
        self.note(|_| Entry::Line(edge, was));
        if let Some(line) = was.filter(|line| !line.is_new) {
            self.lines.removed.push(line.source);
            self.note(|_| Entry::RemovedLine);
        }
    }

    fn add_line(&mut self, new: &NewLine) {
        let edge = rising(new.vertices);
        let was = self.lines.set(edge, Some(Line { source: new.source, is_new: true }));
        self.note(|_| Entry::Line(edge, was));
    }

    #[inline]
    pub(super) fn set_tet_of(&mut self, vertex: VertexId, tet: TetId) {
        if self.tet_of(vertex) != tet {
            self.note(|c| Entry::VertexToTet(vertex, c.tet_of(vertex)));
            self.tets.set_tet_of(vertex, tet);
        }
    }

    fn take_tet_slot(&mut self) -> TetId {
        let n_before = self.n_slots();
        let tet = self.tets.take_slot();
        if tet.index() < n_before {
            self.note(|_| Entry::TookTet(tet));
            return tet;
        }
        self.note(|_| Entry::TetSlots(n_before));
        self.regions.push(0);
        self.qualities.set(tet, 0.0);
        self.provenance.set_new(tet, true);
        tet
    }

    fn take_vertex_slot(&mut self) -> VertexId {
        let n_before = self.n_vertex_slots();
        let vertex = self.vertices.take_slot();
        if vertex.index() < n_before {
            self.note(|_| Entry::TookVertex(vertex));
            return vertex;
        }
        self.note(|_| Entry::VertexSlots(n_before));
        self.provenance.set_origin(vertex, Origin::Inserted);
        self.tets.resize_vertices(n_before + 1);
        self.overlaps.resize(n_before + 1);
        vertex
    }

    fn take_wall_slot(&mut self) -> WallId {
        let n_before = self.walls.n_slots();
        let wall = self.walls.take_slot();
        self.note(|_| match wall.index() < n_before {
            true => Entry::TookWall(wall),
            false => Entry::WallSlots(n_before),
        });
        wall
    }
}
