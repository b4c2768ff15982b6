//! STL surfaces, text and binary. Equal points are merged; several solids become patches.
//!
//! Implemented here because `stl_io` (0.11) merges points in its own way, keeps neither the
//! names of solids nor the attribute bytes, mistakes a binary file that begins with `solid` for text, and
//! reads text in single precision only.
//!
//! Binary files are recognized by their length: a binary file of n triangles has 84 + 50 n bytes, whatever
//! its header, possibly followed after each triangle by as many bytes as its attribute states. Points are
//! merged if all three coordinates are equal (0 and -0 are). Normals are not kept: they follow from the
//! points. Attribute bytes become the cell array `attribute` unless all are 0.

use std::collections::HashMap;
use std::io::Write as _;

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector;
use crate::io::format::{Encoding, Format, Input, Write, WriteOptions};
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays, surface_of};
use crate::io::text::{Text, push_floats, quoted};
use crate::mesh::{CellKind, Cells, Field, Mesh};

pub(super) const FORMAT: Format =
    Format { name: "STL", extensions: &[".stl"], read: Some(read), write: Some(Write::File(write)) };

/// Size of the header and the number of triangles.
const HEAD_BYTES: usize = 84;
/// Size of the normal, three points and the attribute.
const TRIANGLE_BYTES: usize = 50;
/// The word `normal` and three numbers.
const MAX_NORMAL_WORDS: usize = 4;

fn read(input: &Input<'_>) -> Result<Mesh> {
    let bytes = input.bytes;
    if let Some(triangles) = triangles_with_payload(bytes) {
        input.notes.add("additional data after the triangles are skipped");
        let mut mesh = binary(triangles.into_iter())?;
        // These attributes were byte counts.
        mesh.cell_data.clear();
        return Ok(mesh);
    }
    let mesh = match (binary_body(bytes), bytes.trim_ascii_start().get(..5)) {
        (Some((triangles, [])), _) => binary(triangles.chunks_exact(TRIANGLE_BYTES))?,
        (_, Some(word)) if word.eq_ignore_ascii_case(b"solid") => ascii(bytes)?,
        (Some((triangles, after)), _) => {
            // A nonzero attribute may be the count of bytes after its triangle, so these are not consecutive
            // triangles.
            if triangles.chunks_exact(TRIANGLE_BYTES).any(|t| t[TRIANGLE_BYTES - 2..] != [0, 0]) {
                return Err(not_stl(bytes));
            }
            input.notes.add(format!("{} bytes after the last triangle are skipped", after.len()));
            binary(triangles.chunks_exact(TRIANGLE_BYTES))?
        }
        (None, _) => return Err(not_stl(bytes)),
    };
    if mesh.cells.is_empty() {
        return Err(Error::input("the surface has no triangles").remedy("export the surface again"));
    }
    Ok(mesh)
}

/// The triangles of a binary file, and the bytes after them; `None` if the file is too short for the declared
/// number of triangles.
fn binary_body(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let n = u32::from_le_bytes(*bytes.get(80..)?.first_chunk()?);
    bytes[HEAD_BYTES..].split_at_checked(n as usize * TRIANGLE_BYTES)
}

/// The triangles of a binary file whose attributes state how many bytes follow each triangle; `None` unless
/// these fill the file exactly.
fn triangles_with_payload(bytes: &[u8]) -> Option<Vec<&[u8]>> {
    let n = u32::from_le_bytes(*bytes.get(80..)?.first_chunk()?) as usize;
    let mut rest = &bytes[HEAD_BYTES..];
    if n == 0 || n > rest.len() / TRIANGLE_BYTES || n * TRIANGLE_BYTES == rest.len() {
        return None;
    }
    let mut triangles = Vec::with_capacity(n);
    for _ in 0..n {
        let (triangle, after) = rest.split_at_checked(TRIANGLE_BYTES)?;
        let size = u16::from_le_bytes([triangle[TRIANGLE_BYTES - 2], triangle[TRIANGLE_BYTES - 1]]);
        rest = after.get(usize::from(size)..)?;
        triangles.push(triangle);
    }
    rest.is_empty().then_some(triangles)
}

fn not_stl(bytes: &[u8]) -> Error {
    let error = match bytes.get(80..).and_then(|b| b.first_chunk()) {
        Some(n) => Error::input(format!(
            "a binary STL file with {} triangles has {} bytes, but this file has {}",
            u32::from_le_bytes(*n),
            HEAD_BYTES as u64 + u64::from(u32::from_le_bytes(*n)) * TRIANGLE_BYTES as u64,
            bytes.len()
        ))
        .at("byte 80"),
        None => Error::input(format!(
            "expected text that starts with `solid`, or a binary header of {HEAD_BYTES} bytes, found {}",
            quoted(bytes.get(..20).unwrap_or(bytes))
        ))
        .at("byte 0"),
    };
    error.remedy("the file is truncated, damaged or not an STL file: get a new copy")
}

