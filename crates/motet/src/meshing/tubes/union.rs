//! The union of closed parts: divided where they meet, and the pieces inside other parts left out.

use std::collections::{BTreeMap, BTreeSet};

use super::super::compact::{compact, used_vertices};
use super::clusters::divide;
use crate::base::{DisjointSets, Point, Threads, VertexId, same_orientation, sorted_ids};
use crate::geometry::triangle::{area, centroid, longest_side};
use crate::mesh::open_edges;
use crate::mesh::shapes::Soup;
use crate::preflight::{own_crossings, renamed};
use crate::spatial::{WindingNumber, winding_of_triangle};

/// So many rings of triangles beside the place where parts met are made even with it.
const RINGS: usize = 2;

/// Why parts were not united.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Failure {
    /// Triangles could not be divided here so that they share what they have in common.
    NotDivided(Point),
    /// The result has open edges, or pairs of triangles that cross; one of these places.
    Faulty(Point),
}

/// A closed surface.
#[derive(Clone, Debug, Default)]
pub(super) struct United {
    pub(super) points: Vec<Point>,
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// The length of the sides of the parts at each point.
    pub(super) sizes: Vec<f64>,
    /// Whether each point is so far from where parts met that its triangles are as even as they were made.
    pub(super) is_far: Vec<bool>,
    /// The number of places where parts met.
    pub(super) clusters: usize,
    /// How many of these could be divided only after points had been shifted by a tiny length.
    pub(super) shifted: usize,
}

/// The union of the parts of a soup, each of which is closed and faces outward; they may cross and touch, and
/// each may cross itself. Points nearer than `near` are one place.
///
/// # Errors
/// When dividing fails, or the result would not be closed and free of crossings.
pub(super) fn union(soup: &Soup, near: f64, threads: &Threads) -> Result<United, Failure> {
    let cut = divide(soup, near, threads).map_err(Failure::NotDivided)?;
    let pieces = without_twins(&cut.pieces);
    // Points of the soup come first, some of them shifted.
    let winding = WindingNumber::new(&cut.points, &soup.triangles);
    let parts = connected(&pieces);
    let is_outer = outer(&cut.points, soup, &pieces, &parts, &winding, threads);
    let kept = pieces.iter().zip(&parts).filter(|(_, part)| is_outer[**part as usize]);
    let (kept, origins): (Vec<[VertexId; 3]>, Vec<u32>) = kept.map(|(piece, _)| *piece).unzip();
    if let Some(v) = open_vertex(&kept) {
        return Err(Failure::Faulty(cut.points[v.index()]));
    }
    if let Some(pair) = own_crossings(&cut.points, &kept, threads).first() {
        let t = kept[pair[0] as usize];
        return Err(Failure::Faulty(centroid(t.map(|v| cut.points[v.index()]))));
    }
    let is_used = used_vertices(cut.points.len(), kept.as_flattened().iter());
    let (points, old_to_new) = compact(&cut.points, &is_used);
    let triangles = renamed(&kept, &old_to_new);
    let mut sizes = vec![f64::INFINITY; points.len()];
    for (t, &origin) in triangles.iter().zip(&origins) {
        for v in t {
            sizes[v.index()] = sizes[v.index()].min(soup.sizes[origin as usize]);
        }
    }
    let is_near: Vec<bool> = origins.iter().map(|&t| cut.is_cut[t as usize]).collect();
    let is_far = far(points.len(), &triangles, &is_near);
    Ok(United { points, triangles, sizes, is_far, shifted: cut.shifted, clusters: cut.clusters })
}

/// The points that are more than [`RINGS`] edges away from triangles that are near the place where parts met.
fn far(n_points: usize, triangles: &[[VertexId; 3]], is_near: &[bool]) -> Vec<bool> {
    let mut is_far = vec![true; n_points];
    triangles.iter().zip(is_near).filter(|of| *of.1).for_each(|(t, _)| {
        t.iter().for_each(|v| is_far[v.index()] = false);
    });
    for _ in 0..RINGS {
        let beside = |t: &&[VertexId; 3]| t.iter().any(|v| !is_far[v.index()]);
        let ring: Vec<VertexId> = triangles.iter().filter(beside).flatten().copied().collect();
        ring.into_iter().for_each(|v| is_far[v.index()] = false);
    }
    is_far
}

