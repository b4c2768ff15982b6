//! Words and numbers of a text file, with line numbers for errors.
//!
//! Lines are counted only when an error occurs, so that reading millions of numbers costs nothing extra.

use crate::base::{Error, Result, VertexId};

/// A position in a text, from which words are read.
#[derive(Clone, Debug)]
pub(super) struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
    /// The byte that starts a comment, which extends to the end of the line.
    comment: Option<u8>,
}

/// Minimum size of a number in a text: a digit and a separator.
const MIN_NUMBER_BYTES: usize = 2;

impl<'a> Text<'a> {
    /// A text without comments.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, comment: None }
    }

    /// A text in which `comment` and the rest of its line are ignored.
    pub(super) fn with_comments(bytes: &'a [u8], comment: u8) -> Self {
        Self { bytes, at: 0, comment: Some(comment) }
    }

    /// Number of bytes read so far.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    /// Continues reading at byte `position`.
    pub(super) fn set_position(&mut self, position: usize) {
        self.at = position.min(self.bytes.len());
    }

    /// All bytes from the current position.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// The next word on this or a later line; `None` at the end.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            match self.word_in_line() {
                Some(word) => return Some(word),
                None if self.at >= self.bytes.len() => return None,
                None => self.at += 1,
            }
        }
    }

    /// The next word of this line; `None` at the end of the line, before the line break.
    pub(super) fn word_in_line(&mut self) -> Option<&'a [u8]> {
        while self.bytes.get(self.at).is_some_and(|b| *b != b'\n' && b.is_ascii_whitespace()) {
            self.at += 1;
        }
        let rest = self.rest();
        let first = *rest.first()?;
        if Some(first) == self.comment {
            self.at += find(rest, b'\n').unwrap_or(rest.len());
            return None;
        }
        let ends = |b: &u8| b.is_ascii_whitespace() || Some(*b) == self.comment;
        let len = rest.iter().position(ends).unwrap_or(rest.len());
        self.at += len;
        (len > 0).then(|| &rest[..len])
    }

    /// The next word, without consuming it.
    pub(super) fn peek(&self) -> Option<&'a [u8]> {
        self.clone().word()
    }

    /// Consumes the rest of this line with its break and returns it without; `None` at the end of the text.
    pub(super) fn line(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let len = find(rest, b'\n').unwrap_or(rest.len());
        self.at += (len + 1).min(rest.len());
        Some(rest[..len].strip_suffix(b"\r").unwrap_or(&rest[..len]))
    }

    /// Reads the next word; an error at the end of the text.
    pub(super) fn expect(&mut self, what: &str) -> Result<&'a [u8]> {
        match self.word() {
            Some(word) => Ok(word),
            None => Err(self.unexpected_end(what)),
        }
    }

    /// Reads an integer.
    pub(super) fn int(&mut self, what: &str) -> Result<i64> {
        let word = self.expect(what)?;
        parse_int(word).ok_or_else(|| self.unexpected(what, "a whole number", word))
    }

    /// Reads a 32-bit integer, such as a label.
    pub(super) fn int32(&mut self, what: &str) -> Result<i32> {
        let n = self.int(what)?;
        i32::try_from(n).map_err(|_| self.error(format!("{what} {n} does not fit in 32 bits")))
    }

    /// Reads a number of items of `numbers_each` numbers each, and checks it against the remaining bytes, so
    /// that it is safe to allocate memory for them.
    pub(super) fn count(&mut self, what: &str, numbers_each: usize) -> Result<usize> {
        let n = self.int(&format!("the number of {what}"))?;
        let bytes_each = MIN_NUMBER_BYTES * numbers_each;
        // The last number of a file may lack a separator.
        let room = (self.rest().len() + 1) / bytes_each.max(1);
        match usize::try_from(n) {
            Ok(n) if n <= room => Ok(n),
            Ok(n) => Err(self
                .error(format!("{n} {what} declared, but the rest of the file can hold at most {room}"))
                .remedy("the file is truncated or damaged: get a new copy")),
            Err(_) => Err(self.error(format!("the number of {what} is negative: {n}"))),
        }
    }

    /// Reads a number.
    pub(super) fn float(&mut self, what: &str) -> Result<f64> {
        let word = self.expect(what)?;
        match parse_float(word) {
            Some(x) => Ok(x),
            None => Err(self.unexpected(what, "a number in double precision", word)),
        }
    }

    /// Reads an integer from this line.
    pub(super) fn int_in_line(&mut self, what: &str) -> Result<i64> {
        let word = self.expect_in_line(what)?;
        parse_int(word).ok_or_else(|| self.unexpected(what, "a whole number", word))
    }

    /// Reads a number from this line.
    pub(super) fn float_in_line(&mut self, what: &str) -> Result<f64> {
        let word = self.expect_in_line(what)?;
        parse_float(word).ok_or_else(|| self.unexpected(what, "a number in double precision", word))
    }

    /// Reads a vertex of a cell from this line: one of `n_points` numbers from `first` on.
    pub(super) fn vertex_in_line(&mut self, first: i64, n_points: usize) -> Result<VertexId> {
        let id = self.int_in_line("vertex of a cell")?;
        let place = id.checked_sub(first).and_then(|place| usize::try_from(place).ok());
        place.filter(|&place| place < n_points).map(VertexId::new).ok_or_else(|| {
            self.error(format!(
                "a cell refers to vertex {id}, but there are {n_points} vertices, numbered from {first}"
            ))
            .remedy("the file is damaged: write it again")
        })
    }

    fn expect_in_line(&mut self, what: &str) -> Result<&'a [u8]> {
        self.word_in_line().ok_or_else(|| {
            self.error(format!("expected {what}, found the end of the line"))
                .remedy("the file is truncated or damaged: get a new copy")
        })
    }

    /// Moves to the next word, on this or a later line; an error at the end of the text.
    pub(super) fn start_row(&mut self, what: &str) -> Result<()> {
        let word = self.expect(what)?;
        self.at -= word.len();
        Ok(())
    }

    /// Skips the rest of this line, up to its break.
    pub(super) fn skip_line(&mut self) {
        while self.word_in_line().is_some() {}
    }

    /// Reads the coordinates of a point.
    pub(super) fn point(&mut self) -> Result<[f64; 3]> {
        Ok([self.float("coordinate x")?, self.float("coordinate y")?, self.float("coordinate z")?])
    }

    /// An error on the line of the last word read.
    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        Error::input(what).at(format!("line {}", self.line_number()))
    }

    /// The line of the last word read, counted from 1.
    pub(super) fn line_number(&self) -> usize {
        1 + self.bytes[..self.at].iter().filter(|&&b| b == b'\n').count()
    }

    /// The error for `word` in place of what is expected.
    pub(super) fn unexpected(&self, what: &str, expected: &str, word: &[u8]) -> Error {
        self.error(format!("{what}: expected {expected}, found {}", quoted(word)))
    }

    /// The error for a file that ends where `what` is expected.
    pub(super) fn unexpected_end(&self, what: &str) -> Error {
        self.error(format!("expected {what}, found the end of the file"))
            .remedy("the file is truncated: get a new copy")
    }
}

