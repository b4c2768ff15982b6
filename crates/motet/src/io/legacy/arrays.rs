//! Arrays of a legacy VTK file: types, names and metadata.

use crate::base::{Error, Result};
use crate::io::latin::decode_utf8_or_latin1;
use crate::io::legacy::source::{Source, truncated};
use crate::io::scalar::Scalar;
use crate::mesh::Values;

/// A type of values, as named in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Type {
    Number(Scalar),
    /// VTK's ids: 32 bits in binary files, 64 in memory.
    Id,
    Bit,
    Text,
}

impl Type {
    pub(super) fn parse(source: &Source<'_>, word: &str) -> Result<Self> {
        Ok(match word.to_ascii_lowercase().as_str() {
            "bit" => Self::Bit,
            "char" | "signed_char" | "vtktypeint8" => Self::Number(Scalar::I8),
            "unsigned_char" | "vtktypeuint8" => Self::Number(Scalar::U8),
            "short" | "vtktypeint16" => Self::Number(Scalar::I16),
            "unsigned_short" | "vtktypeuint16" => Self::Number(Scalar::U16),
            "int" | "vtktypeint32" => Self::Number(Scalar::I32),
            "unsigned_int" | "vtktypeuint32" => Self::Number(Scalar::U32),
            // 64 bits except on Windows, where VTK writes the unambiguous names instead.
            "long" | "vtktypeint64" | "__int64" => Self::Number(Scalar::I64),
            "unsigned_long" | "vtktypeuint64" | "unsigned___int64" => Self::Number(Scalar::U64),
            "float" | "vtktypefloat32" => Self::Number(Scalar::F32),
            "double" | "vtktypefloat64" => Self::Number(Scalar::F64),
            "vtkidtype" => Self::Id,
            "string" | "utf8_string" => Self::Text,
            _ => {
                return Err(Error::input(format!("unknown value type `{}`", truncated(word)))
                    .at(source.place())
                    .remedy(
                        "supported: bit, char, short, int, long (each also with unsigned_), float, double, string",
                    ));
            }
        })
    }
}

/// Reads the next `n` values.
pub(super) fn values(source: &mut Source<'_>, kind: Type, n: usize) -> Result<Values> {
    match kind {
        Type::Number(kind) => source.numbers(kind, n),
        Type::Id if source.binary => match source.numbers(Scalar::I32, n)? {
            Values::I32(ids) => Ok(Values::I64(ids.into_iter().map(i64::from).collect())),
            other => Ok(other),
        },
        Type::Id => source.numbers(Scalar::I64, n),
        Type::Bit if source.binary => {
            source.start_data();
            let bytes = source.take_bytes(n.div_ceil(8))?;
            Ok(Values::U8((0..n).map(|i| bytes[i / 8] >> (7 - i % 8) & 1).collect()))
        }
        Type::Bit => source.numbers(Scalar::U8, n),
        Type::Text => texts(source, n),
    }
}

fn texts(source: &mut Source<'_>, n: usize) -> Result<Values> {
    source.start_data();
    let mut texts = Vec::new();
    for _ in 0..n {
        texts.push(if source.binary {
            let n = text_length(source)?;
            decode_utf8_or_latin1(source.take_bytes(n)?)
        } else {
            let line = source.line();
            decode(line.ok_or_else(|| source.error(format!("expected {n} texts, found {}", texts.len())))?)
        });
    }
    Ok(Values::Text(texts))
}

/// Reads the length of a text in a binary file: the two highest bits of the first byte give the number of
/// bytes of the length (3: one, 2: two, 1: four, 0: eight).
fn text_length(source: &mut Source<'_>) -> Result<usize> {
    let first = source.take_bytes(1)?[0];
    let more = match first >> 6 {
        3 => 0,
        2 => 1,
        1 => 3,
        _ => 7,
    };
    let rest = source.take_bytes(more)?;
    Ok(rest.iter().fold(usize::from(first & 63), |n, &b| n << 8 | usize::from(b)))
}

/// Encodes the length of a text for a binary file.
pub(super) fn encode_length(n: usize) -> Vec<u8> {
    match n {
        0..64 => vec![3 << 6 | n as u8],
        64..0x4000 => (2 << 14 | n as u16).to_be_bytes().to_vec(),
        0x4000..0x4000_0000 => (1 << 30 | n as u32).to_be_bytes().to_vec(),
        _ => (n as u64).to_be_bytes().to_vec(),
    }
}

/// Decodes a name or text, in which `%20` is a blank and so on.
pub(super) fn decode(text: &[u8]) -> String {
    let digit = |b: Option<&u8>| b.and_then(|&b| char::from(b).to_digit(16));
    let mut bytes = Vec::with_capacity(text.len());
    let mut i = 0;
    while i < text.len() {
        match (text[i], digit(text.get(i + 1)), digit(text.get(i + 2))) {
            (b'%', Some(high), Some(low)) => {
                bytes.push((high * 16 + low) as u8);
                i += 3;
            }
            (byte, ..) => {
                bytes.push(byte);
                i += 1;
            }
        }
    }
    decode_utf8_or_latin1(&bytes)
}

/// Encodes a text for [`decode`], escaping the same characters as VTK.
pub(super) fn encode(text: &str) -> String {
    let plain = |b: u8| (33..=126).contains(&b) && b != b'"' && b != b'%';
    text.bytes().map(|b| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") }).collect()
}

/// Skips a `METADATA` block after an array of `components`; the block ends with a blank line, but names of
/// components may be blank too. Returns whether there were component names.
pub(super) fn skip_metadata(source: &mut Source<'_>, components: usize) -> bool {
    let mut named = false;
    while source.peek().eq_ignore_ascii_case(b"METADATA") {
        source.word();
        source.line();
        while let Some(line) = source.line().filter(|line| !line.trim_ascii().is_empty()) {
            if line.trim_ascii().eq_ignore_ascii_case(b"COMPONENT_NAMES") {
                named = true;
                // Stops at the end of the file, whatever the declared number.
                let _ = (0..components).try_for_each(|_| source.line().map(|_| ()));
            }
        }
    }
    named
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip() {
        for name in ["plain", "my vec %", "", "é\n\t\"", "%zz%2"] {
            assert_eq!(decode(encode(name).as_bytes()), name);
        }
        assert_eq!(encode("a b%"), "a%20b%25");
        assert_eq!(decode(b"100%"), "100%");
    }

    #[test]
    fn text_lengths_round_trip() {
        for n in [0, 63, 64, 0x3fff, 0x4000, 0x3fff_ffff, 0x4000_0000] {
            let bytes = encode_length(n);
            let mut source = Source::new(&bytes);
            assert_eq!(text_length(&mut source).unwrap(), n);
        }
    }
}
