//! The changes of a complex made, as they were checked.

use std::cell::Cell;

use crate::base::{TetId, VertexId};
use crate::kernel::change::{Fill, NewLine, NewWall, VertexChange};
use crate::kernel::check::{Checked, FillFacet, Joint};
use crate::kernel::complex::Complex;
use crate::kernel::hold::Hold;
use crate::kernel::journal::{Entry, TetRecord, VertexRecord};
use crate::kernel::lines::{Line, rising};
use crate::kernel::link::{HalfFacet, Link, NO_TRIANGLE, Wall, WallId};
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
            self.free_vertices.push(v);
            self.note(|_| Entry::FreedVertex);
        }
    }

    fn commit_vertex(&mut self, change: VertexChange) {
        match change {
            VertexChange::None | VertexChange::Remove(_) => {}
            VertexChange::Insert(point, hold) => {
                let vertex = self.take_vertex_slot();
                self.note_vertex(vertex);
                self.points[vertex.index()] = point;
                self.holds[vertex.index()] = hold;
                self.vertex_is_changed[vertex.index()] = true;
                self.vertex_is_inserted[vertex.index()] = true;
            }
            VertexChange::Move(vertex, point) => {
                self.note_vertex(vertex);
                self.points[vertex.index()] = point;
                self.vertex_is_changed[vertex.index()] = true;
            }
        }
    }

    fn note_vertex(&mut self, v: VertexId) {
        self.note(|c| {
            let i = v.index();
            Entry::Vertex(
                v,
                VertexRecord {
                    point: c.points[i],
                    hold: c.holds[i],
                    is_new: c.vertex_is_changed[i],
                    is_inserted: c.vertex_is_inserted[i],
                },
            )
        });
    }

    fn write_tet(&mut self, tet: TetId, fill: &Fill) {
        self.note_tet(tet);
        let i = tet.index();
        self.set_vertices(tet, fill.vertices);
        self.regions[i] = fill.region;
        self.qualities[i].set(fill.quality);
        self.is_new[i] = true;
    }

    pub(super) fn free_tet(&mut self, tet: TetId) {
        self.note_tet(tet);
        let i = tet.index();
        self.count_vertices(tet, FREE);
        self.tets.remove(tet);
        self.is_new[i] = true;
        self.note(|_| Entry::FreedTet);
    }

    /// Sets the vertices of a slot, and updates the number of tets of each vertex.
    pub(super) fn set_vertices(&mut self, tet: TetId, vertices: [VertexId; 4]) {
        self.count_vertices(tet, vertices);
        self.tets.set_vertices(tet, vertices);
    }

    /// Updates the number of tets of each vertex before a slot gets these vertices.
    fn count_vertices(&mut self, tet: TetId, vertices: [VertexId; 4]) {
        let before = self.vertices(tet);
        if before != FREE {
            before.iter().for_each(|v| self.vertex_to_n_tets[v.index()] -= 1);
        }
        if vertices != FREE {
            vertices.iter().for_each(|v| self.vertex_to_n_tets[v.index()] += 1);
        }
    }

    fn note_tet(&mut self, tet: TetId) {
        self.note(|c| {
            let i = tet.index();
            let record = TetRecord {
                vertices: c.vertices(tet),
                links: c.tets.links(tet),
                region: c.regions[i],
                quality: c.qualities[i].get(),
                is_new: c.is_new[i],
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
                let mut sides = self.walls[wall.index()].sides;
                sides[usize::from(sides[0] != before)] = half(x);
                self.set_wall(wall, Wall { sides, ..self.walls[wall.index()] });
            }
            Joint::InnerWall(sides, wall) => {
                self.set_wall(wall, Wall { sides: sides.map(half), ..self.walls[wall.index()] });
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
        self.note(|c| Entry::Wall(id, c.walls[id.index()]));
        self.walls[id.index()] = wall;
        for side in wall.sides.into_iter().filter(|side| !side.is_none()) {
            self.note(|c| Entry::Link(side, c.tets.link(side)));
            self.tets.set_link(side, Link::wall(id));
        }
    }

    pub(super) fn free_wall(&mut self, id: WallId) {
        self.note(|c| Entry::Wall(id, c.walls[id.index()]));
        let wall = std::mem::replace(&mut self.walls[id.index()], Wall::FREE);
        if !wall.is_new && wall.triangle != NO_TRIANGLE {
            self.removed_triangles.push(wall.triangle);
            self.note(|_| Entry::RemovedTriangle);
        }
        self.free_walls.push(id);
        self.note(|_| Entry::FreedWall);
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
        self.qualities.push(Cell::new(0.0));
        self.is_new.push(true);
        tet
    }

    fn take_vertex_slot(&mut self) -> VertexId {
        if let Some(vertex) = self.free_vertices.pop() {
            self.note(|_| Entry::TookVertex(vertex));
            return vertex;
        }
        self.note(|c| Entry::VertexSlots(c.points.len()));
        self.points.push([0.0; 3]);
        self.holds.push(Hold::Free);
        self.vertex_is_changed.push(true);
        self.vertex_is_inserted.push(true);
        self.tets.resize_vertices(self.points.len());
        self.vertex_to_n_tets.push(0);
        VertexId::new(self.points.len() - 1)
    }

    fn take_wall_slot(&mut self) -> WallId {
        if let Some(wall) = self.free_walls.pop() {
            self.note(|_| Entry::TookWall(wall));
            return wall;
        }
        self.note(|c| Entry::WallSlots(c.walls.len()));
        self.walls.push(Wall::FREE);
        WallId(self.walls.len() as u32 - 1)
    }
}
