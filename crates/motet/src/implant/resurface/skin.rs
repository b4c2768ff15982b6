//! The surface between what is inside and what is outside, cut out of a lattice of tets.

use super::cubes::Lattice;
use super::old::OriginalSurface;
use crate::base::{DisjointSets, MaybeId, Point, Threads, VertexId, sorted_ids};
use crate::geometry::tet::{EDGES, FACETS, volume};
use crate::geometry::vector::{add, distance, scale, sub};
use crate::spatial::runs::in_runs;

/// A vertex moves onto a cut that is nearer to it than this fraction of the edge: for short edges, and for
/// long ones (after Labelle and Shewchuk 2007).
const NEAR: [f64; 2] = [0.412, 0.25];

/// After this many rounds in which vertices that cause pinches stay, all vertices stay.
const ROUNDS: usize = 8;

/// The new surface: triangles that face outward.
pub(super) struct Skin {
    pub(super) points: Vec<Point>,
    pub(super) triangles: Vec<[VertexId; 3]>,
}

/// An edge that the surface cuts: its ends, in ascending order, and where it is cut.
#[derive(Clone, Copy)]
struct Cut {
    ends: [VertexId; 2],
    place: Point,
}

impl Skin {
    /// Builds a closed 2-manifold, even where parts of the old surface touch, or come nearer than the lattice
    /// resolves.
    ///
    /// Without vertices that move onto cuts, this is the level set of a function that is linear in each tet
    /// and 0 at no vertex, which is a manifold. Vertices on the surface can make two sheets meet in an edge
    /// or a vertex; those that do stay where they are, and their edges are cut.
    pub(super) fn new(mut lattice: Lattice, old: &OriginalSurface, threads: &Threads) -> Self {
        let windings = old.windings(&lattice, threads);
        let signs: Vec<i8> = windings.iter().map(|&w| if old.is_inside(w) { -1 } else { 1 }).collect();
        let cuts = cuts(&lattice, &signs, &windings, old, threads);
        let mut moves = moves(&lattice, &cuts);
        let unmoved = std::mem::take(&mut lattice.points);
        let mut round = 0;
        loop {
            let (points, triangles) = cut_along(&mut lattice, &unmoved, &signs, &cuts, &moves);
            let mut pinched = pinches(&triangles);
            pinched.retain(|v| moves.get(v.index()).is_some_and(Option::is_some));
            if pinched.is_empty() {
                return Self::compact(&points, triangles);
            }
            round += 1;
            match round < ROUNDS {
                true => pinched.iter().for_each(|v| moves[v.index()] = None),
                false => moves.fill(None),
            }
        }
    }

    /// The triangles, with their vertices numbered in the order of first use, and only those points.
    pub(super) fn compact(all: &[Point], mut triangles: Vec<[VertexId; 3]>) -> Self {
        let mut new = vec![MaybeId::NONE; all.len()];
        let mut points = Vec::new();
        for v in triangles.as_flattened_mut() {
            *v = new[v.index()].get_or_insert_with(|| {
                points.push(all[v.index()]);
                VertexId::new(points.len() - 1)
            });
        }
        Self { points, triangles }
    }
}

/// All edges that the surface cuts, sorted by their ends.
fn cuts(
    lattice: &Lattice,
    signs: &[i8],
    windings: &[f64],
    old: &OriginalSurface,
    threads: &Threads,
) -> Vec<Cut> {
    let mut edges: Vec<[VertexId; 2]> = Vec::new();
    for tet in &lattice.tets {
        let of_tet = tet.map(|v| signs[v.index()]);
        if of_tet == [of_tet[0]; 4] {
            continue;
        }
        let is_cut = |[i, j]: &&[usize; 2]| of_tet[*i] != of_tet[*j];
        edges.extend(EDGES.iter().filter(is_cut).map(|&[i, j]| sorted_ids([tet[i], tet[j]])));
    }
    edges.sort_unstable();
    edges.dedup();
    let cut = |near: &mut Vec<u32>, ends: [VertexId; 2]| {
        let [mut u, mut v] = ends.map(VertexId::index);
        if signs[u] > 0 {
            (u, v) = (v, u);
        }
        let [from, to] = [u, v].map(|v| lattice.points[v]);
        let share = old.crossing_on_way([from, to], [u, v].map(|v| windings[v]), near);
        Cut { ends, place: add(from, scale(sub(to, from), share)) }
    };
    in_runs(edges.len(), threads, |near, run| run.map(|i| cut(near, edges[i])).collect())
}

