//! A box divided by a membrane, which bends until it nearly touches a wall, and back, again and again.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::add;
use motet::mesh::TetMesh;
use motet::remesh::{Options, SurfaceRule, remesh};

use super::harmonic::harmonic;
use super::measure::{features, length, patches, quality, volumes};
use super::meshes::{INNER, Stack, prepared};

/// The membrane lies in the plane z = 0.5 of the unit cube when at rest.
pub const LEVEL: f64 = 0.5;

/// How far the membrane bends, and in how many steps there and back.
#[derive(Clone, Copy, Debug)]
pub struct Bending {
    pub amplitude: f64,
    pub n_steps: usize,
}

impl Bending {
    /// The z of the membrane after some steps.
    fn height(&self, [x, y, _]: Point, step: usize) -> f64 {
        let phase = 2.0 * PI * (step % self.n_steps) as f64 / self.n_steps as f64;
        LEVEL + self.amplitude * 0.5 * (1.0 - phase.cos()) * (PI * x).sin() * (PI * y).sin()
    }
}

/// The unit cube with the membrane at rest.
pub fn membrane_mesh(size: f64, seed: u64) -> TetMesh {
    let stack = Stack { low: [0.0; 3], high: [1.0; 3], levels: vec![0.0, LEVEL, 1.0] };
    prepared(&stack.even_mesh(size, seed))
}

/// Quantities that may drift.
#[derive(Clone, Debug)]
pub struct State {
    pub n_tets: usize,
    pub volumes: BTreeMap<i32, f64>,
    /// Triangles and area of each patch.
    pub patches: BTreeMap<i32, (usize, f64)>,
    /// The number and total length of edges where patches meet.
    pub features: (usize, f64),
    /// The largest distance of membrane vertices from the exact membrane.
    pub off_membrane: f64,
}

/// Statistics of a cycle.
#[derive(Clone, Debug)]
pub struct Cycle {
    /// The largest number of bad tets before a repair in any step.
    pub most_bad: usize,
    /// The largest number of inverted tets before a repair in any step.
    pub most_inverted: usize,
    /// Steps after which some tet was still bad with the surface kept.
    pub n_adapted: usize,
    /// Bad tets after all repair, summed over the steps.
    pub n_left: usize,
    /// The worst EAS after repair, of all steps.
    pub worst: f64,
    /// The state at the end of the cycle.
    pub state: State,
}

fn membrane_vertices(mesh: &TetMesh) -> Vec<VertexId> {
    let triangles = mesh.triangles.iter().zip(&mesh.patches).filter(|(_, patch)| **patch == INNER);
    let mut vertices: Vec<VertexId> = triangles.flat_map(|(t, _)| *t).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// The state of a mesh after whole cycles.
pub fn state(mesh: &TetMesh) -> State {
    let features = features(mesh);
    let place = |v: VertexId| mesh.points[v.index()];
    let off = membrane_vertices(mesh).into_iter().map(|v| (place(v)[2] - LEVEL).abs());
    State {
        n_tets: mesh.tets.len(),
        volumes: volumes(mesh),
        patches: patches(mesh),
        features: (features.len(), length(&features, place)),
        off_membrane: off.fold(0.0, f64::max),
    }
}

/// The mesh after the next step, before repair.
pub fn moved(mesh: &TetMesh, bending: &Bending, step: usize) -> TetMesh {
    let mut prescribed = vec![None; mesh.points.len()];
    for v in mesh.triangles.iter().flatten() {
        prescribed[v.index()] = Some([0.0; 3]);
    }
    let is_on_box = |p: Point| p.iter().any(|&x| x == 0.0 || x == 1.0);
    for v in membrane_vertices(mesh) {
        let p = mesh.points[v.index()];
        if !is_on_box(p) {
            prescribed[v.index()] = Some([0.0, 0.0, bending.height(p, step + 1) - p[2]]);
        }
    }
    let displacement = harmonic(mesh, &prescribed);
    let points = mesh.points.iter().zip(displacement).map(|(&p, d)| add(p, d)).collect();
    TetMesh { points, ..mesh.clone() }
}

/// Makes a cycle, repairing after each step: with the surface kept, and where that leaves bad tets, with a
/// surface that adapts.
pub fn cycle(
    mesh: &mut TetMesh,
    bending: &Bending,
    keep: &Options,
    mut see: impl FnMut(usize, &TetMesh),
) -> Cycle {
    let mut cycle = Cycle {
        most_bad: 0,
        most_inverted: 0,
        n_adapted: 0,
        n_left: 0,
        worst: f64::INFINITY,
        state: state(mesh),
    };
    let adapt = Options { surface: SurfaceRule::Adapt { distance: None }, ..keep.clone() };
    for step in 0..bending.n_steps {
        let moved = moved(mesh, bending, step);
        let before = quality(&moved);
        cycle.most_bad = cycle.most_bad.max(before.bad);
        cycle.most_inverted = cycle.most_inverted.max(before.inverted);
        *mesh = remesh(&moved, keep, &Threads::single()).expect("it is a mesh").extract.mesh;
        if quality(mesh).bad > 0 {
            cycle.n_adapted += 1;
            *mesh = remesh(mesh, &adapt, &Threads::single()).expect("it is a mesh").extract.mesh;
        }
        let after = quality(mesh);
        cycle.n_left += after.bad;
        cycle.worst = cycle.worst.min(after.worst);
        see(step, mesh);
    }
    cycle.state = state(mesh);
    cycle
}
