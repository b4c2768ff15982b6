//! All invariants of a complex, checked by name: for tests.

use std::collections::{HashMap, HashSet};

use crate::base::{TetId, VertexId};
use crate::geometry::tet::{EDGES, FACETS};
use crate::kernel::complex::Complex;
use crate::kernel::lines::rising;
use crate::kernel::link::{Behind, HalfFacet};
use crate::kernel::tets::NO_TET;

impl Complex {
    /// Checks all invariants, in time proportional to the size of the mesh.
    ///
    /// # Errors
    /// The first violation, described in words.
    pub fn verify(&self) -> Result<(), String> {
        self.verify_slots()?;
        self.verify_links()?;
        self.verify_facets()?;
        self.verify_lines()?;
        self.verify_vertices()
    }

    fn verify_slots(&self) -> Result<(), String> {
        let mut free = self.tets.free_slots().to_vec();
        free.sort_unstable();
        let dead: Vec<_> = (0..self.n_slots()).map(TetId::new).filter(|&t| !self.is_alive(t)).collect();
        if free != dead {
            return Err(format!("{} tets on the free list, {} slots free", free.len(), dead.len()));
        }
        for t in self.tets() {
            let mut tet = self.vertices(t);
            tet.sort_unstable();
            if tet.windows(2).any(|w| w[0] == w[1]) || tet[3].index() >= self.n_vertex_slots() {
                return Err(format!("tet {t} has the vertices {tet:?}"));
            }
            let measured = self.measure(self.corners(t));
            if measured.to_bits() != self.quality(t).to_bits() && !self.is_exempt(t) {
                return Err(format!("tet {t} has the quality {measured}, not {}", self.quality(t)));
            }
        }
        Ok(())
    }

    fn verify_links(&self) -> Result<(), String> {
        for half in self.tets().flat_map(|t| (0..4).map(move |i| HalfFacet::new(t, i))) {
            let other = self.across(half.tet(), half.facet());
            match self.behind(half.tet(), half.facet()) {
                Behind::Tet(_) if other.is_none() => {
                    return Err(format!("{half:?} has nothing behind it and is not a wall"));
                }
                Behind::Tet(_) if self.region(other.tet()) != self.region(half.tet()) => {
                    return Err(format!("{half:?} lies between regions and is not a wall"));
                }
                Behind::Tet(_) => {}
                Behind::Wall(wall) if !self.wall(wall).sides.contains(&half) => {
                    return Err(format!("{half:?} is linked to {wall:?}, which does not list it"));
                }
                Behind::Wall(_) => {}
            }
            if other.is_none() {
                continue;
            }
            if !self.is_alive(other.tet()) || self.across(other.tet(), other.facet()) != half {
                return Err(format!("{half:?} leads to {other:?}, which does not lead back"));
            }
            let ([a, b, c], theirs) = (self.facet(half), self.facet(other));
            if ![[a, c, b], [b, a, c], [c, b, a]].contains(&theirs) {
                return Err(format!("{half:?} and {other:?} do not see their facet from opposite sides"));
            }
        }
        for (id, wall) in self.walls() {
            let knows = |side: &HalfFacet| {
                side.is_none() || self.behind(side.tet(), side.facet()) == Behind::Wall(id)
            };
            if !wall.sides.iter().all(knows) {
                return Err(format!("{id:?} has a side that is not linked to it"));
            }
        }
        Ok(())
    }

    /// No facet is used by more than two tets, counted without the links.
    fn verify_facets(&self) -> Result<(), String> {
        let mut counts: HashMap<[VertexId; 3], u32> = HashMap::new();
        for tet in self.tets().map(|t| self.vertices(t)) {
            for facet in FACETS {
                let mut key = facet.map(|i| tet[i]);
                key.sort_unstable();
                *counts.entry(key).or_default() += 1;
            }
        }
        match counts.iter().find(|(_, n)| **n > 2) {
            Some((facet, n)) => Err(format!("{n} tets share the facet {facet:?}")),
            None => Ok(()),
        }
    }

    /// Every line is an edge of a tet.
    fn verify_lines(&self) -> Result<(), String> {
        let lines = self.lines();
        let edges = self.tets().flat_map(|t| EDGES.map(|edge| rising(edge.map(|i| self.vertices(t)[i]))));
        let edges: HashSet<[VertexId; 2]> = if lines.is_empty() { HashSet::new() } else { edges.collect() };
        match lines.iter().find(|(edge, _)| !edges.contains(edge)) {
            Some((edge, _)) => Err(format!("the line {edge:?} is not an edge of a tet")),
            None => Ok(()),
        }
    }

