//! A mover and one step of it, as tests of several methods make them.

use motet::base::{Point, Threads};
use motet::geometry::tet::volume;
use motet::geometry::vector::{add, sub};
use motet::mesh::Mesh;
use motet::motion::{Mover, Options};

pub(crate) fn mover(mesh: &Mesh, options: &Options) -> Mover {
    Mover::new(mesh, options, &Threads::single()).unwrap()
}

/// The points after a step in which `map` gives the place of each boundary vertex.
pub(crate) fn step(mover: &Mover, map: impl Fn(Point) -> Point, threads: &Threads) -> Vec<Point> {
    let displacement: Vec<Point> =
        (mover.boundary().iter()).map(|v| mover.reference()[v.index()]).map(|p| sub(map(p), p)).collect();
    let mut out = vec![[f64::NAN; 3]; mover.reference().len()];
    mover.step(&displacement, &mut out, threads).unwrap();
    for (v, d) in mover.boundary().iter().zip(&displacement) {
        let place = add(mover.reference()[v.index()], *d);
        assert_eq!(out[v.index()], place, "the boundary is where it is requested to be");
    }
    out
}

pub(crate) fn n_inverted(mesh: &Mesh, points: &[Point]) -> usize {
    mesh.cells.tets().filter(|(_, tet)| volume(tet.map(|v| points[v.index()])) <= 0.0).count()
}
