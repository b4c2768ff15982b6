//! Gives a triangle that cannot be recovered otherwise points inside, where edges of tets pierce it.
//!
//! A point where an edge pierces the triangle sees all tets around that edge. Inserting it removes the edge
//! and adds none that pierces. So there are at most as many steps as there are such edges at first; after
//! that the triangle is a union of facets, whichever they are.

use hashbrown::HashSet;

use super::plane::Plane;
use super::sides::Sides;
use super::sites::Sites;
use super::split::{Protected, Split, faces_around, positive_part, round_between};
use super::swap::{Swap, Target};
use crate::base::{TetId, VertexId, sorted_ids};
use crate::geometry::tet::EDGES;
use crate::kernel::Tets;

/// The largest number of points put in one flat facet.
const MAX_POINTS: usize = 4000;

/// The number of times that a point is moved to the middle of its permitted range, in each of two directions.
const STEPS: usize = 3;

/// A flat facet that is missing, and buffers reused from one such facet to the next.
#[derive(Default)]
pub(super) struct PiercedFacet {
    /// The triangles given, with their numbers.
    triangles: Vec<(u32, [VertexId; 3])>,
    sides: Sides,
    /// The triangles into which it is to be cut at first, which define where it is.
    parts: Vec<[VertexId; 3]>,
    /// The edges of its outline in the direction of its orientation, each with a vertex on the inner side.
    rim: Vec<([VertexId; 2], VertexId)>,
    /// The vertices inside it.
    points: Vec<VertexId>,
    n_added: usize,
    split: Split,
    swap: Swap,
    star: Vec<TetId>,
    cut: Vec<TetId>,
    /// The edges that pierce it, each with a tet.
    piercing: Vec<(TetId, [VertexId; 2])>,
}

/// A triangle that is to become a union of facets, among other parts that must not be lost.
struct Whole<'a, K> {
    sites: &'a Sites,
    sides: &'a Sides,
    parts: &'a [[VertexId; 3]],
    kept: &'a K,
}

impl<K: Protected> Protected for Whole<'_, K> {
    fn has_edge(&self, edge: [VertexId; 2]) -> bool {
        self.kept.has_edge(edge)
    }

    fn has_facet(&self, face: [VertexId; 3]) -> bool {
        self.kept.has_facet(face)
    }
}

impl<K: Protected> Target for Whole<'_, K> {
    fn meets_facet(&self, _: [VertexId; 3]) -> u32 {
        0
    }

    fn meets_edge(&self, [u, v]: [VertexId; 2]) -> u32 {
        let is_cut = self.sides.of(self.sites, u) * self.sides.of(self.sites, v) < 0;
        u32::from(is_cut && self.parts.iter().any(|&part| pierces(self.sites, [u, v], part)))
    }
}

/// Whether the line through an edge passes through a triangle.
fn is_in(sites: &Sites, [u, v]: [VertexId; 2], [a, b, c]: [VertexId; 3]) -> bool {
    let turns = [[a, b], [b, c], [c, a]].map(|[p, q]| sites.orient3d([u, v, p, q]));
    turns.iter().all(|&t| t >= 0) || turns.iter().all(|&t| t <= 0)
}

/// Whether an edge passes through a triangle, from one side of it to the other.
fn pierces(sites: &Sites, [u, v]: [VertexId; 2], [a, b, c]: [VertexId; 3]) -> bool {
    // Each part of a facet that is flat only up to rounding has a plane of its own.
    is_in(sites, [u, v], [a, b, c]) && sites.orient3d([a, b, c, u]) * sites.orient3d([a, b, c, v]) < 0
}

impl PiercedFacet {
    /// Switches to another missing flat facet, given as `triangles`, at least one, that is to consist of
    /// `parts`, oriented like the first triangle.
    pub(super) fn begin(&mut self, triangles: Vec<(u32, [VertexId; 3])>, parts: &[[VertexId; 3]]) {
        let around = |&[a, b, c]: &[VertexId; 3]| [([a, b], c), ([b, c], a), ([c, a], b)];
        let edges: HashSet<[VertexId; 2]> = parts.iter().flat_map(around).map(|(edge, _)| edge).collect();
        let is_outer = |(edge, _): &([VertexId; 2], VertexId)| !edges.contains(&[edge[1], edge[0]]);
        self.rim.clear();
        self.rim.extend(parts.iter().flat_map(around).filter(is_outer));
        let on_rim: HashSet<VertexId> = self.rim.iter().flat_map(|(edge, _)| *edge).collect();
        self.points.clear();
        self.points.extend(parts.as_flattened().iter().filter(|v| !on_rim.contains(*v)));
        self.points.sort_unstable();
        self.points.dedup();
        self.sides.begin(triangles[0].1, parts);
        self.triangles = triangles;
        self.parts.clear();
        self.parts.extend_from_slice(parts);
        self.n_added = 0;
    }

