//! Reads points, faces, cells and the names of zones.

use std::collections::BTreeMap;

use super::scan::{Numbers, Scan, Storage};
use super::{INTERIOR, index};
use crate::base::{Csr, Error, Point, Result, VertexId};
use crate::io::cells_of_faces::{Sides, push_face};
use crate::io::format::Input;
use crate::io::gzip;
use crate::io::latin::decode_utf8_or_latin1;
use crate::mesh::{CellKind, Field, Mesh};

/// The type of a zone of faces that others divide.
const PARENTS: i64 = 31;

/// The cells of each type from 1 on in files that list the nodes of cells.
const KINDS: [CellKind; 6] = [
    CellKind::TRIANGLE,
    CellKind::TETRA,
    CellKind::QUAD,
    CellKind::HEXAHEDRON,
    CellKind::PYRAMID,
    CellKind::WEDGE,
];

pub(in crate::io) fn read(input: &Input<'_>) -> Result<Mesh> {
    if gzip::is_gzip(input.bytes) {
        return read_sections(&gzip::decompress(input.bytes)?);
    }
    read_sections(input.bytes)
}

fn read_sections(bytes: &[u8]) -> Result<Mesh> {
    let mut scan = Scan::new(bytes);
    let mut content = Content::default();
    while !scan.is_at_end() {
        scan.expect(b'(')?;
        let (index, storage) = scan.index()?;
        content.section(&mut scan, index, storage)?;
    }
    content.into_mesh()
}

/// A zone of cells: its number, and the numbers of its first and last cell.
struct Zone {
    id: i32,
    first: usize,
    last: usize,
}

#[derive(Default)]
struct Content {
    dim: Option<i64>,
    /// Numbers of points, cells and faces that zone 0 declares, and those that other zones have.
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
    fn section(&mut self, scan: &mut Scan<'_>, index: u32, storage: Storage) -> Result<()> {
        match index {
            index::DIMENSION if storage == Storage::Text => {
                self.set_dim(scan)?;
                scan.expect(b')')
            }
            index::NODES => self.nodes(scan, storage),
            index::CELLS => self.cells(scan, storage),
            index::FACES => self.faces(scan, storage),
            index::ZONE | index::ZONE_OF_MESHERS if storage == Storage::Text => self.name(scan),
            index::CELL_TREE | index::FACE_TREE => Err(scan
                .unsupported("the mesh was refined and has hanging nodes, which are not supported")
                .remedy("convert it to polyhedra in Fluent: mesh/polyhedra/convert-hanging-nodes")),
            _ => scan.skip_section(storage),
        }
    }

    fn set_dim(&mut self, scan: &mut Scan<'_>) -> Result<()> {
        match scan.decimal("dimension")? {
            2 => {
                Err(two_dimensions(scan.unsupported("the mesh has two dimensions, which are not supported")))
            }
            3 => {
                self.dim = Some(3);
                Ok(())
            }
            other => Err(scan.error(format!("expected dimension 3, found {other}"))),
        }
    }

    /// Reads zone, first and last number, type and dimension; the body has the coordinates.
    fn nodes(&mut self, scan: &mut Scan<'_>, storage: Storage) -> Result<()> {
        let header = scan.header()?;
        let dim = header.get(4).copied().filter(|&dim| dim != 0).or(self.dim).unwrap_or(3);
        if dim == 2 {
            return Err(two_dimensions(
                scan.unsupported("the points have two dimensions, which are not supported"),
            ));
        }
        let Some((_, first, n)) = self.range(scan, &header, 0)? else { return scan.expect(b')') };
        let points = scan.body(storage, |numbers| {
            let size = if storage == Storage::Single { 4 } else { 8 };
            numbers.check(n, 3, size, "points")?;
            let point = |numbers: &mut Numbers<'_, '_>| -> Result<Point> {
                Ok([
                    numbers.float("coordinate x")?,
                    numbers.float("coordinate y")?,
                    numbers.float("coordinate z")?,
                ])
            };
            (0..n).map(|_| point(numbers)).collect::<Result<Vec<_>>>()
        })?;
        match self.points.insert(first, points) {
            None => Ok(()),
            Some(_) => Err(scan.error(format!("two sections of points begin with number {first}"))),
        }
    }

    /// Reads zone, first and last number, type and type of cells; the body has the type of each cell, and in
    /// meshio's files the nodes of each cell instead.
    fn cells(&mut self, scan: &mut Scan<'_>, storage: Storage) -> Result<()> {
        let header = scan.header()?;
        let Some((id, first, n)) = self.range(scan, &header, 1)? else { return scan.expect(b')') };
        if !scan.opens() {
            self.zones.push(Zone { id, first, last: first + n - 1 });
            return scan.expect(b')');
        }
        let kind = header.get(4).copied().unwrap_or(0);
        if kind == 0 {
            scan.body(storage, |numbers| {
                numbers.check(n, 1, 4, "cells")?;
                (0..n).try_for_each(|_| numbers.int("type of a cell").map(drop))
            })?;
            self.zones.push(Zone { id, first, last: first + n - 1 });
            return Ok(());
        }
        let known = usize::try_from(kind).ok().and_then(|kind| KINDS.get(kind.checked_sub(1)?));
        let &kind =
            known.ok_or_else(|| scan.error(format!("expected a type of cells from 0 to 6, found {kind}")))?;
        let n_nodes = kind.n_vertices().unwrap_or(0);
        let cells = scan.body(storage, |numbers| {
            let size = if storage == Storage::Double { 8 } else { 4 };
            numbers.check(n, n_nodes, size, "cells")?;
            let node = |numbers: &mut Numbers<'_, '_>| {
                let node = numbers.wide_int("node of a cell")?;
                u32::try_from(node).map_err(|_| numbers.error(format!("a cell refers to node {node}")))
            };
            let cell = |numbers: &mut Numbers<'_, '_>| {
                (0..n_nodes).map(|_| node(numbers)).collect::<Result<Vec<_>>>()
            };
            (0..n).map(|_| Ok((kind, cell(numbers)?, id))).collect::<Result<Vec<_>>>()
        })?;
        self.listed.extend(cells);
        Ok(())
    }

