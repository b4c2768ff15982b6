//! Repairs the surface: points on its edges and in its triangles move inside, and flat facets get back their
//! given triangles.
//!
//! To remove such a point, each side that has tets gets a point inside (`refill`). A point stays on its edge
//! where a side has no space for one, such as at the free edge of a membrane. Tets outside are removed first:
//! then nothing there can be in the way. They stay only where some triangles have no body on either side, to
//! keep together what lies around an edge or a vertex; they are then remade like the others, but need not be
//! positive.

use hashbrown::HashMap;

use super::bodies::Bodies;
use super::flats::FlatFacets;
use super::plane::Plane;
use super::refill::Side;
use super::segments::Segments;
use super::sites::{Place, SegmentId, Sites};
use crate::base::{Csr, Point, Result, TetId, Threads, VertexId, sorted_ids};
use crate::kernel::{HalfFacet, Tets};

/// A point inside is removed when the least share of the tets without it exceeds this, or the present one.
/// The share is six times the volume over the cube of the longest edge.
const FAIR: f64 = 1e-3;

/// The number of rounds in which points without space are tried again.
const MAX_ROUNDS: usize = 4;

/// The number of failed attempts at enlarging cavities that are allowed, each success allowing one more:
/// where walls are as close to each other as floating-point numbers allow, nothing helps.
const MAX_FAILURES: usize = 128;

/// The tets and the surface during the repair.
pub(super) struct SurfaceRepair<'a> {
    pub(super) tets: &'a mut Tets,
    pub(super) sites: &'a mut Sites,
    pub(super) bodies: &'a mut Bodies,
    /// The triangles as given.
    pub(super) triangles: &'a [[VertexId; 3]],
    pub(super) flats: &'a FlatFacets,
    /// The flat facet of each facet of the surface; vertices in ascending order.
    pub(super) walls: HashMap<[VertexId; 3], u32>,
    /// The number of further failed attempts at enlarging cavities that are allowed (`grow`).
    pub(super) n_failures_left: usize,
    /// The tets of each vertex; `None` until first needed.
    incident: Option<Incidence>,
    /// A point in front of the plane of each flat facet.
    beside: Vec<Point>,
}

/// What a repair leaves.
#[derive(Default)]
pub(super) struct Repaired {
    /// The facets of each flat facet.
    pub(super) parts: Csr<[VertexId; 3]>,
    /// Flat facets whose triangles differ from those given.
    pub(super) unrestored: Vec<u32>,
    /// The tets inside that have no volume in the digits of their coordinates.
    pub(super) flat_tets: Vec<[VertexId; 4]>,
}

/// Facets of the surface, and those that replace them, each with its flat facet and oriented like its plane.
#[derive(Clone, Copy)]
pub(super) struct Exchange<'a> {
    /// Vertices in ascending order.
    pub(super) old: &'a [[VertexId; 3]],
    pub(super) base: &'a [(u32, [VertexId; 3])],
}

impl<'a> SurfaceRepair<'a> {
    pub(super) fn new(
        tets: &'a mut Tets,
        sites: &'a mut Sites,
        bodies: &'a mut Bodies,
        triangles: &'a [[VertexId; 3]],
        flats: &'a FlatFacets,
        parts: &Csr<[VertexId; 3]>,
    ) -> Self {
        let of_flat = |(flat, list): (usize, &[[VertexId; 3]])| {
            list.iter().map(|&part| (sorted_ids(part), flat as u32)).collect::<Vec<_>>()
        };
        let walls = parts.iter().enumerate().flat_map(of_flat).collect();
        let beside = |flat: &[u32]| Plane::new(sites, triangles[flat[0] as usize]).beside();
        let beside = flats.triangles.iter().map(beside).collect();
        Self {
            tets,
            sites,
            bodies,
            triangles,
            flats,
            walls,
            n_failures_left: MAX_FAILURES,
            incident: None,
            beside,
        }
    }

