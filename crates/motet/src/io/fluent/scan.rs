//! Sections: an index, numbers between brackets, and a body of text or of bytes.

use crate::base::{Error, Result};
use crate::io::text::{Text, find_subslice, parse_float, parse_int, quoted};

/// What follows the bytes of a binary section.
const END_OF_BINARY: &[u8] = b"End of Binary Section";

/// Whether bytes begin with a section.
pub(in crate::io) fn has_sections(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    start.first() == Some(&b'(') && start[1..].trim_ascii_start().first().is_some_and(u8::is_ascii_digit)
}

/// How the numbers of a section are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Storage {
    Text,
    /// Bytes, little end first; numbers that are not whole in single precision.
    Single,
    /// Bytes, little end first; numbers that are not whole in double precision.
    Double,
}

/// A position in a file.
#[derive(Clone)]
pub(super) struct Scan<'a> {
    text: Text<'a>,
}

impl<'a> Scan<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { text: Text::new(bytes) }
    }

    fn skip_blanks(&mut self) -> &'a [u8] {
        let rest = self.text.rest();
        let n = rest.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(rest.len());
        self.text.set_position(self.text.position() + n);
        self.text.rest()
    }

    fn advance(&mut self, n: usize) {
        self.text.set_position(self.text.position() + n);
    }

    /// Number of bytes left.
    pub(super) fn n_left(&self) -> usize {
        self.text.rest().len()
    }

    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        self.unsupported(what).remedy("the file is truncated or damaged: get a new copy")
    }

    /// The error for what a valid file may have.
    pub(super) fn unsupported(&self, what: impl Into<String>) -> Error {
        self.text.error(what)
    }

    /// Whether a bracket opens here.
    pub(super) fn opens(&mut self) -> bool {
        self.skip_blanks().first() == Some(&b'(')
    }

    /// Whether nothing is left.
    pub(super) fn is_at_end(&mut self) -> bool {
        self.skip_blanks().is_empty()
    }

    /// Reads a bracket.
    pub(super) fn expect(&mut self, bracket: u8) -> Result<()> {
        let rest = self.skip_blanks();
        if rest.first() == Some(&bracket) {
            self.advance(1);
            return Ok(());
        }
        let expected = format!("`{}`", char::from(bracket));
        match self.peek() {
            [] => Err(self.text.unexpected_end(&expected)),
            word => Err(self.error(format!("expected {expected}, found {}", quoted(word)))),
        }
    }

    /// The next word, or a bracket; empty at the end.
    fn peek(&mut self) -> &'a [u8] {
        let rest = self.skip_blanks();
        let is_end = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, b'(' | b')');
        let n = rest.iter().position(is_end).unwrap_or(rest.len());
        &rest[..n.max(1).min(rest.len())]
    }

    /// Reads a word; an error for a bracket and at the end.
    pub(super) fn word(&mut self, what: &str) -> Result<&'a [u8]> {
        match self.peek() {
            [] => Err(self.text.unexpected_end(what)),
            word @ [b'(' | b')', ..] => Err(self.error(format!("expected {what}, found {}", quoted(word)))),
            word => {
                self.advance(word.len());
                Ok(word)
            }
        }
    }

    /// Reads the index of a section: its kind and how its numbers are stored.
    pub(super) fn index(&mut self) -> Result<(u32, Storage)> {
        let word = self.word("the index of a section")?;
        let index = parse_int(word).and_then(|n| u32::try_from(n).ok());
        let index = index
            .ok_or_else(|| self.error(format!("expected the index of a section, found {}", quoted(word))))?;
        Ok(match index {
            2000..3000 => (index - 2000, Storage::Single),
            3000..4000 => (index - 3000, Storage::Double),
            index => (index, Storage::Text),
        })
    }

    /// Reads a decimal number.
    pub(super) fn decimal(&mut self, what: &str) -> Result<i64> {
        let word = self.word(what)?;
        parse_int(word)
            .ok_or_else(|| self.error(format!("{what}: expected a whole number, found {}", quoted(word))))
    }

    /// Reads a hexadecimal number.
    pub(super) fn hexadecimal(&mut self, what: &str) -> Result<i64> {
        let word = self.word(what)?;
        let number = std::str::from_utf8(word).ok().and_then(|word| i64::from_str_radix(word, 16).ok());
        number.ok_or_else(|| {
            self.error(format!("{what}: expected a hexadecimal number, found {}", quoted(word)))
        })
    }

    fn float(&mut self, what: &str) -> Result<f64> {
        let word = self.word(what)?;
        parse_float(word)
            .ok_or_else(|| self.error(format!("{what}: expected a number, found {}", quoted(word))))
    }

    /// Reads the hexadecimal numbers between brackets at the start of a section.
    pub(super) fn header(&mut self) -> Result<Vec<i64>> {
        self.expect(b'(')?;
        let mut numbers = Vec::new();
        while self.peek() != b")" {
            numbers.push(self.hexadecimal("number of a section")?);
        }
        self.expect(b')')?;
        Ok(numbers)
    }

    /// Skips the rest of a section, after its index.
    pub(super) fn skip_section(&mut self, storage: Storage) -> Result<()> {
        if storage != Storage::Text
            && let Some(at) = find_subslice(self.text.rest(), END_OF_BINARY)
        {
            self.advance(at + END_OF_BINARY.len());
        }
        self.skip_brackets(1)
    }

    /// Skips up to and with the bracket that closes `depth` brackets. Brackets in texts do not count.
    pub(super) fn skip_brackets(&mut self, mut depth: usize) -> Result<()> {
        let mut is_text = false;
        let mut is_escaped = false;
        for (i, &byte) in self.text.rest().iter().enumerate() {
            match byte {
                _ if is_escaped => is_escaped = false,
                b'\\' if is_text => is_escaped = true,
                b'"' => is_text = !is_text,
                b'(' if !is_text => depth += 1,
                b')' if !is_text => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                self.advance(i + 1);
                return Ok(());
            }
        }
        self.advance(self.n_left());
        Err(self.text.unexpected_end("`)` at the end of a section"))
    }

    /// Reads the body of a section, which `read` reads number by number, and the end of the section.
    pub(super) fn body<T>(
        &mut self,
        storage: Storage,
        mut read: impl FnMut(&mut Numbers<'_, 'a>) -> Result<T>,
    ) -> Result<T> {
        self.expect(b'(')?;
        if storage == Storage::Text {
            let content = read(&mut Numbers { scan: self, storage })?;
            self.expect(b')')?;
            self.expect(b')')?;
            return Ok(content);
        }
        // The bytes follow the bracket; some programs break the line before.
        let n_breaks =
            self.text.rest().iter().take(2).take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        let mut first = None;
        for skipped in [0, n_breaks] {
            let mut ahead = self.clone();
            ahead.advance(skipped);
            let result = read(&mut Numbers { scan: &mut ahead, storage });
            let result = result.and_then(|content| ahead.end_of_binary().map(|()| content));
            match result {
                Ok(content) => {
                    *self = ahead;
                    return Ok(content);
                }
                Err(error) => first = first.or(Some(error)),
            }
        }
        Err(first.unwrap_or_else(|| self.error("the section cannot be read")))
    }

    fn end_of_binary(&mut self) -> Result<()> {
        self.expect(b')')?;
        if !self.skip_blanks().starts_with(END_OF_BINARY) {
            return Err(self.error("the bytes of a binary section are not followed by their end"));
        }
        self.skip_brackets(1)
    }
}

