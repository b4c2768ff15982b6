//! Writes the sections of a Medit file, as text or binary.

use std::io::Write as _;

use super::{DIMENSION, END, Keyword, TEXT_ONLY};
use crate::base::{Result, Threads};
use crate::io::output::Output;
use crate::io::text::push_float;

/// A file being written.
pub(super) struct Sink<'t> {
    out: Vec<u8>,
    /// The version of a binary file; `None` for text.
    version: Option<i32>,
    threads: &'t Threads,
    /// Where to store the position of the next section.
    next_at: usize,
}

/// The lowest version from 2 on that can hold this many points and bytes.
pub(super) fn version_for(n_points: usize, n_bytes: u64) -> i32 {
    match () {
        () if i32::try_from(n_points).is_err() => 4,
        () if i32::try_from(n_bytes).is_err() => 3,
        () => 2,
    }
}

impl<'t> Sink<'t> {
    /// Starts a file with its head; as text if there is no version.
    pub(super) fn new(version: Option<i32>, threads: &'t Threads) -> Self {
        let mut sink = Self { out: Vec::new(), version, threads, next_at: 0 };
        match version {
            None => sink.out.extend(b"MeshVersionFormatted 2\n\nDimension 3\n"),
            Some(version) => {
                sink.fixed_i32(1);
                sink.fixed_i32(version);
                sink.begin(&DIMENSION);
                sink.fixed_i32(3);
                sink.end_section();
            }
        }
        sink
    }

    /// Whether this form of the file has the section.
    pub(super) fn has(&self, keyword: &Keyword) -> bool {
        self.version.is_none() || keyword.number != TEXT_ONLY
    }

    /// Begins a section with `n` rows.
    pub(super) fn section(&mut self, keyword: &Keyword, n: usize) {
        if self.version.is_some() {
            self.begin(keyword);
            self.int(n as i64);
        } else {
            write!(self.out, "\n{}\n{n}\n", keyword.name).expect("writing into memory does not fail");
        }
    }

    /// Writes `n` rows on all threads, each by `put`, which gets its number.
    pub(super) fn rows(&mut self, n: usize, put: impl Fn(&mut Self, usize) + Sync + Send) -> Result<()> {
        let (version, threads) = (self.version, self.threads);
        Output::to_memory(&mut self.out, threads).rows(n, |rows, out| {
            let mut part = Self { out, version, threads, next_at: 0 };
            for i in rows {
                put(&mut part, i);
                part.end_row();
            }
            part.out
        })
    }

    pub(super) fn end_section(&mut self) {
        let here = self.out.len() as u64;
        match self.version {
            None => {}
            Some(2) => self.out[self.next_at..][..4].copy_from_slice(&(here as u32).to_le_bytes()),
            Some(_) => self.out[self.next_at..][..8].copy_from_slice(&here.to_le_bytes()),
        }
    }

    pub(super) fn end_row(&mut self) {
        if self.version.is_none() {
            self.out.push(b'\n');
        }
    }

    /// Writes a count, a vertex or a reference.
    pub(super) fn int(&mut self, x: i64) {
        match self.version {
            Some(4) => self.out.extend(x.to_le_bytes()),
            _ => self.fixed_i32(x as i32),
        }
    }

    /// Writes the number of arrays, or the type of an array.
    pub(super) fn fixed_i32(&mut self, x: i32) {
        if self.version.is_some() {
            self.out.extend(x.to_le_bytes());
        } else {
            self.blank();
            write!(self.out, "{x}").expect("writing into memory does not fail");
        }
    }

    pub(super) fn float(&mut self, x: f64) {
        if self.version.is_some() {
            self.out.extend(x.to_le_bytes());
        } else {
            self.blank();
            push_float(&mut self.out, x);
        }
    }

    /// Ends the file and returns its bytes.
    pub(super) fn finish(mut self) -> Vec<u8> {
        match self.version {
            None => self.out.extend(b"\nEnd\n"),
            Some(_) => self.begin(&END),
        }
        self.out
    }

    /// Writes the number of a section, and a placeholder for the position of the next: 0, as for the last
    /// section.
    fn begin(&mut self, keyword: &Keyword) {
        self.fixed_i32(keyword.number);
        self.next_at = self.out.len();
        self.out.extend(vec![0; if self.version == Some(2) { 4 } else { 8 }]);
    }

    fn blank(&mut self) {
        if self.out.last().is_some_and(|&last| last != b'\n') {
            self.out.push(b' ');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_beyond_two_gigabytes_take_version_three() {
        assert_eq!(version_for(10, i32::MAX as u64), 2);
        assert_eq!(version_for(10, i32::MAX as u64 + 1), 3);
        assert_eq!(version_for(1 << 31, 1 << 36), 4);
    }
}
