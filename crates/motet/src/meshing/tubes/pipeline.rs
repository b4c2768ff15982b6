//! The steps from centre lines to one closed surface.

use std::f64::consts::TAU;

use super::super::even::{SurfaceWords, even_surface};
use super::super::words::EdgeLength;
use super::bridges::Bridges;
use super::centre_lines::CentreLines;
use super::options::Options;
use super::parts::{Ball, Parts};
use super::report::{EvenReport, EvenTubes, Report, Tubes};
use super::union::{United, branching_edges, pinched_vertices, union};
use crate::base::{DisjointSets, Error, Result, Threads, splitmix64};
use crate::mesh::history::Changed;
use crate::mesh::shapes::{Soup, Wire, add_ball, check_count};
use crate::mesh::{CellKind, Cells, Field, LabelNames, Mesh, Surface};
use crate::preflight::union::Failure;

/// How often parts are turned otherwise where uniting them fails.
const ATTEMPTS: usize = 6;

/// Points nearer than this times the smallest radius are one place, where parts are divided; tried in turn.
const NEAR_OVER_RADIUS: [f64; 3] = [1e-6, 1e-8, 1e-4];

/// Rings are at most this many sides apart.
const SPACING: f64 = 1.25;

/// Edges are this many sides long where the surface is made even.
const SIZE_OVER_SIDE: f64 = 1.2;

/// Edges of balls are divided so that there are about as many triangles around them as a tube has sides.
const EDGES_AROUND_BALL: usize = 5;

/// Makes one closed surface of round tubes along the line cells of a mesh.
///
/// Sections are regular polygons with the area of the round section, so a straight wire, or one that bends
/// where a mitre fits, has the volume of the round one. Where a line bends by more than 90 degrees, or so
/// that sections lean into each other, and where three or more segments meet, tubes end and a ball of 1.1
/// times their radius joins them. Where tubes meet, the surface is that of their union. Wires whose gap is
/// at most [`Options::join`] are joined by material between them, of three quarters of their radius.
///
/// # Errors
/// When there are no lines, a point or a radius is not finite, an option is out of its range, the surface
/// would have too many points, or the tubes cannot be united.
pub fn tubes(mesh: &Mesh, options: &Options, threads: &Threads) -> Result<Tubes> {
    options.check()?;
    let lines = CentreLines::of(mesh, options)?;
    let radii = lines.extremes();
    let sides = options.n_sides(radii);
    let length = |w: &Wire| (0..w.n_segments()).map(|s| w.length(s)).sum::<f64>();
    let rough = rough_count(&lines, sides);
    check_count(rough)?;
    threads.watch().report_and_check("joining wires", 0, ATTEMPTS)?;
    let parts = Parts::of(&lines, sides);
    let bridges = Bridges::of(&parts.chains, sides, options, threads);
    let wires: Vec<&Wire> = parts.wires.iter().chain(&bridges.wires).collect();
    let balls: Vec<Ball> = parts.balls.iter().chain(&bridges.balls).copied().collect();
    let mut failure = None;
    for attempt in 0..ATTEMPTS {
        threads.watch().report_and_check("joining wires", attempt, ATTEMPTS)?;
        let soup = soup(&wires, &balls, sides, attempt);
        let near = radii[0] * NEAR_OVER_RADIUS[attempt % NEAR_OVER_RADIUS.len()];
        match union(&soup, near, threads) {
            Err(why) => failure = Some(why),
            Ok(united) => {
                let report = Report {
                    chains: parts.chains.len(),
                    segments: lines.segments.len(),
                    left_out: lines.left_out,
                    other_cells: lines.other_cells,
                    length: parts.chains.iter().map(length).sum(),
                    radii,
                    sides,
                    branches: parts.branches,
                    sharp_bends: parts.sharp_bends,
                    bridges: bridges.n,
                    least_gap: bridges.least_gap,
                    wire_volume: parts.chains.iter().map(Wire::volume).sum(),
                    volume: 0.0,
                    bodies: bodies(&united),
                    branching_edges: branching_edges(&united.triangles),
                    pinched_vertices: pinched_vertices(&united.triangles),
                    meetings: united.clusters,
                    shifted: united.shifted,
                    retries: attempt,
                };
                return made(united, report, options.allowed(radii[0]));
            }
        }
    }
    let error = Error::input(format!("the tubes could not be united in {ATTEMPTS} attempts"))
        .remedy("ask for other `sides`, or a larger gap at which wires are joined");
    Err(match failure {
        Some(Failure::Faulty(place) | Failure::NotDivided(place)) => error.at(format!("near {place:?}")),
        _ => error,
    })
}

