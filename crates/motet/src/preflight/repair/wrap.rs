//! Replaces boundaries by new closed surfaces around what they enclose.

use std::collections::BTreeSet;

use super::Repairs;
use super::divide::DividedSurfaces;
use super::report::RepairKind;
use super::work::{Piece, Work};
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle::centroid;
use crate::geometry::vector::LARGEST;
use crate::mesh::{cone_volume, largest_extent};
use crate::preflight::parts::Parts;
use crate::preflight::single::{Shape, shapes};
use crate::preflight::surfaces::Role;
use crate::preflight::wrap::{Fate, Field, wrap as wrapped};
use crate::spatial::bounding_box;

/// The least distance, over the largest extent of a surface.
const LEAST_OVER_EXTENT: f64 = 1e-5;

/// Replaces each boundary by a new surface within `distance`. `None` if there is no boundary.
///
/// # Errors
/// If the distance is not positive, or too small, or a boundary encloses nothing. When a stop was requested.
pub(super) fn wrap(
    work: &mut Work,
    repairs: &Repairs,
    distance: f64,
    threads: &Threads,
) -> Result<Option<DividedSurfaces>> {
    if !(distance > 0.0 && distance <= LARGEST) {
        return Err(Error::options(format!("the distance of a wrapped surface cannot be {distance}"))
            .remedy("give a positive distance"));
    }
    if repairs.orient {
        turn_open_parts(work);
    }
    let open = open_parts(work);
    let lists = work.lists();
    let shapes = shapes(&lists.surfaces(work), threads);
    let n_before = work.points.len();
    let (mut points, mut origins) = (work.points.to_vec(), Vec::new());
    let mut is_replaced = vec![false; work.roles.len()];
    let mut pieces: Vec<Piece> = Vec::new();
    for surface in (0..work.roles.len() as u32).filter(|s| work.roles[*s as usize] == Role::Boundary) {
        let is_own = |i: &usize| work.pieces[*i].surface == surface && shapes[*i] == Shape::Sound;
        let mut own: Vec<usize> = (0..work.pieces.len()).filter(is_own).collect();
        let mut triangles: Vec<[VertexId; 3]> = own.iter().map(|&i| work.pieces[i].vertices).collect();
        if own.is_empty() {
            continue;
        }
        let used = triangles.as_flattened().iter().map(|v| work.points[v.index()]);
        let extent = largest_extent(bounding_box(used));
        if distance < LEAST_OVER_EXTENT * extent {
            let least = LEAST_OVER_EXTENT * extent;
            return Err(Error::options(format!(
                "a wrapped surface would need too many triangles at {distance}"
            ))
            .remedy(format!("give a distance of at least {least:.1e}, a hundred thousandth of the extent")));
        }
        let mut field = Field::new(work.points, &triangles, distance, threads);
        // In the thin room behind a bent sheet, a new surface would need very many triangles.
        let is_sheet = |part: &&Vec<u32>| {
            let corners = |t: &u32| work.pieces[*t as usize].vertices.map(|v| work.points[v.index()]);
            work.pieces[part[0] as usize].surface == surface
                && !field.is_enclosing(&part.iter().map(corners).collect::<Vec<_>>(), threads)
        };
        let sheets: BTreeSet<u32> = open.iter().filter(is_sheet).flatten().copied().collect();
        if !sheets.is_empty() {
            for &i in own.iter().filter(|i| sheets.contains(&(**i as u32))) {
                let vertices = work.pieces[i].vertices.to_vec();
                work.record(RepairKind::DroppedOutside, vec![work.old(i as u32)], vertices);
            }
            own.retain(|i| !sheets.contains(&(*i as u32)));
            triangles = own.iter().map(|&i| work.pieces[i].vertices).collect();
            field = Field::new(work.points, &triangles, distance, threads);
        }
        let made = match own.is_empty() {
            true => None,
            false => wrapped(work.points, &triangles, &field, threads)?,
        };
        let Some(made) = made else {
            return Err(Error::input(format!("the surfaces enclose nothing thicker than {distance}")).remedy(
                "wrap within a smaller distance; triangles have to face outward, as `--repair` turns them",
            ));
        };
        is_replaced[surface as usize] = true;
        let nearest =
            |p: Point| field.nearest(p).map_or((0, [1.0, 0.0, 0.0]), |near| (near.triangle, near.weights));
        let to_id: Vec<VertexId> = made
            .points
            .iter()
            .zip(&made.given)
            .map(|(p, given)| {
                given.get().unwrap_or_else(|| {
                    let (triangle, weights) = nearest(*p);
                    origins.push((triangles[triangle], weights));
                    points.push(*p);
                    VertexId::new(points.len() - 1)
                })
            })
            .collect();
        let after = threads.map_parts(made.triangles.len(), 64, |t| {
            own[nearest(centroid(made.triangles[t].map(|v| made.points[v as usize]))).0]
        });
        pieces.extend(made.triangles.iter().zip(after).map(|(t, i)| Piece {
            vertices: t.map(|v| to_id[v as usize]),
            is_new: true,
            is_reversed: false,
            ..work.pieces[i]
        }));
        work.record(RepairKind::Wrapped, Vec::new(), Vec::new());
        for (fate, &i) in made.fates.iter().zip(&own) {
            let kind = match fate {
                Fate::Kept => continue,
                Fate::Inside => RepairKind::DroppedInside,
                Fate::Outside => RepairKind::DroppedOutside,
                Fate::Thin => RepairKind::DroppedThin,
            };
            work.record(kind, vec![work.old(i as u32)], work.pieces[i].vertices.to_vec());
        }
    }
    if !is_replaced.contains(&true) {
        return Ok(None);
    }
    pieces.extend(work.pieces.iter().filter(|piece| !is_replaced[piece.surface as usize]));
    let vertex_to_kept = (0..n_before).map(VertexId::new).collect();
    Ok(Some(DividedSurfaces { points, origins, vertex_to_kept, pieces }))
}

/// The parts of the surfaces that are open.
fn open_parts(work: &mut Work) -> Vec<Vec<u32>> {
    let lists = work.lists();
    let sides = work.sides(&lists);
    let parts = Parts::new(work.pieces.len(), &sides);
    parts.iter().filter(|(_, is_closed)| !is_closed).map(|(part, _)| part.to_vec()).collect()
}

/// Turns open parts so that they face away from what they go around.
fn turn_open_parts(work: &mut Work) {
    for part in open_parts(work) {
        let of = |t: &u32| work.pieces[*t as usize].vertices;
        let corners = || part.iter().flat_map(of).map(|v| work.points[v.index()]);
        let n = 3.0 * part.len() as f64;
        let middle = corners().fold([0.0; 3], |sum, p| [0, 1, 2].map(|axis| sum[axis] + p[axis] / n));
        let volume: f64 = part.iter().map(|t| cone_volume(of(t).into_iter(), work.points, middle)).sum();
        if volume < 0.0 {
            part.into_iter().for_each(|t| work.reverse(t));
        }
    }
}
