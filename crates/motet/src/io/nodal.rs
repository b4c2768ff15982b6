//! Values of nodes over time, in the text format of "temporal and spatial values" of a boundary in
//! svMultiPhysics, such as the displacements of a wall.
//!
//! The layout is that of the section "Temporal and Spatial Values Data" of its guide: the number of
//! components, of times and of nodes; the times, ascending; then for each node its id, and a row of
//! components for each time. Words are separated by blanks or line breaks.

use std::collections::HashSet;
use std::io::Write as _;
use std::path::Path;

use crate::base::{Error, Point, Result};
use crate::io::replace;
use crate::io::text::{Text, push_floats};

/// Values of nodes at several times.
#[derive(Clone, Debug, PartialEq)]
pub struct NodalSeries {
    /// Times, in ascending order.
    pub times: Vec<f64>,
    /// Ids of the nodes: their `GlobalNodeID`, or indices in the mesh counted from 1. No duplicates.
    pub ids: Vec<i64>,
    /// Number of values per node and time.
    pub components: usize,
    /// Values node by node; for each node, one row of components per time.
    pub values: Vec<f64>,
}

impl NodalSeries {
    /// A series of vectors; `frames` holds a vector for each node at each time.
    ///
    /// # Panics
    /// If the number of `frames` differs from that of the times, or the length of a frame from that of `ids`.
    pub fn of_vectors(times: Vec<f64>, ids: Vec<i64>, frames: &[Vec<Point>]) -> Self {
        assert!(frames.len() == times.len() && frames.iter().all(|frame| frame.len() == ids.len()));
        let of_node = |node: usize| frames.iter().flat_map(move |frame| frame[node]);
        let values = (0..ids.len()).flat_map(of_node).collect();
        Self { times, ids, components: 3, values }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// If the file cannot be read or is invalid: malformed or non-finite numbers, times that do not ascend, a
    /// duplicate node, or fewer or more numbers than its first line declares. Reports the line.
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|e| Error::io(path, e))?;
        let remedy = "the file is damaged or contains no nodal values over time: write it again";
        Self::parse(&bytes).map_err(|e| e.in_file(path).remedy(remedy))
    }

    /// Parses the content of a file, as [`read`](Self::read) does.
    ///
    /// # Errors
    /// If the content is invalid, see [`read`](Self::read).
    pub fn parse(bytes: &[u8]) -> Result<Self> {
        let mut text = Text::new(bytes);
        let components = text.count("components", 1)?;
        let n_times = text.count("times", 1)?;
        if components == 0 || n_times == 0 {
            return Err(text.error("expected at least one component and one time"));
        }
        // The file has at most this many rows, so the product below does not overflow.
        let row = components.saturating_mul(n_times).saturating_add(1);
        let n_nodes = text.count("nodes", row)?;
        let mut times: Vec<f64> = Vec::with_capacity(n_times);
        for _ in 0..n_times {
            let time = finite(&mut text, "time")?;
            if let Some(&before) = times.last()
                && time <= before
            {
                return Err(
                    text.error(format!("time {time} is not greater than the previous time, {before}"))
                );
            }
            times.push(time);
        }
        let mut ids = Vec::with_capacity(n_nodes);
        let mut known = HashSet::with_capacity(n_nodes);
        let mut values = Vec::with_capacity(n_nodes * n_times * components);
        for _ in 0..n_nodes {
            let id = text.int("node id")?;
            if !known.insert(id) {
                return Err(text.error(format!("node {id} occurs twice")));
            }
            ids.push(id);
            for _ in 0..n_times * components {
                values.push(finite(&mut text, "value")?);
            }
        }
        match text.word() {
            None => Ok(Self { times, ids, components, values }),
            Some(word) => Err(text.unexpected("after the last node", "the end of the file", word)),
        }
    }

    /// Writes a file, with enough digits to recover each number to the bit.
    ///
    /// # Errors
    /// If the file cannot be written; its previous content is then unchanged.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let mut out = Vec::new();
        let infallible = "writing into memory does not fail";
        writeln!(out, "{} {} {}", self.components, self.times.len(), self.ids.len()).expect(infallible);
        for &time in &self.times {
            push_floats(&mut out, &[time]);
            out.push(b'\n');
        }
        let of_node = self.values.chunks_exact((self.times.len() * self.components).max(1));
        for (id, rows) in self.ids.iter().zip(of_node) {
            writeln!(out, "{id}").expect(infallible);
            for row in rows.chunks_exact(self.components) {
                push_floats(&mut out, row);
                out.push(b'\n');
            }
        }
        replace(path.as_ref(), &out).map(drop)
    }

    /// The vectors of all nodes at the time with index `time`.
    ///
    /// # Errors
    /// If there are not three components.
    ///
    /// # Panics
    /// If there is no such time.
    pub fn vectors(&self, time: usize) -> Result<Vec<Point>> {
        if self.components != 3 {
            return Err(Error::input(format!("expected 3 components per node, found {}", self.components)));
        }
        assert!(time < self.times.len(), "there is no time {time}");
        let of_node = self.values.chunks_exact(3 * self.times.len());
        Ok(of_node.map(|rows| [0, 1, 2].map(|i| rows[3 * time + i])).collect())
    }
}

