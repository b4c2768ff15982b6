//! Which tets of the host are removed, and what bounds the cavity that they leave.

use std::collections::HashSet;

use super::devices::Devices;
use super::options::Options;
use super::place::format_point;
use crate::base::{Error, MaybeId, Result, TetId, Threads, VertexId, sorted_ids};
use crate::contact::inside;
use crate::geometry::quality::eas;
use crate::geometry::tet::{EDGES, FACETS, centroid, volume};
use crate::geometry::triangle;
use crate::geometry::vector::distance;
use crate::mesh::tet_facets::{for_each_tet_facet, tet_neighbors};
use crate::mesh::{OrientedTets, TetMesh, bounds, firsts_at_place};
use crate::preflight::own_crossings;
use crate::spatial::NearestTriangle;

/// What becomes of a tet of the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Fate {
    /// It stays, to the bit.
    Kept,
    /// It stays, unless a bad new tet needs its space.
    Near,
    /// It is replaced.
    Removed,
}

/// A facet that new tets have to fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Face {
    /// Oriented outward, as seen from the tet behind it.
    pub(super) vertices: [VertexId; 3],
    /// The region behind it, where a tet is removed.
    pub(super) behind: i32,
    /// The region in front of it; `None` if no tet is removed there.
    pub(super) front: Option<i32>,
}

/// The host after carving.
pub(super) struct Carved {
    pub(super) fates: Vec<Fate>,
    /// Facets between tets that are removed and others; and those between two that are removed, where regions
    /// meet or a triangle lies.
    pub(super) faces: Vec<Face>,
    /// Whether each tet is within [`Options::reach`], so that it may be removed.
    is_in_reach: Vec<bool>,
}

/// A tet with at least this many removed neighbours is only a tooth.
const MIN_REMOVED_NEIGHBORS: usize = 3;

impl Carved {
    pub(super) fn new(
        host: &TetMesh,
        devices: &Devices,
        nearest: &NearestTriangle,
        options: &Options,
        threads: &Threads,
    ) -> Self {
        let mut fates = threads
            .map(host.tets.len(), |t| fate_by_distance(host, t, nearest, options.carve, options.reach));
        let is_in_reach = fates.iter().map(|fate| *fate != Fate::Kept).collect();
        remove_inside(host, devices, &mut fates, threads);
        remove_teeth(&tet_neighbors(&host.tets), &mut fates);
        keep_bad(host, options.improve.limit(), &mut fates);
        let faces = faces(host, &fates);
        Self { fates, faces, is_in_reach }
    }

    /// Removes what is left within reach at the edges of these faces as well. Returns whether there was
    /// anything.
    pub(super) fn remove_around(&mut self, host: &TetMesh, faces: &[[VertexId; 3]]) -> bool {
        let sides = |[a, b, c]: &[VertexId; 3]| [[*a, *b], [*b, *c], [*c, *a]].map(sorted_ids);
        let edges: HashSet<[VertexId; 2]> = faces.iter().flat_map(sides).collect();
        let is_at =
            |tet: &[VertexId; 4]| EDGES.iter().any(|&[i, j]| edges.contains(&sorted_ids([tet[i], tet[j]])));
        let is_lost =
            |t: &usize| self.fates[*t] != Fate::Removed && self.is_in_reach[*t] && is_at(&host.tets[*t]);
        let lost: Vec<usize> = (0..host.tets.len()).filter(is_lost).collect();
        lost.iter().for_each(|&t| self.fates[t] = Fate::Removed);
        remove_teeth(&tet_neighbors(&host.tets), &mut self.fates);
        self.faces = self::faces(host, &self.fates);
        !lost.is_empty()
    }

    /// Refuses a host whose tets overlap where they were carved: no tets fit facets that cross each other,
    /// and a long search for them would fail.
    ///
    /// # Errors
    /// Names a place where two of [`Self::faces`] cross.
    pub(super) fn check_overlaps(&self, host: &TetMesh, threads: &Threads) -> Result<()> {
        let tets = OrientedTets::of_tets(host, threads);
        let n_inverted = (0..host.tets.len()).filter(|&t| tets.is_inverted(t, &host.points)).count();
        if n_inverted == 0 {
            return Ok(());
        }
        // The two sides of a slit coincide, and do not cross.
        let firsts = firsts_at_place(&host.points);
        let faces: Vec<[VertexId; 3]> =
            self.faces.iter().map(|face| face.vertices.map(|v| firsts[v.index()])).collect();
        let crossings = own_crossings(&host.points, &faces, threads);
        let Some(&[first, _]) = crossings.first() else { return Ok(()) };
        let place = format_point(triangle::centroid(faces[first as usize].map(|v| host.points[v.index()])));
        Err(Error::input(format!(
            "tets of the host overlap where the devices lie: {} pairs of facets around the devices cross each \
             other; {n_inverted} of the host's {} tets are flat or inverted",
            crossings.len(),
            host.tets.len()
        ))
        .at(format!("the first facet at {place}"))
        .remedy("repair the host first (`motet remesh`), or carve farther (--carve, --reach)"))
    }

