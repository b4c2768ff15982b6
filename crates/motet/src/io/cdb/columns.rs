//! Numbers in columns of fixed width, as a Fortran format describes them.

use std::ops::Range;

/// Maximum number of columns of a row, more than any block has.
const MAX_COLUMNS: usize = 64;

/// Maximum width of a row.
const MAX_WIDTH: usize = 1 << 12;

/// The columns of a row.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Columns {
    /// The whole numbers and texts at the start of a row.
    pub(super) whole: Vec<Range<usize>>,
    /// The numbers after them.
    pub(super) real: Vec<Range<usize>>,
}

impl Columns {
    /// The columns of a format such as `(3i9,6e21.13e3)`; `None` if it is not one.
    pub(super) fn parse(format: &[u8]) -> Option<Self> {
        let text = std::str::from_utf8(format).ok()?.trim().to_ascii_lowercase();
        let inside = text.strip_prefix('(')?.split_once(')')?.0;
        let (mut columns, mut at) = (Self::default(), 0);
        for item in inside.split(',').map(str::trim) {
            let letter = item.find(|c: char| c.is_ascii_alphabetic())?;
            let (count, rest) = item.split_at(letter);
            let n: usize = if count.is_empty() { 1 } else { count.parse().ok()? };
            let digits = rest[1..].find(|c: char| !c.is_ascii_digit()).map_or(rest.len(), |end| end + 1);
            let width: usize = rest[1..digits].parse().ok().filter(|width| (1..MAX_WIDTH).contains(width))?;
            let to = match &rest[..1] {
                "i" | "a" => &mut columns.whole,
                "e" | "f" | "g" | "d" => &mut columns.real,
                _ => return None,
            };
            if to.len().saturating_add(n) > MAX_COLUMNS {
                return None;
            }
            for _ in 0..n {
                to.push(at..at + width);
                at += width;
            }
        }
        Some(columns)
    }
}

/// What a row has in a column, without blanks around; empty beyond the end of the row.
pub(super) fn field<'r>(row: &'r [u8], column: &Range<usize>) -> &'r [u8] {
    row.get(column.start..column.end.min(row.len())).unwrap_or_default().trim_ascii()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_give_columns() {
        let columns = Columns::parse(b" (2i9,I8,3e21.13e3) ").unwrap();
        assert_eq!(columns.whole, [0..9, 9..18, 18..26]);
        assert_eq!(columns.real, [26..47, 47..68, 68..89]);
        assert_eq!(Columns::parse(b"(i4)").unwrap().whole.first(), Some(&(0..4)));
        for bad in
            [&b"3i9"[..], b"(3i9", b"()", b"(3x9)", b"(i)", b"(99999999999i9)", b"(i99999999999)", b"\xff"]
        {
            assert_eq!(Columns::parse(bad), None, "{}", String::from_utf8_lossy(bad));
        }
    }

    #[test]
    fn fields_may_touch_or_be_missing() {
        assert_eq!(field(b"  12 345", &(0..4)), b"12");
        assert_eq!(field(b"  12 345", &(4..12)), b"345");
        assert_eq!(field(b"  12 345", &(8..12)), b"");
        assert_eq!(field(b"  12 345", &(9..12)), b"");
    }
}
