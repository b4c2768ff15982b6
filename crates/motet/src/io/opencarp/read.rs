//! Reads the files with a common stem.

use std::borrow::Cow;
use std::path::Path;

use super::{DIRECTIONS, TAG, TYPES};
use crate::base::{Error, Point, Result, VertexId};
use crate::io::format::{Input, Notes};
use crate::io::reading::read_if_exists;
use crate::io::text::{Text, parse_float, parse_int};
use crate::mesh::{Cells, Field, Mesh, Values};

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let points = required(input, "pts", "points")?;
    let points =
        read_points(&points, input.notes).map_err(|e| e.in_file(input.path.with_extension("pts")))?;
    let elements = match has_extension(input.path, "pts") {
        true => read_if_exists(&input.path.with_extension("elem"))?.map(Cow::Owned),
        false => Some(required(input, "elem", "elements")?),
    };
    let Some(elements) = elements else {
        input.notes.add("there is no .elem file of the same name: only points are read");
        return Ok(Mesh::new(points, Cells::new()));
    };
    let mut mesh = read_elements(&elements, points, input.notes)
        .map_err(|e| e.in_file(input.path.with_extension("elem")))?;
    let path = input.path.with_extension("lon");
    let directions = match has_extension(input.path, "lon") {
        true => Some(Cow::Borrowed(input.bytes)),
        false => read_if_exists(&path)?.map(Cow::Owned),
    };
    if let Some(directions) = directions {
        mesh.cell_data.extend(read_directions(&directions, mesh.cells.len()).map_err(|e| e.in_file(&path))?);
    }
    Ok(mesh)
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

/// The content of the file with this extension, which is the given one or lies beside it.
fn required<'a>(input: &Input<'a>, extension: &str, what: &str) -> Result<Cow<'a, [u8]>> {
    if has_extension(input.path, extension) {
        return Ok(Cow::Borrowed(input.bytes));
    }
    let path = input.path.with_extension(extension);
    read_if_exists(&path)?.map(Cow::Owned).ok_or_else(|| {
        Error::input(format!("the file with the {what} does not exist"))
            .in_file(&path)
            .remedy(format!("put the .{extension} file of the same name in the same folder"))
    })
}

fn read_points(bytes: &[u8], notes: &Notes) -> Result<Vec<Point>> {
    let mut text = Text::new(bytes);
    let n = text.count("points", 3)?;
    let mut points = Vec::with_capacity(n);
    for _ in 0..n {
        points.push(text.point()?);
    }
    note_rest(&text, ".pts", notes);
    Ok(points)
}

fn note_rest(text: &Text<'_>, file: &str, notes: &Notes) {
    if text.peek().is_some() {
        notes.add(format!("lines of the {file} file beyond the number in its first line are skipped"));
    }
}

fn read_elements(bytes: &[u8], points: Vec<Point>, notes: &Notes) -> Result<Mesh> {
    let mut text = Text::new(bytes);
    let n = text.count("elements", 3)?;
    let mut cells = Cells::new();
    let mut tags = Vec::with_capacity(n);
    let mut are_tagged = false;
    let mut theirs = [VertexId::default(); 8];
    for _ in 0..n {
        let name = text.expect("an element")?;
        let Some((_, kind, order)) = TYPES.iter().find(|(known, ..)| known.as_bytes() == name) else {
            let known: Vec<&str> = TYPES.iter().map(|(known, ..)| *known).collect();
            return Err(text.unexpected("element type", &known.join(", "), name));
        };
        for vertex in &mut theirs[..order.len()] {
            *vertex = text.vertex_in_line(0, points.len())?;
        }
        cells.push(*kind, order.iter().map(|&k| theirs[k]));
        tags.push(match text.word_in_line() {
            None => 0,
            Some(word) => {
                are_tagged = true;
                let tag = parse_int(word).and_then(|tag| i32::try_from(tag).ok());
                tag.ok_or_else(|| text.unexpected("region", "a whole number of 32 bits", word))?
            }
        });
        if let Some(word) = text.word_in_line() {
            return Err(text
                .unexpected("element", "the end of the line", word)
                .remedy("the element has more vertices than its type, or the file is damaged"));
        }
    }
    note_rest(&text, ".elem", notes);
    let mut mesh = Mesh::new(points, cells);
    if are_tagged {
        mesh.set_cell_field(Field::scalars(TAG, tags));
    }
    Ok(mesh)
}

/// Reads the number of directions, which may be missing, then one or two directions for each element.
fn read_directions(bytes: &[u8], n_cells: usize) -> Result<Vec<Field>> {
    let mut text = Text::new(bytes);
    let mut head = text.clone();
    let first = head.expect("the number of directions")?;
    let mut n_words = 1;
    while head.word_in_line().is_some() {
        n_words += 1;
    }
    if n_words == 1 {
        text = head;
    }
    let n_directions = match (n_words, first) {
        (1, b"1") | (3, _) => 1,
        (1, b"2") | (6, _) => 2,
        _ => {
            return Err(text
                .unexpected("the number of directions", "1 or 2", first)
                .remedy("put the number of directions per element in the first line"));
        }
    };
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); n_directions];
    for i in 0..n_cells {
        for (k, values) in values.iter_mut().enumerate() {
            for axis in 0..3 {
                let word = match (k, axis) {
                    (0, 0) => text.word(),
                    _ => text.word_in_line(),
                };
                let word = word.ok_or_else(|| {
                    text.error(format!("the directions of element {i} of {n_cells} are incomplete"))
                        .remedy("the files do not belong together, or are damaged")
                })?;
                let x = parse_float(word).ok_or_else(|| text.unexpected("direction", "a number", word))?;
                values.push(x);
            }
        }
        if let Some(word) = text.word_in_line() {
            return Err(text.unexpected("directions", "the end of the line", word));
        }
    }
    if text.peek().is_some() {
        return Err(text
            .error(format!("there are directions for more than {n_cells} elements"))
            .remedy("the files do not belong together, or are damaged"));
    }
    let field = |(name, values): (&&str, Vec<f64>)| Field {
        name: (*name).to_owned(),
        components: 3,
        values: Values::F64(values),
    };
    Ok(DIRECTIONS.iter().zip(values).map(field).collect())
}