fn finite(text: &mut Text<'_>, what: &str) -> Result<f64> {
    let x = text.float(what)?;
    match x.is_finite() {
        true => Ok(x),
        false => Err(text.error(format!("{what} is not finite"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of svMultiPhysics' guide.
    const GUIDE: &str = "\
2   2   3
0.000000000
100.000000000
1
0.000000000000000000e+00 0.000000000000000000e+00
0.000000000000000000e+00 0.000000000000000000e+00
2
1.547824639326119289e+01 0.000000000000000000e+00
1.547824639326119289e+01 0.000000000000000000e+00
3
3.080742881248511011e+01 0.000000000000000000e+00
3.080742881248511011e+01 0.000000000000000000e+00
";

    #[test]
    fn the_guides_example_is_read() {
        let series = NodalSeries::parse(GUIDE.as_bytes()).unwrap();
        assert_eq!(
            (series.components, &series.times[..], &series.ids[..]),
            (2, &[0.0, 100.0][..], &[1, 2, 3][..])
        );
        assert_eq!(series.values[4..8], [15.478_246_393_261_193, 0.0, 15.478_246_393_261_193, 0.0]);
        assert!(series.vectors(0).unwrap_err().to_string().contains("found 2"));
    }

    #[test]
    fn files_round_trip_bit_for_bit() {
        let frames = [vec![[0.0; 3], [-0.0, 5e-324, 0.1]], vec![[1.0 / 3.0, 1e300, -7.0], [0.1; 3]]];
        let series = NodalSeries::of_vectors(vec![0.0, 0.1], vec![7, 3], &frames);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("wall.dat");
        series.write(&file).unwrap();
        let back = NodalSeries::read(&file).unwrap();
        assert_eq!(back, series);
        assert_eq!(back.vectors(1).unwrap(), frames[1]);
        assert!(back.vectors(0).unwrap()[1][0].is_sign_negative());
    }

    #[test]
    fn damage_is_reported_with_its_line() {
        // A last number with missing digits is still a number.
        let whole = GUIDE.trim_end().as_bytes();
        for len in 0..whole.len() - 24 {
            assert!(NodalSeries::parse(&whole[..len]).is_err(), "truncated at {len}");
        }
        for (from, to, expected) in [
            ("2   2   3", "2   2   900", "line 1: 900 nodes declared"),
            ("2   2   3", "2   2   2", "after the last node"),
            ("2   2   3", "9000000000000000000 2 3", "components declared"),
            ("2   2   3", "0 2 3", "at least one component"),
            ("100.000000000", "0", "line 3: time 0 is not greater than the previous time, 0"),
            ("100.000000000", "nan", "line 3: time is not finite"),
            ("\n3\n", "\n2\n", "node 2 occurs twice"),
            ("3.080742881248511011e+01", "inf", "line 11: value is not finite"),
        ] {
            assert!(GUIDE.contains(from));
            let error = NodalSeries::parse(GUIDE.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
