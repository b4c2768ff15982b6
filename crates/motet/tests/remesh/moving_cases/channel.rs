//! Figure 11 of the paper: a sphere moves along a channel.

use motet::base::{Point, TetId, Threads};
use motet::geometry::vector::{add, scale};
use motet::mesh::TetMesh;
use motet::remesh::{Options, Report, remesh};

use super::harmonic::harmonic;
use super::measure::{Quality, quality};
use super::meshes::INNER;

/// A mesh moved from its reference by a part of the whole motion.
pub struct Stretched {
    pub shift: f64,
    pub mesh: TetMesh,
    pub quality: Quality,
}

/// The prescribed displacements: vertices of the sphere move, those of the box stay.
fn prescribed(mesh: &TetMesh, shift: Point) -> Vec<Option<Point>> {
    let mut prescribed = vec![None; mesh.points.len()];
    for (triangle, &patch) in mesh.triangles.iter().zip(&mesh.patches) {
        let displacement = if patch == INNER { shift } else { [0.0; 3] };
        triangle.iter().for_each(|v| prescribed[v.index()] = Some(displacement));
    }
    prescribed
}

fn moved(mesh: &TetMesh, displacement: &[Point], by: f64) -> TetMesh {
    let points = mesh.points.iter().zip(displacement).map(|(&p, &d)| add(p, scale(d, by))).collect();
    TetMesh { points, ..mesh.clone() }
}

/// The mesh at each of several shifts along x, all from the reference.
pub fn stretched(mesh: &TetMesh, shifts: &[f64]) -> Vec<Stretched> {
    let unit = harmonic(mesh, &prescribed(mesh, [1.0, 0.0, 0.0]));
    let at = |&shift: &f64| {
        let mesh = moved(mesh, &unit, shift);
        Stretched { shift, quality: quality(&mesh), mesh }
    };
    shifts.iter().map(at).collect()
}

/// A step of motion, and the repair after it.
pub struct Step {
    pub shift: f64,
    pub moved: TetMesh,
    pub repaired: TetMesh,
    pub report: Report<TetId>,
}

/// Moves the mesh by `n` steps of `step` and repairs it after each; the next one starts from there. Calls
/// `see` with each.
pub fn repaired_as_it_moves(
    mesh: &TetMesh,
    step: f64,
    n: usize,
    options: &Options,
    mut see: impl FnMut(&Step),
) {
    let mut mesh = mesh.clone();
    for i in 1..=n {
        let displacement = harmonic(&mesh, &prescribed(&mesh, [step, 0.0, 0.0]));
        let moved = moved(&mesh, &displacement, 1.0);
        let outcome = remesh(&moved, options, &Threads::single()).expect("it is a mesh");
        let step =
            Step { shift: i as f64 * step, moved, repaired: outcome.extract.mesh, report: outcome.report };
        see(&step);
        mesh = step.repaired;
    }
}