    /// Repairs the surface where possible.
    pub(super) fn run(mut self, segments: &Segments, threads: &Threads) -> Result<Repaired> {
        self.shed();
        self.remove_outside();
        let on_segments = segments.points(self.sites);
        let mut chains: Vec<(u32, Vec<VertexId>)> = (0..on_segments.len() as u32)
            .map(|s| (s, on_segments.list(s as usize).to_vec()))
            .filter(|(_, points)| !points.is_empty())
            .collect();
        let is_in = |(v, place): (VertexId, Place)| matches!(place, Place::In(..)).then_some(v);
        let mut in_triangles: Vec<VertexId> = self.sites.all_placed().filter_map(is_in).collect();
        // Points without space at first may find some once their neighbours have moved.
        for _ in 0..MAX_ROUNDS {
            in_triangles.retain(|&vertex| self.free(vertex, None).is_none());
            let n_chains = chains.len();
            for (i, (segment, points)) in chains.iter_mut().enumerate() {
                threads.watch().report_and_check("moving points off edges", i, n_chains)?;
                self.move_all_inside(segments.ends(SegmentId(*segment)), points);
            }
            chains.retain(|(_, points)| !points.is_empty());
        }
        let mut lists = self.lists();
        let mut unrestored = Vec::new();
        for (flat, list) in lists.iter_mut().enumerate() {
            if self.flats.triangles.list(flat).len() > 1 && self.restore(flat, list).is_none() {
                unrestored.push(flat as u32);
            }
        }
        let flat_tets = self.remove_flat(threads);
        let mut parts = Csr::default();
        lists.into_iter().for_each(|list| parts.push(list));
        Ok(Repaired { parts, unrestored, flat_tets })
    }

    /// Removes the tets outside where each triangle has a body at it: they are no longer needed.
    fn remove_outside(&mut self) {
        if self.bodies.sides.iter().all(|sides| *sides != [0; 2]) {
            let is_outside = |tet: &TetId| self.bodies.of_slot[tet.index()] == 0;
            let outside: Vec<TetId> = self.tets.iter().map(|(tet, _)| tet).filter(is_outside).collect();
            for tet in outside {
                for half in Tets::facets(tet) {
                    self.tets.join(HalfFacet::NONE, self.tets.across(half));
                }
                self.tets.remove(tet);
            }
        }
    }

    /// All tets of a vertex, which need not be connected.
    pub(super) fn star(&mut self, vertex: VertexId) -> Vec<TetId> {
        let incident = self.incident.get_or_insert_with(|| Incidence::of(self.tets, self.sites.len()));
        incident.star(self.tets, vertex)
    }

    /// Moves inside those points of a segment that can be; leaves the others in the list.
    fn move_all_inside(&mut self, [mut before, last]: [VertexId; 2], points: &mut Vec<VertexId>) {
        let mut left = Vec::new();
        for (i, &vertex) in points.iter().enumerate() {
            let after = points.get(i + 1).copied().unwrap_or(last);
            if self.free(vertex, Some([before, after])).is_none() {
                left.push(vertex);
                before = vertex;
            }
        }
        *points = left;
    }

    /// The facets of the surface by flat facet, each list sorted and oriented like its plane.
    pub(super) fn lists(&self) -> Vec<Vec<[VertexId; 3]>> {
        let mut lists = vec![Vec::new(); self.flats.triangles.len()];
        self.walls.iter().for_each(|(&face, &flat)| lists[flat as usize].push(face));
        for (flat, list) in (0..).zip(&mut lists) {
            let first = self.triangles[self.flats.triangles.list(flat as usize)[0] as usize];
            list.sort_unstable();
            if *list == [sorted_ids(first)] {
                *list = vec![first];
            } else {
                let plane = self.plane(flat);
                list.iter_mut().for_each(|face| *face = plane.turned(*face));
            }
        }
        lists
    }

    /// Moves a point inside: one on an edge, whose neighbours `ends` there are joined, or one in a triangle.
    /// `None` where that is impossible.
    fn free(&mut self, vertex: VertexId, ends: Option<[VertexId; 2]>) -> Option<()> {
        let star = self.star(vertex);
        let fans = self.fans(vertex, &star);
        let mut base: Vec<(u32, [VertexId; 3])> = Vec::new();
        let mut i = 0;
        while i < fans.len() {
            let n = fans[i..].iter().take_while(|f| f.0 == fans[i].0).count();
            base.extend(self.joined(vertex, ends, &fans[i..i + n])?);
            i += n;
        }
        let old: Vec<_> = fans.iter().map(|f| sorted_ids(f.1)).collect();
        let is_around = |tets: &Tets, half: HalfFacet| tets.vertices(half.tet())[half.facet()] == vertex;
        if star.is_empty() {
            return None;
        }
        let sides = self.sides(&star, &old, &base, is_around)?;
        self.commit(sides, self.sites.near(vertex), Exchange { old: &old, base: &base }, true)
    }