/// The fraction of its edge below which a cut is near an end.
fn near(lattice: &Lattice, ends: [VertexId; 2]) -> f64 {
    let [a, b] = ends.map(|v| v.index() >= lattice.n_corners);
    NEAR[usize::from(a == b)]
}

/// For each vertex, the nearest of the cuts that are too near to it: where it moves.
fn moves(lattice: &Lattice, cuts: &[Cut]) -> Vec<Option<Point>> {
    let mut nearest: Vec<(f64, Point)> = vec![(1.0, [0.0; 3]); lattice.points.len()];
    for cut in cuts {
        let [a, b] = cut.ends.map(|v| lattice.points[v.index()]);
        let near = near(lattice, cut.ends);
        let length = distance(a, b);
        for (end, p) in cut.ends.into_iter().zip([a, b]) {
            let share = distance(p, cut.place) / length;
            // As a fraction of what is too near, so that long and short edges compare.
            let part = share / near;
            if part < nearest[end.index()].0 {
                nearest[end.index()] = (part, cut.place);
            }
        }
    }
    nearest.into_iter().map(|(part, place)| (part < 1.0).then_some(place)).collect()
}

/// The points of the lattice, moved, then the cuts that are left; and the triangles of the surface over
/// these.
fn cut_along(
    lattice: &mut Lattice,
    unmoved: &[Point],
    signs: &[i8],
    cuts: &[Cut],
    moves: &[Option<Point>],
) -> (Vec<Point>, Vec<[VertexId; 3]>) {
    let signs: Vec<i8> =
        signs.iter().zip(moves).map(|(&s, place)| if place.is_some() { 0 } else { s }).collect();
    let is_left = |cut: &&Cut| cut.ends.iter().all(|v| signs[v.index()] != 0);
    let left: Vec<Cut> = cuts.iter().filter(is_left).copied().collect();
    lattice.points = unmoved.iter().zip(moves).map(|(&p, place)| place.unwrap_or(p)).collect();
    let mut cutter =
        Cutter { signs: &signs, lattice, cuts: &left, triangles: Vec::new(), closing: Vec::new() };
    for tet in &lattice.tets {
        cutter.cut(*tet);
    }
    let (mut triangles, closing) = (cutter.triangles, cutter.closing);
    triangles.extend(occurring_once(closing));
    let mut points = std::mem::take(&mut lattice.points);
    let place = |cut: &Cut| {
        let [a, b] = cut.ends.map(|v| unmoved[v.index()]);
        let share = distance(a, cut.place) / distance(a, b);
        // Only cuts at vertices that cause pinches are so near to an end: other vertices have moved. Shifted
        // away to `near`, these cuts leave triangles as wide as elsewhere: 25 degrees where turns of a coil
        // touch, 6 with cuts left a tenth of the edge from its end.
        let near = near(lattice, cut.ends);
        if (near..=1.0 - near).contains(&share) {
            return cut.place;
        }
        add(a, scale(sub(b, a), share.clamp(near, 1.0 - near)))
    };
    points.extend(left.iter().map(place));
    (points, triangles)
}

/// The vertices where triangles are no manifold: on edges that are not used by exactly two of them, and where
/// they form more than one fan.
fn pinches(triangles: &[[VertexId; 3]]) -> Vec<VertexId> {
    // A side, and the two corners of its triangle there, as indices into all corners.
    let mut sides: Vec<([VertexId; 2], [u32; 2])> = Vec::with_capacity(3 * triangles.len());
    for (t, triangle) in (0u32..).zip(triangles) {
        for [i, j] in [[0, 1], [1, 2], [2, 0]] {
            let (u, v) = (triangle[i as usize], triangle[j as usize]);
            let corners = [3 * t + i, 3 * t + j];
            sides.push(if u < v { ([u, v], corners) } else { ([v, u], [corners[1], corners[0]]) });
        }
    }
    sides.sort_unstable();
    // Corners connected by triangles with a common edge are one fan.
    let mut fans = DisjointSets::new(3 * triangles.len());
    let mut pinches = Vec::new();
    for same in sides.chunk_by(|x, y| x.0 == y.0) {
        match same {
            [x, y] => (0..2).for_each(|k| fans.join(x.1[k], y.1[k])),
            _ => pinches.extend(same[0].0),
        }
    }
    let corners = triangles.as_flattened();
    let mut roots: Vec<(VertexId, u32)> = (0..).zip(corners).map(|(k, &v)| (v, fans.root(k))).collect();
    roots.sort_unstable();
    roots.dedup();
    pinches.extend(roots.chunk_by(|x, y| x.0 == y.0).filter(|fans| fans.len() > 1).map(|fans| fans[0].0));
    pinches.sort_unstable();
    pinches.dedup();
    pinches
}

