//! Reads the numbers of an MSH file, as text or binary in either byte order.

use crate::base::{Error, Result};
use crate::io::text::{Text, find_subslice, quoted};

/// How numbers are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Ascii,
    Binary {
        /// Whether the byte order differs from that of this machine.
        swapped: bool,
    },
}

/// A position in an MSH file.
pub(super) struct Source<'a> {
    pub(super) text: Text<'a>,
    pub(super) form: Form,
    /// Size in bytes of a `size_t` on the machine that wrote the file.
    pub(super) size_bytes: usize,
}

impl<'a> Source<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { text: Text::new(bytes), form: Form::Ascii, size_bytes: 8 }
    }

    /// Reads the name of the next section with its line; `None` at the end of the file.
    pub(super) fn section(&mut self) -> Result<Option<String>> {
        let Some(word) = self.text.word() else { return Ok(None) };
        let name = word.strip_prefix(b"$").filter(|name| !name.starts_with(b"End"));
        let Some(name) = name.and_then(|name| std::str::from_utf8(name).ok()) else {
            return Err(self.error(format!("expected the start of a section ($...), found {}", quoted(word))));
        };
        self.text.line();
        Ok(Some(name.to_owned()))
    }

    /// Reads `$End...` of a section.
    pub(super) fn end_section(&mut self, name: &str) -> Result<()> {
        let end = format!("$End{name}");
        match self.text.word() {
            Some(word) if word == end.as_bytes() => Ok(()),
            Some(word) => Err(self
                .error(format!("expected {end}, found {}", quoted(word)))
                .remedy("the count of the section is wrong, or the file is damaged: write it again")),
            None => Err(self.unexpected_end(&end)),
        }
    }

    /// Skips the section that has just begun.
    pub(super) fn skip_section(&mut self, name: &str) -> Result<()> {
        let end = format!("$End{name}");
        let Some(at) = find_subslice(self.text.rest(), end.as_bytes()) else {
            return Err(self.unexpected_end(&end));
        };
        self.text.set_position(self.text.position() + at);
        self.end_section(name)
    }

    /// Reads a C `int`.
    pub(super) fn int(&mut self, what: &str) -> Result<i32> {
        match self.form {
            Form::Ascii => self.text.int32(what),
            Form::Binary { swapped } => self.take(what).map(|bytes| {
                if swapped { i32::from_ne_bytes(bytes).swap_bytes() } else { i32::from_ne_bytes(bytes) }
            }),
        }
    }

    /// Reads a C `size_t`: a tag or a count.
    pub(super) fn size(&mut self, what: &str) -> Result<u64> {
        match self.form {
            Form::Ascii => {
                let n = self.text.int(what)?;
                u64::try_from(n).map_err(|_| self.error(format!("{what} is negative: {n}")))
            }
            Form::Binary { swapped } if self.size_bytes == 4 => {
                let n = u32::from_ne_bytes(self.take(what)?);
                Ok(u64::from(if swapped { n.swap_bytes() } else { n }))
            }
            Form::Binary { swapped } => {
                let n = u64::from_ne_bytes(self.take(what)?);
                Ok(if swapped { n.swap_bytes() } else { n })
            }
        }
    }

    /// Reads a C `double`.
    pub(super) fn double(&mut self, what: &str) -> Result<f64> {
        match self.form {
            Form::Ascii => self.text.float(what),
            Form::Binary { swapped } => {
                let bits = u64::from_ne_bytes(self.take(what)?);
                Ok(f64::from_bits(if swapped { bits.swap_bytes() } else { bits }))
            }
        }
    }

    /// Reads the coordinates of a point.
    pub(super) fn point(&mut self) -> Result<[f64; 3]> {
        Ok([self.double("coordinate x")?, self.double("coordinate y")?, self.double("coordinate z")?])
    }

    /// Reads a number of items as a `size_t`; see [`Self::checked_count`].
    pub(super) fn count(&mut self, what: &str, numbers_each: usize) -> Result<usize> {
        let n = self.size(&format!("the number of {what}"))?;
        self.checked_count(n, what, numbers_each)
    }

    /// Reads a number of items as an `int`; see [`Self::checked_count`].
    pub(super) fn int_count(&mut self, what: &str, numbers_each: usize) -> Result<usize> {
        let n = self.int(&format!("the number of {what}"))?;
        let n = u64::try_from(n).map_err(|_| self.error(format!("the number of {what} is negative: {n}")))?;
        self.checked_count(n, what, numbers_each)
    }

    /// `n` as a number of items, each of at least `numbers_each` numbers, checked against the remaining
    /// bytes.
    pub(super) fn checked_count(&self, n: u64, what: &str, numbers_each: usize) -> Result<usize> {
        let bytes_per_number = if self.form == Form::Ascii { 2 } else { 4 };
        let room = (self.text.rest().len() + 1) / (bytes_per_number * numbers_each).max(1);
        usize::try_from(n).ok().filter(|&n| n <= room).ok_or_else(|| {
            self.error(format!("{n} {what} declared, but the rest of the file can hold at most {room}"))
                .remedy("the file is truncated or damaged: get a new copy")
        })
    }

    /// An error at this position.
    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        match self.form {
            Form::Ascii => self.text.error(what),
            Form::Binary { .. } => Error::input(what).at(format!("byte {}", self.text.position())),
        }
    }

    fn unexpected_end(&self, what: &str) -> Error {
        self.error(format!("expected {what}, found the end of the file"))
            .remedy("the file is truncated: get a new copy")
    }

    fn take<const N: usize>(&mut self, what: &str) -> Result<[u8; N]> {
        let Some(&bytes) = self.text.rest().first_chunk::<N>() else {
            return Err(self.unexpected_end(what));
        };
        self.text.set_position(self.text.position() + N);
        Ok(bytes)
    }
}
