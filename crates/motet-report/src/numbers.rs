//! Numbers formatted for people.

/// A number in few digits.
pub(crate) fn short(x: f64) -> String {
    let size = x.abs();
    if !x.is_finite() {
        "none".into()
    } else if x == 0.0 {
        "0".into()
    } else if x.fract() == 0.0 && size < 1e6 {
        format!("{x:.0}").replace('-', "\u{2212}")
    } else if (1e-3..1e6).contains(&size) {
        let decimals = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{x:.decimals$}").replace('-', "\u{2212}")
    } else {
        format!("{x:.3e}").replace('-', "\u{2212}")
    }
}

/// A count with its thousands separated.
pub(crate) fn count(n: usize) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            // A narrow no-break space.
            out.push('\u{202f}');
        }
        out.push(digit);
    }
    out
}

/// A count with its noun: `1 frame`, `3 frames`.
pub(crate) fn counted(n: usize, noun: &str) -> String {
    format!("{} {noun}{}", count(n), if n == 1 { "" } else { "s" })
}

/// A time as given, apart from rounding.
pub(crate) fn time(t: f64) -> String {
    let rounded = (t * 1e6).round() / 1e6;
    if rounded == 0.0 { short(t) } else { rounded.to_string().replace('-', "\u{2212}") }
}

/// A size in bytes as megabytes.
pub(crate) fn megabytes(bytes: usize) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [short(0.123456), short(-1234.5), short(1e-9)],
            ["0.1235", "\u{2212}1234", "1.000e\u{2212}9"]
        );
        assert_eq!([short(12.0), short(f64::NAN), time(0.1 + 0.2)], ["12", "none", "0.3"]);
        assert_eq!(counted(1234567, "tet"), "1\u{202f}234\u{202f}567 tets");
        assert_eq!(counted(1, "tet"), "1 tet");
    }
}
