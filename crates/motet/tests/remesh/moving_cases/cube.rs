//! A cube that is distorted and restored again and again: every vertex moves by the map of the cube.

use motet::base::{Point, TetId, Threads, VertexId};
use motet::mesh::TetMesh;
use motet::remesh::{Options, Reason, Report, remesh};

use super::measure::{features, length, on_patches, quality, volumes};
use super::meshes::{Stack, prepared};

/// The distortion of the cube `[-0.5, 0.5]^2 x [0, 1]`; a part of 1 is the whole of it, 0 none.
#[derive(Clone, Copy, Debug)]
pub enum Distortion {
    /// The top moves along x until the sides lean by an angle in degrees.
    Shear(f64),
    /// The top turns by an angle in degrees, the bottom stays.
    Twist(f64),
}

impl Distortion {
    /// The image of a point of the undistorted cube.
    pub fn map(&self, [x, y, z]: Point, part: f64) -> Point {
        match self {
            Self::Shear(degrees) => [x + part * degrees.to_radians().tan() * z, y, z],
            Self::Twist(degrees) => {
                let (s, c) = (part * degrees.to_radians() * z).sin_cos();
                [c * x - s * y, s * x + c * y, z]
            }
        }
    }

    /// The preimage of a point of the distorted cube. Both maps are inverted by their opposites.
    pub fn back(&self, p: Point, part: f64) -> Point {
        self.map(p, -part)
    }
}

/// The cube undistorted.
pub fn cube_mesh(size: f64, seed: u64) -> TetMesh {
    let stack = Stack { low: [-0.5, -0.5, 0.0], high: [0.5, 0.5, 1.0], levels: vec![0.0, 1.0] };
    prepared(&stack.even_mesh(size, seed))
}

/// Quantities that must not drift. Lengths are in the cube's own coordinates.
#[derive(Clone, Copy, Debug)]
pub struct State {
    pub n_tets: usize,
    pub volume: f64,
    /// The largest distance of vertices of a side from its plane.
    pub off_side: f64,
    /// The largest distance of vertices where sides meet from the edge there.
    pub off_edge: f64,
    /// The total length of the edges where sides meet: 12 if correct.
    pub edges: f64,
    /// How many corners of the cube have a vertex within 1e-9.
    pub corners: usize,
}

/// The distance of a point of the cube from the plane of a side, 1 to 6.
fn off_side(p: Point, side: i32) -> f64 {
    let planes = [-0.5, 0.5, -0.5, 0.5, 0.0, 1.0];
    let side = side as usize - 1;
    (p[side / 2] - planes[side]).abs()
}

/// The state of a cube mesh distorted by `part`.
pub fn state(mesh: &TetMesh, distortion: &Distortion, part: f64) -> State {
    let own = |v: VertexId| distortion.back(mesh.points[v.index()], part);
    let features = features(mesh);
    let at_edges = features
        .iter()
        .flat_map(|(edge, sides)| edge.iter().flat_map(|&v| sides.iter().map(move |&side| (v, side))));
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let corners = (0..8).map(|i| [(i & 1) as f64 - 0.5, (i >> 1 & 1) as f64 - 0.5, (i >> 2) as f64]);
    let has_vertex = |corner: &Point| {
        (0..mesh.points.len()).map(VertexId::new).any(|v| {
            let p = own(v);
            (0..3).all(|i| (p[i] - corner[i]).abs() < 1e-9)
        })
    };
    State {
        n_tets: mesh.tets.len(),
        volume: volumes(mesh).values().sum(),
        off_side: largest(&mut on_patches(mesh).map(|(p, side)| off_side(distortion.back(p, part), side))),
        off_edge: largest(&mut at_edges.map(|(v, side)| off_side(own(v), side))),
        edges: length(&features, own),
        corners: corners.filter(has_vertex).count(),
    }
}

/// A step of a cycle.
pub struct Step {
    pub part: f64,
    pub bad_before: usize,
    pub inverted_before: usize,
    pub bad: usize,
    pub report: Report<TetId>,
    /// Numbers of remaining bad tets: between walls that meet at too sharp an angle for any tet; on a wall
    /// with such an angle; others.
    pub reasons: [usize; 3],
    pub worst: f64,
    pub state: State,
}

/// Distorts the cube in `n` steps and restores it in as many, repairing after each.
pub fn cycle(
    mesh: &mut TetMesh,
    distortion: &Distortion,
    n: usize,
    adapt: &Options,
    mut see: impl FnMut(&Step, &TetMesh),
) {
    let part_at = |step: usize| (n - step.abs_diff(n)) as f64 / n as f64;
    for step in 1..=2 * n {
        let [old, part] = [step - 1, step].map(part_at);
        for p in &mut mesh.points {
            *p = distortion.map(distortion.back(*p, old), part);
        }
        let before = quality(mesh);
        let outcome = remesh(mesh, adapt, &Threads::single()).expect("it is a mesh");
        *mesh = outcome.extract.mesh;
        let after = quality(mesh);
        let mut reasons = [0; 3];
        for left in &outcome.report.left {
            let reason = match left.reason {
                Reason::WallsMeet { .. } => 0,
                Reason::WallAngle { .. } => 1,
                _ => 2,
            };
            reasons[reason] += 1;
        }
        let step = Step {
            part,
            bad_before: before.bad,
            inverted_before: before.inverted,
            bad: after.bad,
            reasons,
            worst: after.worst,
            state: state(mesh, distortion, part),
            report: outcome.report,
        };
        see(&step, mesh);
    }
}
