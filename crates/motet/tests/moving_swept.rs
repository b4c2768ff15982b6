//! The volumes that facets sweep: what a cell gains is what its facets sweep, whatever way each vertex goes.

mod common;

use common::Numbers;
use motet::base::{Id, Point, VertexId};
use motet::geometry::tet::volume;
use motet::mesh::shapes::sphere_in_box;
use motet::moving::swept_volumes;

#[test]
fn what_the_facets_of_a_tet_sweep_is_what_it_gains() {
    let mesh = sphere_in_box(3, 3);
    let mut numbers = Numbers(1);
    // Ways in all directions: of ways in one plane, terms of the third order vanish.
    let after: Vec<Point> = mesh.points.iter().map(|p| p.map(|x| x + 0.6 * numbers.unit() - 0.3)).collect();
    let swept = swept_volumes(&mesh.cells, &mesh.points, &after);
    let mut gained = vec![0.0; mesh.cells.len()];
    for (i, &v) in swept.volumes.iter().enumerate() {
        gained[swept.owners[i].index()] += v;
        if swept.neighbors[i] != Id::NONE {
            gained[swept.neighbors[i].index()] -= v;
        }
    }
    for (cell, tet) in mesh.cells.tets() {
        let of = |points: &[Point]| volume(tet.map(|v: VertexId| points[v.index()]));
        let gain = of(&after) - of(&mesh.points);
        assert!((gain - gained[cell.index()]).abs() < 1e-13, "{gain} {}", gained[cell.index()]);
    }
}
