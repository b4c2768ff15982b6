//! The cells of a mesh grouped by label, as sections store them: those of the highest dimension first.

use std::collections::HashMap;

use crate::io::cgns::kinds::ElementType;
use crate::io::cgns::names::{default_name, valid};
use crate::mesh::{CellKind, Labels, Mesh};

/// Names of nodes beside those of sections, families and conditions.
pub(super) const ZONE: &str = "Zone";
pub(super) const POINT_DATA: &str = "PointData";
pub(super) const CELL_DATA: &str = "CellData";
pub(super) const FACE_DATA: &str = "FaceData";
pub(super) const INNER_FACES: &str = "InnerFaces";
const RESERVED: [&str; 8] =
    [ZONE, POINT_DATA, CELL_DATA, FACE_DATA, INNER_FACES, "GridCoordinates", "ZoneBC", "ZoneType"];

/// Cells of one dimension and one label.
pub(super) struct Part {
    pub(super) dim: usize,
    pub(super) number: i32,
    /// The name of the section, the family and the boundary condition.
    pub(super) name: String,
    /// Whether the part has a family, so that its label can be recovered on reading.
    pub(super) has_label: bool,
    /// Indices of the cells, in the order of the mesh.
    pub(super) cells: Vec<usize>,
}

impl Part {
    /// The type of all its cells; `None` if they are of several types.
    pub(super) fn element_type(&self, mesh: &Mesh) -> Option<ElementType> {
        let kind_of = |cell: usize| mesh.cells.kinds()[cell];
        let kind = kind_of(*self.cells.first()?);
        self.cells.iter().all(|&cell| kind_of(cell) == kind).then(|| element_type(kind))?
    }
}

/// The type that cells of a kind are written as.
pub(super) fn element_type(kind: CellKind) -> Option<ElementType> {
    ElementType::of_kind(kind, kind.n_vertices()?)
}

/// The cells of a mesh by dimension and label; parts of one dimension are ordered by their first cells.
pub(super) fn parts(mesh: &Mesh, lost: &mut Vec<String>) -> Vec<Part> {
    let mut taken: Vec<String> = RESERVED.map(str::to_owned).to_vec();
    let mut parts = Vec::new();
    let named = [(3, mesh.regions(), "Volume"), (2, mesh.patches(), "Surface")];
    let unnamed = [(1, None, "Curves"), (0, None, "Points")];
    for (dim, labels, rest) in named.into_iter().chain(unnamed) {
        // Cells without a label must have none when read back.
        let has_labels = labels.is_some() || dim == 2;
        for (number, cells) in by_label(mesh, dim, labels.as_ref()) {
            let called = labels.as_ref().and_then(|l| l.names.get(&number)).filter(|name| !name.is_empty());
            let wanted = match (number, called) {
                (0, _) => rest.to_owned(),
                (_, Some(name)) => name.clone(),
                (number, None) => default_name(dim, number),
            };
            let name = valid(&wanted, &taken);
            if number != 0 && name != wanted {
                lost.push(format!(
                    "the name {wanted:?} is written as {name:?}: CGNS names are unique, without slashes, and at most 32 bytes long"
                ));
            }
            taken.push(name.clone());
            parts.push(Part { dim, number, name, has_label: has_labels && dim > 1, cells });
        }
    }
    parts
}

fn by_label(mesh: &Mesh, dim: usize, labels: Option<&Labels>) -> Vec<(i32, Vec<usize>)> {
    let mut places: HashMap<i32, usize> = HashMap::new();
    let mut all: Vec<(i32, Vec<usize>)> = Vec::new();
    for (cell, _) in mesh.cells.kinds().iter().enumerate().filter(|(_, kind)| kind.dim() == Some(dim)) {
        let number = labels.map_or(0, |labels| labels.ids[cell]);
        let place = *places.entry(number).or_insert(all.len());
        if place == all.len() {
            all.push((number, Vec::new()));
        }
        all[place].1.push(cell);
    }
    all
}
