//! Surfaces as cells: faces of volume cells, and existing surface cells.

use std::collections::{HashMap, HashSet};

use super::kinds::faces;
use super::line::Target;
use super::scope::SurfaceDefinition;
use super::sets::{Context, MAX_RUNS, no_set};
use crate::base::{Error, Result, VertexId};
use crate::io::facet_key::{FacetKey, facet_key};
use crate::io::format::Notes;
use crate::io::named_sets::{Runs, merged};
use crate::mesh::facets::facet_shapes;
use crate::mesh::{Boundary, CellKind, Cells, corners};

/// The facets of surfaces, as existing cells of the mesh or as cells appended to it.
pub(super) struct Facets<'m> {
    cells: &'m Cells,
    /// The faces S1, S2, ... of each kind.
    faces: HashMap<CellKind, Vec<usize>>,
    cell_of: HashMap<FacetKey, u32>,
    /// The boundary facets, those of one volume cell only; computed on first use.
    free: Option<HashSet<FacetKey>>,
    pub(super) added: Vec<(CellKind, Vec<VertexId>)>,
    n_runs: usize,
    notes: &'m Notes,
}

impl<'m> Facets<'m> {
    pub(super) fn new(cells: &'m Cells, notes: &'m Notes) -> Self {
        let mut cell_of = HashMap::new();
        for (cell, kind, vertices) in cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2)) {
            cell_of.entry(facet_key(corners(kind, vertices).iter().copied())).or_insert(cell.0);
        }
        Self { cells, faces: HashMap::new(), cell_of, free: None, added: Vec::new(), n_runs: 0, notes }
    }

    /// The cells of a surface.
    pub(super) fn surface(&mut self, surface: &SurfaceDefinition, around: &Context<'_>) -> Result<Runs> {
        let mut all = Runs::new();
        let mut known = HashSet::new();
        for (reference, face) in &surface.faces {
            let scope = around.scope(reference.instance.as_ref())?;
            let mut runs = Runs::new();
            match &reference.to {
                Target::Number(id) => match scope.elements.place(*id) {
                    Some(cell) => self.face(cell, face, &surface.label.shown, &mut runs)?,
                    None => self
                        .notes
                        .add(format!("surface {} refers to nonexistent elements", surface.label.shown)),
                },
                Target::Label(set) => {
                    if !known.insert((&reference.instance, &set.key, face)) {
                        continue;
                    }
                    let cells = scope.element_sets.find(&set.key).ok_or_else(|| no_set(&set.key))?;
                    for cell in cells.iter().cloned().flatten() {
                        self.face(cell, face, &surface.label.shown, &mut runs)?;
                    }
                }
            }
            runs = merged(runs);
            self.n_runs += runs.len();
            if self.n_runs > MAX_RUNS {
                return Err(
                    Error::input("surfaces repeat the same sets too often").remedy("write each surface once")
                );
            }
            all.append(&mut runs);
        }
        Ok(merged(all))
    }

    /// Adds the cells that stand for a face of a cell; for a solid without a face name, all its boundary
    /// facets.
    fn face(&mut self, cell: u32, face: &str, surface: &str, runs: &mut Runs) -> Result<()> {
        let kind = self.cells.kinds()[cell as usize];
        match (kind.dim(), face) {
            (Some(3), "") => {
                for place in 0..facet_shapes(kind).map_or(0, <[_]>::len) {
                    if self.is_free(cell, kind, place) {
                        runs.push(self.facet(cell, kind, place));
                    }
                }
            }
            (Some(3), _) => {
                let faces = self.faces.entry(kind).or_insert_with(|| faces(kind));
                let number = face.strip_prefix('S').and_then(|n| n.parse::<usize>().ok());
                let place = number.and_then(|n| faces.get(n.checked_sub(1)?).copied());
                let n = faces.len();
                let place = place.ok_or_else(|| {
                    Error::input(format!(
                        "surface {surface} refers to face `{face}` of a solid with faces S1 to S{n}"
                    ))
                    .remedy("the file is damaged: write it again")
                })?;
                runs.push(self.facet(cell, kind, place));
            }
            (Some(2), "" | "SPOS" | "SNEG" | "POS" | "NEG" | "P" | "N") => runs.push(cell..cell + 1),
            _ => self.notes.add(format!("surface {surface}: edges and ends are skipped, faces are kept")),
        }
        Ok(())
    }

    fn key(&self, cell: u32, kind: CellKind, place: usize) -> FacetKey {
        let vertices = self.cells.connectivity().list(cell as usize);
        let shape = facet_shapes(kind).and_then(|shapes| shapes.get(place));
        facet_key(shape.into_iter().flat_map(|s| s.corners()).map(|&i| vertices[usize::from(i)]))
    }

    fn is_free(&mut self, cell: u32, kind: CellKind, place: usize) -> bool {
        let key = self.key(cell, kind, place);
        let free = self.free.get_or_insert_with(|| {
            let boundary = Boundary::of(self.cells);
            let facets = boundary.kinds.iter().zip(boundary.facets.iter());
            facets.map(|(kind, vertices)| facet_key(corners(*kind, vertices).iter().copied())).collect()
        });
        free.contains(&key)
    }

    /// The surface cell on a facet, which is appended if there is none.
    fn facet(&mut self, cell: u32, kind: CellKind, place: usize) -> std::ops::Range<u32> {
        let next = (self.cells.len() + self.added.len()) as u32;
        let found = *self.cell_of.entry(self.key(cell, kind, place)).or_insert(next);
        if found == next
            && let Some(shape) = facet_shapes(kind).and_then(|shapes| shapes.get(place))
        {
            let vertices = self.cells.connectivity().list(cell as usize);
            self.added.push((shape.kind, shape.nodes.iter().map(|&i| vertices[usize::from(i)]).collect()));
        }
        found..found + 1
    }
}
