//! Words and numbers of a text file, each with the line that it stands on.
//!
//! The line is found by counting only when something is wrong: a reader of
//! millions of numbers pays nothing for it.

use crate::base::{Error, Result};

/// A place in a text, and the words from there on.
#[derive(Clone, Debug)]
pub(super) struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
    /// What begins a comment, which goes on to the end of the line.
    comment: Option<u8>,
}

/// What a number in a text takes at least: a digit and what divides it from the next.
const BYTES_A_NUMBER: usize = 2;

impl<'a> Text<'a> {
    /// A text without comments.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, comment: None }
    }

    /// A text in which `comment` and all behind it on the line mean nothing.
    pub(super) fn with_comments(bytes: &'a [u8], comment: u8) -> Self {
        Self { bytes, at: 0, comment: Some(comment) }
    }

    /// How many bytes have been read.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    /// Goes on reading at byte `position`.
    pub(super) fn set_position(&mut self, position: usize) {
        self.at = position.min(self.bytes.len());
    }

    /// All bytes from here on.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// The next word, on whatever line; `None` at the end.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            match self.word_in_line() {
                Some(word) => return Some(word),
                None if self.at >= self.bytes.len() => return None,
                None => self.at += 1,
            }
        }
    }

    /// The next word of this line; `None` at its end, where the line break is still to come.
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

    /// The next word, left in place.
    pub(super) fn peek(&self) -> Option<&'a [u8]> {
        self.clone().word()
    }

    /// What is left of this line, without its break; the next line comes next.
    /// `None` at the end of the text.
    pub(super) fn line(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let len = find(rest, b'\n').unwrap_or(rest.len());
        self.at += (len + 1).min(rest.len());
        Some(rest[..len].strip_suffix(b"\r").unwrap_or(&rest[..len]))
    }

    /// Reads the next word, which must be there.
    pub(super) fn expect(&mut self, what: &str) -> Result<&'a [u8]> {
        match self.word() {
            Some(word) => Ok(word),
            None => Err(self.ends(what)),
        }
    }

    /// Reads a whole number.
    pub(super) fn int(&mut self, what: &str) -> Result<i64> {
        let word = self.expect(what)?;
        parse_int(word).ok_or_else(|| self.unexpected(what, "a whole number", word))
    }

    /// Reads a whole number of 32 bits, such as a label.
    pub(super) fn int32(&mut self, what: &str) -> Result<i32> {
        let n = self.int(what)?;
        i32::try_from(n).map_err(|_| self.error(format!("{what} {n} does not fit in 32 bits")))
    }

    /// Reads how many things follow, of `numbers_each` numbers each, and holds
    /// that against the bytes that are there, so that it is safe to allocate for.
    pub(super) fn count(&mut self, what: &str, numbers_each: usize) -> Result<usize> {
        let n = self.int(&format!("the number of {what}"))?;
        let bytes_each = BYTES_A_NUMBER * numbers_each;
        // The last number of a file may lack what divides it from the next.
        let room = (self.rest().len() + 1) / bytes_each.max(1);
        match usize::try_from(n) {
            Ok(n) if n <= room => Ok(n),
            Ok(n) => Err(self
                .error(format!("{n} {what} are announced, but what is left of the file holds at most {room}"))
                .remedy("the file is cut off or damaged: get it again")),
            Err(_) => Err(self.error(format!("{n} is no number of {what}"))),
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

    /// Reads the coordinates of a point.
    pub(super) fn point(&mut self) -> Result<[f64; 3]> {
        Ok([self.float("coordinate x")?, self.float("coordinate y")?, self.float("coordinate z")?])
    }

    /// An error on the line of the word read last.
    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        Error::input(what).at(format!("line {}", self.line_number()))
    }

    /// The line of the word read last, counted from 1.
    pub(super) fn line_number(&self) -> usize {
        1 + self.bytes[..self.at].iter().filter(|&&b| b == b'\n').count()
    }

    /// The error where `word` stands in place of what is expected.
    pub(super) fn unexpected(&self, what: &str, expected: &str, word: &[u8]) -> Error {
        self.error(format!("{what}: expected {expected}, found {}", quoted(word)))
    }

    /// The error where the text ends too early.
    pub(super) fn ends(&self, what: &str) -> Error {
        self.error(format!("the file ends where {what} should follow"))
            .remedy("the file is cut off: get it again")
    }
}

