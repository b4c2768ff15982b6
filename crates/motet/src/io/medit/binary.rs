//! The binary form: numbered sections, each with the position where the next one begins.
//!
//! The number 1 in 32 bits determines the byte order; the version follows. Real numbers have 32 bits in
//! version 1, 64 in later versions; positions have 64 bits since version 3; counts, vertices and references
//! since version 4. Section numbers, the dimension, and the list of types of a solution have 32 bits in every
//! version.

use std::borrow::Cow;

use super::{END, name_of};
use crate::base::{Error, Result};

/// A position in a binary file.
pub(super) struct Binary<'a> {
    bytes: &'a [u8],
    at: usize,
    swapped: bool,
    version: i64,
    /// Where the next section begins: the end of the file if the section declares itself the last.
    next: usize,
}

impl<'a> Binary<'a> {
    /// Reads the head of a binary file, up to its version; `None` if the bytes are not in binary form.
    pub(super) fn new(bytes: &'a [u8]) -> Result<Option<Self>> {
        let swapped = match bytes.first_chunk::<4>().map(|&first| i32::from_ne_bytes(first)) {
            Some(1) => false,
            Some(0x0100_0000) => true,
            _ => return Ok(None),
        };
        let mut binary = Self { bytes, at: 4, swapped, version: 0, next: bytes.len() };
        binary.version = binary.fixed_i32("the version")?;
        if !(1..=4).contains(&binary.version) {
            return Err(binary
                .error(format!("expected format version 1 to 4, found {}", binary.version))
                .remedy("the file is damaged or in another format: get a new copy"));
        }
        Ok(Some(binary))
    }

    pub(super) fn section(&mut self) -> Result<Option<Cow<'static, str>>> {
        self.next = self.bytes.len();
        if self.at == self.bytes.len() {
            return Ok(None);
        }
        let number = self.fixed_i32("the number of a section")?;
        if number == i64::from(END.number) {
            return Ok(Some(Cow::Borrowed(END.name)));
        }
        let next = if self.version < 3 {
            self.fixed_i32("the position of the next section")?
        } else {
            self.int64("the position of the next section")?
        };
        self.next = match usize::try_from(next) {
            // The section declares itself the last.
            Ok(0) => self.bytes.len(),
            Ok(next) if (self.at..=self.bytes.len()).contains(&next) => next,
            _ => {
                return Err(self
                    .error(format!(
                        "section {number}: the position of the next section, byte {next}, is not between here and the end of the file, byte {}",
                        self.bytes.len()
                    ))
                    .remedy("the file is truncated or damaged: get a new copy"));
            }
        };
        let name = i32::try_from(number).ok().and_then(name_of);
        Ok(Some(name.map_or_else(|| Cow::Owned(format!("number {number}")), Cow::Borrowed)))
    }

    pub(super) fn end_section(&mut self) -> Result<()> {
        // `End` may still follow a section that declares itself the last.
        if self.next < self.bytes.len() && self.at != self.next {
            return Err(self
                .error(format!(
                    "the section ends here, but the file places the next one at byte {}",
                    self.next
                ))
                .remedy("the count of the section is wrong, or the file is damaged: write it again"));
        }
        Ok(())
    }

    pub(super) fn skip_section(&mut self) {
        self.at = self.next;
    }

    pub(super) fn count(&mut self, what: &str, n_ints: usize, n_floats: usize) -> Result<usize> {
        let n = self.int(&format!("the number of {what}"))?;
        let bytes_each = n_ints
            .saturating_mul(self.int_size())
            .saturating_add(n_floats.saturating_mul(self.float_size()))
            .max(1);
        let room = self.remaining() / bytes_each;
        usize::try_from(n).ok().filter(|&n| n <= room).ok_or_else(|| {
            self.error(format!("{n} {what} declared, but the rest of the section can hold at most {room}"))
                .remedy("the file is truncated or damaged: get a new copy")
        })
    }

    pub(super) fn int(&mut self, what: &str) -> Result<i64> {
        if self.version < 4 { self.fixed_i32(what) } else { self.int64(what) }
    }

    pub(super) fn fixed_i32(&mut self, what: &str) -> Result<i64> {
        let bits = u32::from_ne_bytes(self.take(what)?);
        Ok(i64::from((if self.swapped { bits.swap_bytes() } else { bits }) as i32))
    }

    pub(super) fn float(&mut self, what: &str) -> Result<f64> {
        if self.version > 1 {
            return self.int64(what).map(|bits| f64::from_bits(bits as u64));
        }
        self.fixed_i32(what).map(|bits| f32::from_bits(bits as u32).into())
    }

    fn int64(&mut self, what: &str) -> Result<i64> {
        let bits = u64::from_ne_bytes(self.take(what)?);
        Ok((if self.swapped { bits.swap_bytes() } else { bits }) as i64)
    }

    /// Number of bytes left in this section.
    pub(super) fn remaining(&self) -> usize {
        self.next - self.at
    }

    pub(super) fn float_size(&self) -> usize {
        if self.version == 1 { 4 } else { 8 }
    }

    fn int_size(&self) -> usize {
        if self.version < 4 { 4 } else { 8 }
    }

    pub(super) fn error(&self, what: impl Into<String>) -> Error {
        Error::input(what).at(format!("byte {}", self.at))
    }

    fn take<const N: usize>(&mut self, what: &str) -> Result<[u8; N]> {
        let Some(&bytes) = self.bytes[self.at..self.next].first_chunk::<N>() else {
            let of = if self.next < self.bytes.len() { "section" } else { "file" };
            return Err(self
                .error(format!("expected {what}, found the end of the {of}"))
                .remedy("the file is truncated or damaged: get a new copy"));
        };
        self.at += N;
        Ok(bytes)
    }
}
