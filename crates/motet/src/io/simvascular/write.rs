//! Writes a mesh to a folder.
//!
//! Every patch becomes a face with the ids that solvers need: `GlobalNodeID` (its points in the volume),
//! `GlobalElementID` (the element behind each facet), `ModelFaceID` (the label of the patch). Ids of the mesh
//! are kept if they identify its points or elements uniquely; otherwise both are numbered from 1.

use std::collections::{BTreeMap, HashMap};

use crate::base::{Error, Result, Threads, VertexId, rising_list};
use crate::io::format::{WriteOptions, Written};
use crate::io::select::{facet_mesh, restricted_to_kinds};
use crate::io::simvascular::read::node_ids;
use crate::io::simvascular::{ELEMENT_ID, FACE_ID, NODE_ID, REGION_ID, SURFACES, VOLUME};
use crate::io::tags::Tags;
use crate::io::vtkxml;
use crate::mesh::{Boundary, Field, Labels, Mesh, Values, corners};

pub(super) fn write(mesh: &Mesh, options: &WriteOptions, threads: &Threads) -> Result<Written> {
    let of_dim = |dim| -> Vec<usize> {
        (0..mesh.cells.len()).filter(|&i| mesh.cells.kinds()[i].dim() == Some(dim)).collect()
    };
    let (volume_cells, surface_cells) = (of_dim(3), of_dim(2));
    if volume_cells.is_empty() {
        return Err(Error::input("a mesh-complete folder needs volume cells, but the mesh has none")
            .remedy("write a surface as .vtp"));
    }
    let (labels, mut faces) = faces(mesh, &surface_cells);
    if faces.is_empty() {
        return Err(Error::input("a mesh-complete folder needs faces, but no surface cell has a patch")
            .remedy("give the mesh surface cells with the cell array \"patch\""));
    }
    let numbered = WithIds::new(mesh, &volume_cells);
    let mut written = Written::default();
    let volume = numbered.volume(&volume_cells);
    add(&mut written, VOLUME.into(), vtkxml::VTU.to_files(&volume, options, threads)?);
    let mut unknown = 0;
    let face = |written: &mut Written, path: String, cells: &[usize]| -> Result<usize> {
        let (face, inside) = numbered.face(cells, &labels);
        add(written, path, vtkxml::VTP.to_files(&face, options, threads)?);
        Ok(inside)
    };
    for (name, cells) in &faces {
        unknown += face(&mut written, format!("{SURFACES}/{name}.vtp"), cells)?;
    }
    let exterior: Vec<usize> = surface_cells.iter().copied().filter(|&i| labels.ids[i] != 0).collect();
    face(&mut written, "mesh-complete.exterior.vtp".into(), &exterior)?;
    faces.retain(|name, _| name.to_lowercase().starts_with("wall"));
    let mut walls: Vec<usize> = faces.into_values().flatten().collect();
    walls.sort_unstable();
    if !walls.is_empty() {
        face(&mut written, "walls_combined.vtp".into(), &walls)?;
    }
    let others = mesh.cells.len() - volume_cells.len() - exterior.len();
    if others > 0 {
        written
            .lost
            .push(format!("{others} cells are not written: they are neither volume cells nor in a patch"));
    }
    if unknown > 0 {
        written
            .lost
            .push(format!("{unknown} facets of patches are not on the boundary: their {ELEMENT_ID} is 0"));
    }
    written.lost.dedup();
    Ok(written)
}

/// Adds the single file of a writer under `path`.
fn add(written: &mut Written, path: String, made: Written) {
    written.lost.extend(made.lost);
    written.files.extend(made.files.into_iter().map(|(_, bytes)| (path.clone(), bytes)));
}

/// The patch of each cell, and the cells of each patch, keyed by a valid file name.
fn faces(mesh: &Mesh, surface_cells: &[usize]) -> (Labels, BTreeMap<String, Vec<usize>>) {
    let labels = mesh.patches().unwrap_or_default();
    let mut faces = BTreeMap::new();
    for label in labels.used() {
        let cells: Vec<usize> = surface_cells.iter().copied().filter(|&i| labels.ids[i] == label).collect();
        let is_safe = |c: char| c.is_alphanumeric() || "-_.+ ".contains(c);
        let mut name: String = labels.name(label).chars().map(|c| if is_safe(c) { c } else { '_' }).collect();
        if name.trim_matches(['.', ' ']).is_empty() || faces.contains_key(&name) {
            name = format!("{name}_{label}");
        }
        if !cells.is_empty() {
            faces.insert(name, cells);
        }
    }
    (labels, faces)
}