/// Where `byte` first stands.
pub(super) fn find(bytes: &[u8], byte: u8) -> Option<usize> {
    bytes.iter().position(|&b| b == byte)
}

/// Where `pattern` first stands.
pub(super) fn find_all(bytes: &[u8], pattern: &[u8]) -> Option<usize> {
    bytes.windows(pattern.len()).position(|w| w == pattern)
}

/// A word as messages show it: between quotes, cut off where it is long.
pub(super) fn quoted(word: &[u8]) -> String {
    let shown: String = String::from_utf8_lossy(word).chars().take(40).collect();
    format!("`{}`{}", shown.escape_debug(), if word.len() > 40 { "..." } else { "" })
}

/// A whole number; `None` when `word` is none, or does not fit in 64 bits.
pub(super) fn parse_int(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A number in double precision; `None` when `word` is none, or is too large to
/// be one. `nan` and `inf` are numbers here: whether a mesh may have them is
/// for whoever uses it to say.
pub(super) fn parse_float(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    let x: f64 = match text.parse() {
        Ok(x) => x,
        // Fortran writes its double precision with a D.
        Err(_) if text.contains(['d', 'D']) => text.replace(['d', 'D'], "e").parse().ok()?,
        Err(_) => return None,
    };
    let overflowed = x.is_infinite() && text.bytes().any(|b| b.is_ascii_digit());
    (!overflowed).then_some(x)
}

/// Writes `x` with as many digits as bring it back bit for bit.
pub(super) fn push_float(out: &mut Vec<u8>, x: f64) {
    use std::io::Write;
    write!(out, "{x:?}").expect("writing into memory does not fail");
}

/// Writes numbers with blanks between.
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
    fn words_come_with_their_lines() {
        let mut text = Text::with_comments(b"# head\n a 1 # tail\n\r\n2.5\n", b'#');
        assert_eq!(text.word(), Some(&b"a"[..]));
        assert_eq!(text.line_number(), 2);
        assert_eq!(text.int("n").unwrap(), 1);
        assert_eq!(text.word_in_line(), None);
        assert_eq!(text.float("x").unwrap(), 2.5);
        assert_eq!(text.line_number(), 4);
        let error = text.float("x").unwrap_err().to_string();
        assert_eq!(error, "line 5: the file ends where x should follow; the file is cut off: get it again");
    }

    #[test]
    fn lines_end_as_unix_and_windows_end_them() {
        let mut text = Text::new(b"one\r\ntwo\n\nend");
        let lines: Vec<_> = std::iter::from_fn(|| text.line()).collect();
        assert_eq!(lines, [&b"one"[..], b"two", b"", b"end"]);
    }

    #[test]
    fn a_count_that_the_file_cannot_hold_is_refused() {
        assert_eq!(Text::new(b"2 1 2").count("things", 1).unwrap(), 2);
        let error = Text::new(b"1152921504606846976 1 2").count("points", 3).unwrap_err().to_string();
        assert!(error.starts_with("line 1: 1152921504606846976 points are announced, but"), "{error}");
        assert!(Text::new(b"-1 0").count("points", 3).is_err());
        assert!(Text::new(b"99999999999999999999 0").count("points", 3).is_err());
    }

    #[test]
    fn numbers_that_are_none_are_told_apart() {
        assert_eq!(parse_float(b"1.5d-3"), Some(1.5e-3));
        assert_eq!(parse_float(b"-Inf"), Some(f64::NEG_INFINITY));
        assert!(parse_float(b"nan").unwrap().is_nan());
        for bad in [&b"1e999"[..], b"1,5", b"", b"0x10", b"1.#QNAN", b"\xff"] {
            assert_eq!(parse_float(bad), None, "{}", quoted(bad));
        }
    }

    #[test]
    fn floats_come_back_bit_for_bit() {
        for x in [0.1, -0.0, 1.0 / 3.0, 5e-324, f64::MAX, 1e22, 123_456_789.123_456_79] {
            let mut out = Vec::new();
            push_float(&mut out, x);
            assert_eq!(parse_float(&out).map(f64::to_bits), Some(x.to_bits()));
        }
    }
}
