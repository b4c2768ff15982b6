//! Regions and patches: from boundary conditions, and for cells without a condition, from families, zones and
//! sections.

use std::collections::{BTreeSet, HashMap};

use crate::base::VertexId;
use crate::io::cgns::cells::Span;
use crate::io::cgns::conditions::{Condition, Members, Numbers};
use crate::io::cgns::families::{Families, Family};
use crate::io::cgns::names::default_name;
use crate::io::format::Notes;
use crate::mesh::{CellKind, Field, Mesh};

/// The parts of a zone that give labels to its cells.
pub(super) struct LabelSources<'a> {
    pub(super) zone: &'a str,
    pub(super) family: Option<&'a str>,
    pub(super) conditions: &'a [Condition],
    pub(super) spans: &'a [Span],
    /// The number of points before those of this zone, and the number of its points.
    pub(super) points: (usize, usize),
}

/// Marks a cell without a label.
const NONE: u32 = u32::MAX;

/// Labels of the cells of one dimension.
struct Labels {
    dim: usize,
    /// Whether cells of this dimension fill the zones, rather than bound them.
    fills: bool,
    of_cells: Vec<u32>,
    families: Vec<Family>,
    by_name: HashMap<String, u32>,
}

/// Labels the cells of a mesh that was joined from zones.
pub(super) fn set_labels(
    mesh: &mut Mesh,
    zones: &[LabelSources<'_>],
    families: &Families,
    cell_dim: usize,
    notes: &Notes,
) {
    for (dim, array) in [(2, "patch"), (3, "region")] {
        let mut labels = Labels {
            dim,
            fills: dim == cell_dim,
            of_cells: vec![NONE; mesh.cells.len()],
            families: Vec::new(),
            by_name: HashMap::new(),
        };
        for zone in zones {
            for condition in zone.conditions {
                labels.take_condition(mesh, zone, condition, families, notes);
            }
            labels.label_by_section(mesh, zone, zones.len() > 1, families);
        }
        labels.store(mesh, array);
    }
}

impl Labels {
    fn label(&mut self, family: Family) -> u32 {
        let next = self.families.len() as u32;
        let label = *self.by_name.entry(family.name.clone()).or_insert(next);
        if label == next {
            self.families.push(family);
        }
        label
    }

    /// Whether a cell has the dimension of these labels.
    fn has_dim(&self, mesh: &Mesh, cell: usize) -> bool {
        mesh.cells.kinds()[cell].dim() == Some(self.dim)
    }

    fn take_condition(
        &mut self,
        mesh: &Mesh,
        zone: &LabelSources<'_>,
        condition: &Condition,
        families: &Families,
        notes: &Notes,
    ) {
        let cells: Vec<usize> = match &condition.members {
            Members::Elements(numbers) => {
                let of = |span: &Span| -> Vec<usize> {
                    numbers.within(span.first, span.last()).filter_map(|number| span.cell(number)).collect()
                };
                zone.spans.iter().flat_map(of).filter(|&cell| self.has_dim(mesh, cell)).collect()
            }
            // Points only identify a surface.
            Members::Points(_) if self.dim == 3 => return,
            Members::Points(numbers) => {
                let cells = self.on_points(mesh, zone, numbers);
                if cells.is_empty() && self.dim == 2 {
                    notes.add(format!(
                        "boundary condition {} is skipped: no surface cells lie on its points",
                        condition.name
                    ));
                }
                cells
            }
        };
        if cells.is_empty() {
            return;
        }
        let family = families.named(condition.family.as_ref().unwrap_or(&condition.name));
        let label = self.label(family);
        for cell in cells {
            match &mut self.of_cells[cell] {
                free if *free == NONE => *free = label,
                other if *other == label => {}
                _ => notes.add("for cells in several boundary conditions, only the first is used"),
            }
        }
    }

    /// The unlabelled cells of this dimension all of whose vertices are among the given points.
    fn on_points(&self, mesh: &Mesh, zone: &LabelSources<'_>, numbers: &Numbers) -> Vec<usize> {
        let (shift, n) = zone.points;
        let mut is_named = vec![false; n];
        numbers.within(1, n as i64).for_each(|number| is_named[number as usize - 1] = true);
        let is_on_patch = |v: &VertexId| is_named[v.index() - shift];
        let cells = zone.spans.iter().flat_map(Span::cells).filter(|&cell| self.has_dim(mesh, cell));
        cells
            .filter(|&cell| {
                self.of_cells[cell] == NONE && mesh.cells.connectivity().list(cell).iter().all(is_on_patch)
            })
            .collect()
    }

    /// Labels the cells of sections that no condition touches.
    fn label_by_section(
        &mut self,
        mesh: &Mesh,
        zone: &LabelSources<'_>,
        are_several: bool,
        families: &Families,
    ) {
        let ours = |span: &Span| -> Vec<usize> {
            span.cells().filter(|&cell| mesh.cells.kinds()[cell].dim() == Some(self.dim)).collect()
        };
        let spans: Vec<(&Span, Vec<usize>)> =
            zone.spans.iter().map(|span| (span, ours(span))).filter(|(_, cells)| !cells.is_empty()).collect();
        let of_zone = zone.family.map(|name| families.named(name));
        let of_zone = of_zone.or_else(|| are_several.then(|| families.named(zone.zone)));
        let by_section = if self.fills { spans.len() > 1 && !sections_are_kinds(mesh, &spans) } else { true };
        for (span, cells) in spans {
            if cells.iter().any(|&cell| self.of_cells[cell] != NONE) {
                continue;
            }
            let of_section = || by_section.then(|| Family { name: span.name.clone(), number: None });
            let family = match families.get(&span.name) {
                Some(family) => Some(family.clone()),
                None if self.fills => of_zone.clone().or_else(of_section),
                None => of_section(),
            };
            let Some(family) = family else { continue };
            let label = self.label(family);
            cells.into_iter().for_each(|cell| self.of_cells[cell] = label);
        }
    }

    /// Stores the labels in the mesh, if there are any.
    fn store(self, mesh: &mut Mesh, array: &str) {
        if self.families.is_empty() {
            return;
        }
        let mut taken = BTreeSet::from([0]);
        let given: Vec<Option<i32>> = self
            .families
            .iter()
            .map(|family| family.number.filter(|&number| number == 0 || taken.insert(number)))
            .collect();
        let mut free = (1..).filter(|number| !taken.contains(number));
        let numbers: Vec<i32> =
            given.into_iter().map(|number| number.or_else(|| free.next()).unwrap_or_default()).collect();
        let names = if self.dim == 3 { &mut mesh.label_names.regions } else { &mut mesh.label_names.patches };
        for (family, &number) in self.families.iter().zip(&numbers) {
            if number != 0 && family.name != default_name(self.dim, number) {
                names.insert(number, family.name.clone());
            }
        }
        let number = |&label: &u32| numbers.get(label as usize).copied().unwrap_or(0);
        let ids: Vec<i32> = self.of_cells.iter().map(number).collect();
        if ids.iter().any(|&id| id != 0) {
            mesh.set_cell_field(Field::scalars(array, ids));
        }
    }
}

/// Whether each section holds a single kind of cells, different from those of the others; such sections carry
/// no label information.
fn sections_are_kinds(mesh: &Mesh, spans: &[(&Span, Vec<usize>)]) -> bool {
    let mut seen: Vec<CellKind> = Vec::new();
    spans.iter().all(|(_, cells)| {
        let kind = mesh.cells.kinds()[cells[0]];
        let is_new = !seen.contains(&kind);
        seen.push(kind);
        is_new && cells.iter().all(|&cell| mesh.cells.kinds()[cell] == kind)
    })
}
