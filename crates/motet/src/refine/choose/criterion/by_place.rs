//! Criteria based on the place of a tet: ball, box, surface, region, patch.

use super::{Criterion, Target, finite};
use crate::base::{Error, Point, Result, TetId, Threads};
use crate::geometry::tet;
use crate::mesh::{Mesh, Surface, TetMesh, TetPart};
use crate::refine::estimate::{corners, longest_edge};
use crate::refine::mark;
use crate::refine::wish::Wish;

/// Checks the corners of a box.
///
/// # Errors
/// When a coordinate is not finite, or the second corner is lower than the first.
pub(super) fn check_box([low, high]: [Point; 2]) -> Result<()> {
    low.iter().chain(&high).try_for_each(|x| finite("a corner of a box", *x))?;
    match (0..3).find(|&k| low[k] > high[k]) {
        None => Ok(()),
        Some(k) => Err(Error::options(format!(
            "a box from {} to {} along {} is empty",
            low[k],
            high[k],
            ["x", "y", "z"][k]
        ))
        .remedy("give the lowest corner first")),
    }
}

/// Returns the wishes of a criterion of place; for any other, every division may be taken back.
pub(super) fn wishes(
    criterion: &Criterion,
    mesh: &Mesh,
    part: &TetPart,
    threads: &Threads,
) -> Result<Vec<Wish>> {
    let tets = &part.mesh;
    Ok(match criterion {
        Criterion::Ball { centre, radius } => of_marks(tets, &mark::in_ball(tets, *centre, *radius, threads)),
        Criterion::Box(corners) => of_marks(tets, &mark::in_box(tets, *corners, threads)),
        Criterion::Near { target, within } => near(tets, target, *within, threads),
        Criterion::NearSize { target, size, growth } => near_size(tets, target, [*size, *growth], threads),
        Criterion::Region(word) => {
            let id = mesh.find_region(word)?;
            tets.regions.iter().map(|region| Wish::of_mark(*region == id)).collect()
        }
        Criterion::Patch { patch, within } => at_patch(patch, *within, mesh, part, threads)?,
        _ => vec![Wish::Coarser; tets.tets.len()],
    })
}

fn of_marks(mesh: &TetMesh, marks: &[TetId]) -> Vec<Wish> {
    let mut wishes = vec![Wish::Coarser; mesh.tets.len()];
    marks.iter().for_each(|tet| wishes[tet.index()] = Wish::Divided(1));
    wishes
}

fn near(mesh: &TetMesh, target: &Target, within: f64, threads: &Threads) -> Vec<Wish> {
    threads.map(mesh.tets.len(), |t| Wish::of_mark(target.is_within(within, corners(mesh, mesh.tets[t]))))
}

/// Whether a tet is too large is decided exactly. How often it is to be divided is estimated from the size at
/// its centre, and whether a tet twice as large would be too large from the distance less the extent of that
/// tet.
fn near_size(mesh: &TetMesh, target: &Target, [size, growth]: [f64; 2], threads: &Threads) -> Vec<Wish> {
    let longest = threads.map(mesh.tets.len(), |t| longest_edge(corners(mesh, mesh.tets[t])));
    // Tets with shorter edges are `Coarser` at any distance.
    let candidates: Vec<usize> =
        (0..longest.len()).filter(|&t| Wish::of_ratio(longest[t] / size) != Wish::Coarser).collect();
    let places: Vec<[Point; 4]> = threads.map(candidates.len(), |i| corners(mesh, mesh.tets[candidates[i]]));
    let centres: Vec<Point> = threads.map(places.len(), |i| tet::centroid(places[i]));
    let found = target.tree().closest_all(&centres, None, threads);
    let of_candidates = threads.map(candidates.len(), |i| {
        let Some(found) = &found[i] else { return Wish::Coarser };
        let (longest, away) = (longest[candidates[i]], found.distance_squared.sqrt());
        if mark::is_above_size(places[i], [size, growth], found) {
            return Wish::of_ratio(longest / (size + growth * away)).max(Wish::Divided(1));
        }
        // The whole that this tet is a part of reaches no farther.
        Wish::of_ratio(longest / (size + growth * (away - 2.0 * longest).max(0.0))).min(Wish::Kept)
    });
    let mut wishes = vec![Wish::Coarser; longest.len()];
    candidates.into_iter().zip(of_candidates).for_each(|(t, wish)| wishes[t] = wish);
    wishes
}

fn at_patch(
    word: &str,
    within: Option<f64>,
    mesh: &Mesh,
    part: &TetPart,
    threads: &Threads,
) -> Result<Vec<Wish>> {
    let id = mesh.find_patch(word)?;
    let surface = Surface::of(mesh);
    let of_patch = surface.triangles.iter().zip(&surface.patches).filter(|(_, patch)| **patch == id);
    let triangles: Vec<_> = of_patch.map(|(triangle, _)| *triangle).collect();
    if let Some(within) = within {
        let target = Target::new(surface.points, triangles, threads)?;
        return Ok(near(&part.mesh, &target, within, threads));
    }
    let mut is_at = vec![false; mesh.points.len()];
    triangles.as_flattened().iter().for_each(|v| is_at[v.index()] = true);
    let touches = |tet: usize| part.mesh.tets[tet].iter().any(|v| is_at[v.index()]);
    Ok(threads.map(part.mesh.tets.len(), |tet| Wish::of_mark(touches(tet))))
}
