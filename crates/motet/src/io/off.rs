//! OFF surfaces: points and polygons, as text.
//!
//! Implemented here because `off-rs` (2.0) only has single-precision coordinates. Numbers
//! after the coordinates in `COFF`, `NOFF` and similar files, and colours of faces, are skipped with a note;
//! binary and four-dimensional files are rejected.

use std::io::Write as _;

use crate::base::{Error, Result, VertexId};
use crate::io::cell_labels::{cell_labels, lost_cell_arrays, lost_names};
use crate::io::format::{Format, Input, Write, WriteOptions};
use crate::io::output::{Output, write_all};
use crate::io::polygonal::kind_of_face;
use crate::io::select::{keep_cells, lost_arrays, surface_of};
use crate::io::text::{Text, parse_int, push_floats};
use crate::mesh::{CellKind, Cells, Mesh};

pub(super) const FORMAT: Format =
    Format { name: "OFF", extensions: &[".off"], read: Some(read), write: Some(Write::File(write)) };

fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut text = Text::with_comments(input.bytes, b'#');
    head(&mut text)?;
    let n_points = text.count("points", 3)?;
    let n_faces = text.count("faces", 1)?;
    text.int("the number of edges")?;
    if n_points == 0 {
        return Err(Error::input("the surface has no points").remedy("export the surface again"));
    }
    let mut points = Vec::with_capacity(n_points);
    let mut n_further = 0;
    for _ in 0..n_points {
        points.push(text.point()?);
        n_further += rest_of_line(&mut text);
    }
    if n_further > 0 {
        input
            .notes
            .add("normals, colours and texture coordinates after the coordinates of points are skipped");
    }
    let (cells, n_colours) = faces(&mut text, n_faces, n_points)?;
    if n_colours > 0 {
        input.notes.add("colours of faces are skipped");
    }
    Ok(Mesh::new(points, cells))
}

/// Reads the first word, which is optional.
fn head(text: &mut Text<'_>) -> Result<()> {
    let Some(word) = text.peek() else {
        return Err(Error::input("the file is empty").remedy("export the surface again"));
    };
    if parse_int(word).is_some() {
        return Ok(());
    }
    text.word();
    let prefix = word.strip_suffix(b"OFF").filter(|p| p.iter().all(|b| b"STCN".contains(b)));
    let is_binary = text.clone().word_in_line() == Some(b"BINARY");
    match prefix {
        Some(_) if !is_binary => Ok(()),
        Some(_) => {
            Err(text.error("binary OFF files are not supported").remedy("write it as text, or as PLY"))
        }
        None => Err(text
            .unexpected("header", "`OFF`", word)
            .remedy("the file is damaged or not a three-dimensional OFF file: get a new copy")),
    }
}

/// Consumes the rest of the line and returns its number of words.
fn rest_of_line(text: &mut Text<'_>) -> usize {
    let mut n = 0;
    while text.word_in_line().is_some() {
        n += 1;
    }
    n
}

/// Reads faces; returns the cells and the number of faces with colours.
fn faces(text: &mut Text<'_>, n: usize, n_points: usize) -> Result<(Cells, usize)> {
    let (mut cells, mut n_colours) = (Cells::new(), 0);
    for _ in 0..n {
        let k = text.count("corners of a face", 1)?;
        let mut vertices = Vec::with_capacity(k);
        for _ in 0..k {
            let id = text.int("corner of a face")?;
            let v = usize::try_from(id).ok().filter(|&v| v < n_points).ok_or_else(|| {
                text.error(format!(
                    "a face refers to point {id}, but there are {n_points} points, numbered from 0"
                ))
                .remedy("the file is damaged: get a new copy")
            })?;
            vertices.push(VertexId::new(v));
        }
        cells.push(kind_of_face(k), vertices);
        n_colours += usize::from(rest_of_line(text) > 0);
    }
    Ok((cells, n_colours))
}

fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (surface, boundary_only) = surface_of(mesh, "OFF");
    let holds = |kind| matches!(kind, CellKind::TRIANGLE | CellKind::QUAD | CellKind::POLYGON);
    let (mesh, mut lost) = keep_cells(&surface, "OFF", holds);
    lost.extend(boundary_only);
    lost.extend(lost_arrays("OFF", "point", &mesh.point_data));
    // Labels that are all 0 carry no information.
    let labels = cell_labels(&mesh, None);
    let none = vec![0; labels.len()];
    lost.extend(lost_cell_arrays("OFF", &mesh, &none));
    lost.extend(lost_names("OFF", &mesh));
    lost.extend(lost_arrays("OFF", "field", &mesh.field_data));
    let mut out = Vec::new();
    writeln!(out, "OFF\n{} {} 0", mesh.points.len(), mesh.cells.len())
        .expect("writing into memory does not fail");
    for point in &mesh.points {
        push_floats(&mut out, point);
        out.push(b'\n');
    }
    for (_, _, vertices) in mesh.cells.iter() {
        write!(out, "{}", vertices.len()).expect("writing into memory does not fail");
        for v in vertices {
            write!(out, " {v}").expect("writing into memory does not fail");
        }
        out.push(b'\n');
    }
    write_all(output, &out)?;
    Ok(lost)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::in_memory::parsed;

    fn parse(text: &str) -> (Result<Mesh>, Vec<String>) {
        parsed(&FORMAT, "in.off", text.as_bytes())
    }

    #[test]
    fn comments_colours_and_a_missing_header_are_accepted() {
        let (mesh, notes) = parse(
            "# a comment\nCOFF\n4 2 0\n0 0 0 1 1 1 1\n1 0 0\n0 1 0 # so\n0 0 1\n3 0 1 2 255 0 0\n4 0 1 2 3\n",
        );
        let mesh = mesh.unwrap();
        assert_eq!(mesh.cells.kinds(), [CellKind::TRIANGLE, CellKind::QUAD]);
        assert_eq!(notes.len(), 2);
        assert_eq!(parse("3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2").0.unwrap().points.len(), 3);
    }

    #[test]
    fn errors_are_reported() {
        for (text, expected) in [
            ("", "empty"),
            ("OFF BINARY\n", "binary"),
            ("4OFF\n1 0 0\n", "expected `OFF`"),
            ("OFF\n99999999 1 0\n", "declared"),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "point 3"),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 x\n", "found `x`"),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1", "truncated"),
            ("OFF\n0 0 0\n", "no points"),
        ] {
            let error = parse(text).0.unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
