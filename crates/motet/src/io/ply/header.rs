//! The head of a PLY file: what follows, and in which form.

use std::collections::BTreeMap;

use crate::base::{Error, Result};
use crate::io::scalar::{ByteOrder, Scalar};
use crate::io::text::{Text, quoted};

/// What the file says of itself.
#[derive(Debug)]
pub(super) struct Header {
    /// `None`: text.
    pub(super) order: Option<ByteOrder>,
    pub(super) elements: Vec<Element>,
    /// From comments that this library writes.
    pub(super) patch_names: BTreeMap<i32, String>,
    /// Bytes that the head takes.
    pub(super) length: usize,
}

/// A kind of thing, and how many of it follow.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) n: usize,
    pub(super) properties: Vec<Property>,
}

/// A number of each thing, or a list of numbers.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Scalar,
    /// For a list the type of its length.
    pub(super) count: Option<Scalar>,
}

impl Property {
    /// How many bytes it takes at least.
    pub(super) fn smallest(&self, is_text: bool) -> usize {
        match is_text {
            true => 2,
            false => self.count.unwrap_or(self.kind).size(),
        }
    }
}

impl Header {
    pub(super) fn read(bytes: &[u8]) -> Result<Self> {
        let mut text = Text::new(bytes);
        if text.line().map(<[u8]>::trim_ascii_end) != Some(b"ply") {
            return Err(Error::input("a PLY file begins with a line `ply`")
                .at("line 1")
                .remedy("the file is damaged or no PLY: get it again"));
        }
        let mut header = Self { order: None, elements: Vec::new(), patch_names: BTreeMap::new(), length: 0 };
        let mut has_format = false;
        loop {
            match text.expect("`end_header`")? {
                b"format" => {
                    header.order = order(&mut text)?;
                    has_format = true;
                }
                b"comment" => header.comment(text.line().unwrap_or_default()),
                b"obj_info" => drop(text.line()),
                b"element" => {
                    let name = String::from_utf8_lossy(text.expect("the name of an element")?).into_owned();
                    let n = text.int("the number of elements")?;
                    let n = usize::try_from(n)
                        .map_err(|_| text.error(format!("{n} is no number of elements")))?;
                    header.elements.push(Element { name, n, properties: Vec::new() });
                }
                b"property" => {
                    let property = property(&mut text)?;
                    let Some(element) = header.elements.last_mut() else {
                        return Err(text.error("a property before the first element"));
                    };
                    element.properties.push(property);
                }
                b"end_header" => break,
                word => {
                    return Err(text
                        .unexpected("the head", "format, comment, element, property or end_header", word)
                        .remedy("the file is damaged: get it again"));
                }
            }
        }
        if !has_format {
            return Err(text.error("no line says the format").remedy("the file is damaged: get it again"));
        }
        text.line();
        header.length = text.position();
        Ok(header)
    }

    /// `patch 3 wall`
    fn comment(&mut self, line: &[u8]) {
        let line = String::from_utf8_lossy(line);
        let Some((id, name)) = line.trim().strip_prefix("patch ").and_then(|rest| rest.split_once(' '))
        else {
            return;
        };
        if let Ok(id) = id.parse() {
            self.patch_names.insert(id, name.to_owned());
        }
    }
}

fn order(text: &mut Text<'_>) -> Result<Option<ByteOrder>> {
    let word = text.expect("the format")?;
    let order = match word {
        b"ascii" => None,
        b"binary_little_endian" => Some(ByteOrder::Little),
        b"binary_big_endian" => Some(ByteOrder::Big),
        _ => {
            return Err(text
                .unexpected("the format", "ascii, binary_little_endian or binary_big_endian", word)
                .remedy("write the file in one of these"));
        }
    };
    text.expect("the version")?;
    Ok(order)
}

fn property(text: &mut Text<'_>) -> Result<Property> {
    let first = text.expect("the type of a property")?;
    let (count, kind) = match first {
        b"list" => (Some(scalar(text, None)?), scalar(text, None)?),
        word => (None, scalar(text, Some(word))?),
    };
    if count.is_some_and(|count| matches!(count, Scalar::F32 | Scalar::F64)) {
        return Err(text.error("the length of a list is a whole number"));
    }
    let name = String::from_utf8_lossy(text.expect("the name of a property")?).into_owned();
    Ok(Property { name, kind, count })
}

fn scalar(text: &mut Text<'_>, word: Option<&[u8]>) -> Result<Scalar> {
    let word = match word {
        Some(word) => word,
        None => text.expect("a type of number")?,
    };
    Ok(match word {
        b"char" | b"int8" => Scalar::I8,
        b"uchar" | b"uint8" => Scalar::U8,
        b"short" | b"int16" => Scalar::I16,
        b"ushort" | b"uint16" => Scalar::U16,
        b"int" | b"int32" => Scalar::I32,
        b"uint" | b"uint32" => Scalar::U32,
        b"float" | b"float32" => Scalar::F32,
        b"double" | b"float64" => Scalar::F64,
        _ => {
            return Err(text
                .error(format!("{} is no type of number of PLY", quoted(word)))
                .remedy("known: char, uchar, short, ushort, int, uint, float, double, and int8 to float64"));
        }
    })
}
