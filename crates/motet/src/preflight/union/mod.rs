//! The union of closed surfaces that cross, touch or lie on each other: what lies inside is left out.
//!
//! | step | where | how |
//! |---|---|---|
//! | divide | `clusters` | triangles that meet share what they have in common afterwards |
//! | sheets | `Sheet` | pieces on each other are one, which counts for as many as face one way more than the other |
//! | outside | `bounding` | sheets stay that have inside on one side and outside on the other, by winding numbers |
//!
//! A place is inside if surfaces go around it more than half a time (Jacobson, Kavan and Sorkine-Hornung
//! 2013, *Robust inside-outside segmentation using generalized winding numbers*).

mod clusters;

use std::collections::BTreeMap;

use crate::base::{DisjointSets, Point, Threads, VertexId, same_orientation, sorted_ids};
use crate::geometry::triangle::{area, centroid, longest_side};
use crate::mesh::open_edges;
use crate::preflight::crossing::own_crossings;
use crate::spatial::{WindingNumber, winding_of_triangle};
pub(crate) use clusters::Divided;

/// Why surfaces were not united.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Failure {
    /// Triangles could not be divided here so that they share what they have in common.
    NotDivided(Point),
    /// The result has open edges, or pairs of triangles that cross; one of these places.
    Faulty(Point),
    /// Nothing is inside.
    Empty,
}

/// A piece, or several on each other.
struct Sheet {
    /// One of the pieces that face the side that more of them face.
    vertices: [VertexId; 3],
    origin: u32,
    /// How many more pieces face that side than the other.
    surplus: i32,
    /// The given triangles of all of them.
    origins: Vec<u32>,
}

/// Divides surfaces where they meet, and keeps the pieces that bound their union. The triangles face outward,
/// those of voids inward; points nearer than `near` are one place.
///
/// # Errors
/// When dividing fails, or the result would be empty, open or not free of crossings.
pub(crate) fn unite(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    near: f64,
    threads: &Threads,
) -> Result<Divided, Failure> {
    let divided = clusters::divide(points, triangles, near, threads).map_err(Failure::NotDivided)?;
    let sheets = sheets(&divided.pieces);
    // The given points come first, some of them shifted.
    let winding = WindingNumber::new(&divided.points, triangles);
    let parts = connected(&sheets);
    let is_kept = bounding(&divided.points, triangles, &sheets, &parts, &winding, threads);
    let kept = sheets.iter().zip(&parts).filter(|(_, part)| is_kept[**part as usize]);
    let pieces: Vec<([VertexId; 3], u32)> = kept.map(|(sheet, _)| (sheet.vertices, sheet.origin)).collect();
    if pieces.is_empty() {
        return Err(Failure::Empty);
    }
    let made: Vec<[VertexId; 3]> = pieces.iter().map(|piece| piece.0).collect();
    if let Some([v, _]) = open_edges(&made).first() {
        return Err(Failure::Faulty(divided.points[v.index()]));
    }
    if let Some(pair) = own_crossings(&divided.points, &made, threads).first() {
        let corners = made[pair[0] as usize].map(|v| divided.points[v.index()]);
        return Err(Failure::Faulty(centroid(corners)));
    }
    Ok(Divided { pieces, ..divided })
}

/// The sheets that pieces form, in the order of the pieces. Those of which as many face either side bound
/// nothing and are left out.
fn sheets(pieces: &[([VertexId; 3], u32)]) -> Vec<Sheet> {
    let mut same: BTreeMap<[VertexId; 3], Vec<usize>> = BTreeMap::new();
    for (i, (t, _)) in pieces.iter().enumerate() {
        same.entry(sorted_ids(*t)).or_default().push(i);
    }
    let sheet = |list: Vec<usize>| {
        let first = pieces[list[0]].0;
        let (alike, opposite): (Vec<usize>, Vec<usize>) =
            list.iter().partition(|&&i| same_orientation(pieces[i].0, first));
        let surplus = alike.len() as i32 - opposite.len() as i32;
        let shown = *if surplus > 0 { alike.first() } else { opposite.first() }?;
        let origins = list.iter().map(|&i| pieces[i].1).collect();
        let (vertices, origin) = pieces[shown];
        (surplus != 0).then_some((shown, Sheet { vertices, origin, surplus: surplus.abs(), origins }))
    };
    let mut sheets: Vec<(usize, Sheet)> = same.into_values().filter_map(sheet).collect();
    sheets.sort_unstable_by_key(|(shown, _)| *shown);
    sheets.into_iter().map(|(_, sheet)| sheet).collect()
}

/// The connected part of each sheet: sheets of the same surplus are connected at edges of two sheets that run
/// along it in opposite directions. Where surfaces meet, an edge has more.
fn connected(sheets: &[Sheet]) -> Vec<u32> {
    let mut sides: Vec<([VertexId; 2], bool, u32)> = Vec::with_capacity(3 * sheets.len());
    for (i, Sheet { vertices: [a, b, c], .. }) in (0u32..).zip(sheets) {
        sides.extend([[*a, *b], [*b, *c], [*c, *a]].map(|side| (sorted_ids(side), side[0] < side[1], i)));
    }
    sides.sort_unstable();
    let mut sets = DisjointSets::new(sheets.len());
    for same in sides.chunk_by(|x, y| x.0 == y.0) {
        if let [x, y] = same
            && x.1 != y.1
            && sheets[x.2 as usize].surplus == sheets[y.2 as usize].surplus
        {
            sets.join(x.2, y.2);
        }
    }
    sets.roots()
}

/// For each part of sheets, whether it has outside before it and inside behind it. Decided at the middle of
/// its best sheet; from one side to the other of a sheet the winding number changes by its surplus.
fn bounding(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    sheets: &[Sheet],
    parts: &[u32],
    winding: &WindingNumber,
    threads: &Threads,
) -> Vec<bool> {
    let corners = |t: [VertexId; 3]| t.map(|v| points[v.index()]);
    let mut best: BTreeMap<u32, (f64, usize)> = BTreeMap::new();
    for (i, (sheet, part)) in sheets.iter().zip(parts).enumerate() {
        let longest = longest_side(corners(sheet.vertices));
        let height = if longest > 0.0 { area(corners(sheet.vertices)) / longest } else { 0.0 };
        let known = best.entry(*part).or_insert((height, i));
        if height > known.0 {
            *known = (height, i);
        }
    }
    let best: Vec<(u32, usize)> = best.into_iter().map(|(part, (_, i))| (part, i)).collect();
    let answers = threads.map(best.len(), |k| {
        let sheet = &sheets[best[k].1];
        let middle = centroid(corners(sheet.vertices));
        let of = |t: &u32| winding_of_triangle(corners(triangles[*t as usize]), middle);
        let on_sheet = winding.at(middle) - sheet.origins.iter().map(of).sum::<f64>();
        let half = 0.5 * f64::from(sheet.surplus);
        on_sheet - half < 0.5 && on_sheet + half > 0.5
    });
    let mut is_kept = vec![false; sheets.len()];
    best.iter().zip(answers).for_each(|((part, _), answer)| is_kept[*part as usize] = answer);
    is_kept
}
