//! Bodies whose faces are flat up to rounding are filled with every triangle kept and every tet positive.

use crate::common::cad::cad;
use motet::base::Threads;
use motet::delaunay::{EdgePoints, constrain};
use motet::geometry::predicates::orient3d;

#[test]
fn every_triangle_is_kept_and_every_tet_is_positive() {
    for body in (0..140).map(cad) {
        let filled = constrain(&body.points, &body.triangles, EdgePoints::MoveInside, &Threads::single())
            .unwrap_or_else(|error| panic!("{}: {error}", body.kind));
        for (triangle, facets) in body.triangles.iter().zip(filled.triangle_to_facets.iter()) {
            let is_kept = facets.len() == 1 && facets[0].iter().all(|v| triangle.contains(v));
            assert!(is_kept, "{}: {triangle:?} became {facets:?}", body.kind);
        }
        for tet in &filled.tets {
            let [a, b, c, d] = tet.map(|v| filled.points[v.index()]);
            assert!(orient3d(a, b, c, d) > 0, "{}: {tet:?}", body.kind);
        }
    }
}