/// The numbers of the body of a section.
pub(super) struct Numbers<'s, 'a> {
    scan: &'s mut Scan<'a>,
    storage: Storage,
}

impl<'a> Numbers<'_, 'a> {
    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        self.scan.error(what)
    }

    /// Checks that the rest of the file can hold `n` rows of `each` numbers, of which each takes at least
    /// `size` bytes in binary.
    pub(super) fn check(&self, n: usize, each: usize, size: usize, what: &str) -> Result<()> {
        let bytes_each = if self.storage == Storage::Text { 2 } else { size };
        let room = (self.scan.n_left() + 1) / (bytes_each * each);
        if n <= room {
            return Ok(());
        }
        Err(self.scan.error(format!("{n} {what} declared, but the rest of the file can hold at most {room}")))
    }

    fn bytes<const N: usize>(&mut self, what: &str) -> Result<[u8; N]> {
        let bytes = self.scan.text.rest().first_chunk::<N>().copied();
        self.scan.advance(N);
        bytes.ok_or_else(|| self.scan.text.unexpected_end(what))
    }

    /// A number of double precision, or as the section stores it.
    pub(super) fn float(&mut self, what: &str) -> Result<f64> {
        match self.storage {
            Storage::Text => self.scan.float(what),
            Storage::Single => Ok(f64::from(f32::from_le_bytes(self.bytes(what)?))),
            Storage::Double => Ok(f64::from_le_bytes(self.bytes(what)?)),
        }
    }

    /// A whole number, of 32 bits in binary.
    pub(super) fn int(&mut self, what: &str) -> Result<i64> {
        match self.storage {
            Storage::Text => self.scan.hexadecimal(what),
            _ => Ok(i64::from(i32::from_le_bytes(self.bytes(what)?))),
        }
    }

    /// A whole number, of 64 bits in binary sections of double precision, as meshio writes it.
    pub(super) fn wide_int(&mut self, what: &str) -> Result<i64> {
        match self.storage {
            Storage::Double => Ok(i64::from_le_bytes(self.bytes(what)?)),
            _ => self.int(what),
        }
    }
}