/// A mesh with ids of its points and elements.
struct WithIds<'m> {
    mesh: &'m Mesh,
    node_ids: Values,
    /// Element id of each cell; 0 for cells that are not volume cells.
    element_ids: Vec<i64>,
    /// The element behind a boundary facet, keyed by the facet's sorted corners.
    behind: HashMap<Vec<VertexId>, i64>,
}

impl<'m> WithIds<'m> {
    fn new(mesh: &'m Mesh, volume_cells: &[usize]) -> Self {
        let own = node_ids(mesh).filter(|ids| !ids.contains(&0) && Tags::new(ids, NODE_ID).is_ok());
        let node_ids = match own {
            Some(ids) => integers(ids.into_iter().map(|id| id as i64).collect()),
            None => integers((1..).take(mesh.points.len()).collect()),
        };
        let mut element_ids = vec![0; mesh.cells.len()];
        let own = mesh.cell_field(ELEMENT_ID).filter(|f| f.components == 1).and_then(|f| f.values.to_i64());
        let own = own.map(|ids| volume_cells.iter().map(|&i| ids[i]).collect::<Vec<_>>()).filter(|ids| {
            let unsigned: Vec<u64> = ids.iter().map(|&id| id.max(0) as u64).collect();
            !unsigned.contains(&0) && Tags::new(&unsigned, ELEMENT_ID).is_ok()
        });
        let ids = own.unwrap_or_else(|| (1..).take(volume_cells.len()).collect());
        volume_cells.iter().zip(ids).for_each(|(&i, id)| element_ids[i] = id);
        let boundary = Boundary::of(&mesh.cells);
        let keys = boundary.facets.iter().zip(&boundary.kinds).zip(&boundary.cells);
        let behind =
            keys.map(|((facet, kind), cell)| (rising_list(corners(*kind, facet)), element_ids[cell.index()]));
        Self { mesh, node_ids, behind: behind.collect(), element_ids }
    }

    fn volume(&self, volume_cells: &[usize]) -> Mesh {
        let mut volume = restricted_to_kinds(self.mesh, |kind| kind.dim() == Some(3));
        volume.set_point_field(Field::scalars(NODE_ID, self.node_ids.clone()));
        let ids = volume_cells.iter().map(|&i| self.element_ids[i]).collect();
        volume.set_cell_field(Field::scalars(ELEMENT_ID, integers(ids)));
        if volume.cell_field(REGION_ID).is_none() {
            let regions = self.mesh.regions().map(|regions| regions.ids);
            let region = |&i: &usize| regions.as_ref().map_or(1, |ids| ids[i]);
            volume.set_cell_field(Field::scalars(
                REGION_ID,
                volume_cells.iter().map(region).collect::<Vec<_>>(),
            ));
        }
        volume.label_names.patches.clear();
        volume
    }

    /// The surface formed by some cells, and how many of them are not boundary facets.
    fn face(&self, cells: &[usize], labels: &Labels) -> (Mesh, usize) {
        let facet = |&i: &usize| (self.mesh.cells.kinds()[i], self.mesh.cells.connectivity().list(i));
        let mut used: Vec<VertexId> = cells.iter().map(facet).flat_map(|(_, v)| v).copied().collect();
        used.sort_unstable();
        used.dedup();
        let mut face = facet_mesh(self.mesh, &used, cells.iter().map(facet), cells);
        let point_rows = used.iter().map(|v| v.index());
        face.set_point_field(Field::scalars(NODE_ID, self.node_ids.clone()).pick(point_rows));
        let behind =
            |(kind, vertices)| self.behind.get(&rising_list(corners(kind, vertices))).copied().unwrap_or(0);
        let behind: Vec<i64> = cells.iter().map(facet).map(behind).collect();
        let inside = behind.iter().filter(|&&id| id == 0).count();
        face.set_cell_field(Field::scalars(ELEMENT_ID, integers(behind)));
        let face_ids: Vec<i32> = cells.iter().map(|&i| labels.ids[i]).collect();
        face.set_cell_field(Field::scalars(FACE_ID, face_ids));
        (face, inside)
    }
}

/// Ids as 32-bit integers if they fit, as SimVascular uses.
fn integers(ids: Vec<i64>) -> Values {
    let small: Option<Vec<i32>> = ids.iter().map(|&id| i32::try_from(id).ok()).collect();
    small.map_or(Values::I64(ids), Values::I32)
}