/// Triangles whose corners are merged into vertices.
#[derive(Default)]
struct Merged {
    places: HashMap<[u64; 3], VertexId>,
    points: Vec<Point>,
    triangles: Vec<VertexId>,
}

impl Merged {
    fn corner(&mut self, point: Point) {
        // Adding 0 turns -0 into 0.
        let key = point.map(|x| (x + 0.0).to_bits());
        let next = VertexId::new(self.points.len());
        let vertex = *self.places.entry(key).or_insert(next);
        if vertex == next {
            self.points.push(point);
        }
        self.triangles.push(vertex);
    }

    fn into_mesh(self) -> Result<Mesh> {
        Ok(Mesh::new(self.points, Cells::uniform(CellKind::TRIANGLE, self.triangles)?))
    }
}

fn binary<'a>(triangles: impl ExactSizeIterator<Item = &'a [u8]>) -> Result<Mesh> {
    let mut merged = Merged::default();
    let mut attributes = Vec::with_capacity(triangles.len());
    for triangle in triangles {
        let (floats, attribute) = triangle.split_at(TRIANGLE_BYTES - 2);
        let (numbers, _) = floats.as_chunks::<4>();
        for corner in numbers[3..].chunks_exact(3) {
            merged.corner([0, 1, 2].map(|i| f64::from(f32::from_le_bytes(corner[i]))));
        }
        attributes.push(u16::from_le_bytes([attribute[0], attribute[1]]));
    }
    let mut mesh = merged.into_mesh()?;
    if attributes.iter().any(|&a| a != 0) {
        mesh.set_cell_field(Field::scalars("attribute", attributes));
    }
    Ok(mesh)
}

fn ascii(bytes: &[u8]) -> Result<Mesh> {
    let mut text = Text::new(bytes);
    let mut merged = Merged::default();
    let mut solids: Vec<String> = Vec::new();
    let mut solid_of_triangle: Vec<i32> = Vec::new();
    while let Some(word) = text.word() {
        if !word.eq_ignore_ascii_case(b"solid") {
            return Err(text
                .unexpected("solid", "`solid`", word)
                .remedy("the file is damaged: get a new copy"));
        }
        let name = String::from_utf8_lossy(text.line().unwrap_or_default()).trim().to_owned();
        let known = solids.iter().position(|solid| *solid == name && !name.is_empty());
        let solid = known.unwrap_or(solids.len());
        if known.is_none() {
            solids.push(name);
        }
        while facet(&mut text, &mut merged)? {
            solid_of_triangle.push(solid as i32 + 1);
        }
    }
    let mut mesh = merged.into_mesh()?;
    if solids.len() > 1 {
        mesh.set_cell_field(Field::scalars("patch", solid_of_triangle));
        let named = (1..).zip(solids).filter(|(_, name)| !name.is_empty());
        mesh.label_names.patches = named.collect();
    }
    Ok(mesh)
}

/// Reads `facet ... endfacet`; returns false at `endsolid`.
fn facet(text: &mut Text<'_>, merged: &mut Merged) -> Result<bool> {
    let word = text.expect("`facet` or `endsolid`")?;
    if word.eq_ignore_ascii_case(b"endsolid") {
        text.line();
        return Ok(false);
    }
    if !word.eq_ignore_ascii_case(b"facet") {
        return Err(text.unexpected("triangle", "`facet` or `endsolid`", word));
    }
    // The normal follows from the points, and not all programs write it as numbers.
    for _ in 0..=MAX_NORMAL_WORDS {
        if text.peek().is_some_and(|word| word.eq_ignore_ascii_case(b"outer")) {
            break;
        }
        text.word();
    }
    words(text, &["outer", "loop"])?;
    for _ in 0..3 {
        words(text, &["vertex"])?;
        merged.corner(text.point()?);
    }
    words(text, &["endloop", "endfacet"])?;
    Ok(true)
}

fn words(text: &mut Text<'_>, expected: &[&str]) -> Result<()> {
    for word in expected {
        let found = text.expect(&format!("`{word}`"))?;
        if !found.eq_ignore_ascii_case(word.as_bytes()) {
            return Err(text.unexpected("triangle", &format!("`{word}`"), found));
        }
    }
    Ok(())
}

