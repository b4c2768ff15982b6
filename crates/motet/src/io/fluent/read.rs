//! Reads points, faces, cells and the names of zones from sections of text and of bytes.

use super::content::{Content, HANGING_NODES, Numbered, hanging_nodes, span, two_dimensions};
use super::index;
use super::scan::{Numbers, Scan, Storage};
use crate::base::{Csr, Point, Result};
use crate::io::format::Input;
use crate::io::gzip;
use crate::io::latin::decode_utf8_or_latin1;
use crate::mesh::{CellKind, Mesh};

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
    let mut reader = Reader::default();
    while !scan.is_at_end() {
        scan.expect(b'(')?;
        let (index, storage) = scan.index()?;
        reader.section(&mut scan, index, storage)?;
    }
    reader.content.into_mesh()
}

/// What the sections have so far.
#[derive(Default)]
struct Reader {
    dim: Option<i64>,
    content: Content,
}

impl Reader {
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
            index::CELL_TREE | index::FACE_TREE => Err(hanging_nodes(scan.unsupported(HANGING_NODES))),
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
        let Some((_, first, n)) = self.range(scan, &header, Numbered::Points)? else {
            return scan.expect(b')');
        };
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
        self.content.add_points(first, points).map_err(|what| scan.error(what))
    }

    /// Reads zone, first and last number, type and type of cells; the body has the type of each cell, and in
    /// meshio's files the nodes of each cell instead.
    fn cells(&mut self, scan: &mut Scan<'_>, storage: Storage) -> Result<()> {
        let header = scan.header()?;
        let Some((id, first, n)) = self.range(scan, &header, Numbered::Cells)? else {
            return scan.expect(b')');
        };
        if !scan.opens() {
            self.content.add_zone(id, first, n);
            return scan.expect(b')');
        }
        let kind = header.get(4).copied().unwrap_or(0);
        if kind == 0 {
            scan.body(storage, |numbers| {
                numbers.check(n, 1, 4, "cells")?;
                (0..n).try_for_each(|_| numbers.int("type of a cell").map(drop))
            })?;
            self.content.add_zone(id, first, n);
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
        self.content.add_listed(cells);
        Ok(())
    }

    /// Reads zone, first and last number, type and type of faces. A row of the body has the points and the
    /// two cells of a face; their number comes first if faces may be of any type.
    fn faces(&mut self, scan: &mut Scan<'_>, storage: Storage) -> Result<()> {
        let header = scan.header()?;
        let Some((id, _, n)) = self.range(scan, &header, Numbered::Faces)? else { return scan.expect(b')') };
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
        for row in rows.iter() {
            let (ring, cells) = row.split_at(row.len() - 2);
            self.content
                .add_face(ring, [cells[0], cells[1]], id, zone_type)
                .map_err(|what| scan.error(what))?;
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
        self.content.add_name(id, name);
        scan.skip_brackets(2)
    }

    /// The zone, the first number and how many there are; `None` for an empty zone, and for zone 0, which
    /// declares how many all zones have.
    fn range(
        &mut self,
        scan: &Scan<'_>,
        header: &[i64],
        of: Numbered,
    ) -> Result<Option<(i32, usize, usize)>> {
        let [id, first, last, ..] = header else {
            return Err(scan.error(format!(
                "a section needs zone, first and last number, found {} numbers",
                header.len()
            )));
        };
        let id = i32::try_from(*id).map_err(|_| scan.error(format!("zone {id} needs more than 32 bits")))?;
        if id == 0 {
            self.content.declare(of, last.saturating_sub(*first).saturating_add(1));
            return Ok(None);
        }
        let span = span(*first, *last).map_err(|what| scan.error(format!("zone {id} {what}")))?;
        Ok(span.map(|(first, n)| {
            self.content.count(of, n);
            (id, first, n)
        }))
    }
}
