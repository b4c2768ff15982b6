//! The loop of solving, sizes from the second derivatives of the solution, and adapting, beside refinement everywhere.
//!
//! `refine_loop [MESH] [--rounds N] [--tets N] [--factor F] [--error E] [--threads N]` begins with a mesh file, or a tube. In each of the rounds (default 4) a formula stands in for the
//! solver, the mesh is coarsened and refined to sizes for so many tets (default 10000, and `F` times as many from round to round, default 2.5) or, with `--error`, for an error of
//! at most `E`, one generation a round. Errors are relative to the fastest flow: the root of the mean square, and the most.

use std::error::Error;

use motet::base::{Point, TetId, Threads};
use motet::geometry::tet::{at, volume};
use motet::geometry::vector::distance;
use motet::mesh::history::Rules;
use motet::mesh::shapes::{TubeOptions, tube};
use motet::mesh::{Field, TetMesh, TetPart, bounds};
use motet::refine::sizes::SizeLimits;
use motet::refine::wish::{coarser, marked};
use motet::refine::{Aim, HessianSizes, MeshRefinement, Options, Refinement};
use motet::{Mesh, io};

/// A front round the middle of the mesh that stands in for a solution: fast within a tenth of the extent, a hundredth wide.
struct Front {
    middle: Point,
    extent: f64,
}

impl Front {
    fn of(mesh: &Mesh) -> Option<Self> {
        let [low, high] = bounds(&mesh.points)?;
        let extent = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        Some(Self { middle: [0, 1, 2].map(|k| 0.5 * (low[k] + high[k])), extent })
    }

    fn speed(&self, p: Point) -> f64 {
        0.5 * (1.0 - ((distance(p, self.middle) / self.extent - 0.1) / 0.01).tanh())
    }

    fn solve(&self, mesh: &mut Mesh) {
        let velocity: Vec<Point> = mesh.points.iter().map(|p| [0.0, 0.0, self.speed(*p)]).collect();
        let pressure: Vec<f64> = mesh.points.iter().map(|p| -p[2] / self.extent).collect();
        mesh.set_point_field(Field::vectors("velocity", &velocity));
        mesh.set_point_field(Field::scalars("pressure", pressure));
    }

    /// How far the speed is from its linear interpolant, at five places a tet.
    fn error(&self, mesh: &TetMesh) -> [f64; 2] {
        let (mut squares, mut weights, mut most) = (0.0f64, 0.0f64, 0.0f64);
        let (a, b) = (1.0 / 6.0, 0.5);
        let places = [[0.25; 4], [b, a, a, a], [a, b, a, a], [a, a, b, a], [a, a, a, b]];
        for tet in &mesh.tets {
            let corners = tet.map(|v| mesh.points[v.index()]);
            let weight = volume(corners).abs();
            for place in places {
                let linear: f64 = corners.iter().zip(place).map(|(p, w)| w * self.speed(*p)).sum();
                let off = (linear - self.speed(at(corners, place))).abs();
                squares += weight * off * off;
                weights += weight;
                most = most.max(off);
            }
        }
        [(squares / weights).sqrt(), most]
    }
}

/// Refinement everywhere, as far as there are so many tets: their number and the mean error, one generation after the other.
fn everywhere(front: &Front, first: &TetMesh, n: usize, threads: &Threads) -> motet::Result<Vec<[f64; 2]>> {
    let mut refinement = Refinement::new(first, Options::default(), threads)?;
    let mut found = vec![[first.tets.len() as f64, front.error(first)[0]]];
    while refinement.mesh().tets.len() < n {
        let all: Vec<TetId> = (0..refinement.mesh().tets.len()).map(TetId::new).collect();
        refinement.refine(&all, threads)?;
        found.push([refinement.mesh().tets.len() as f64, front.error(refinement.mesh())[0]]);
    }
    Ok(found)
}

/// Between two generations the error goes with a power of the number of tets.
fn with_as_many(found: &[[f64; 2]], n: f64) -> f64 {
    // The last generation has no fewer tets.
    let Some(pair) = found.windows(2).find(|pair| n <= pair[1][0]) else { return found[0][1] };
    let [[n0, e0], [n1, e1]] = [pair[0], pair[1]];
    e0 * (n / n0).powf((e1 / e0).ln() / (n1 / n0).ln())
}

/// The mesh for the next solution: divisions taken back, then tets divided, so often at most. Sizes are found once and carried.
fn adapt(mesh: &mut Mesh, sizes: &HessianSizes, most: usize, threads: &Threads) -> motet::Result<[f64; 2]> {
    let criterion = sizes.put(mesh, &TetPart::of(mesh)?, "size", threads)?;
    let all = mesh.point_field("size").and_then(|field| field.values.to_f64()).unwrap_or_default();
    let mut refinement = MeshRefinement::new(mesh, Options::default(), threads)?;
    loop {
        let before = refinement.refinement().mesh().tets.len();
        let back = coarser(&criterion.wishes(refinement.mesh(), &refinement.part(), threads)?);
        let (summary, _) = refinement.coarsen(&back, &Rules::default(), threads)?;
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

fn main() -> Result<(), Box<dyn Error>> {
    let (mut file, mut rounds, mut n_tets, mut factor, mut error, mut threads) =
        (None, 4, 10_000, 2.5, None, 1);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--rounds" => rounds = value()?.parse()?,
            "--tets" => n_tets = value()?.parse()?,
            "--factor" => factor = value()?.parse::<f64>()?,
            "--error" => error = Some(value()?.parse()?),
            "--threads" => threads = value()?.parse()?,
            _ => file = Some(word),
        }
    }
    let threads = Threads::new(threads)?;
    let mut mesh = file.map_or_else(|| Ok(tube(&TubeOptions::default())), io::read)?;
    let front = Front::of(&mesh).ok_or("a mesh has points")?;
    let first = TetPart::of(&mesh)?.mesh;
    let mut rows = vec![(first.tets.len(), None, front.error(&first))];
    for round in 0..rounds {
        front.solve(&mut mesh);
        let tets = (f64::from(n_tets) * factor.powi(round)) as usize;
        let (aim, most) = error.map_or((Aim::Tets(tets), usize::MAX), |error| (Aim::Error(error), 1));
        let arrays = vec!["pressure".into(), "velocity".into()];
        let sizes = HessianSizes { arrays, aim, limits: SizeLimits::default() };
        let extremes = adapt(&mut mesh, &sizes, most, &threads)?;
        let tets = TetPart::of(&mesh)?.mesh;
        rows.push((tets.tets.len(), Some(extremes), front.error(&tets)));
    }
    let found = everywhere(&front, &first, rows.iter().map(|row| row.0).max().unwrap_or(0), &threads)?;
    println!(
        "| tets | smallest size | largest size | mean error | most | mean error, as many tets everywhere |"
    );
    println!("|---|---|---|---|---|---|");
    for (n, extremes, [mean, most]) in rows {
        let [low, high] = extremes.map_or(["-".into(), "-".into()], |all| all.map(|h| format!("{h:.3}")));
        let uniform = with_as_many(&found, n as f64);
        println!("| {n} | {low} | {high} | {mean:.4} | {most:.3} | {uniform:.4} |");
    }
    Ok(())
}
