//! Plain tables for people: aligned columns, numbers to the right.

use std::fmt;

/// A table; every row has as many cells as the header.
pub(crate) struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new<S: Into<String>>(head: impl IntoIterator<Item = S>) -> Self {
        Self { rows: vec![head.into_iter().map(Into::into).collect()] }
    }

    pub(crate) fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        let cells: Vec<String> = cells.into_iter().map(Into::into).collect();
        debug_assert_eq!(cells.len(), self.rows[0].len());
        self.rows.push(cells);
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = |column: usize| self.rows.iter().map(|r| r[column].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.rows[0].len()).map(width).collect();
        for (i, row) in self.rows.iter().enumerate() {
            let newline = if i == 0 { "" } else { "\n" };
            let mut line = String::new();
            for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
                let gap = if column == 0 { "  " } else { "   " };
                line += gap;
                line += &if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") };
            }
            write!(f, "{newline}{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// A number in few digits, for people.
pub(crate) fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".into()
    } else if (1e-3..1e6).contains(&size) {
        let decimals = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{x:.decimals$}")
    } else {
        format!("{x:.3e}")
    }
}

/// A time as given, apart from rounding.
pub(crate) fn time(t: f64) -> String {
    let rounded = (t * 1e6).round() / 1e6;
    if rounded == 0.0 { short(t) } else { rounded.to_string() }
}

/// A count with its thousands separated.
pub(crate) fn count(n: usize) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(' ');
        }
        out.push(digit);
    }
    out
}

/// A count with its noun: `1 frame`, `3 frames`.
pub(crate) fn counted(n: usize, noun: &str) -> String {
    format!("{} {noun}{}", count(n), if n == 1 { "" } else { "s" })
}

/// A duration in a suitable unit.
pub(crate) fn seconds(s: f64) -> String {
    match s {
        s if s >= 1.0 => format!("{s:.2} s"),
        s if s >= 1e-3 => format!("{:.1} ms", s * 1e3),
        s => format!("{:.0} us", s * 1e6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_and_numbers_stand_to_the_right() {
        let mut table = Table::new(["step", "eas"]);
        table.row(["1", "0.5"]);
        table.row(["10", "0.25"]);
        assert_eq!(table.to_string(), "  step    eas\n  1       0.5\n  10     0.25");
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(short(0.0), "0");
        assert_eq!(short(0.123456), "0.1235");
        assert_eq!(short(-1234.5), "-1234");
        assert_eq!(short(1e-9), "1.000e-9");
        assert_eq!(count(1234567), "1 234 567");
        assert_eq!(count(123), "123");
        assert_eq!([time(0.1 + 0.2), time(10.0), time(0.0)], ["0.3", "10", "0"]);
    }
}