/// Pieces without those that have the same vertices as another: of those that face one side one stays, of two
/// that face each other none.
fn without_twins(pieces: &[([VertexId; 3], u32)]) -> Vec<([VertexId; 3], u32)> {
    let mut same: BTreeMap<[VertexId; 3], Vec<usize>> = BTreeMap::new();
    for (i, (t, _)) in pieces.iter().enumerate() {
        same.entry(sorted_ids(*t)).or_default().push(i);
    }
    let mut kept: Vec<usize> = Vec::with_capacity(pieces.len());
    for list in same.values() {
        let first = pieces[list[0]].0;
        let (alike, opposite): (Vec<usize>, Vec<usize>) =
            list.iter().partition(|&&i| same_orientation(pieces[i].0, first));
        match alike.len().cmp(&opposite.len()) {
            std::cmp::Ordering::Greater => kept.push(alike[0]),
            std::cmp::Ordering::Less => kept.push(opposite[0]),
            std::cmp::Ordering::Equal => {}
        }
    }
    kept.sort_unstable();
    kept.into_iter().map(|i| pieces[i]).collect()
}

/// The connected part of each piece: pieces are connected at edges of two pieces that run along it in
/// opposite directions. Where surfaces cross, an edge has more.
fn connected(pieces: &[([VertexId; 3], u32)]) -> Vec<u32> {
    let mut sides: Vec<([VertexId; 2], bool, u32)> = Vec::with_capacity(3 * pieces.len());
    for (i, ([a, b, c], _)) in (0u32..).zip(pieces) {
        sides.extend([[*a, *b], [*b, *c], [*c, *a]].map(|side| (sorted_ids(side), side[0] < side[1], i)));
    }
    sides.sort_unstable();
    let mut sets = DisjointSets::new(pieces.len());
    for same in sides.chunk_by(|x, y| x.0 == y.0) {
        if let [x, y] = same
            && x.1 != y.1
        {
            sets.join(x.2, y.2);
        }
    }
    sets.roots()
}

/// For each part of pieces, whether it bounds the union: before it no part of the soup winds around, behind
/// it one does. Decided at the middle of its best piece, where its own triangle counts half on either side.
fn outer(
    points: &[Point],
    soup: &Soup,
    pieces: &[([VertexId; 3], u32)],
    parts: &[u32],
    winding: &WindingNumber,
    threads: &Threads,
) -> Vec<bool> {
    let corners = |t: [VertexId; 3]| t.map(|v| points[v.index()]);
    let mut best: BTreeMap<u32, (f64, usize)> = BTreeMap::new();
    for (i, ((t, _), part)) in pieces.iter().zip(parts).enumerate() {
        let longest = longest_side(corners(*t));
        let height = if longest > 0.0 { area(corners(*t)) / longest } else { 0.0 };
        let known = best.entry(*part).or_insert((height, i));
        if height > known.0 {
            *known = (height, i);
        }
    }
    let best: Vec<(u32, usize)> = best.into_iter().map(|(part, (_, i))| (part, i)).collect();
    let answers = threads.map(best.len(), |k| {
        let (t, origin) = pieces[best[k].1];
        let middle = centroid(corners(t));
        let own = corners(soup.triangles[origin as usize]);
        let before = winding.at(middle) - winding_of_triangle(own, middle) - 0.5;
        before.round() == 0.0
    });
    let mut is_outer = vec![false; pieces.len()];
    best.iter().zip(answers).for_each(|((part, _), answer)| is_outer[*part as usize] = answer);
    is_outer
}

/// A vertex at an edge along which triangles do not run as often one way as the other.
fn open_vertex(triangles: &[[VertexId; 3]]) -> Option<VertexId> {
    open_edges(triangles).first().map(|edge| edge[0])
}

/// The edges that more than two triangles share.
pub(super) fn branching_edges(triangles: &[[VertexId; 3]]) -> usize {
    let mut edges: Vec<[VertexId; 2]> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]].map(sorted_ids)).collect();
    edges.sort_unstable();
    edges.chunk_by(|x, y| x == y).filter(|same| same.len() > 2).count()
}

/// The vertices whose triangles are not one fan, beside those of edges that more than two triangles share.
pub(super) fn pinched_vertices(triangles: &[[VertexId; 3]]) -> usize {
    let mut fans: BTreeMap<VertexId, Vec<[VertexId; 2]>> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for (v, edge) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
            fans.entry(v).or_default().push(edge);
        }
    }
    let is_pinched = |edges: &Vec<[VertexId; 2]>| {
        let mut reached = BTreeSet::from([edges[0][0]]);
        let mut at = edges[0][1];
        while reached.insert(at) {
            match edges.iter().find(|edge| edge[0] == at) {
                Some(edge) => at = edge[1],
                None => break,
            }
        }
        reached.len() < edges.len()
    };
    fans.values().filter(|edges| is_pinched(edges)).count()
}
