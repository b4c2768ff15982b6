//! Compact encoding of tables of integers: differences, bytes grouped by significance, zlib.
//!
//! `script/unpack.js` of the page decodes it.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// What the numbers of a table are, and so which differences are small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Each number as it is: values of cells, which say little about their neighbours.
    Plain,
    /// Each number minus the one above it: positions and values of nearby points.
    Steps,
    /// The first of a row minus the one above it, the others minus the one before them: vertex ids of cells
    /// in ascending order.
    Ids,
}

impl Kind {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Steps => "steps",
            Self::Ids => "ids",
        }
    }
}

/// A packed table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Block {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    /// How many bytes of each number are stored; the higher ones are 0 everywhere.
    pub(crate) planes: usize,
    pub(crate) kind: Kind,
    pub(crate) data: Vec<u8>,
}

impl Block {
    /// Packs rows of `N` numbers.
    pub(crate) fn of<const N: usize>(kind: Kind, rows: &[[u32; N]]) -> Self {
        let columns: Vec<Vec<u32>> = (0..N).map(|column| differences(kind, rows, column)).collect();
        let highest = columns.iter().flatten().fold(0, |bits, x| bits | x);
        let planes = (4 - highest.leading_zeros() as usize / 8).max(1);
        let mut bytes = Vec::with_capacity(rows.len() * N * planes);
        for column in &columns {
            for plane in 0..planes {
                bytes.extend(column.iter().map(|x| (x >> (8 * plane)) as u8));
            }
        }
        Self { rows: rows.len(), columns: N, planes, kind, data: deflated(&bytes) }
    }

    /// Packs one column.
    pub(crate) fn column(kind: Kind, values: &[u32]) -> Self {
        Self::of(kind, values.as_chunks::<1>().0)
    }

    /// The number of bytes it takes on the page, as base64 with its description.
    pub(crate) fn cost(&self) -> usize {
        self.data.len().div_ceil(3) * 4 + 80
    }
}

fn differences<const N: usize>(kind: Kind, rows: &[[u32; N]], column: usize) -> Vec<u32> {
    let mut above = 0u32;
    let mut less_above = |x: u32| {
        let difference = zigzag(x.wrapping_sub(above));
        above = x;
        difference
    };
    match kind {
        Kind::Plain => rows.iter().map(|row| row[column]).collect(),
        Kind::Ids if column > 0 => {
            rows.iter().map(|row| zigzag(row[column].wrapping_sub(row[column - 1]))).collect()
        }
        Kind::Ids | Kind::Steps => rows.iter().map(|row| less_above(row[column])).collect(),
    }
}

/// Maps small numbers of either sign to small unsigned ones: 0, -1, 1, -2, ... to 0, 1, 2, 3, ...
fn zigzag(difference: u32) -> u32 {
    (difference << 1) ^ (difference.cast_signed() >> 31).cast_unsigned()
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(6));
    // Writing to a vector cannot fail.
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}

#[cfg(test)]
pub(crate) mod tests {
    use std::io::Read as _;

    use super::*;

    /// Does what `script/unpack.js` does.
    pub(crate) fn unpacked(block: &Block) -> Vec<Vec<u32>> {
        let mut bytes = Vec::new();
        flate2::read::ZlibDecoder::new(&block.data[..]).read_to_end(&mut bytes).unwrap();
        assert_eq!(bytes.len(), block.rows * block.columns * block.planes);
        let mut rows = vec![vec![0u32; block.columns]; block.rows];
        for column in 0..block.columns {
            let mut above = 0u32;
            for row in 0..block.rows {
                let byte = |plane| {
                    u32::from(bytes[(column * block.planes + plane) * block.rows + row]) << (8 * plane)
                };
                let coded = (0..block.planes).fold(0, |x, plane| x | byte(plane));
                let difference = (coded >> 1) ^ (coded & 1).wrapping_neg();
                let before = if column > 0 { rows[row][column - 1] } else { 0 };
                rows[row][column] = match block.kind {
                    Kind::Plain => coded,
                    Kind::Ids if column > 0 => before.wrapping_add(difference),
                    _ => above.wrapping_add(difference),
                };
                above = rows[row][column];
            }
        }
        rows
    }

    #[test]
    fn what_is_packed_is_unpacked() {
        let rows = [[0, 5, u32::MAX], [7, 3, 0], [u32::MAX, 0, 1], [1 << 20, 2, 3]];
        for kind in [Kind::Plain, Kind::Steps, Kind::Ids] {
            assert_eq!(unpacked(&Block::of(kind, &rows)), rows, "{kind:?}");
            assert_eq!(unpacked(&Block::of::<3>(kind, &[])), Vec::<Vec<u32>>::new());
        }
    }

    #[test]
    fn small_differences_take_one_byte() {
        let rows: Vec<[u32; 2]> = (0..1000).map(|i| [1_000_000 + i, 1_000_050 + i]).collect();
        let block = Block::of(Kind::Ids, &rows[1..]);
        assert!(block.planes <= 3 && block.cost() < 300, "{block:?}");
    }
}