    /// Makes it a union of facets by swaps, without points inside; returns whether that succeeded.
    pub(super) fn swap_all(&mut self, tets: &mut Tets, sites: &Sites, kept: &impl Protected) -> bool {
        loop {
            self.find_piercing(tets, sites, kept);
            let wanted = Whole { sites, sides: &self.sides, parts: &self.parts, kept };
            let mut edges = self.piercing.iter();
            if !edges.any(|&(tet, edge)| self.swap.remove(tets, sites, edge, tet, &wanted, 0)) {
                return self.piercing.is_empty();
            }
        }
    }

    /// Makes it a union of facets, with points inside; returns the facets, or `None` where that fails.
    pub(super) fn run(
        &mut self,
        tets: &mut Tets,
        sites: &mut Sites,
        kept: &impl Protected,
    ) -> Option<Vec<[VertexId; 3]>> {
        while !self.swap_all(tets, sites, kept) {
            if self.n_added == MAX_POINTS {
                return None;
            }
            self.pierce(tets, sites, kept)?;
        }
        self.facets(tets, sites)
    }

    /// Inserts a point where one of the edges pierces: the first possible one, starting from the middle of
    /// the list.
    fn pierce(&mut self, tets: &mut Tets, sites: &mut Sites, kept: &impl Protected) -> Option<()> {
        let n = self.piercing.len();
        for i in 0..n {
            let (tet, edge) = self.piercing[(n / 2 + i) % n];
            tets.around_from(edge, tet, &mut self.star);
            let Some((number, triangle)) = self.triangles.iter().copied().find(|t| pierces(sites, edge, t.1))
            else {
                continue;
            };
            let shares = self.shares(tets, sites, edge, triangle);
            let vertex = sites.add_in(number, triangle, shares);
            if self.split.insert(tets, sites, vertex, (&self.star, &self.star), kept) {
                self.points.push(vertex);
                self.sides.add(vertex);
                self.n_added += 1;
                return Some(());
            }
        }
        None
    }

    /// Collects the edges that pierce the triangle, each once, with one tet of each.
    fn find_piercing(&mut self, tets: &mut Tets, sites: &Sites, kept: &impl Protected) {
        self.sides.grow(sites);
        let mut cut = std::mem::take(&mut self.cut);
        cut.clear();
        for &([a, b], beyond) in &self.rim {
            tets.around([a, b], &mut self.star);
            let is_cut = |tet: &&TetId| {
                let Some([p, q]) = self.across(tets, sites, **tet) else { return false };
                // Between the half planes of p and q, which are less than half a turn apart.
                let turn = sites.orient3d([a, b, p, q]);
                sites.orient3d([a, b, p, beyond]) == turn && sites.orient3d([a, b, beyond, q]) == turn
            };
            cut.extend(self.star.iter().find(is_cut));
        }
        for i in 0..self.points.len() {
            tets.star(self.points[i], &mut self.star);
            cut.extend(self.star.iter().filter(|&&tet| self.across(tets, sites, tet).is_some()));
        }
        let wanted = Whole { sites, sides: &self.sides, parts: &self.parts, kept };
        if self.rim.len() > 3 {
            // What is missing may lie between existing edges, none of them on the outline.
            for &([a, _], _) in &self.rim {
                tets.star(a, &mut self.star);
                let is_pierced = |tet: &&TetId| {
                    let v = tets.vertices(**tet);
                    EDGES.iter().any(|&[i, j]| wanted.meets_edge([v[i], v[j]]) > 0)
                };
                cut.extend(self.star.iter().filter(is_pierced));
            }
        }
        cut.sort_unstable();
        cut.dedup();
        tets.begin();
        cut.iter().for_each(|&tet| _ = tets.mark(tet));
        self.piercing.clear();
        let mut next = 0;
        while let Some(&tet) = cut.get(next) {
            next += 1;
            let v = tets.vertices(tet);
            let sides = v.map(|v| self.side(sites, v));
            for [i, j] in EDGES.into_iter().filter(|&[i, j]| sides[i] * sides[j] < 0) {
                self.piercing.push((tet, sorted_ids([v[i], v[j]])));
            }
            for half in Tets::facets(tet) {
                let of = [0, 1, 2, 3].map(|i| if i == half.facet() { 0 } else { sides[i] });
                let other = tets.across(half);
                let is_cut = of.contains(&1) && of.contains(&-1) && !other.is_none();
                if is_cut && tets.mark(other.tet()) {
                    cut.push(other.tet());
                }
            }
        }
        self.piercing.sort_unstable_by_key(|&(tet, edge)| (edge, tet));
        self.piercing.dedup_by_key(|p| p.1);
        self.piercing.retain(|&(_, edge)| wanted.meets_edge(edge) > 0);
        self.cut = cut;
    }