    /// The facets of the surface at a vertex, each with its flat facet and oriented like its plane; sorted.
    fn fans(&self, vertex: VertexId, star: &[TetId]) -> Vec<(u32, [VertexId; 3])> {
        let mut fans = Vec::new();
        for &tet in star {
            for half in Tets::facets(tet) {
                let face = self.tets.inward(half);
                if face.contains(&vertex)
                    && let Some(flat) = self.wall(half)
                {
                    fans.push((flat, sorted_ids(face)));
                }
            }
        }
        fans.sort_unstable();
        fans.dedup();
        for (flat, face) in &mut fans {
            *face = self.plane(*flat).turned(*face);
        }
        fans
    }

    /// The flat facet to which a facet of a tet belongs. Tets outside may overlap, so facets with the same
    /// vertices may lie between other tets; these do not count.
    pub(super) fn wall(&self, half: HalfFacet) -> Option<u32> {
        let flat = *self.walls.get(&sorted_ids(self.tets.inward(half)))?;
        let other = self.tets.across(half);
        let behind = if other.is_none() { 0 } else { self.bodies.of_slot[other.tet().index()] };
        let bodies = [self.bodies.of_slot[half.tet().index()], behind];
        let [a, b] = self.bodies.sides[flat as usize];
        (bodies == [a, b] || bodies == [b, a]).then_some(flat)
    }

