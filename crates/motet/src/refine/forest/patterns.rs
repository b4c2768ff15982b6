//! All ways to divide a tet whose edges are partly split, without a vertex inside.
//!
//! Local vertices 0 to 3 are the corners, and 4 + e is the middle of edge e. Which edges are split is a mask
//! of six bits. A facet with two split edges is cut into a triangle and a quadrilateral, and one bit per
//! facet says along which diagonal the latter is cut. Both together determine the surface of the tet, and a
//! search finds what fills it: facet by facet, try any vertex in front of it. Positive tets whose facets
//! match in pairs, except on the surface, fill the tet exactly once everywhere, since the number of tets
//! around a point does not change across a facet.

use std::sync::OnceLock;

use crate::geometry::tet::{EDGES, FACETS};

/// All edges split.
pub(super) const FULL: u8 = 0b11_1111;

/// The tets of one way, by local vertices; positive if the whole tet is.
pub(in crate::refine) type Pattern = Vec<[u8; 4]>;

/// The edges of facet `i`: its corners are `FACETS[i]`, and edge `k` is opposite corner `k` of them.
pub(in crate::refine) const FACET_EDGES: [[usize; 3]; 4] = facet_edges();

/// All ways to fill a tet with these edges split. Facet `i` is cut from the middle of the second of its two
/// split edges if bit `i` of `cuts` is set, else of the first, in the order of [`FACET_EDGES`]. There are
/// mostly one or two; for 14 combinations, in which the cuts form a cycle, there are none. Where all edges
/// are split, [`eight`](super::eight) has the same ways in another order.
pub(in crate::refine) fn patterns(mask: u8, cuts: u8) -> &'static [Pattern] {
    // Each entry is computed on first use: computing all of them takes as long as refining a small mesh.
    static TABLE: [OnceLock<Vec<Pattern>>; 64 * 16] = [const { OnceLock::new() }; 64 * 16];
    let (mask, cuts) = (mask & FULL, cuts & 15);
    TABLE[usize::from(mask) * 16 + usize::from(cuts)].get_or_init(|| all_ways(mask, cuts))
}

/// The split edges of a facet, in the order of [`FACET_EDGES`], and their number.
pub(super) fn split_edges(facet: usize, mask: u8) -> ([usize; 3], usize) {
    let (mut edges, mut n) = ([0; 3], 0);
    for edge in FACET_EDGES[facet] {
        if mask >> edge & 1 == 1 {
            edges[n] = edge;
            n += 1;
        }
    }
    (edges, n)
}

const fn facet_edges() -> [[usize; 3]; 4] {
    let mut out = [[6; 3]; 4];
    let mut facet = 0;
    while facet < 4 {
        let mut k = 0;
        while k < 3 {
            let (u, v) = (FACETS[facet][(k + 1) % 3], FACETS[facet][(k + 2) % 3]);
            let mut edge = 0;
            while edge < 6 {
                let [a, b] = EDGES[edge];
                if a == u && b == v || a == v && b == u {
                    out[facet][k] = edge;
                }
                edge += 1;
            }
            k += 1;
        }
        facet += 1;
    }
    out
}

/// Cuts a triangle into triangles of the same orientation. `middles[k]` is the middle of the edge opposite
/// corner `k`, if that is split. With two middles, the quadrilateral is cut from that of the second split
/// edge if `second` is true.
pub(super) fn cut<T: Copy>(corners: [T; 3], middles: [Option<T>; 3], second: bool) -> Vec<[T; 3]> {
    let turned = |k: usize| [corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]];
    match middles {
        [None, None, None] => vec![corners],
        [Some(x), Some(y), Some(z)] => {
            let [a, b, c] = corners;
            vec![[a, z, y], [z, b, x], [y, x, c], [x, y, z]]
        }
        _ => {
            let n = middles.iter().flatten().count();
            if n == 1 {
                let k = middles.iter().position(Option::is_some).unwrap_or(0);
                let ([a, b, c], Some(m)) = (turned(k), middles[k]) else { return vec![corners] };
                return vec![[a, b, m], [a, m, c]];
            }
            let whole = middles.iter().position(Option::is_none).unwrap_or(0);
            let [apex, b, c] = turned(whole);
            // Opposite b is the edge from c to the apex, opposite c the one from the apex to b.
            let (k_b, k_c) = ((whole + 1) % 3, (whole + 2) % 3);
            let (Some(on_c), Some(on_b)) = (middles[k_b], middles[k_c]) else { return vec![corners] };
            // The second split edge is the one with the larger index.
            let from_on_c = (k_b > k_c) == second;
            let mut out = vec![[apex, on_b, on_c]];
            out.extend(if from_on_c {
                [[on_b, b, on_c], [on_c, b, c]]
            } else {
                [[on_b, b, c], [on_b, c, on_c]]
            });
            out
        }
    }
}

/// The triangles of the surface, as seen from outside.
fn surface(mask: u8, cuts: u8) -> Vec<[u8; 3]> {
    (0..4)
        .flat_map(|facet| {
            let corners = FACETS[facet].map(|v| v as u8);
            let middle = |edge: usize| (mask >> edge & 1 == 1).then_some(4 + edge as u8);
            cut(corners, FACET_EDGES[facet].map(middle), cuts >> facet & 1 == 1)
        })
        .map(canonical)
        .collect()
}

