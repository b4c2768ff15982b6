//! The bytes of a classic netCDF file.

use super::layout::{Array, Content, Layout};
use crate::base::Result;
use crate::io::output::{Output, write_all};
use crate::io::scalar::write_big_values;

/// The largest size of an array with offsets of 64 bits only.
const MAX_SIZE: u64 = u32::MAX as u64 - 3;

const CHARACTERS: u32 = 2;
const WHOLE: u32 = 4;
const SINGLE: u32 = 5;
const DOUBLE: u32 = 6;

/// The header, with counts of 4 or 8 bytes.
struct Header {
    bytes: Vec<u8>,
    is_wide: bool,
}

impl Header {
    fn word(&mut self, word: u32) {
        self.bytes.extend(word.to_be_bytes());
    }

    fn count(&mut self, n: u64) {
        match self.is_wide {
            true => self.bytes.extend(n.to_be_bytes()),
            false => self.word(n as u32),
        }
    }

    fn padded(&mut self, bytes: &[u8]) {
        self.count(bytes.len() as u64);
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
    }

    fn text_attribute(&mut self, name: &str, text: &str) {
        self.padded(name.as_bytes());
        self.word(CHARACTERS);
        self.padded(text.as_bytes());
    }

    fn word_attribute(&mut self, name: &str, kind: u32, word: u32) {
        self.padded(name.as_bytes());
        self.word(kind);
        self.count(1);
        self.word(word);
    }
}

/// Writes a file whose first dimension is that over time.
pub(super) fn encode(layout: &Layout, output: &mut Output<'_>) -> Result<()> {
    let is_wide = layout.arrays.iter().any(|array| array.size() > MAX_SIZE);
    // Arrays over time come last, all of one step together.
    let mut arrays: Vec<&Array> = layout.arrays.iter().collect();
    arrays.sort_by_key(|array| array.is_over_time);
    let mut begins = vec![0; arrays.len()];
    let mut begin = header(layout, &arrays, &begins, is_wide).len() as u64;
    for (place, array) in begins.iter_mut().zip(&arrays) {
        *place = begin;
        begin += array.size();
    }
    write_all(output, &header(layout, &arrays, &begins, is_wide))?;
    for array in arrays {
        match &array.content {
            Content::Numbers(values) => write_big_values(output, values)?,
            Content::Texts(texts, width) => {
                let mut bytes = Vec::new();
                for text in texts {
                    let row = &text.as_bytes()[..text.len().min(width.saturating_sub(1))];
                    bytes.extend(row);
                    bytes.resize(bytes.len() + width - row.len(), 0);
                }
                bytes.resize(bytes.len().next_multiple_of(4), 0);
                write_all(output, &bytes)?;
            }
        }
    }
    Ok(())
}

fn header(layout: &Layout, arrays: &[&Array], begins: &[u64], is_wide: bool) -> Vec<u8> {
    let mut header = Header { bytes: b"CDF".to_vec(), is_wide };
    header.bytes.push(if is_wide { 5 } else { 2 });
    header.count(1);
    header.word(10);
    header.count(layout.dimensions.len() as u64);
    for (i, (name, length)) in layout.dimensions.iter().enumerate() {
        header.padded(name.as_bytes());
        header.count(if i == 0 { 0 } else { *length as u64 });
    }
    header.word(12);
    header.count(5);
    header.word_attribute("api_version", SINGLE, 5.14f32.to_bits());
    header.word_attribute("version", SINGLE, 5.14f32.to_bits());
    header.word_attribute("floating_point_word_size", WHOLE, 8);
    header.word_attribute("file_size", WHOLE, 1);
    header.text_attribute("title", "Mesh written by motet");
    header.word(11);
    header.count(arrays.len() as u64);
    for (array, &begin) in arrays.iter().zip(begins) {
        header.padded(array.name.as_bytes());
        header.count((array.dimensions.len() + usize::from(array.is_over_time)) as u64);
        if array.is_over_time {
            header.count(0);
        }
        array.dimensions.iter().for_each(|&dimension| header.count(dimension as u64));
        header.word(if array.attribute.is_some() { 12 } else { 0 });
        header.count(array.attribute.iter().len() as u64);
        if let Some([name, text]) = array.attribute {
            header.text_attribute(name, text);
        }
        header.word(match &array.content {
            Content::Texts(..) => CHARACTERS,
            Content::Numbers(crate::mesh::Values::I32(_)) => WHOLE,
            Content::Numbers(_) => DOUBLE,
        });
        header.count(array.size());
        header.bytes.extend(begin.to_be_bytes());
    }
    header.bytes
}
