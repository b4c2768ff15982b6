//! The elements of a zone as cells: polyhedra are built from polygons, some of which are cells themselves.

use crate::base::{Csr, Result, VertexId};
use crate::io::cells_of_faces;
use crate::io::cgns::conditions::Members;
use crate::io::cgns::elements::{Body, Section};
use crate::io::cgns::zone::Zone;
use crate::mesh::{CellKind, Cells};

/// Marks an element without a cell.
pub(super) const NO_CELL: u32 = u32::MAX;

/// The cells made of the elements of a section.
pub(super) struct Span {
    pub(super) name: String,
    /// The number of the first element.
    pub(super) first: i64,
    /// The cell of each element, [`NO_CELL`] for elements that are not cells.
    pub(super) places: Vec<u32>,
}

impl Span {
    /// The number of the last element.
    pub(super) fn last(&self) -> i64 {
        self.first + self.places.len() as i64 - 1
    }

    /// The cells of those elements that have one.
    pub(super) fn cells(&self) -> impl Iterator<Item = usize> + '_ {
        self.places.iter().filter(|&&place| place != NO_CELL).map(|&place| place as usize)
    }

    /// The cell of an element of this section, if it has one.
    pub(super) fn cell(&self, number: i64) -> Option<usize> {
        let place = *self.places.get(usize::try_from(number - self.first).ok()?)?;
        (place != NO_CELL).then_some(place as usize)
    }
}

/// Appends the elements of a zone to `cells`; `first_point` points precede those of the zone.
pub(super) fn place(zone: &Zone, first_point: u32, cells: &mut Cells) -> Result<Vec<Span>> {
    let faces = Faces { zone };
    let mut node_budget = faces.node_budget();
    let mut spans = Vec::new();
    for (section, is_cell) in zone.sections.iter().zip(faces.are_cells()) {
        let mut places = Vec::with_capacity(section.len());
        let here = |cells: &Cells, is_cell: bool| if is_cell { cells.len() as u32 } else { NO_CELL };
        match &section.body {
            Body::Cells(kinds, nodes) => {
                for (kind, nodes) in kinds.iter().zip(nodes.iter()) {
                    places.push(here(cells, kind.is_some()));
                    kind.iter().for_each(|&kind| cells.push(kind, shifted(nodes, first_point)));
                }
            }
            Body::Faces(lists) => {
                for (nodes, is_cell) in lists.iter().zip(is_cell) {
                    places.push(here(cells, is_cell));
                    let message = || {
                        format!(
                            "section {}: a polygon has {} nodes, but at least 3 are needed",
                            section.name,
                            nodes.len()
                        )
                    };
                    let kind = polygon(nodes.len()).ok_or_else(|| zone.node.error(message()))?;
                    if is_cell {
                        cells.push(kind, shifted(nodes, first_point));
                    }
                }
            }
            Body::Polyhedra(lists) => {
                for list in lists.iter() {
                    places.push(here(cells, true));
                    cells_of_faces::push(cells, &faces.rings(list, first_point, &mut node_budget)?);
                }
            }
        }
        if cells.connectivity().items().len() > VertexId::MAX_COUNT {
            return Err(zone.node.error("more element nodes than a mesh can hold"));
        }
        spans.push(Span { name: section.name.clone(), first: section.first, places });
    }
    Ok(spans)
}

fn shifted(nodes: &[u32], first_point: u32) -> impl Iterator<Item = VertexId> + '_ {
    nodes.iter().map(move |&node| VertexId(node + first_point))
}

fn polygon(n_nodes: usize) -> Option<CellKind> {
    match n_nodes {
        0..3 => None,
        3 => Some(CellKind::TRIANGLE),
        4 => Some(CellKind::QUAD),
        _ => Some(CellKind::POLYGON),
    }
}

/// The polygons of a zone.
struct Faces<'a> {
    zone: &'a Zone,
}

impl Faces<'_> {
    /// For each section, which of its polygons are cells: all of them, or where polygons bound polyhedra,
    /// those in a boundary condition.
    fn are_cells(&self) -> Vec<Vec<bool>> {
        let sections = &self.zone.sections;
        let all = !sections.iter().any(|section| matches!(section.body, Body::Polyhedra(_)));
        let mut are_cells: Vec<Vec<bool>> = sections
            .iter()
            .map(|section| match &section.body {
                Body::Faces(lists) => vec![all; lists.len()],
                _ => Vec::new(),
            })
            .collect();
        for condition in &self.zone.conditions {
            let Members::Elements(numbers) = &condition.members else { continue };
            for (section, are_cells) in sections.iter().zip(&mut are_cells).filter(|(_, a)| !a.is_empty()) {
                let last = section.first + section.len() as i64 - 1;
                numbers
                    .within(section.first, last)
                    .for_each(|number| are_cells[(number - section.first) as usize] = true);
            }
        }
        are_cells
    }

    /// Upper bound on the nodes of the faces of all polyhedra together: at most two polyhedra share a face.
    fn node_budget(&self) -> usize {
        let items = |section: &Section| match &section.body {
            Body::Faces(lists) => lists.items().len(),
            _ => 0,
        };
        self.zone.sections.iter().map(items).sum::<usize>().saturating_mul(2)
    }

    /// The faces of a polyhedron, oriented outward. Subtracts their nodes from `node_budget`.
    fn rings(
        &self,
        numbers: &[i64],
        first_point: u32,
        node_budget: &mut usize,
    ) -> Result<Vec<Vec<VertexId>>> {
        if numbers.len() < 4 {
            return Err(self
                .zone
                .node
                .error(format!("a polyhedron has {} polygons, but at least 4 are needed", numbers.len())));
        }
        let mut rings = Vec::with_capacity(numbers.len());
        for &number in numbers {
            let nodes = self.face(number.saturating_abs()).ok_or_else(|| {
                self.zone
                    .node
                    .error(format!("a polyhedron refers to element {number}, which is not a polygon"))
            })?;
            *node_budget = node_budget
                .checked_sub(nodes.len())
                .ok_or_else(|| self.zone.node.error("polyhedra refer to polygons more than twice"))?;
            let mut ring: Vec<VertexId> = shifted(nodes, first_point).collect();
            if number < 0 {
                ring.reverse();
            }
            rings.push(ring);
        }
        Ok(rings)
    }

    fn face(&self, number: i64) -> Option<&[u32]> {
        let sections = &self.zone.sections;
        let at = sections.partition_point(|section| section.first <= number).checked_sub(1)?;
        let lists: &Csr<u32> = match &sections[at].body {
            Body::Faces(lists) => lists,
            _ => return None,
        };
        let place = usize::try_from(number - sections[at].first).ok().filter(|&p| p < lists.len())?;
        Some(lists.list(place)).filter(|nodes| nodes.len() >= 3)
    }
}