fn all_ways(mask: u8, cuts: u8) -> Vec<Pattern> {
    // A bit for a facet that is not cut changes nothing.
    if (0..4).any(|facet| cuts >> facet & 1 == 1 && split_edges(facet, mask).1 != 2) {
        return Vec::new();
    }
    let is_there = std::array::from_fn(|v| v < 4 || mask >> (v - 4) & 1 == 1);
    let mut search = Search { is_there, tets: Vec::new(), found: Vec::new() };
    search.fill(surface(mask, cuts), 64);
    search.found
}

struct Search {
    /// Which local vertices exist.
    is_there: [bool; 10],
    tets: Pattern,
    found: Vec<Pattern>,
}

impl Search {
    /// Fills the space behind the open triangles, which are given as seen from outside of it; `left` is the
    /// volume left.
    fn fill(&mut self, open: Vec<[u8; 3]>, left: i32) {
        let Some(&[a, b, c]) = open.first() else {
            if left == 0 {
                self.found.push(self.tets.clone());
            }
            return;
        };
        for v in 0..10 {
            // Seen from outside the triangle runs counter-clockwise, so a positive tet has it in the opposite
            // order.
            let tet = [a, c, b, v];
            let volume = volume(tet);
            if !self.is_there[usize::from(v)] || volume <= 0 || volume > left {
                continue;
            }
            let facets = FACETS.map(|facet| canonical(facet.map(|i| tet[i])));
            // A facet on the surface must be a part of it. Without this check the search takes thirteen times
            // as long.
            let fits = |seen: &[u8; 3]| {
                open.contains(seen) || !on_surface(*seen) && !open.contains(&from_other_side(*seen))
            };
            if facets.iter().all(fits) {
                let mut rest: Vec<[u8; 3]> =
                    open.iter().filter(|other| !facets.contains(other)).copied().collect();
                rest.extend(facets.into_iter().filter(|seen| !open.contains(seen)).map(from_other_side));
                self.tets.push(tet);
                self.fill(rest, left - volume);
                self.tets.pop();
            }
        }
    }
}

/// Rotates a triangle so that it begins with its least vertex: its unique name from that side.
fn canonical([a, b, c]: [u8; 3]) -> [u8; 3] {
    match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    }
}

/// The name of a triangle from the other side.
fn from_other_side([a, b, c]: [u8; 3]) -> [u8; 3] {
    [a, c, b]
}

/// Whether three local vertices lie on one facet.
fn on_surface(triangle: [u8; 3]) -> bool {
    // The facets that a vertex does not lie on, named by their opposite corners: a corner is off the facet
    // opposite to it, a middle off those opposite to the ends of its edge.
    let off = |v: u8| match v {
        0..4 => 1 << v,
        _ => EDGES[usize::from(v) - 4].iter().fold(0, |off, corner| off | 1 << corner),
    };
    triangle.iter().fold(0, |all, v| all | off(*v)) != 15u8
}

/// Twice the coordinates of the corners of a tet of volume 8/6, and of its middles, which are integers.
fn place(v: u8) -> [i32; 3] {
    const CORNERS: [[i32; 3]; 4] = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]];
    match v {
        0..4 => CORNERS[usize::from(v)].map(|x| 2 * x),
        _ => {
            let [a, b] = EDGES[usize::from(v) - 4].map(|v| CORNERS[v]);
            [0, 1, 2].map(|k| a[k] + b[k])
        }
    }
}

/// Six times the volume; that of the whole tet is 64.
pub(super) fn volume(tet: [u8; 4]) -> i32 {
    let [a, b, c, d] = tet.map(place);
    let sub = |p: [i32; 3]| [0, 1, 2].map(|k| p[k] - a[k]);
    let ([x, y, z], v, w) = (sub(b), sub(c), sub(d));
    x * (v[1] * w[2] - v[2] * w[1]) - y * (v[0] * w[2] - v[2] * w[0]) + z * (v[0] * w[1] - v[1] * w[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn halves(mask: u8, cuts: u8) -> bool {
        (0..4).all(|facet| cuts >> facet & 1 == 0 || split_edges(facet, mask).1 == 2)
    }

    #[test]
    fn the_table_has_what_the_experiment_counted() {
        let keys = || (0..64u8).flat_map(|mask| (0..16u8).map(move |cuts| (mask, cuts)));
        let needed: Vec<_> = keys().filter(|&(mask, cuts)| halves(mask, cuts)).collect();
        let n = |of: usize| needed.iter().filter(|&&(mask, cuts)| patterns(mask, cuts).len() == of).count();
        println!("{} keys: none {}, one {}, two {}, three {}", needed.len(), n(0), n(1), n(2), n(3));
        assert_eq!((needed.len(), n(0)), (239, 14));
        assert_eq!(n(0) + n(1) + n(2) + n(3), 239);
        // The three diagonals of the octahedron, each with four corner tets and four tets around the
        // diagonal.
        assert_eq!(patterns(FULL, 0).len(), 3);
        assert!(patterns(FULL, 0).iter().all(|pattern| pattern.len() == 8));
    }

    #[test]
    fn every_pattern_fills_the_tet_and_has_its_surface() {
        for mask in 0..64u8 {
            for cuts in 0..16u8 {
                for pattern in patterns(mask, cuts) {
                    assert_eq!(pattern.iter().map(|t| volume(*t)).sum::<i32>(), 64);
                    let mut facets: Vec<_> = pattern
                        .iter()
                        .flat_map(|t| FACETS.map(|facet| canonical(facet.map(|i| t[i]))))
                        .collect();
                    let all = facets.clone();
                    facets.retain(|f| !all.contains(&from_other_side(*f)));
                    let expected = surface(mask, cuts);
                    assert_eq!(facets.len(), expected.len());
                    assert!(facets.iter().all(|f| expected.contains(f)));
                }
            }
        }
    }
}