fn write(mesh: &Mesh, options: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (surface, boundary_only) = surface_of(mesh, "STL");
    let (mesh, mut lost) = keep_cells(&surface, "STL", |kind| fan(kind).is_some());
    lost.extend(boundary_only);
    let triangles = triangles(&mesh, &mut lost);
    lost.extend(lost_arrays("STL", "point", &mesh.point_data));
    let binary = options.encoding != Encoding::Ascii;
    let kept = |f: &&Field| (!binary && f.name == "patch") || (binary && f.name == "attribute");
    lost.extend(lost_arrays("STL", "cell", mesh.cell_data.iter().filter(|f| !kept(f))));
    lost.extend(lost_arrays("STL", "field", &mesh.field_data));
    let bytes =
        if binary { write_binary(&mesh, &triangles, &mut lost)? } else { write_ascii(&mesh, &triangles) };
    write_all(output, &bytes)?;
    Ok(lost)
}

/// Whether cells of this kind are split into triangles around their first vertex, and into how many if that
/// is fixed.
fn fan(kind: CellKind) -> Option<Option<usize>> {
    match kind {
        CellKind::TRIANGLE => Some(Some(1)),
        CellKind::QUAD => Some(Some(2)),
        CellKind::POLYGON => Some(None),
        _ => None,
    }
}

/// A triangle of the surface, and the cell that it comes from.
type Triangle = ([VertexId; 3], usize);

fn triangles(mesh: &Mesh, lost: &mut Vec<String>) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    let mut n_split = 0;
    for (cell, _, v) in mesh.cells.iter() {
        n_split += usize::from(v.len() > 3);
        for i in 2..v.len() {
            triangles.push(([v[0], v[i - 1], v[i]], cell.index()));
        }
    }
    if n_split > 0 {
        lost.push(format!("{n_split} quads and polygons are split into triangles"));
    }
    triangles
}

fn corners(mesh: &Mesh, triangle: &Triangle) -> [Point; 3] {
    triangle.0.map(|v| mesh.points[v.index()])
}

/// The unit normal; zero for a degenerate triangle, as readers expect.
fn normal([a, b, c]: [Point; 3]) -> Point {
    let n = vector::cross(vector::sub(b, a), vector::sub(c, a));
    let length = vector::dot(n, n).sqrt();
    if length.is_normal() { n.map(|x| x / length) } else { [0.0; 3] }
}

fn write_binary(mesh: &Mesh, triangles: &[Triangle], lost: &mut Vec<String>) -> Result<Vec<u8>> {
    let n = u32::try_from(triangles.len()).map_err(|_| {
        Error::input(format!("{} triangles are more than a binary STL file can hold", triangles.len()))
    })?;
    let attributes = mesh.cell_field("attribute").and_then(|f| f.values.to_i64());
    let mut out = Vec::with_capacity(HEAD_BYTES + TRIANGLE_BYTES * triangles.len());
    out.extend([b' '; 80]);
    out[..19].copy_from_slice(b"binary STL of motet");
    out.extend(n.to_le_bytes());
    for triangle in triangles {
        let corners = corners(mesh, triangle);
        let numbers = [normal(corners), corners[0], corners[1], corners[2]];
        numbers.as_flattened().iter().for_each(|&x| out.extend((x as f32).to_le_bytes()));
        let attribute = attributes.as_ref().and_then(|a| u16::try_from(*a.get(triangle.1)?).ok());
        out.extend(attribute.unwrap_or(0).to_le_bytes());
    }
    let rounded = mesh.points.as_flattened().iter().any(|&x| f64::from(x as f32).to_bits() != x.to_bits());
    if rounded {
        lost.push("binary STL rounds coordinates to single precision; text (ascii) keeps them".into());
    }
    if !mesh.label_names.patches.is_empty() {
        lost.push("binary STL has no patch names; text (ascii) keeps them".into());
    }
    Ok(out)
}

/// Writes a solid for each run of triangles with the same patch.
fn write_ascii(mesh: &Mesh, triangles: &[Triangle]) -> Vec<u8> {
    let patches = mesh.patches();
    let label = |t: &Triangle| patches.as_ref().map_or(0, |p| p.ids[t.1]);
    let mut out = Vec::new();
    let mut runs: Vec<&[Triangle]> = triangles.chunk_by(|a, b| label(a) == label(b)).collect();
    if runs.is_empty() {
        runs.push(&[]);
    }
    for run in runs {
        let name = match (&patches, run.first()) {
            (Some(patches), Some(first)) => patches.name(label(first)).replace(['\n', '\r'], " "),
            _ => "motet".into(),
        };
        writeln!(out, "solid {name}").expect("writing into memory does not fail");
        for triangle in run {
            let corners = corners(mesh, triangle);
            out.extend(b"facet normal ");
            push_floats(&mut out, &normal(corners));
            out.extend(b"\nouter loop\n");
            for corner in corners {
                out.extend(b"vertex ");
                push_floats(&mut out, &corner);
                out.push(b'\n');
            }
            out.extend(b"endloop\nendfacet\n");
        }
        writeln!(out, "endsolid {name}").expect("writing into memory does not fail");
    }
    out
}
