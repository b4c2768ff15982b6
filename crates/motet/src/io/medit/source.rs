//! Reads the numbers of a Medit file, whether text or binary.

use std::borrow::Cow;

use super::binary::Binary;
use super::{ALIASES, END};
use crate::base::{Error, Result};
use crate::io::text::Text;

/// A position in a Medit file.
pub(super) enum Source<'a> {
    Text(Text<'a>),
    Binary(Binary<'a>),
}

impl<'a> Source<'a> {
    /// Opens a file, detects its form from the first bytes, and reads its head.
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self> {
        match Binary::new(bytes)? {
            Some(binary) => Ok(Self::Binary(binary)),
            None => text(bytes).map(Self::Text),
        }
    }

    /// The name of the next section; `None` at the end of the file, since `End` may be missing.
    pub(super) fn section(&mut self) -> Result<Option<Cow<'static, str>>> {
        let text = match self {
            Self::Binary(binary) => return binary.section(),
            Self::Text(text) => text,
        };
        let Some(word) = text.word() else { return Ok(None) };
        if !word[0].is_ascii_alphabetic() {
            return Err(text
                .unexpected("section", "a name", word)
                .remedy("the count of the previous section is wrong, or the file is damaged"));
        }
        let name = String::from_utf8_lossy(word);
        let known = ALIASES.iter().find(|(other, _)| *other == name).map(|&(_, known)| known);
        Ok(Some(known.map_or(Cow::Owned(name.into_owned()), Cow::Borrowed)))
    }

    /// Ends a section that has been read.
    pub(super) fn end_section(&mut self) -> Result<()> {
        match self {
            Self::Text(_) => Ok(()),
            Self::Binary(binary) => binary.end_section(),
        }
    }

    /// Skips the section that has just begun.
    pub(super) fn skip_section(&mut self) {
        match self {
            Self::Binary(binary) => binary.skip_section(),
            Self::Text(text) => {
                while text.peek().is_some_and(|next| !next[0].is_ascii_alphabetic()) {
                    text.word();
                }
            }
        }
    }

    /// Reads the number of records that follow, each of `n_ints` integers and `n_floats` real numbers, and
    /// checks it against the remaining bytes.
    pub(super) fn count(&mut self, what: &str, n_ints: usize, n_floats: usize) -> Result<usize> {
        match self {
            Self::Text(text) => text.count(what, n_ints.saturating_add(n_floats)),
            Self::Binary(binary) => binary.count(what, n_ints, n_floats),
        }
    }

    /// Reads a vertex or a reference.
    pub(super) fn int(&mut self, what: &str) -> Result<i64> {
        match self {
            Self::Text(text) => text.int(what),
            Self::Binary(binary) => binary.int(what),
        }
    }

    /// Reads a reference.
    pub(super) fn int32(&mut self, what: &str) -> Result<i32> {
        let n = self.int(what)?;
        i32::try_from(n).map_err(|_| self.error(format!("{what} {n} does not fit in 32 bits")))
    }

    /// Reads the dimension, or the number or a type of the arrays of a solution: 32 bits in every version.
    pub(super) fn fixed_i32(&mut self, what: &str) -> Result<i64> {
        match self {
            Self::Text(text) => text.int(what),
            Self::Binary(binary) => binary.fixed_i32(what),
        }
    }

    /// Reads a coordinate or a value.
    pub(super) fn float(&mut self, what: &str) -> Result<f64> {
        match self {
            Self::Text(text) => text.float(what),
            Self::Binary(binary) => binary.float(what),
        }
    }

    /// Upper bound on the number of values in the rest of this section.
    pub(super) fn max_floats_left(&self) -> usize {
        match self {
            // A digit and a separator each.
            Self::Text(text) => text.rest().len().div_ceil(2),
            Self::Binary(binary) => binary.remaining() / binary.float_size(),
        }
    }

    /// An error at this position.
    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        match self {
            Self::Text(text) => text.error(what),
            Self::Binary(binary) => binary.error(what),
        }
    }
}

/// Whether this section name ends a file.
pub(super) fn is_end(name: &str) -> bool {
    name == END.name
}

/// Whether the bytes begin like a Medit file, in either form.
pub(super) fn is_medit(bytes: &[u8]) -> bool {
    matches!(Binary::new(bytes), Ok(Some(_))) || text(bytes).is_ok()
}

/// Opens the text form and reads its version.
fn text(bytes: &[u8]) -> Result<Text<'_>> {
    let mut text = Text::with_comments(bytes, b'#');
    match text.word() {
        Some(b"MeshVersionFormatted") => {}
        Some(word) => {
            return Err(text
                .unexpected("the first word", "`MeshVersionFormatted`, or the number 1 in binary files", word)
                .remedy("check the format of the file"));
        }
        None => return Err(text.unexpected_end("`MeshVersionFormatted`")),
    }
    let version = text.int("version")?;
    if !(0..=4).contains(&version) {
        return Err(text.error(format!("expected format version 1 to 4, found {version}")));
    }
    Ok(text)
}
