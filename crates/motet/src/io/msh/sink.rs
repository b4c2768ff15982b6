//! Writes the numbers of an MSH file, as text or binary.

use std::io::Write as _;

use crate::base::Result;
use crate::io::output::{Output, ROWS_PER_PART, drain};
use crate::io::text::push_floats;

/// Bytes that may wait until they are written.
const MAX_PENDING: usize = 1 << 20;

/// The output, as text or binary.
pub(super) struct Sink {
    pub(super) out: Vec<u8>,
    pub(super) binary: bool,
}

impl Sink {
    /// Writes `n` rows, each by `put`, which gets its number; many rows on all threads.
    pub(super) fn rows(
        &mut self,
        output: &mut Output<'_>,
        n: usize,
        put: impl Fn(&mut Self, usize) + Sync + Send,
    ) -> Result<()> {
        if n <= ROWS_PER_PART {
            (0..n).for_each(|i| put(self, i));
            return if self.out.len() > MAX_PENDING { drain(&mut self.out, output) } else { Ok(()) };
        }
        drain(&mut self.out, output)?;
        let binary = self.binary;
        output.rows(n, |rows, out| {
            let mut part = Self { out, binary };
            rows.for_each(|i| put(&mut part, i));
            part.out
        })
    }

    pub(super) fn int(&mut self, n: i32) {
        if self.binary { self.out.extend(n.to_ne_bytes()) } else { self.word(n) }
    }

    pub(super) fn size(&mut self, n: usize) {
        if self.binary { self.out.extend((n as u64).to_ne_bytes()) } else { self.word(n) }
    }

    pub(super) fn doubles(&mut self, numbers: &[f64]) {
        if self.binary {
            numbers.iter().for_each(|x| self.out.extend(x.to_ne_bytes()));
        } else {
            push_floats(&mut self.out, numbers);
            self.out.push(b' ');
        }
    }

    fn word(&mut self, n: impl std::fmt::Display) {
        write!(self.out, "{n} ").expect("writing into memory does not fail");
    }

    /// Ends a line of text; no effect in binary files.
    pub(super) fn end_line(&mut self) {
        if !self.binary {
            self.out.pop_if(|b| *b == b' ');
            self.out.push(b'\n');
        }
    }

    /// Writes a line that is text in binary files too.
    pub(super) fn line(&mut self, line: impl std::fmt::Display) {
        writeln!(self.out, "{line}").expect("writing into memory does not fail");
    }

    pub(super) fn end_section(&mut self, name: &str) {
        if self.binary {
            self.out.push(b'\n');
        }
        self.line(format_args!("$End{name}"));
    }
}
