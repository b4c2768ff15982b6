//! Divides triangles where they touch, overlap or cross, so that they share vertices, edges and whole
//! triangles.
//!
//! What counts as one place is determined from the digits of the coordinates (`geometry::rounding`). Surfaces
//! that are already correct stay as they are: within a part connected by edges, triangles are compared only
//! if some of them meet by exact tests, or a vertex of a rim lies on an open edge; otherwise only different
//! parts are compared.

use std::collections::{BTreeMap, BTreeSet};

use super::Repairs;
use super::report::{Repair, RepairKind};
use super::work::{Origin, Piece, Work};
use crate::base::{DisjointSets, Point, Threads, VertexId, same_orientation, sorted_ids};
use crate::geometry::triangle::{self, centroid};
use crate::geometry::vector::{add, distance, in_range, scale, sub};
use crate::geometry::{rounding, segment};
use crate::preflight::crossing::own_crossings;
use crate::preflight::cut::{Cut, Meeting, MeetingKind, Rule};
use crate::preflight::single::{Shape, shapes};
use crate::preflight::surfaces::Role;
use crate::spatial::{BoxTree, WindingNumber, bounding_box};

/// The result of dividing: all points, the origins of the new ones, the vertex that each given one has
/// become, and the pieces.
pub(super) struct DividedSurfaces {
    pub(super) points: Vec<Point>,
    pub(super) origins: Vec<Origin>,
    pub(super) vertex_to_kept: Vec<VertexId>,
    pub(super) pieces: Vec<Piece>,
}

impl DividedSurfaces {
    /// The work with these points and pieces in place of those before; continues what is known of vertices
    /// and new points.
    pub(super) fn replace<'a>(
        &'a self,
        work: Work<'a>,
        vertex_to_kept: &mut Vec<VertexId>,
        origins: &mut Vec<Origin>,
    ) -> Work<'a> {
        let n_before = work.points.len();
        vertex_to_kept.iter_mut().for_each(|v| *v = self.vertex_to_kept[v.index()]);
        vertex_to_kept.extend((n_before..self.points.len()).map(VertexId::new));
        origins.extend(&self.origins);
        Work { points: &self.points, pieces: self.pieces.clone(), ..work }
    }
}

/// Divides triangles that touch or overlap and, with `cut` or `unite`, those that cross. `None` if nothing
/// has to be divided, or if dividing fails, which is reported; what is to be united is divided once more
/// later.
pub(super) fn divide(work: &mut Work, repairs: &Repairs, threads: &Threads) -> Option<DividedSurfaces> {
    let lists = work.lists();
    let shapes = shapes(&lists.surfaces(work), threads);
    let sound: Vec<u32> =
        (0..).zip(&shapes).filter(|(_, shape)| **shape == Shape::Sound).map(|(t, _)| t).collect();
    let triangles: Vec<[VertexId; 3]> = sound.iter().map(|&t| work.pieces[t as usize].vertices).collect();
    if triangles.is_empty() {
        return None;
    }
    let used: Vec<Point> = triangles.as_flattened().iter().map(|v| work.points[v.index()]).collect();
    // Each of two points can be off by this much.
    let near = 2.0 * rounding::of(&used);
    let parts = Parts::new(work.points, &triangles, near, threads);
    let admits = |p: u32, q: u32| p != q || parts.is_faulty[p as usize];
    let cut = |crossings: bool| {
        let rule = Rule { group_of: &parts.part_of, admits: &admits, near, crossings };
        Cut::new(work.points, &triangles, &rule, threads)
    };
    let made = cut(repairs.cut || repairs.unite).or_else(|| repairs.unite.then(|| cut(false)).flatten());
    let Some(cut) = made else {
        if !repairs.unite {
            work.record(RepairKind::LeftMeeting, Vec::new(), Vec::new());
        }
        return None;
    };
    let is_changed = cut.pieces.len() != triangles.len()
        || cut.pieces.iter().zip(&triangles).any(|(piece, t)| piece.0 != *t);
    if is_changed {
        record_meetings(work, &cut, &sound);
    }
    let origins = origins(work, &cut, &sound);
    let mut divided = DividedSurfaces {
        pieces: pieces(work, &cut, &sound),
        points: cut.points,
        origins,
        vertex_to_kept: cut.vertex_to_kept,
    };
    let has_duplicates = !repairs.unite && drop_duplicate_pieces(work, &mut divided);
    (is_changed || has_duplicates).then_some(divided)
}