/// Cuts tets one by one. A corner of the skin is a vertex of the lattice or, numbered behind those, a cut.
struct Cutter<'a> {
    /// -1 inside, 0 on the surface, 1 outside.
    signs: &'a [i8],
    lattice: &'a Lattice,
    cuts: &'a [Cut],
    triangles: Vec<[VertexId; 3]>,
    /// Facets of inner tets whose corners are all on the surface; those found twice do not belong to it.
    closing: Vec<[VertexId; 3]>,
}

impl Cutter<'_> {
    fn sign(&self, v: VertexId) -> i8 {
        self.signs[v.index()]
    }

    fn corner(&self, u: VertexId, v: VertexId) -> VertexId {
        let i = self.cuts.binary_search_by_key(&sorted_ids([u, v]), |cut| cut.ends).unwrap_or_default();
        VertexId::new(self.lattice.points.len() + i)
    }

    fn cut(&mut self, tet: [VertexId; 4]) {
        let signs = tet.map(|v| self.sign(v));
        let of = |sign: i8| (0..4).filter(move |&k| signs[k] == sign);
        let (inner, outer, on) = (of(-1).count(), of(1).count(), of(0).count());
        if outer == 0 {
            if let (1, 3, Some(k)) = (inner, on, of(-1).next()) {
                self.closing.push(FACETS[k].map(|i| tet[i]));
            }
            return;
        }
        if inner == 0 {
            return;
        }
        // Corners in cyclic order around the cut, as seen from the inner vertices.
        let ring: Vec<VertexId> = match (inner, outer) {
            (2, 2) => {
                let (i, o): (Vec<usize>, Vec<usize>) = (of(-1).collect(), of(1).collect());
                [[i[0], o[0]], [i[0], o[1]], [i[1], o[1]], [i[1], o[0]]]
                    .map(|[u, v]| self.corner(tet[u], tet[v]))
                    .to_vec()
            }
            _ => {
                let cuts = of(-1).flat_map(|i| of(1).map(move |o| [i, o]));
                let cuts = cuts.map(|[i, o]| self.corner(tet[i], tet[o]));
                cuts.chain(of(0).map(|k| tet[k])).collect()
            }
        };
        let is_turned = self.is_turned(tet, &ring);
        for k in 1..ring.len() - 1 {
            let triangle = [ring[0], ring[k], ring[k + 1]];
            self.triangles.push(if is_turned { [triangle[0], triangle[2], triangle[1]] } else { triangle });
        }
    }

    /// Whether a ring of corners runs clockwise seen from an outer vertex. Decided by the order of the tet's
    /// vertices, not by places.
    fn is_turned(&self, tet: [VertexId; 4], ring: &[VertexId]) -> bool {
        // Middles of the edges stand for the cuts, whose exact places do not matter.
        const UNIT: [Point; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let n = self.lattice.points.len();
        let at = |v: VertexId| match v.index().checked_sub(n) {
            None => UNIT[tet.iter().position(|u| *u == v).unwrap_or(0)],
            Some(i) => {
                let ends = self.cuts[i].ends.map(|end| UNIT[tet.iter().position(|u| *u == end).unwrap_or(0)]);
                scale(add(ends[0], ends[1]), 0.5)
            }
        };
        let inner = (0..4).find(|&k| self.sign(tet[k]) < 0).unwrap_or(0);
        volume([at(ring[0]), at(ring[1]), at(ring[2]), UNIT[inner]]) > 0.0
    }
}

/// Facets that occur only once.
fn occurring_once(facets: Vec<[VertexId; 3]>) -> impl Iterator<Item = [VertexId; 3]> {
    let mut keyed: Vec<([VertexId; 3], [VertexId; 3])> =
        facets.into_iter().map(|facet| (sorted_ids(facet), facet)).collect();
    keyed.sort_unstable();
    let single: Vec<[VertexId; 3]> =
        keyed.chunk_by(|x, y| x.0 == y.0).filter(|same| same.len() == 1).map(|same| same[0].1).collect();
    single.into_iter()
}
