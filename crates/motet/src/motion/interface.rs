//! Interfaces inside a volume that a displacement of all points moves: where regions meet, and sheets of
//! labelled facets.

use std::collections::{BTreeMap, HashSet};

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::in_range;
use crate::mesh::adjacency::Facets;
use crate::mesh::{Boundary, Mesh};
use crate::motion::options::FacetSet;
use crate::motion::slide::key;

/// Interior facets between two regions, or those of one patch.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface {
    /// The names of the two regions, or that of the patch.
    pub name: String,
    /// The vertices on its facets, in rising order; those on its rim may lie on the boundary.
    pub vertices: Vec<VertexId>,
}

impl Interface {
    /// All interfaces of a mesh: one for each pair of regions that share a facet, then one for each patch
    /// with interior facets.
    pub fn all(mesh: &Mesh, boundary: &Boundary) -> Vec<Self> {
        let mut all = between_regions(mesh);
        all.extend(patches_inside(mesh, boundary));
        all
    }

    /// The interfaces that a displacement of all points moves: those with an interior vertex whose
    /// displacement is not zero. The others are not prescribed, and follow like the rest of the interior.
    ///
    /// # Errors
    /// When such an interface has a vertex whose displacement is not finite, or when the numbers of
    /// displacements and points differ.
    pub fn moved(mesh: &Mesh, boundary: &Boundary, displacement: &[Point]) -> Result<Vec<Self>> {
        if displacement.len() != mesh.points.len() {
            let what = format!("{} displacements for {} points", displacement.len(), mesh.points.len());
            return Err(Error::input(what));
        }
        let at = |v: &VertexId| displacement[v.index()];
        let is_inside = |v: &&VertexId| boundary.vertices.binary_search(v).is_err();
        let is_displaced = |v: &VertexId| in_range(at(v)) && at(v) != [0.0; 3];
        if !(0..mesh.points.len()).map(VertexId::new).any(|v| is_displaced(&v) && is_inside(&&v)) {
            return Ok(Vec::new());
        }
        let mut all = Self::all(mesh, boundary);
        all.retain(|interface| interface.vertices.iter().filter(is_inside).any(is_displaced));
        for interface in &all {
            if let Some(v) = interface.vertices.iter().find(|v| !in_range(at(v))) {
                return Err(Error::input(format!(
                    "a displacement on the interface {} is not finite",
                    interface.name
                ))
                .at(format!("point {v}"))
                .remedy(
                    "give finite displacements on the whole interface, or zeros where it should follow",
                ));
            }
        }
        Ok(all)
    }
}

/// Calls `visit` with every labelled facet, on the boundary too, and with every facet between two regions.
pub(crate) fn for_each_wall_facet(mesh: &Mesh, mut visit: impl FnMut(&[VertexId])) {
    let of_patches = mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2));
    of_patches.for_each(|(.., vertices)| visit(vertices));
    for_each_between(mesh, |_, vertices| visit(vertices));
}

/// Calls `visit` with every facet between two regions and their labels, the lower first.
fn for_each_between(mesh: &Mesh, mut visit: impl FnMut([i32; 2], &[VertexId])) {
    let Some(regions) = mesh.regions() else { return };
    let volumes = mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3));
    let mut of_volumes = volumes.map(|(cell, ..)| regions.ids[cell.index()]);
    let first = of_volumes.next();
    if of_volumes.all(|region| Some(region) == first) {
        return;
    }
    let facets = Facets::of(&mesh.cells);
    facets.for_each_shared(|uses| {
        if let [a, b] = uses {
            let [x, y] = [a, b].map(|facet| regions.ids[facet.cell.index()]);
            if x != y {
                let facet: Vec<VertexId> = facets.vertices(*a).1.collect();
                visit([x.min(y), x.max(y)], &facet);
            }
        }
    });
}

fn between_regions(mesh: &Mesh) -> Vec<Interface> {
    let Some(regions) = mesh.regions() else { return Vec::new() };
    let mut vertices: BTreeMap<[i32; 2], Vec<VertexId>> = BTreeMap::new();
    for_each_between(mesh, |labels, facet| vertices.entry(labels).or_default().extend(facet));
    let of = |([x, y], mut vertices): ([i32; 2], Vec<VertexId>)| {
        vertices.sort_unstable();
        vertices.dedup();
        Interface { name: format!("between {} and {}", regions.name(x), regions.name(y)), vertices }
    };
    vertices.into_iter().map(of).collect()
}

/// The facets of each patch that are not on the boundary, where there are any.
fn patches_inside(mesh: &Mesh, boundary: &Boundary) -> Vec<Interface> {
    let Some(patches) = mesh.patches() else { return Vec::new() };
    let outer: HashSet<_> = FacetSet::of_boundary(boundary, "", |_| true).rings.iter().map(key).collect();
    let of_label = |label: i32| {
        let set = FacetSet::of_patch(mesh, label);
        let inside: Vec<&[VertexId]> = set.rings.iter().filter(|ring| !outer.contains(&key(ring))).collect();
        let vertices = match inside.len() == set.rings.len() {
            true => set.vertices,
            false => FacetSet::of_rings("", inside.into_iter()).vertices,
        };
        Interface { name: set.name, vertices }
    };
    let used = patches.used().into_iter().filter(|&label| label != 0);
    used.map(of_label).filter(|interface| !interface.vertices.is_empty()).collect()
}