/// The parts connected by edges, across all surfaces.
struct Parts {
    /// The part of each triangle.
    part_of: Vec<u32>,
    /// Whether triangles of the part meet in more than they share, or a vertex of a rim lies on an open edge.
    is_faulty: Vec<bool>,
}

impl Parts {
    fn new(points: &[Point], triangles: &[[VertexId; 3]], near: f64, threads: &Threads) -> Self {
        let of = |(t, [a, b, c]): (u32, &[VertexId; 3])| {
            [[*a, *b], [*b, *c], [*c, *a]].map(|edge| (sorted_ids(edge), t))
        };
        let mut edges: Vec<([VertexId; 2], u32)> = (0..).zip(triangles).flat_map(of).collect();
        edges.sort_unstable();
        let mut sets = DisjointSets::new(triangles.len());
        let mut open = Vec::new();
        for same in edges.chunk_by(|x, y| x.0 == y.0) {
            same[1..].iter().for_each(|other| sets.join(same[0].1, other.1));
            if same.len() == 1 {
                open.push(same[0]);
            }
        }
        let part_of = sets.roots();
        let mut is_faulty = vec![false; triangles.len()];
        for pair in own_crossings(points, triangles, threads) {
            let [i, j] = pair.map(|t| t as usize);
            let is_twice = sorted_ids(triangles[i]) == sorted_ids(triangles[j]);
            if part_of[i] == part_of[j] && !is_twice {
                is_faulty[part_of[i] as usize] = true;
            }
        }
        for t in at_open_edges(points, &open, near) {
            is_faulty[part_of[t as usize] as usize] = true;
        }
        Self { part_of, is_faulty }
    }
}

/// The triangles of open edges on which the end of another open edge lies.
fn at_open_edges(points: &[Point], open: &[([VertexId; 2], u32)], near: f64) -> Vec<u32> {
    let at = |v: VertexId| points[v.index()];
    let mut ends: Vec<VertexId> = open.iter().flat_map(|edge| edge.0).collect();
    ends.sort_unstable();
    ends.dedup();
    let tree = BoxTree::new(&ends.iter().map(|&v| [at(v); 2]).collect::<Vec<_>>());
    let (mut touching, mut found) = (Vec::new(), Vec::new());
    for &(edge, t) in open {
        let [from, to] = edge.map(at);
        let [low, high] = bounding_box([from, to]);
        tree.touching([low.map(|x| x - near), high.map(|x| x + near)], &mut touching);
        let is_on = |v: VertexId| {
            let p = at(v);
            let foot = add(from, scale(sub(to, from), segment::closest([from, to], p)));
            !edge.contains(&v) && distance(foot, p) <= near
        };
        if touching.iter().any(|&i| is_on(ends[i as usize])) {
            found.push(t);
        }
    }
    found
}

/// The pieces, each with the data of the triangle that it is part of; triangles without area stay as they
/// are.
fn pieces(work: &Work, cut: &Cut, sound: &[u32]) -> Vec<Piece> {
    let mut is_sound = vec![false; work.pieces.len()];
    sound.iter().for_each(|&t| is_sound[t as usize] = true);
    let others = (0..work.pieces.len()).filter(|&t| !is_sound[t]);
    let renumbered = |t: usize| work.pieces[t].vertices.map(|v| cut.vertex_to_kept[v.index()]);
    let mut all: Vec<(usize, [VertexId; 3])> = others.map(|t| (t, renumbered(t))).collect();
    all.extend(cut.pieces.iter().map(|&(vertices, i)| (sound[i as usize] as usize, vertices)));
    all.sort_by_key(|piece| piece.0);
    all.into_iter().map(|(t, vertices)| Piece { vertices, ..work.pieces[t] }).collect()
}

/// For each new point, its place in a triangle that contains it.
fn origins(work: &Work, cut: &Cut, sound: &[u32]) -> Vec<Origin> {
    let n_given = work.points.len();
    let mut origins = vec![([VertexId(0); 3], [1.0, 0.0, 0.0]); cut.points.len() - n_given];
    for (vertices, i) in &cut.pieces {
        let of = work.pieces[sound[*i as usize] as usize].vertices;
        let corners = of.map(|v| work.points[v.index()]);
        for v in vertices.iter().filter(|v| v.index() >= n_given) {
            origins[v.index() - n_given] = (of, triangle::closest(corners, cut.points[v.index()]));
        }
    }
    origins
}

