//! The numbers of a glTF file: each range is checked against the bytes present before it is read.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::document::{Accessor, Document};
use crate::base::{Error, Result};

/// Component types by their codes, with their sizes in bytes.
const BYTE: (u32, usize) = (5121, 1);
const SHORT: (u32, usize) = (5123, 2);
const INT: (u32, usize) = (5125, 4);
const FLOAT: (u32, usize) = (5126, 4);

/// The buffers of a file.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    buffers: Vec<std::borrow::Cow<'a, [u8]>>,
}

impl<'a> Buffers<'a> {
    /// The buffers of a document: `binary` is the chunk of a binary file, others are inside the text.
    ///
    /// # Errors
    /// When a buffer is in a file of its own, or is not base64.
    pub(super) fn new(document: &'a Document, binary: Option<&'a [u8]>) -> Result<Self> {
        let mut buffers = Vec::new();
        for (i, buffer) in document.buffers.iter().enumerate() {
            let bytes = match (&buffer.uri, binary) {
                (None, Some(binary)) if i == 0 => binary.into(),
                (Some(uri), _) if uri.starts_with("data:") => {
                    let encoded = uri.split_once(";base64,").map_or("", |(_, encoded)| encoded);
                    STANDARD.decode(encoded).map_err(|_| damaged(format!("buffer {i} is not base64")))?.into()
                }
                (Some(_), _) => {
                    return Err(Error::input("the numbers are in a file of their own")
                        .at(format!("buffer {i}"))
                        .remedy("export the scene as .glb"));
                }
                (None, _) => return Err(damaged(format!("buffer {i} has no bytes"))),
            };
            buffers.push(bytes);
        }
        Ok(Self { document, buffers })
    }

    /// The rows of an accessor with `n` components of `size` bytes, after its range has been checked.
    fn rows(
        &self,
        id: usize,
        n: usize,
        size: usize,
    ) -> Result<(&Accessor, impl Iterator<Item = &[u8]> + '_)> {
        let wrong = |what: &str| damaged(format!("accessor {id}: {what}"));
        let accessor = self.document.accessors.get(id).ok_or_else(|| wrong("does not exist"))?;
        if accessor.sparse.is_some() {
            return Err(Error::input("sparse accessors are not read")
                .at(format!("accessor {id}"))
                .remedy("export the scene without morph targets"));
        }
        let view = accessor.buffer_view.and_then(|view| self.document.buffer_views.get(view));
        let view = view.ok_or_else(|| wrong("has no buffer view"))?;
        let buffer = self.buffers.get(view.buffer).ok_or_else(|| wrong("has no buffer"))?;
        let end = view.byte_offset.checked_add(view.byte_length).filter(|end| *end <= buffer.len());
        let bytes = end.map(|end| &buffer[view.byte_offset..end]);
        let bytes = bytes.ok_or_else(|| wrong("its view ends beyond the buffer"))?;
        let (row, stride) = (n * size, view.byte_stride.unwrap_or(n * size));
        if stride < row {
            return Err(wrong("its rows overlap"));
        }
        let last = accessor.count.checked_sub(1).and_then(|last| last.checked_mul(stride));
        let needed =
            last.and_then(|last| last.checked_add(row)).and_then(|n| n.checked_add(accessor.byte_offset));
        if accessor.count > 0 && needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(wrong("ends beyond its view"));
        }
        let start = move |i: usize| accessor.byte_offset + i * stride;
        Ok((accessor, (0..accessor.count).map(move |i| &bytes[start(i)..start(i) + row])))
    }

    /// Places, three numbers each.
    ///
    /// # Errors
    /// When they are not single-precision numbers, or lie beyond the bytes present.
    pub(super) fn places(&self, id: usize) -> Result<Vec<[f64; 3]>> {
        let (accessor, rows) = self.rows(id, 3, FLOAT.1)?;
        if (accessor.component_type, accessor.kind.as_str()) != (FLOAT.0, "VEC3") {
            return Err(damaged(format!("accessor {id}: places are three numbers of single precision")));
        }
        let number = |row: &[u8], k: usize| f32::from_le_bytes(std::array::from_fn(|i| row[4 * k + i]));
        Ok(rows.map(|row| [0, 1, 2].map(|k| f64::from(number(row, k)))).collect())
    }

    /// Numbers of vertices.
    ///
    /// # Errors
    /// When they are not whole numbers, or lie beyond the bytes present.
    pub(super) fn indices(&self, id: usize) -> Result<Vec<u32>> {
        let kind = self.document.accessors.get(id).map_or(0, |accessor| accessor.component_type);
        let sizes = [BYTE, SHORT, INT];
        let Some((_, size)) = sizes.into_iter().find(|(code, _)| *code == kind) else {
            return Err(damaged(format!("accessor {id}: numbers of vertices are whole numbers")));
        };
        let (_, rows) = self.rows(id, 1, size)?;
        let number = |row: &[u8]| row.iter().rev().fold(0, |sum, byte| sum << 8 | u32::from(*byte));
        Ok(rows.map(number).collect())
    }
}

/// The error for a file that contradicts itself.
pub(super) fn damaged(what: impl Into<String>) -> Error {
    Error::input(what).remedy("the file is damaged: export the scene again")
}