/// Makes one closed surface of round tubes along the line cells of a mesh, as [`tubes`] does, and gives it
/// even triangles. The distance follows the smallest radius, if the words do not say it, and sizes the sides
/// of the tubes.
///
/// # Errors
/// Those of [`tubes`] and of [`even_surface`].
pub fn even_tubes(
    mesh: &Mesh,
    options: &Options,
    words: &SurfaceWords,
    threads: &Threads,
) -> Result<EvenTubes> {
    let size = match words.size {
        Some(EdgeLength::Length(size)) => Some(size),
        _ => None,
    };
    let options = Options {
        size: options.size.or(size),
        distance: options.distance.or(words.distance),
        ..options.clone()
    };
    let made = tubes(mesh, &options, threads)?;
    // What words ask to be repaired is in the lines.
    let words = SurfaceWords { repair: false, ..words.clone() };
    let even = made.fit(words.options(&made.mesh)?);
    let Changed { mesh, report, .. } = even_surface(&made.mesh, &even, threads)?;
    Ok(EvenTubes { mesh, report: EvenReport { surface: report, wires: made.report } })
}

/// The expected number of points, from above.
fn rough_count(lines: &CentreLines, sides: usize) -> f64 {
    let of = |(segment, radii): (&[crate::base::VertexId; 2], &[f64; 2])| {
        let [a, b] = segment.map(|v| lines.points[v.index()]);
        let side = std::f64::consts::PI * (radii[0] + radii[1]) / sides as f64;
        crate::geometry::vector::distance(a, b) / (SPACING * side) + 2.0
    };
    lines.segments.iter().zip(&lines.radii).map(of).sum::<f64>() * sides as f64
}

/// All parts, each turned about itself by an angle of its own, so that sides of different tubes lie in no
/// common plane.
fn soup(wires: &[&Wire], balls: &[Ball], sides: usize, attempt: usize) -> Soup {
    let mut soup = Soup::default();
    let phase = |number: usize| {
        let random = splitmix64((number + attempt * (wires.len() + balls.len())) as u64);
        TAU * random as f64 / u64::MAX as f64
    };
    for (number, wire) in wires.iter().enumerate() {
        wire.sweep(sides, phase(number), SPACING, &mut soup);
    }
    let divided = sides.div_ceil(EDGES_AROUND_BALL).max(3);
    for (number, ball) in (wires.len()..).zip(balls) {
        add_ball(ball.centre, ball.radius, divided, phase(number), &mut soup);
    }
    soup
}

/// The number of parts connected by vertices.
fn bodies(united: &United) -> usize {
    let mut sets = DisjointSets::new(united.points.len());
    sets.join_all(united.triangles.iter().map(|t| t.as_slice()));
    let mut roots = sets.roots();
    roots.sort_unstable();
    roots.dedup();
    roots.len()
}

fn made(united: United, report: Report, allowed: f64) -> Result<Tubes> {
    let cells = Cells::uniform(CellKind::TRIANGLE, united.triangles.into_flattened())?;
    let names = [(1, "wire".to_owned())].into();
    let mesh = Mesh {
        cell_data: vec![Field::scalars("patch", vec![1; cells.len()])],
        label_names: LabelNames { patches: names, ..LabelNames::default() },
        ..Mesh::new(united.points, cells)
    };
    let volume = Surface::of(&mesh).enclosed_volume();
    let sizes = united.sizes.iter().map(|side| SIZE_OVER_SIDE * side).collect();
    Ok(Tubes { mesh, report: Report { volume, ..report }, sizes, is_far: united.is_far, allowed })
}