/// Records what was found where triangles met.
fn record_meetings(work: &mut Work, cut: &Cut, sound: &[u32]) {
    for (v, &kept) in cut.vertex_to_kept.iter().enumerate().filter(|(v, kept)| kept.index() != *v) {
        work.record(RepairKind::MergedVertex, Vec::new(), vec![VertexId::new(v), kept]);
    }
    for Meeting { kind, triangles, vertices, at } in &cut.meetings {
        let kind = match kind {
            MeetingKind::VertexOnEdge => RepairKind::TJunction,
            MeetingKind::Overlap => RepairKind::Imprinted,
            MeetingKind::Crossing => RepairKind::CutCrossing,
        };
        let triangles = triangles.iter().map(|&i| work.old(sound[i as usize])).collect();
        work.done.push(Repair { kind, triangles, vertices: vertices.clone(), at: Some(*at) });
    }
}

/// Leaves one of the pieces of a surface with the same vertices. If as many face either side, it remains only
/// if it lies inside the rest of the surface, where it separates two bodies; otherwise none remains. Returns
/// whether there were any such pieces.
fn drop_duplicate_pieces(work: &mut Work, divided: &mut DividedSurfaces) -> bool {
    let mut same: BTreeMap<(u32, [VertexId; 3]), Vec<usize>> = BTreeMap::new();
    for (i, piece) in divided.pieces.iter().enumerate() {
        let [a, b, c] = sorted_ids(piece.vertices);
        if a != b && b != c {
            same.entry((piece.surface, [a, b, c])).or_default().push(i);
        }
    }
    same.retain(|_, list| list.len() > 1);
    let mut is_removed = vec![false; divided.pieces.len()];
    let mut even = Vec::new();
    for (&(surface, _), list) in &same {
        list.iter().for_each(|&i| is_removed[i] = true);
        let first = divided.pieces[list[0]].vertices;
        let faces_as_first = |i: &&usize| same_orientation(divided.pieces[**i].vertices, first);
        let n_alike = list.iter().filter(faces_as_first).count();
        if 2 * n_alike == list.len() {
            even.push((surface, list));
            continue;
        }
        let of_more = list.iter().find(|i| faces_as_first(i) == (2 * n_alike > list.len()));
        of_more.iter().for_each(|&&i| is_removed[i] = false);
        record_shared(work, divided, list, &is_removed, RepairKind::DroppedDuplicate);
    }
    let surfaces: BTreeSet<u32> = even.iter().map(|of| of.0).collect();
    let rests: BTreeMap<u32, WindingNumber> =
        surfaces.into_iter().map(|surface| (surface, rest_of(divided, &is_removed, surface))).collect();
    for (surface, list) in even {
        let at = middle(divided, list[0]);
        let is_wall = work.roles[surface as usize] == Role::Boundary && rests[&surface].at(at).abs() > 0.5;
        is_removed[list[0]] = !is_wall;
        let kind = if is_wall { RepairKind::KeptWall } else { RepairKind::DroppedDuplicate };
        record_shared(work, divided, list, &is_removed, kind);
    }
    let mut is_removed = is_removed.into_iter();
    divided.pieces.retain(|_| is_removed.next() != Some(true));
    !same.is_empty()
}

fn middle(divided: &DividedSurfaces, piece: usize) -> Point {
    centroid(divided.pieces[piece].vertices.map(|v| divided.points[v.index()]))
}

/// Records pieces with the same vertices, of which some are removed.
fn record_shared(
    work: &mut Work,
    divided: &DividedSurfaces,
    list: &[usize],
    is_removed: &[bool],
    kind: RepairKind,
) {
    let triangles = list.iter().filter(|&&i| is_removed[i]).map(|&i| divided.pieces[i].takes_after).collect();
    let (vertices, at) = (divided.pieces[list[0]].vertices.to_vec(), middle(divided, list[0]));
    work.done.push(Repair { kind, triangles, vertices, at: in_range(at).then_some(at) });
}

/// The winding number of the pieces of a surface that remain and whose corners are finite.
fn rest_of(divided: &DividedSurfaces, is_removed: &[bool], surface: u32) -> WindingNumber {
    let own = divided
        .pieces
        .iter()
        .zip(is_removed)
        .filter(|(piece, is_removed)| piece.surface == surface && !**is_removed);
    let is_finite = |t: &[VertexId; 3]| t.iter().all(|v| in_range(divided.points[v.index()]));
    let rest: Vec<_> = own.map(|(piece, _)| piece.vertices).filter(is_finite).collect();
    WindingNumber::new(&divided.points, &rest)
}