    fn verify_vertices(&self) -> Result<(), String> {
        let mut n_tets = vec![0usize; self.n_vertex_slots()];
        self.tets().flat_map(|t| self.vertices(t)).for_each(|v| n_tets[v.index()] += 1);
        for v in self.vertices.slots() {
            let (tet, n) = (self.tet_of(v), n_tets[v.index()]);
            if (n > 0) != (tet != NO_TET) || n != self.overlaps.n_tets(v) {
                let counted = self.overlaps.n_tets(v);
                return Err(format!("vertex {v} has the tet {tet} and {n} tets, counted: {counted}"));
            }
            if tet != NO_TET && !self.vertices(tet).contains(&v) {
                return Err(format!("vertex {v} is not in its tet {tet}"));
            }
        }
        match self.vertices.free_slots().iter().find(|v| self.is_used(**v)) {
            Some(v) => Err(format!("vertex {v} is on the free list and used")),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::link::{Link, Wall, WallId};
    use crate::kernel::tets::FREE;
    use crate::mesh::shapes::box_grid;
    use crate::mesh::{TetMesh, TetPart};

    /// A box of two regions with a line inside.
    fn sound() -> Complex {
        let mut mesh: TetMesh = TetPart::of(&box_grid([2; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
        let is_left = |t: &[VertexId; 4]| t.iter().map(|v| mesh.points[v.index()][0]).sum::<f64>() < 2.0;
        mesh.regions = mesh.tets.iter().map(|t| i32::from(is_left(t))).collect();
        mesh.lines = vec![[mesh.tets[0][0], mesh.tets[0][1]]];
        mesh.line_labels = vec![1];
        let complex = Complex::new(&mesh).unwrap();
        complex.verify().unwrap();
        complex
    }

    /// The first facet of a tet that is a wall, or that is not.
    fn facet(c: &Complex, is_wall: bool) -> (TetId, usize) {
        let all = c.tets().flat_map(|t| (0..4).map(move |i| (t, i)));
        all.into_iter().find(|&(t, i)| c.is_wall(t, i) == is_wall).unwrap()
    }

    fn set_vertex(c: &mut Complex, tet: TetId, place: usize, vertex: VertexId) {
        let mut vertices = c.vertices(tet);
        vertices[place] = vertex;
        c.tets.set_vertices(tet, vertices);
    }

    #[test]
    fn every_fault_is_found_and_named() {
        type Fault = (&'static str, fn(&mut Complex));
        let faults: [Fault; 16] = [
            ("on the free list", |c| c.tets.put_back_slot(TetId(0))),
            ("on the free list", |c| c.tets.set_vertices(TetId(5), FREE)),
            ("has the vertices", |c| {
                let first = c.vertices(TetId(0))[0];
                set_vertex(c, TetId(0), 1, first);
            }),
            ("has the vertices", |c| {
                let none = c.next_vertex();
                set_vertex(c, TetId(0), 1, none);
            }),
            ("has the quality", |c| c.qualities.set(TetId(3), 0.25)),
            ("has nothing behind it", |c| {
                let (t, i) = facet(c, false);
                c.tets.set_link(HalfFacet::new(t, i), Link::tet(HalfFacet::NONE));
            }),
            ("lies between regions", |c| {
                let (t, _) = facet(c, false);
                c.regions[t.index()] += 7;
            }),
            ("does not list it", |c| {
                let (t, i) = facet(c, true);
                c.tets.set_link(HalfFacet::new(t, i), Link::wall(WallId(c.walls.n_slots() as u32 - 1)));
                let (u, k) = facet(c, false);
                c.tets.set_link(HalfFacet::new(u, k), Link::wall(WallId(0)));
            }),
            ("does not lead back", |c| {
                let (t, i) = facet(c, false);
                let k = (0..4).find(|&k| k != i && !c.is_wall(t, k)).unwrap();
                let mut links = c.tets.links(t);
                links.swap(i, k);
                c.tets.set_links(t, links);
            }),
            ("from opposite sides", |c| {
                let vertex = c.vertices.take_slot();
                c.vertices.set_point(vertex, [0.3; 3]);
                let (t, i) = facet(c, false);
                let k = (0..4).find(|&k| k != i).unwrap();
                set_vertex(c, t, k, vertex);
                c.qualities.set(t, c.measure(c.corners(t)));
            }),
            ("a side that is not linked to it", |c| {
                let (t, i) = facet(c, false);
                let sides = [HalfFacet::new(t, i), HalfFacet::NONE];
                let wall = c.walls.take_slot();
                c.walls.set(wall, Wall { sides, patch: 0, triangle: 0, is_new: true });
            }),
            ("is not an edge of a tet", |c| {
                let line = c.lines()[0].1;
                let far = |p: &[f64; 3]| c.vertices.slots().find(|&v| c.vertices.point(v) == *p).unwrap();
                let edge = rising([far(&[0.0; 3]), far(&[1.0; 3])]);
                c.lines.set(edge, Some(line));
                let edge = rising([far(&[0.0, 0.0, 1.0]), far(&[1.0, 1.0, 0.0])]);
                c.lines.set(edge, Some(line));
            }),
            ("counted", |c| c.overlaps.replace(FREE, [VertexId(4); 4])),
            ("counted", |c| c.tets.set_tet_of(VertexId(4), NO_TET)),
            ("is not in its tet", |c| {
                let other = c.tets().find(|&t| !c.vertices(t).contains(&VertexId(4))).unwrap();
                c.tets.set_tet_of(VertexId(4), other);
            }),
            ("on the free list and used", |c| c.vertices.free_slot(VertexId(4))),
        ];
        for (i, (name, make)) in faults.into_iter().enumerate() {
            let mut complex = sound();
            make(&mut complex);
            let fault = complex.verify().expect_err(name);
            assert!(fault.contains(name), "fault {i}: {fault}, and not: {name}");
        }
    }
}
