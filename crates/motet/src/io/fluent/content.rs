//! What both forms of a file have: points, faces with the cells on their sides, and zones. Makes them a mesh.

use std::collections::BTreeMap;

use super::INTERIOR;
use crate::base::{Csr, Error, Point, Result, VertexId};
use crate::io::cells_of_faces::{Sides, push_face};
use crate::mesh::{CellKind, Field, Mesh};

/// The type of a zone of faces that others divide.
const PARENTS: i64 = 31;

/// What a file numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbered {
    Points,
    Cells,
    Faces,
}

/// A zone of cells: its number, and the numbers of its first and last cell.
struct Zone {
    id: i32,
    first: usize,
    last: usize,
}

/// The content of a file, as a reader finds it.
#[derive(Default)]
pub(super) struct Content {
    /// Numbers of points, cells and faces that the file declares, and those that it has.
    declared: [i64; 3],
    found: [i64; 3],
    /// Points by the number of the first of each section.
    points: BTreeMap<usize, Vec<Point>>,
    zones: Vec<Zone>,
    names: BTreeMap<i32, String>,
    /// Faces of cells, as rings that run counter-clockwise seen from outside their owners. Vertices are the
    /// numbers of points in the file.
    faces: Csr<u32>,
    owners: Vec<i64>,
    neighbours: Vec<i64>,
    /// Faces that become surface cells, with their zones.
    surface: Csr<u32>,
    of_zone: Vec<i32>,
    /// Cells whose nodes are listed, with their zones.
    listed: Vec<(CellKind, Vec<u32>, i32)>,
}

impl Content {
    /// Says how many there must be.
    pub(super) fn declare(&mut self, of: Numbered, n: i64) {
        self.declared[of as usize] = n;
    }

    /// Counts what a section or zone has.
    pub(super) fn count(&mut self, of: Numbered, n: usize) {
        let found = &mut self.found[of as usize];
        *found = found.saturating_add(i64::try_from(n).unwrap_or(i64::MAX));
    }

    /// Adds the points of a section; an error if another one begins with the same number.
    pub(super) fn add_points(&mut self, first: usize, points: Vec<Point>) -> Result<(), String> {
        match self.points.insert(first, points) {
            None => Ok(()),
            Some(_) => Err(format!("two sections of points begin with number {first}")),
        }
    }

    /// Adds a zone of `n` cells, of which there is at least one.
    pub(super) fn add_zone(&mut self, id: i32, first: usize, n: usize) {
        self.zones.push(Zone { id, first, last: first + n - 1 });
    }

    /// Adds cells whose nodes are listed, with their zones.
    pub(super) fn add_listed(&mut self, cells: Vec<(CellKind, Vec<u32>, i32)>) {
        self.listed.extend(cells);
    }

    /// Adds the name of a zone.
    pub(super) fn add_name(&mut self, id: i32, name: String) {
        self.names.insert(id, name);
    }

    /// Adds a face of a zone: its points, so that it runs counter-clockwise seen from inside the first of its
    /// cells, and the numbers of both cells, 0 for none.
    pub(super) fn add_face(
        &mut self,
        ring: &[u32],
        cells: [u32; 2],
        zone: i32,
        zone_type: i64,
    ) -> Result<(), String> {
        if zone_type == PARENTS {
            return Ok(());
        }
        if ring.len() < 3 {
            return Err("a face has two points, as in two dimensions, which are not supported".into());
        }
        let [first, second] = cells.map(i64::from);
        let turned = ring.iter().rev().copied();
        let is_border = zone_type != INTERIOR;
        if second > 0 {
            self.faces.push(ring.iter().copied());
            self.owners.push(second - 1);
            self.neighbours.push(first - 1);
        } else if first > 0 {
            self.faces.push(turned.clone());
            self.owners.push(first - 1);
            self.neighbours.push(-1);
        }
        if is_border {
            if second == 0 && first > 0 {
                self.surface.push(turned)
            } else {
                self.surface.push(ring.iter().copied())
            }
            self.of_zone.push(zone);
        }
        Ok(())
    }

    /// Checks that all points, cells and faces that the file declares are there.
    fn check(&self) -> Result<()> {
        for ((declared, found), what) in
            self.declared.iter().zip(self.found).zip(["points", "cells", "faces"])
        {
            if found < *declared {
                return Err(Error::input(format!("{declared} {what} declared, but the file has {found}"))
                    .remedy("the file is truncated or damaged: get a new copy"));
            }
        }
        Ok(())
    }