    pub(super) fn removed(&self) -> impl Iterator<Item = usize> + '_ {
        self.fates.iter().enumerate().filter(|(_, fate)| **fate == Fate::Removed).map(|(t, _)| t)
    }
}

/// The fate of a tet by the distance between the devices and the tet's sphere, as a multiple of its mean edge
/// length.
fn fate_by_distance(host: &TetMesh, t: usize, nearest: &NearestTriangle, carve: f64, reach: f64) -> Fate {
    let corners = host.tets[t].map(|v| host.points[v.index()]);
    let centre = centroid(corners);
    let radius = corners.iter().map(|&p| distance(p, centre)).fold(0.0, f64::max);
    let size = EDGES.iter().map(|&[i, j]| distance(corners[i], corners[j])).sum::<f64>() / 6.0;
    match nearest.closest_within(centre, radius + reach * size) {
        None => Fate::Kept,
        Some(found) if found.distance_squared.sqrt() > radius + carve * size => Fate::Near,
        Some(_) => Fate::Removed,
    }
}

/// Removes tets inside devices. A tet that no device is near lies on one side of all of them, so one vertex
/// decides.
fn remove_inside(host: &TetMesh, devices: &Devices, fates: &mut [Fate], threads: &Threads) {
    let Some([low, high]) = bounds(&devices.points) else { return };
    let is_in_box = |v: VertexId| {
        let p = host.points[v.index()];
        (0..3).all(|i| low[i] <= p[i] && p[i] <= high[i])
    };
    let is_candidate = |t: &usize| fates[*t] != Fate::Removed && host.tets[*t].iter().all(|&v| is_in_box(v));
    let candidates: Vec<usize> = (0..fates.len()).filter(is_candidate).collect();
    let firsts: Vec<VertexId> = candidates.iter().map(|&t| host.tets[t][0]).collect();
    let mut points = devices.points.clone();
    let mut vertices: Vec<VertexId> = firsts.clone();
    vertices.sort_unstable();
    vertices.dedup();
    let queries: Vec<VertexId> = (0..vertices.len()).map(|i| VertexId::new(points.len() + i)).collect();
    points.extend(vertices.iter().map(|v| host.points[v.index()]));
    let is_inside = inside(&points, &queries, &[], &devices.triangles, &[], threads);
    for (t, first) in candidates.into_iter().zip(firsts) {
        if vertices.binary_search(&first).is_ok_and(|i| is_inside[i]) {
            fates[t] = Fate::Removed;
        }
    }
}

/// Removes tets that stick out into the cavity as well, so that it has no narrow notches.
fn remove_teeth(neighbors: &[[MaybeId<TetId>; 4]], fates: &mut [Fate]) {
    let mut todo: Vec<usize> = (0..fates.len()).filter(|&t| fates[t] == Fate::Near).collect();
    while let Some(t) = todo.pop() {
        let around = neighbors[t].into_iter().filter_map(MaybeId::get);
        let n_removed = around.clone().filter(|n| fates[n.index()] == Fate::Removed).count();
        if fates[t] == Fate::Near && n_removed >= MIN_REMOVED_NEIGHBORS {
            fates[t] = Fate::Removed;
            todo.extend(around.map(TetId::index));
        }
    }
}

/// Keeps bad tets of the host that need not be removed: what made them bad is not here, and where they are
/// connected they reach far. (Carving those at the cavity as well left 428 bad ones instead of 17 in a public
/// aneurysm of which 43 of 100 tets are bad.)
fn keep_bad(host: &TetMesh, limit: f64, fates: &mut [Fate]) {
    let is_bad = |tet: &[VertexId; 4]| eas(tet.map(|v| host.points[v.index()])).abs() < limit;
    for (fate, tet) in fates.iter_mut().zip(&host.tets) {
        if *fate == Fate::Near && is_bad(tet) {
            *fate = Fate::Kept;
        }
    }
}

fn faces(host: &TetMesh, fates: &[Fate]) -> Vec<Face> {
    let mut faces = Vec::new();
    for_each_tet_facet(&host.tets, &host.triangles, |sharing| {
        let removed = sharing.tets.iter().filter(|(t, _)| fates[t.index()] == Fate::Removed);
        let mut removed = removed.map(|&(t, i)| (t.index(), i));
        let Some((t, i)) = removed.next() else { return };
        let front = removed.next().map(|(other, _)| host.regions[other]);
        let behind = host.regions[t];
        if front == Some(behind) && sharing.triangles.is_empty() {
            return;
        }
        faces.push(Face { vertices: outward(host, t, i), behind, front });
    });
    faces
}

/// Facet `i` of a tet, oriented outward whichever way the tet is numbered.
pub(super) fn outward(host: &TetMesh, t: usize, i: usize) -> [VertexId; 3] {
    let tet = host.tets[t];
    let [a, b, c] = FACETS[i].map(|k| tet[k]);
    if volume(tet.map(|v| host.points[v.index()])) < 0.0 { [a, c, b] } else { [a, b, c] }
}
