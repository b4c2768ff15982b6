//! Labelled meshes: volume cells and their boundary, or a surface alone.

use std::collections::BTreeMap;

use crate::base::{Point, VertexId};
use crate::mesh::{Boundary, CellKind, Cells, Field, LabelNames, Mesh};

/// A mesh of `cells`, all of one region, followed by its boundary facets as surface cells. `patch_of` returns
/// the patch of a facet, as an index into `patches` (the names of labels 1, 2, ...).
pub(super) fn labelled(
    points: Vec<Point>,
    mut cells: Cells,
    region: &str,
    patches: &[&str],
    patch_of: impl Fn(&[VertexId]) -> usize,
) -> Mesh {
    let boundary = Boundary::of(&cells);
    let mut region_ids = vec![1; cells.len()];
    let mut patch_ids = vec![0; cells.len()];
    for (facet, &kind) in boundary.facets.iter().zip(&boundary.kinds) {
        cells.push(kind, facet.iter().copied());
        region_ids.push(0);
        patch_ids.push(patch_of(facet) as i32 + 1);
    }
    let names = |names: &[&str]| -> BTreeMap<i32, String> {
        (1..).zip(names.iter().map(|name| (*name).to_owned())).collect()
    };
    Mesh {
        cell_data: vec![Field::scalars("region", region_ids), Field::scalars("patch", patch_ids)],
        label_names: LabelNames { regions: names(&[region]), patches: names(patches) },
        ..Mesh::new(points, cells)
    }
}

/// A surface mesh of triangles, all of one patch.
pub(super) fn surface_mesh(points: Vec<Point>, triangles: &[[VertexId; 3]], patch: &str) -> Mesh {
    patched_surface_mesh(points, &[(patch, triangles)])
}

/// A surface mesh of the triangles of several patches, which are labelled 1, 2, ...
pub(super) fn patched_surface_mesh(points: Vec<Point>, parts: &[(&str, &[[VertexId; 3]])]) -> Mesh {
    let (mut cells, mut patches, mut names) = (Cells::new(), Vec::new(), BTreeMap::new());
    for (label, (name, triangles)) in (1..).zip(parts) {
        triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
        patches.resize(cells.len(), label);
        names.insert(label, (*name).to_owned());
    }
    Mesh {
        cell_data: vec![Field::scalars("patch", patches)],
        label_names: LabelNames { patches: names, ..LabelNames::default() },
        ..Mesh::new(points, cells)
    }
}