/// The first position of `byte`.
pub(super) fn find(bytes: &[u8], byte: u8) -> Option<usize> {
    bytes.iter().position(|&b| b == byte)
}

/// The first position of `pattern`.
pub(super) fn find_subslice(bytes: &[u8], pattern: &[u8]) -> Option<usize> {
    bytes.windows(pattern.len()).position(|w| w == pattern)
}

/// A word for messages, quoted and truncated if long.
pub(super) fn quoted(word: &[u8]) -> String {
    let shown: String = String::from_utf8_lossy(word).chars().take(40).collect();
    format!("`{}`{}", shown.escape_debug(), if word.len() > 40 { "..." } else { "" })
}

/// Parses an integer; `None` if `word` is not one, or does not fit in 64 bits.
pub(super) fn parse_int(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// Parses a double-precision number; `None` if `word` is not one, or is too large. Accepts `nan` and `inf`:
/// whether a mesh may contain them is decided by its users.
pub(super) fn parse_float(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    let x: f64 = match text.parse() {
        Ok(x) => x,
        // Fortran writes exponents of double-precision numbers with a D.
        Err(_) if text.contains(['d', 'D']) => text.replace(['d', 'D'], "e").parse().ok()?,
        Err(_) => return None,
    };
    let overflowed = x.is_infinite() && text.bytes().any(|b| b.is_ascii_digit());
    (!overflowed).then_some(x)
}

/// Writes `x` with enough digits to recover it bit for bit.
pub(super) fn push_float(out: &mut Vec<u8>, x: f64) {
    use std::io::Write;
    write!(out, "{x:?}").expect("writing into memory does not fail");
}

/// Writes numbers separated by blanks.
pub(super) fn push_floats(out: &mut Vec<u8>, numbers: &[f64]) {
    for (i, &x) in numbers.iter().enumerate() {
        if i > 0 {
            out.push(b' ');
        }
        push_float(out, x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_have_line_numbers() {
        let mut text = Text::with_comments(b"# head\n a 1 # tail\n\r\n2.5\n", b'#');
        assert_eq!(text.word(), Some(&b"a"[..]));
        assert_eq!(text.line_number(), 2);
        assert_eq!(text.int("n").unwrap(), 1);
        assert_eq!(text.word_in_line(), None);
        assert_eq!(text.float("x").unwrap(), 2.5);
        assert_eq!(text.line_number(), 4);
        let error = text.float("x").unwrap_err().to_string();
        assert_eq!(
            error,
            "line 5: expected x, found the end of the file; the file is truncated: get a new copy"
        );
    }

    #[test]
    fn lines_may_have_unix_and_windows_endings() {
        let mut text = Text::new(b"one\r\ntwo\n\nend");
        let lines: Vec<_> = std::iter::from_fn(|| text.line()).collect();
        assert_eq!(lines, [&b"one"[..], b"two", b"", b"end"]);
    }

    #[test]
    fn a_count_that_the_file_cannot_hold_is_refused() {
        assert_eq!(Text::new(b"2 1 2").count("things", 1).unwrap(), 2);
        let error = Text::new(b"1152921504606846976 1 2").count("points", 3).unwrap_err().to_string();
        assert!(error.starts_with("line 1: 1152921504606846976 points declared, but"), "{error}");
        assert!(Text::new(b"-1 0").count("points", 3).is_err());
        assert!(Text::new(b"99999999999999999999 0").count("points", 3).is_err());
    }

    #[test]
    fn numbers_are_distinguished_from_other_words() {
        assert_eq!(parse_float(b"1.5d-3"), Some(1.5e-3));
        assert_eq!(parse_float(b"-Inf"), Some(f64::NEG_INFINITY));
        assert!(parse_float(b"nan").unwrap().is_nan());
        for bad in [&b"1e999"[..], b"1,5", b"", b"0x10", b"1.#QNAN", b"\xff"] {
            assert_eq!(parse_float(bad), None, "{}", quoted(bad));
        }
    }

    #[test]
    fn floats_round_trip_bit_for_bit() {
        for x in [0.1, -0.0, 1.0 / 3.0, 5e-324, f64::MAX, 1e22, 123_456_789.123_456_79] {
            let mut out = Vec::new();
            push_float(&mut out, x);
            assert_eq!(parse_float(&out).map(f64::to_bits), Some(x.to_bits()));
        }
    }
}
