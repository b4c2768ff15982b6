//! What stays to the bit: named regions and patches, entities marked as required, and facets of the boundary
//! that have a twin.

use serde::Serialize;

use std::collections::{BTreeMap, BTreeSet};

use crate::base::{CellId, Error, Point, Result, TetId, VertexId};
use crate::kernel::{Complex, Hold, WallId};
use crate::mesh::{CellKind, Labels, Mesh, TetMesh, TetPart, firsts_at_place};

/// What is held: the tets of regions, single tets, and the facets of patches stay, with their vertices.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Held {
    /// Regions whose tets stay.
    pub regions: Vec<i32>,
    /// Patches whose triangles stay; the tets beside them may change.
    pub patches: Vec<i32>,
    /// Tets that stay, by their cell ids; ids of other cells are ignored.
    pub cells: Vec<CellId>,
}

impl Held {
    /// Finds the regions and patches with the given names or numbers. A word that is both a region and a
    /// patch holds both.
    ///
    /// # Errors
    /// If a word is neither; the error lists the regions and patches of the mesh.
    pub fn of_names(mesh: &Mesh, words: &[String]) -> Result<Self> {
        let mut held = Self::default();
        let [regions, patches] = [mesh.regions(), mesh.patches()].map(Option::unwrap_or_default);
        for word in words {
            let (region, patch) = (regions.find(word), patches.find(word));
            if region.is_none() && patch.is_none() {
                let names = |labels: &Labels| {
                    labels.used().into_iter().map(|id| labels.name(id)).collect::<Vec<_>>().join(", ")
                };
                let what = format!("no region or patch is called `{word}`, which is to be held");
                return Err(Error::options(what).remedy(format!(
                    "the mesh has the regions {} and the patches {}",
                    names(&regions),
                    names(&patches)
                )));
            }
            held.regions.extend(region);
            held.patches.extend(patch);
        }
        Ok(held)
    }
}

/// Entities that are held one by one.
#[derive(Clone, Debug, Default)]
pub(super) struct Required {
    tets: Vec<TetId>,
    /// Indices into the triangles of the mesh; those of `lines`, into its lines.
    triangles: Vec<u32>,
    lines: Vec<u32>,
    vertices: Vec<VertexId>,
}

impl Required {
    /// The entities that arrays of a mesh mark as required: see [`marks`](crate::mesh::marks).
    pub(super) fn of(mesh: &Mesh, part: &TetPart) -> Self {
        let places = |kind: CellKind, to_cell: &[CellId]| -> Vec<u32> {
            let cells = mesh.required_cells(kind).into_iter().map(CellId::new);
            cells.filter_map(|cell| to_cell.binary_search(&cell).ok()).map(|place| place as u32).collect()
        };
        Self {
            tets: places(CellKind::TETRA, &part.tet_to_cell).into_iter().map(TetId).collect(),
            triangles: places(CellKind::TRIANGLE, &part.triangle_to_cell),
            lines: places(CellKind::LINE, &part.line_to_cell),
            vertices: mesh.marked_points().into_iter().map(VertexId::new).collect(),
        }
    }
}

/// Fixes everything that is `held` or `required`; `adapts` says whether walls may change at all.
pub(super) fn hold(complex: &mut Complex, mesh: &TetMesh, held: &Held, required: &Required, adapts: bool) {
    let regions: BTreeSet<i32> = held.regions.iter().copied().collect();
    let of_regions = (0..mesh.tets.len()).filter(|&t| regions.contains(&mesh.regions[t])).map(TetId::new);
    let tets: Vec<TetId> = if regions.is_empty() { Vec::new() } else { of_regions.collect() };
    let one_by_one =
        held.cells.iter().filter(|cell| cell.index() < mesh.tets.len()).map(|cell| TetId(cell.0));
    for tet in tets.into_iter().chain(one_by_one).chain(required.tets.iter().copied()) {
        complex.lock(tet);
        complex.vertices(tet).into_iter().for_each(|v| complex.set_hold(v, Hold::Fixed));
    }
    let patches: BTreeSet<i32> = held.patches.iter().copied().collect();
    let is_held = |patch: i32, triangle: u32| {
        (triangle as usize) < mesh.triangles.len()
            && (patches.contains(&patch) || required.triangles.binary_search(&triangle).is_ok())
    };
    let mut walls: Vec<WallId> = Vec::new();
    if !(patches.is_empty() && required.triangles.is_empty()) {
        walls.extend(complex.walls().filter(|(_, w)| is_held(w.patch, w.triangle)).map(|(id, _)| id));
    }
    if adapts {
        walls.extend(twins(complex));
    }
    walls.into_iter().for_each(|wall| complex.fix_wall(wall));
    let lines: Vec<[VertexId; 2]> = required.lines.iter().map(|&line| mesh.lines[line as usize]).collect();
    if !lines.is_empty() {
        complex.fix_edges(lines);
    }
    required.vertices.iter().for_each(|&v| complex.set_hold(v, Hold::Fixed));
}

/// The facets of the boundary that coincide with others, vertex on vertex: both sides of a slit, or of an
/// interface with duplicate points. If they changed one by one, they would no longer fit.
fn twins(complex: &Complex) -> Vec<WallId> {
    let outer = || complex.walls().filter(|(_, wall)| wall.sides[1].is_none());
    let mut vertices: Vec<VertexId> = outer().flat_map(|(_, wall)| complex.facet(wall.sides[0])).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let points: Vec<Point> = vertices.iter().map(|&v| complex.point(v)).collect();
    let firsts = firsts_at_place(&points);
    if firsts.iter().enumerate().all(|(i, first)| first.index() == i) {
        return Vec::new();
    }
    let place = |v: VertexId| vertices.binary_search(&v).map_or(v, |i| firsts[i]);
    let mut at_places: BTreeMap<[VertexId; 3], WallId> = BTreeMap::new();
    let mut found = Vec::new();
    for (id, wall) in outer() {
        let mut places = complex.facet(wall.sides[0]).map(place);
        places.sort_unstable();
        match at_places.get(&places) {
            Some(&other) => found.extend([other, id]),
            None => drop(at_places.insert(places, id)),
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}
