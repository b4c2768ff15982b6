//! The adaptation loop: solve, compute sizes from the second derivatives of the solution, adapt. The solver
//! is a formula, so that the error is known.

use motet::base::{Point, TetId, Threads};
use motet::geometry::tet::{at, volume};
use motet::mesh::history::Rules;
use motet::mesh::{Field, TetMesh, TetPart};
use motet::refine::wish::{coarser, marked};
use motet::refine::{HessianSizes, MeshRefinement, Options, Refinement};
use motet::{Mesh, Result};

/// The solution on this mesh: velocities along z, and a pressure.
pub(crate) fn solve(mesh: &mut Mesh, speed: impl Fn(Point) -> f64, pressure: impl Fn(Point) -> f64) {
    let velocity: Vec<Point> = mesh.points.iter().map(|p| [0.0, 0.0, speed(*p)]).collect();
    let pressure: Vec<f64> = mesh.points.iter().map(|p| pressure(*p)).collect();
    mesh.set_point_field(Field::vectors("velocity", &velocity));
    mesh.set_point_field(Field::scalars("pressure", pressure));
}

/// The difference between a formula and its linear interpolant: root mean square and maximum, at five places
/// per tet.
pub(crate) fn error(mesh: &TetMesh, of: impl Fn(Point) -> f64) -> [f64; 2] {
    let (mut squares, mut weights, mut most) = (0.0f64, 0.0f64, 0.0f64);
    let (a, b) = (1.0 / 6.0, 0.5);
    let places = [[0.25; 4], [b, a, a, a], [a, b, a, a], [a, a, b, a], [a, a, a, b]];
    for tet in &mesh.tets {
        let corners = tet.map(|v| mesh.points[v.index()]);
        let weight = volume(corners).abs();
        for place in places {
            let linear: f64 = corners.iter().zip(place).map(|(p, w)| w * of(*p)).sum();
            let off = (linear - of(at(corners, place))).abs();
            squares += weight * off * off;
            weights += weight;
            most = most.max(off);
        }
    }
    [(squares / weights).sqrt(), most]
}

/// Refines uniformly until there are `n` tets; returns the number of tets and the mean error of each
/// generation.
pub(crate) fn everywhere(
    first: &TetMesh,
    n: usize,
    of: impl Fn(Point) -> f64,
    threads: &Threads,
) -> Result<Vec<[f64; 2]>> {
    let mut refinement = Refinement::new(first, Options::default(), threads)?;
    let mut found = vec![[first.tets.len() as f64, error(first, &of)[0]]];
    while refinement.mesh().tets.len() < n {
        let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
        refinement.refine(&all, threads)?;
        found.push([refinement.mesh().tets.len() as f64, error(refinement.mesh(), &of)[0]]);
    }
    Ok(found)
}

/// The mean error of uniform refinement with `n` tets, interpolated between two generations by a power law.
pub(crate) fn with_as_many(found: &[[f64; 2]], n: f64) -> f64 {
    // The last generation has at least as many tets.
    let Some(pair) = found.windows(2).find(|pair| n <= pair[1][0]) else { return found[0][1] };
    let [[n0, e0], [n1, e1]] = [pair[0], pair[1]];
    e0 * (n / n0).powf((e1 / e0).ln() / (n1 / n0).ln())
}

/// Makes the mesh for the next solution: takes back divisions, then divides tets, at most this many times.
/// Sizes are computed once and carried; the smallest and the largest are given.
pub(crate) fn adapt(
    mesh: &mut Mesh,
    sizes: &HessianSizes,
    most: usize,
    threads: &Threads,
) -> Result<[f64; 2]> {
    let criterion = sizes.put(mesh, &TetPart::of(mesh)?, "size", threads)?;
    let all = mesh.point_field("size").and_then(|field| field.values.to_f64()).unwrap_or_default();
    let mut refinement = MeshRefinement::new(mesh, Options::default(), threads)?;
    loop {
        let before = refinement.refinement().mesh().tets.len();
        let back = coarser(&criterion.wishes(refinement.mesh(), &refinement.part(), threads)?);
        let summary = refinement.coarsen(&back, &Rules::default(), threads)?.report;
        if summary.n_tets == before {
            break;
        }
    }
    for _ in 0..most {
        let marks = marked(&criterion.wishes(refinement.mesh(), &refinement.part(), threads)?);
        if marks.is_empty() {
            break;
        }
        refinement.refine(&marks, &Rules::default(), threads)?;
    }
    *mesh = refinement.with_memory(threads);
    Ok([all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(0.0, f64::max)])
}