    pub(super) fn plane(&self, flat: u32) -> Plane<'_> {
        Plane::behind(self.sites, self.beside[flat as usize])
    }

    /// The triangles that replace those around a vertex in one flat facet.
    fn joined(
        &self,
        vertex: VertexId,
        ends: Option<[VertexId; 2]>,
        fan: &[(u32, [VertexId; 3])],
    ) -> Option<Vec<(u32, [VertexId; 3])>> {
        let flat = fan[0].0;
        let plane = self.plane(flat);
        // For each facet (vertex, x, y), the step from x to y around the vertex.
        let step = |&(_, [a, b, c]): &(u32, [VertexId; 3])| match vertex {
            v if v == a => (b, c),
            v if v == b => (c, a),
            _ => (a, b),
        };
        let Some(ends) = ends else {
            let mut polygon = vec![step(&fan[0]).0];
            for _ in 1..fan.len() {
                let next = fan.iter().map(step).find(|s| Some(&s.0) == polygon.last())?;
                polygon.push(next.1);
            }
            return Some(plane.clip(&polygon)?.into_iter().map(|t| (flat, t)).collect());
        };
        let mut triangles = Vec::new();
        let mut n_steps = 0;
        for start in ends {
            let mut polygon = vec![start];
            while let Some((_, next)) = fan.iter().map(step).find(|s| Some(&s.0) == polygon.last()) {
                polygon.push(next);
                n_steps += 1;
                if ends.contains(&next) || n_steps > fan.len() {
                    break;
                }
            }
            if polygon.len() > 2 {
                triangles.extend(plane.clip(&polygon)?.into_iter().map(|t| (flat, t)));
            }
        }
        (n_steps == fan.len()).then_some(triangles)
    }

    /// The sides of a part of the surface whose facets `old` are to be replaced by `base`: sets of tets in
    /// `star` that are connected without crossing the surface. `is_around` selects the facets of the tets
    /// that stay. `None` where one tet lies on both sides.
    pub(super) fn sides(
        &mut self,
        star: &[TetId],
        old: &[[VertexId; 3]],
        base: &[(u32, [VertexId; 3])],
        is_around: impl Fn(&Tets, HalfFacet) -> bool,
    ) -> Option<Vec<Side>> {
        let mut sides: Vec<Side> = Vec::new();
        let mut done: Vec<TetId> = Vec::new();
        for &first in star {
            if done.contains(&first) {
                continue;
            }
            let mut side = Side::default();
            let mut seen: Vec<(u32, bool)> = Vec::new();
            side.tets.push(first);
            let mut next = 0;
            while let Some(&tet) = side.tets.get(next) {
                next += 1;
                for half in Tets::facets(tet) {
                    let (face, other) = (self.tets.inward(half), self.tets.across(half));
                    if is_around(self.tets, half) {
                        side.shell.push((other, face));
                    } else if let Some(flat) = self.wall(half) {
                        if !old.contains(&sorted_ids(face)) {
                            return None;
                        }
                        seen.push((flat, self.plane(flat).turned(face) == face));
                    } else if !other.is_none() && !side.tets.contains(&other.tet()) {
                        side.tets.push(other.tet());
                    }
                }
            }
            seen.sort_unstable();
            seen.dedup();
            for &(flat, is_front) in &seen {
                if seen.contains(&(flat, !is_front)) {
                    return None;
                }
                let own = base.iter().filter(|b| b.0 == flat).map(|b| b.1);
                side.base.extend(own.map(|[a, b, c]| if is_front { [a, b, c] } else { [a, c, b] }));
            }
            done.extend(&side.tets);
            sides.push(side);
        }
        Some(sides)
    }

    /// Fills each cavity of `sides` with tets from a new point, provided that all have such a point, enlarged
    /// if necessary. Unless tets `may_be_flat`, all have a volume in the digits of their coordinates.
    pub(super) fn commit(
        &mut self,
        mut sides: Vec<Side>,
        middle: Point,
        Exchange { old, base }: Exchange,
        may_be_flat: bool,
    ) -> Option<()> {
        let mut places = Vec::with_capacity(sides.len());
        for i in 0..sides.len() {
            let is_outside = self.bodies.of_slot[sides[i].tets[0].index()] == 0;
            places.push(if is_outside {
                middle
            } else {
                self.find_apex(&mut sides, i, middle, may_be_flat)?
            });
        }
        let (mut on_base, mut new_inside) = (Vec::new(), Vec::new());
        for (side, place) in sides.iter().zip(places) {
            let is_inside = self.bodies.of_slot[side.tets[0].index()] != 0;
            let vertex = self.sites.add_point(place);
            let made = self.make(side, vertex);
            new_inside.extend(is_inside.then_some(vertex));
            let bare = side.base.iter().zip(&made[side.shell.len()..]);
            on_base.extend(bare.map(|(&face, &tet)| (sorted_ids(face), HalfFacet::new(tet, 3))));
        }
        on_base.sort_unstable();
        for pair in on_base.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, a), (_, b)] = *pair {
                self.tets.join(a, b);
            }
        }
        for face in old {
            self.walls.remove(face);
        }
        self.walls.extend(base.iter().map(|&(flat, face)| (sorted_ids(face), flat)));
        new_inside.into_iter().for_each(|vertex| self.remove_or_improve(vertex));
        Some(())
    }

    /// Remakes a side from `apex`: the new tets are of the body of the removed ones.
    fn make(&mut self, side: &Side, apex: VertexId) -> Vec<TetId> {
        let body = self.bodies.of_slot[side.tets[0].index()];
        let made = side.make(self.tets, apex);
        self.bodies.of_slot.resize(self.tets.n_slots(), Bodies::NONE);
        made.iter().for_each(|tet| self.bodies.of_slot[tet.index()] = body);
        if let Some(incident) = &mut self.incident {
            made.iter().for_each(|&tet| incident.add(tet, self.tets.vertices(tet)));
        }
        made
    }

    /// Removes a point inside if another vertex can take its place; otherwise moves it to a better place.
    /// Without this, points nearby would have less and less space.
    fn remove_or_improve(&mut self, vertex: VertexId) {
        let mut star = Vec::new();
        self.tets.star(vertex, &mut star);
        let side = Side::of_star(self.tets, vertex, &star);
        let worst = side.worst_to(self.sites, vertex);
        if let Some(apex) = side.best_apex(self.sites, worst.min(FAIR)) {
            self.make(&side, apex);
        } else if let Some(place) = side.better_place(self.sites, vertex, worst) {
            self.sites.move_to(vertex, place);
        }
    }
}

/// The tets of each vertex, together with some that no longer have it.
struct Incidence {
    first: Csr<TetId>,
    /// Tets made later.
    made: HashMap<VertexId, Vec<TetId>>,
}

impl Incidence {
    fn of(tets: &Tets, n_vertices: usize) -> Self {
        let pairs = || tets.iter().flat_map(|(tet, v)| v.map(|v| (v.index(), tet)));
        Self { first: Csr::from_pairs(n_vertices, pairs), made: HashMap::new() }
    }

    fn add(&mut self, tet: TetId, vertices: [VertexId; 4]) {
        vertices.into_iter().for_each(|v| self.made.entry(v).or_default().push(tet));
    }

    /// All tets of a vertex, in rising order.
    fn star(&self, tets: &Tets, vertex: VertexId) -> Vec<TetId> {
        let first = if vertex.index() < self.first.len() { self.first.list(vertex.index()) } else { &[] };
        let made = self.made.get(&vertex).map_or(&[][..], Vec::as_slice);
        let all = first.iter().chain(made).copied();
        let mut star: Vec<TetId> = all.filter(|&tet| tets.vertices(tet).contains(&vertex)).collect();
        star.sort_unstable();
        star.dedup();
        star
    }
}
