//! Reads words, lines and numbers of a legacy VTK file, with the position for messages.

use crate::base::{Error, Result};
use crate::io::scalar::{ByteOrder, Scalar};
use crate::mesh::Values;

pub(super) const WRITE_AGAIN: &str = "the file is truncated or damaged: write it again";

/// The file and the current position in it.
pub(super) struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Whether numbers are binary, in big-endian order.
    pub(super) binary: bool,
}

impl<'a> Source<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, binary: false }
    }

    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// The current position, for messages: a byte offset in binary files, where lines mean nothing, otherwise
    /// a line.
    pub(super) fn place(&self) -> String {
        if self.binary {
            return format!("byte {}", self.at);
        }
        format!("line {}", 1 + self.bytes[..self.at].iter().filter(|&&b| b == b'\n').count())
    }

    /// An error at the current position.
    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        Error::input(what).at(self.place()).remedy(WRITE_AGAIN)
    }

    fn skip_blanks(&mut self) {
        self.at += self.rest().iter().take_while(|b| b.is_ascii_whitespace()).count();
    }

    /// The next word; `None` at the end of the file.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        let n = self.rest().iter().take_while(|b| !b.is_ascii_whitespace()).count();
        let word = &self.rest()[..n];
        self.at += n;
        (n > 0).then_some(word)
    }

    /// The next word, without consuming it.
    pub(super) fn peek(&mut self) -> &'a [u8] {
        let at = self.at;
        let word = self.word().unwrap_or_default();
        self.at = at;
        word
    }

    /// The next word as text; `what` names the expected item in messages.
    pub(super) fn text(&mut self, what: &str) -> Result<&'a str> {
        let word =
            self.word().ok_or_else(|| self.error(format!("expected {what}, found the end of the file")))?;
        std::str::from_utf8(word).map_err(|_| self.error(format!("{what} is not text")))
    }

    /// The next word as a count.
    pub(super) fn count(&mut self, what: &str) -> Result<usize> {
        let text = self.text(what)?;
        text.parse().map_err(|_| self.error(format!("{what}: expected a count, found `{}`", truncated(text))))
    }

    /// The rest of this line as a count, consumed only if it is one.
    pub(super) fn count_on_line(&mut self) -> Option<usize> {
        let end = self.rest().iter().position(|&b| b == b'\n').unwrap_or(self.rest().len());
        let line = std::str::from_utf8(&self.rest()[..end]).ok()?;
        let count = line.trim().parse().ok()?;
        self.at += end;
        Some(count)
    }

    /// The rest of this line without its end; `None` at the end of the file.
    pub(super) fn line(&mut self) -> Option<&'a [u8]> {
        if self.rest().is_empty() {
            return None;
        }
        let rest = self.rest();
        let end = rest.iter().position(|&b| b == b'\n');
        self.at += end.map_or(rest.len(), |end| end + 1);
        let line = &rest[..end.unwrap_or(rest.len())];
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// Skips the rest of a header line, so that data can follow.
    fn end_header(&mut self) {
        let blank = self.rest().iter().take_while(|b| matches!(b, b' ' | b'\t' | b'\r')).count();
        if self.rest().get(blank) == Some(&b'\n') {
            self.at += blank + 1;
        }
    }

    /// Takes the next `n` bytes of binary data; after words, call [`Self::start_data`] first.
    pub(super) fn take_bytes(&mut self, n: usize) -> Result<&'a [u8]> {
        let Some(bytes) = self.rest().get(..n) else {
            return Err(self.error(format!("expected {n} bytes, but only {} are left", self.rest().len())));
        };
        self.at += n;
        Ok(bytes)
    }

    /// The next `n` numbers, which start on the next line.
    pub(super) fn numbers(&mut self, kind: Scalar, n: usize) -> Result<Values> {
        if !self.binary {
            return self.numbers_as_text(kind, n);
        }
        self.end_header();
        let n_bytes = n.saturating_mul(kind.size());
        kind.numbers(self.take_bytes(n_bytes)?, ByteOrder::Big)
    }

    fn numbers_as_text(&mut self, kind: Scalar, n: usize) -> Result<Values> {
        // A number takes at least a digit and a blank.
        if n > self.rest().len().div_ceil(2) {
            return Err(
                self.error(format!("expected {n} numbers, but only {} bytes are left", self.rest().len()))
            );
        }
        let mut words = Words(self);
        let values = kind.parse(n, &mut words).map_err(str::to_owned);
        let values = values.map_err(|bad| {
            self.error(format!("`{}` is not a number of the declared type", truncated(&bad)))
        })?;
        if values.len() == n {
            return Ok(values);
        }
        Err(self.error(format!("expected {n} numbers, found {}", values.len())))
    }

    /// Moves to the start of binary data on a new line, before calls to [`Self::take_bytes`].
    pub(super) fn start_data(&mut self) {
        self.end_header();
    }
}

/// The words of a source; a word that is not UTF-8 becomes a question mark, which does not parse as a number.
struct Words<'s, 'a>(&'s mut Source<'a>);

impl<'a> Iterator for Words<'_, 'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        self.0.word().map(|word| std::str::from_utf8(word).unwrap_or("?"))
    }
}

/// The start of a text, for messages.
pub(super) fn truncated(text: &str) -> String {
    text.chars().take(30).collect()
}