    /// The mesh of all that was added.
    pub(super) fn into_mesh(mut self) -> Result<Mesh> {
        self.check()?;
        let (first, points) = joined(std::mem::take(&mut self.points))?;
        if self.faces.is_empty() && self.surface.is_empty() && self.listed.is_empty() {
            return Err(Error::input("there are no faces")
                .remedy("the file contains no mesh or is truncated: get a new copy"));
        }
        let n_points = points.len();
        let vertex =
            |&number: &u32| (number as usize).checked_sub(first).filter(|&v| v < n_points).map(|v| v as u32);
        let renumbered = |faces: &Csr<u32>| -> Result<Csr<u32>> {
            let mut new = Csr::default();
            for (i, face) in faces.iter().enumerate() {
                let ring = face.iter().map(vertex).collect::<Option<Vec<_>>>();
                new.push(ring.ok_or_else(|| missing_point(&format!("face {i}"), face, first, n_points))?);
            }
            Ok(new)
        };
        let sides = renumbered(&self.faces)?;
        let sides = Sides::new(&sides, &self.owners, &self.neighbours, n_points)?;
        let mut mesh = Mesh::new(points, sides.cells());
        let mut regions = vec![0; mesh.cells.len()];
        if self.zones.iter().map(|zone| zone.last - zone.first + 1).sum::<usize>() > regions.len() {
            return Err(Error::input(format!(
                "zones have more than the {} cells that faces refer to",
                regions.len()
            ))
            .remedy("the file is truncated or damaged: get a new copy"));
        }
        for zone in &self.zones {
            label_zone(zone, &mut regions)?;
        }
        let mut patches = vec![0; mesh.cells.len()];
        for (face, &zone) in renumbered(&self.surface)?.iter().zip(&self.of_zone) {
            push_face(&mut mesh.cells, face);
            patches.push(zone);
        }
        regions.resize(mesh.cells.len(), 0);
        for (i, (kind, nodes, zone)) in self.listed.iter().enumerate() {
            let vertices = nodes.iter().map(vertex).collect::<Option<Vec<_>>>();
            let vertices =
                vertices.ok_or_else(|| missing_point(&format!("cell {i}"), nodes, first, n_points))?;
            mesh.cells.push(*kind, vertices.into_iter().map(VertexId));
            let is_volume = kind.dim() == Some(3);
            regions.push(if is_volume { *zone } else { 0 });
            patches.push(if is_volume { 0 } else { *zone });
        }
        for (array, labels, names) in [
            ("region", regions, &mut mesh.label_names.regions),
            ("patch", patches, &mut mesh.label_names.patches),
        ] {
            let used = |id: &i32| labels.contains(id);
            names.extend(
                self.names
                    .iter()
                    .filter(|(id, _)| **id != 0 && used(id))
                    .map(|(&id, name)| (id, name.clone())),
            );
            if labels.iter().any(|&label| label != 0) {
                mesh.cell_data.push(Field::scalars(array, labels));
            }
        }
        Ok(mesh)
    }
}

fn label_zone(zone: &Zone, regions: &mut [i32]) -> Result<()> {
    let n = regions.len();
    let cells = zone.first.checked_sub(1).and_then(|first| regions.get_mut(first..zone.last));
    cells.map(|cells| cells.fill(zone.id)).ok_or_else(|| {
        Error::input(format!(
            "zone {} has cells {} to {}, but faces refer to cells up to {n}",
            zone.id, zone.first, zone.last
        ))
        .remedy("the file is truncated or damaged: get a new copy")
    })
}

/// The first number from `first` to `last` and how many there are; `None` for an empty range, which ends
/// before it begins. The error continues a sentence.
pub(super) fn span(first: i64, last: i64) -> Result<Option<(usize, usize)>, String> {
    let (Ok(from), Ok(to)) = (usize::try_from(first), usize::try_from(last)) else {
        return Err(format!("has negative numbers: {first} to {last}"));
    };
    match to.checked_add(1).and_then(|end| end.checked_sub(from)) {
        Some(0) => Ok(None),
        Some(n) if to < u32::MAX as usize => Ok(Some((from, n))),
        _ => Err(format!("has numbers {first} to {last}")),
    }
}

/// Says what to do with a file of two dimensions.
pub(super) fn two_dimensions(error: Error) -> Error {
    error.remedy("open it in ParaView and save the data as .vtu")
}

/// What a mesh with hanging nodes is refused with.
pub(super) const HANGING_NODES: &str = "the mesh was refined and has hanging nodes, which are not supported";

/// Says what to do with a mesh that has hanging nodes.
pub(super) fn hanging_nodes(error: Error) -> Error {
    error.remedy("convert it to polyhedra in Fluent: mesh/polyhedra/convert-hanging-nodes")
}

fn missing_point(what: &str, numbers: &[u32], first: usize, n: usize) -> Error {
    let missing = numbers.iter().find(|&&number| !(first..first + n).contains(&(number as usize)));
    let missing = missing.copied().unwrap_or_default();
    Error::input(format!("refers to point {missing}, but there are {n} points, numbered from {first}"))
        .at(what)
        .remedy("the file is truncated or damaged: get a new copy")
}

/// All points, and the number of the first.
fn joined(sections: BTreeMap<usize, Vec<Point>>) -> Result<(usize, Vec<Point>)> {
    let first = *sections.keys().next().ok_or_else(|| {
        Error::input("there are no points")
            .remedy("the file contains no mesh or is truncated: get a new copy")
    })?;
    let mut points: Vec<Point> = Vec::new();
    for (start, section) in sections {
        if start != first + points.len() {
            return Err(Error::input(format!(
                "points {} are expected to follow, found {start}",
                first + points.len()
            ))
            .remedy("the file is truncated or damaged: get a new copy"));
        }
        points.extend(section);
    }
    if points.len() > VertexId::MAX_COUNT {
        return Err(Error::input("more points than a mesh can hold"));
    }
    Ok((first, points))
}
