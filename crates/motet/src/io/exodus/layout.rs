//! What goes into a classic netCDF file: dimensions, arrays and their values.

use crate::mesh::Values;

/// The values of an array.
#[derive(Debug)]
pub(super) enum Content {
    /// Whole numbers of 32 bits, or numbers of double precision.
    Numbers(Values),
    /// Texts in rows of the given width.
    Texts(Vec<String>, usize),
}

/// An array; one over time has one step.
#[derive(Debug)]
pub(super) struct Array {
    pub(super) name: String,
    /// Numbers of dimensions, without that over time.
    pub(super) dimensions: Vec<usize>,
    pub(super) is_over_time: bool,
    pub(super) attribute: Option<[&'static str; 2]>,
    pub(super) content: Content,
}

/// A file.
#[derive(Debug, Default)]
pub(super) struct Layout {
    pub(super) dimensions: Vec<(String, usize)>,
    pub(super) arrays: Vec<Array>,
}

impl Layout {
    /// The number of a dimension, which is added under its name.
    pub(super) fn dimension(&mut self, name: impl Into<String>, length: usize) -> usize {
        self.dimensions.push((name.into(), length));
        self.dimensions.len() - 1
    }

    /// Adds an array of numbers.
    pub(super) fn numbers(
        &mut self,
        name: impl Into<String>,
        dimensions: &[usize],
        values: Values,
    ) -> &mut Array {
        self.add(name.into(), dimensions, Content::Numbers(values))
    }

    /// Adds texts in rows; the second dimension has the width of a row.
    pub(super) fn texts(&mut self, name: &str, dimensions: [usize; 2], texts: Vec<String>) {
        let width = self.dimensions[dimensions[1]].1;
        self.add(name.to_owned(), &dimensions, Content::Texts(texts, width));
    }

    fn add(&mut self, name: String, dimensions: &[usize], content: Content) -> &mut Array {
        self.arrays.push(Array {
            name,
            dimensions: dimensions.to_vec(),
            is_over_time: false,
            attribute: None,
            content,
        });
        let last = self.arrays.len() - 1;
        &mut self.arrays[last]
    }
}

impl Array {
    /// Number of bytes of its values, padded to whole words.
    pub(super) fn size(&self) -> u64 {
        let n = match &self.content {
            Content::Numbers(values @ Values::I32(_)) => 4 * values.len(),
            Content::Numbers(values) => 8 * values.len(),
            Content::Texts(texts, width) => texts.len() * width,
        };
        (n as u64).next_multiple_of(4)
    }
}