    /// An edge of a tet whose ends lie strictly on different sides of the plane.
    fn across(&self, tets: &Tets, sites: &Sites, tet: TetId) -> Option<[VertexId; 2]> {
        let v = tets.vertices(tet);
        let sides = v.map(|v| self.side(sites, v));
        let front = sides.iter().position(|&s| s > 0)?;
        let behind = sides.iter().position(|&s| s < 0)?;
        Some([v[front], v[behind]])
    }

    fn side(&self, sites: &Sites, v: VertexId) -> i8 {
        self.sides.of(sites, v)
    }

    fn turn(&self, sites: &Sites, t: [VertexId; 3]) -> i8 {
        Plane::new(sites, self.sides.corners).turn(t)
    }

    /// Where an edge pierces a triangle, moved towards the middle of the range from which the tets around the
    /// edge, in `star`, are all seen.
    fn shares(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        [u, v]: [VertexId; 2],
        [a, b, c]: [VertexId; 3],
    ) -> [f64; 2] {
        let weights = sites.volume_ratios([[u, v, b, c], [u, v, c, a], [u, v, a, b]]);
        let all: f64 = weights.iter().sum();
        let [_, mut s, mut t] = weights.map(|w| w / all);
        let faces = faces_around(tets, &self.star);
        let corner =
            |[p, q, r]: [VertexId; 3]| sites.volume_ratios([[p, q, r, a], [p, q, r, b], [p, q, r, c]]);
        // The height of each corner of the triangle over each face.
        let heights: Vec<[f64; 3]> = faces.into_iter().map(corner).collect();
        for _ in 0..STEPS {
            let along_s = |&[a, b, c]: &[f64; 3]| [a + t * (c - a), b + t * (c - a)];
            let [low, high] = positive_part(heights.iter().map(along_s)).unwrap_or([0.0, 1.0]);
            s = round_between([low, high.min(1.0 - t)]);
            let along_t = |&[a, b, c]: &[f64; 3]| [a + s * (b - a), c + s * (b - a)];
            let [low, high] = positive_part(heights.iter().map(along_t)).unwrap_or([0.0, 1.0]);
            t = round_between([low, high.min(1.0 - s)]);
        }
        [s, t]
    }

    /// The vertex that forms a facet in the plane with an edge, on the left of it; `star` holds the tets of
    /// the edge. Where rounding has left flat tets in the plane there may be several facets: the one taken
    /// has none in front of it.
    fn frontmost(&self, tets: &Tets, sites: &Sites, [a, b]: [VertexId; 2]) -> Option<VertexId> {
        let mut any = None;
        for v in self.star.iter().map(|&tet| tets.vertices(tet)) {
            let mut others = v.into_iter().filter(|&c| c != a && c != b);
            let (c, d) = (others.next()?, others.next()?);
            for (c, beyond) in [(c, d), (d, c)] {
                if self.side(sites, c) == 0 && self.turn(sites, [a, b, c]) > 0 {
                    if self.side(sites, beyond) > 0 {
                        return Some(c);
                    }
                    any = Some(c);
                }
            }
        }
        any
    }

    /// The facets of which the triangle consists, found from its outline inwards.
    pub(super) fn facets(&mut self, tets: &mut Tets, sites: &Sites) -> Option<Vec<[VertexId; 3]>> {
        let mut facets: Vec<[VertexId; 3]> = Vec::new();
        let mut todo: Vec<[VertexId; 2]> = self.rim.iter().map(|r| r.0).collect();
        let outline: HashSet<[VertexId; 2]> = todo.iter().copied().collect();
        let most = 2 * (self.rim.len() + self.points.len()) + self.parts.len();
        let mut done: HashSet<[VertexId; 2]> = HashSet::new();
        while let Some([a, b]) = todo.pop() {
            if done.contains(&[a, b]) {
                continue;
            }
            tets.around([a, b], &mut self.star);
            let c = self.frontmost(tets, sites, [a, b])?;
            facets.push([a, b, c]);
            done.extend([[a, b], [b, c], [c, a]]);
            todo.extend([[b, c], [c, a]].into_iter().filter(|e| !outline.contains(e)).map(|[p, q]| [q, p]));
            if facets.len() > most {
                return None;
            }
        }
        let mut seen: Vec<_> = facets.iter().copied().map(sorted_ids).collect();
        seen.sort_unstable();
        seen.dedup();
        (seen.len() == facets.len()).then_some(facets)
    }
}