    /// Reads zone, first and last number, type and type of faces. A row of the body has the points and the
    /// two cells of a face; their number comes first if faces may be of any type.
    fn faces(&mut self, scan: &mut Scan<'_>, storage: Storage) -> Result<()> {
        let header = scan.header()?;
        let Some((id, _, n)) = self.range(scan, &header, 2)? else { return scan.expect(b')') };
        let zone_type = header.get(3).copied().unwrap_or(0);
        let each = match header.get(4).copied().unwrap_or(0) {
            0 | 5 => None,
            2 => {
                return Err(two_dimensions(
                    scan.unsupported("faces have two points, as in two dimensions, which are not supported"),
                ));
            }
            n @ 3..=4 => Some(n as usize),
            other => return Err(scan.error(format!("expected a type of faces 0, 3, 4 or 5, found {other}"))),
        };
        let rows = scan.body(storage, |numbers| {
            numbers.check(n, each.unwrap_or(4) + 2, 4, "faces")?;
            let mut rows: Csr<u32> = Csr::default();
            for _ in 0..n {
                let n_points = match each {
                    Some(n_points) => n_points,
                    None => {
                        let n_points = numbers.int("number of points of a face")?;
                        let n_points = usize::try_from(n_points).ok().filter(|&n_points| n_points >= 2);
                        n_points.ok_or_else(|| numbers.error("a face has fewer than two points"))?
                    }
                };
                numbers.check(1, n_points.saturating_add(2), 4, "faces")?;
                let row = (0..n_points + 2).map(|_| {
                    let number = numbers.int("point or cell of a face")?;
                    u32::try_from(number)
                        .map_err(|_| numbers.error(format!("a face has a point or cell {number}")))
                });
                rows.push(row.collect::<Result<Vec<_>>>()?);
            }
            Ok(rows)
        })?;
        if zone_type == PARENTS {
            return Ok(());
        }
        for row in rows.iter() {
            self.face(row, id, zone_type).map_err(|what| scan.error(what))?;
        }
        Ok(())
    }

    fn face(&mut self, row: &[u32], zone: i32, zone_type: i64) -> Result<(), String> {
        let (ring, cells) = row.split_at(row.len() - 2);
        if ring.len() < 3 {
            return Err("a face has two points, as in two dimensions, which are not supported".into());
        }
        let [first, second] = [cells[0], cells[1]].map(i64::from);
        let turned = ring.iter().rev().copied();
        let is_border = zone_type != INTERIOR;
        // The ring runs counter-clockwise seen from inside the first cell.
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

    /// Reads the number, type and name of a zone; what follows are its settings.
    fn name(&mut self, scan: &mut Scan<'_>) -> Result<()> {
        scan.expect(b'(')?;
        let id = scan.decimal("number of a zone")?;
        scan.word("type of a zone")?;
        let name = decode_utf8_or_latin1(scan.word("name of a zone")?);
        let id = i32::try_from(id).map_err(|_| scan.error(format!("zone {id} needs more than 32 bits")))?;
        self.names.insert(id, name);
        scan.skip_brackets(2)
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

    fn into_mesh(mut self) -> Result<Mesh> {
        self.check()?;
        let (first, points) = joined(std::mem::take(&mut self.points))?;
        if self.faces.is_empty() && self.surface.is_empty() && self.listed.is_empty() {
            return Err(Error::input("there are no faces (section 13)")
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

    /// The zone, the first number and how many there are; `None` for an empty zone, and for zone 0, which
    /// declares how many all zones have.
    fn range(&mut self, scan: &Scan<'_>, header: &[i64], what: usize) -> Result<Option<(i32, usize, usize)>> {
        let [id, first, last, ..] = header else {
            return Err(scan.error(format!(
                "a section needs zone, first and last number, found {} numbers",
                header.len()
            )));
        };
        let id = i32::try_from(*id).map_err(|_| scan.error(format!("zone {id} needs more than 32 bits")))?;
        if id == 0 {
            self.declared[what] = last.saturating_sub(*first).saturating_add(1);
            return Ok(None);
        }
        let (Ok(first), Ok(last)) = (usize::try_from(*first), usize::try_from(*last)) else {
            return Err(scan.error(format!("zone {id} has negative numbers: {first} to {last}")));
        };
        match (last + 1).checked_sub(first) {
            // An empty zone ends before it begins.
            Some(0) => Ok(None),
            Some(n) if last < u32::MAX as usize => {
                self.found[what] += n as i64;
                Ok(Some((id, first, n)))
            }
            _ => Err(scan.error(format!("zone {id} has numbers {first} to {last}"))),
        }
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

fn two_dimensions(error: Error) -> Error {
    error.remedy("open it in ParaView and save the data as .vtu")
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
        Error::input("there are no points (section 10)")
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
