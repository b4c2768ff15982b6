//! The Delaunay tets of all vertices, and which of them span a gap.

use super::GapKind;
use super::sites::{Duplicate, SiteId, Sites};
use crate::base::{BodyId, MaybeId, Point, Result, Threads, VertexId};
use crate::delaunay::Triangulation;
use crate::geometry::vector::{add, scale, sub};

/// The sites of a tet; none in the last places of a triangle, a segment or a vertex.
pub(super) type Simplex = [MaybeId<SiteId>; 4];

/// Tets over a list of points, and the points that coincide.
pub(super) struct Simplices {
    pub(super) tets: Vec<Simplex>,
    pub(super) duplicates: Vec<Duplicate>,
}

/// The Delaunay tets of any finite points. Points in one plane give triangles instead, points on one line
/// segments, and points at one place nothing but duplicates.
pub(super) fn simplices(points: &[Point], threads: &Threads) -> Result<Simplices> {
    if points.iter().all(|p| *p == points[0]) {
        let of_first = |i: u32| Duplicate { duplicate: SiteId(i), kept: SiteId(0) };
        let duplicates = (1..points.len() as u32).map(of_first).collect();
        return Ok(Simplices { tets: Vec::new(), duplicates });
    }
    match Triangulation::new(points, threads) {
        Ok(delaunay) => Ok(taken(&delaunay, points.len())),
        // All points are finite, so the cause is that they span no volume. If it is something else, the
        // second try fails, too.
        Err(_) => {
            let mut more = points.to_vec();
            more.extend(corners_around(points));
            let mut flat = taken(&Triangulation::new(&more, threads)?, points.len());
            flat.tets.iter_mut().for_each(|tet| tet.sort_unstable());
            flat.tets.retain(|tet| tet[1].is_some());
            flat.tets.sort_unstable();
            flat.tets.dedup();
            Ok(flat)
        }
    }
}

/// Eight points around all others, so far away that none lies within a sphere whose diameter joins two of the
/// others: that sphere is within half a diagonal of their box.
fn corners_around(points: &[Point]) -> [Point; 8] {
    let bound = |of: fn(f64, f64) -> f64| {
        points.iter().fold(points[0], |m, p| [of(m[0], p[0]), of(m[1], p[1]), of(m[2], p[2])])
    };
    let (low, high) = (bound(f64::min), bound(f64::max));
    let size = sub(high, low).into_iter().fold(0.0, f64::max);
    let centre = add(scale(low, 0.5), scale(high, 0.5));
    std::array::from_fn(|i| {
        let sign = |k: usize| if i >> k & 1 == 0 { -2.0 * size } else { 2.0 * size };
        add(centre, [sign(0), sign(1), sign(2)])
    })
}

/// Tets and duplicates below `n`; vertices from `n` on are none.
fn taken(delaunay: &Triangulation, n: usize) -> Simplices {
    let place = |v: &VertexId| -> MaybeId<SiteId> { (v.index() < n).then_some(SiteId(v.0)).into() };
    let tets = delaunay.tets().iter().map(|[a, b, c, d]| [place(a), place(b), place(c), place(d)]).collect();
    let own = delaunay.duplicates().iter().filter(|(duplicate, _)| duplicate.index() < n);
    let pair = |&(duplicate, kept): &(VertexId, VertexId)| Duplicate {
        duplicate: SiteId(duplicate.0),
        kept: SiteId(kept.0),
    };
    Simplices { tets, duplicates: own.map(pair).collect() }
}

/// The kind of a tet, by the bodies its vertices belong to, and its sites in the order that [`super::GapTet`]
/// promises.
pub(super) fn classified(tet: Simplex, sites: &Sites) -> (GapKind, Simplex) {
    let mut ordered = tet;
    if tet.iter().any(|&s| sites.owners(s).len() > 1) {
        return (GapKind::Touching, ordered);
    }
    let body =
        |s: MaybeId<SiteId>| -> MaybeId<BodyId> { sites.owners(s).first().map(|owner| owner.body).into() };
    let alike = |s: MaybeId<SiteId>| tet.iter().filter(|&&other| body(other) == body(s)).count();
    // The larger share first, then the smaller body; missing vertices last.
    ordered.sort_by_key(|&s| (s.is_none(), 4 - alike(s), body(s)));
    let of = ordered.map(body);
    let real = ordered.iter().filter(|s| s.is_some()).count();
    let n_bodies = 1 + (1..real).filter(|&i| of[i] != of[i - 1]).count();
    let kind = match (real, n_bodies, alike(ordered[0])) {
        (_, 1, _) => GapKind::Four,
        (2 | 3, _, _) => GapKind::Flat,
        (_, 2, 2) => GapKind::TwoTwo,
        (_, 2, _) => GapKind::ThreeOne,
        (_, 3, _) => GapKind::TwoOneOne,
        _ => GapKind::Ones,
    };
    (kind, ordered)
}
