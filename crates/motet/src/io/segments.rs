//! Centre lines of wires as a pair of plain texts, as beam codes write them (EndoBeams): positions, three
//! numbers a row, and segments, two numbers of positions a row, counted from 1.

use std::path::Path;

use crate::base::{Error, Result};
use crate::geometry::vector::in_range;
use crate::io::text::Text;
use crate::mesh::{CellKind, Cells, Mesh};

/// Reads the positions of nodes from one text and the segments between them from another. Lines may have
/// comments after `#`.
///
/// # Errors
/// If a file cannot be read, a row has fewer or more numbers, one is malformed or not finite, or a segment
/// refers to a position that does not exist. Reports the line.
pub fn read_segments(positions: impl AsRef<Path>, segments: impl AsRef<Path>) -> Result<Mesh> {
    let [positions, segments] = [positions.as_ref(), segments.as_ref()];
    let bytes = |path: &Path| std::fs::read(path).map_err(|e| Error::io(path, e));
    let remedy = "give positions, three numbers a row, and segments, two numbers of positions a row from 1";
    let points = parse_positions(&bytes(positions)?).map_err(|e| e.in_file(positions).remedy(remedy))?;
    let cells = parse_segments(&bytes(segments)?, points.len());
    Ok(Mesh::new(points, cells.map_err(|e| e.in_file(segments).remedy(remedy))?))
}

fn parse_positions(bytes: &[u8]) -> Result<Vec<[f64; 3]>> {
    let mut text = Text::with_comments(bytes, b'#');
    let mut points = Vec::new();
    while text.peek().is_some() {
        text.start_row("position")?;
        let point = [text.float_in_line("x")?, text.float_in_line("y")?, text.float_in_line("z")?];
        if !in_range(point) {
            return Err(text.error(format!("the position {point:?} is not finite or too large")));
        }
        end_row(&mut text)?;
        points.push(point);
    }
    match points.is_empty() {
        true => Err(Error::input("the file contains no positions")),
        false => Ok(points),
    }
}

fn parse_segments(bytes: &[u8], n_points: usize) -> Result<Cells> {
    let mut text = Text::with_comments(bytes, b'#');
    let mut cells = Cells::new();
    while text.peek().is_some() {
        text.start_row("segment")?;
        let ends = [text.vertex_in_line(1, n_points)?, text.vertex_in_line(1, n_points)?];
        end_row(&mut text)?;
        cells.push(CellKind::LINE, ends);
    }
    match cells.is_empty() {
        true => Err(Error::input("the file contains no segments")),
        false => Ok(cells),
    }
}

fn end_row(text: &mut Text<'_>) -> Result<()> {
    match text.word_in_line() {
        None => Ok(()),
        Some(word) => Err(text.unexpected("row", "the end of the line", word)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_and_segments_are_read_and_checked() {
        let points = parse_positions(b"# x y z\n0 0 0\n1.5 0 -2e-1\n\n3 1 0").unwrap();
        assert_eq!(points, [[0.0; 3], [1.5, 0.0, -0.2], [3.0, 1.0, 0.0]]);
        let cells = parse_segments(b"1 2\n2 3\n", 3).unwrap();
        assert_eq!(cells.counts(), [(CellKind::LINE, 2)]);
        for (bytes, part) in [
            (&b""[..], "no positions"),
            (b"0 0 0\n1 2\n", "line 2"),
            (b"0 0 0 0\n", "end of the line"),
            (b"0 nan 0\n", "not finite"),
            (b"0 x 0\n", "`x`"),
        ] {
            let error = parse_positions(bytes).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
        for (bytes, part) in
            [(&b""[..], "no segments"), (b"1 2\n0 1\n", "line 2"), (b"1 4\n", "4"), (b"1 2 3\n", "end of")]
        {
            let error = parse_segments(bytes, 3).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }
}
