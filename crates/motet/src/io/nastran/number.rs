//! Numbers in fields: an exponent may lack its letter.

use crate::io::text::parse_float;

/// The longest field.
const WIDTH: usize = 16;

/// Parses numbers such as `1.5`, `1.5E-3`, `1.5D-3` and `1.5-3`.
pub(super) fn parse_real(field: &[u8]) -> Option<f64> {
    parse_float(field).or_else(|| {
        let sign = field.iter().skip(1).position(|byte| matches!(byte, b'+' | b'-'))? + 1;
        let (mantissa, exponent) = field.split_at(sign);
        parse_float(&[mantissa, b"e", exponent].concat())
    })
}

/// A number in at most 16 characters, as near as that allows, and whether it is the same to the bit.
pub(super) fn real(x: f64) -> (String, bool) {
    if !x.is_finite() {
        return (format!("{x:?}"), true);
    }
    let short = [format!("{x:?}").replace('e', "E"), exponential(&format!("{x:E}"))];
    if let Some(short) = short.into_iter().find(|text| text.len() <= WIDTH && text.contains('.')) {
        return (short, true);
    }
    let fixed = (0..WIDTH).rev().map(|n| without_zero(&format!("{x:.n$}"))).find(|text| text.len() <= WIDTH);
    let letterless = |text: String| text.replace("E-", "-").replace('E', "+");
    let exponential = (1..WIDTH)
        .rev()
        .map(|n| letterless(exponential(&format!("{x:.n$E}"))))
        // The largest numbers must not be rounded up.
        .find(|text| text.len() <= WIDTH && parse_real(text.as_bytes()).is_some());
    let error = |text: &String| parse_real(text.as_bytes()).map_or(f64::INFINITY, |found| (found - x).abs());
    let best = fixed.into_iter().chain(exponential).filter(|text| text.contains('.'));
    let best = best.min_by(|a, b| error(a).total_cmp(&error(b))).unwrap_or_default();
    let is_same = parse_real(best.as_bytes()).map(f64::to_bits) == Some(x.to_bits());
    (best, is_same)
}

/// Puts the point, which each real number must have, behind the digits before the exponent.
fn exponential(text: &str) -> String {
    match text.split_once('E') {
        Some((mantissa, exponent)) if !mantissa.contains('.') => format!("{mantissa}.E{exponent}"),
        _ => text.to_owned(),
    }
}

fn without_zero(text: &str) -> String {
    match text.strip_prefix("-0.") {
        Some(digits) => format!("-.{digits}"),
        None => text.strip_prefix("0.").map_or_else(|| text.to_owned(), |digits| format!(".{digits}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_may_lack_their_letter() {
        for (field, x) in [
            ("1.5-3", 1.5e-3),
            ("-1.5+3", -1.5e3),
            ("-.15E2", -15.0),
            ("7.", 7.0),
            ("1.5D-3", 1.5e-3),
            ("2", 2.0),
        ] {
            assert_eq!(parse_real(field.as_bytes()), Some(x), "{field}");
        }
        for field in ["", "-", "1.5-", "a-3", "1.5-3-3", "1.5E-3+2"] {
            assert_eq!(parse_real(field.as_bytes()), None, "{field}");
        }
    }

    #[test]
    fn numbers_fit_fields_with_as_many_digits_as_possible() {
        for (x, field) in [
            (0.1, "0.1"),
            (-0.0, "-0.0"),
            (1e300, "1.E300"),
            (1.5e-7, "1.5E-7"),
            (1.0 / 3.0, ".333333333333333"),
            (-1.0 / 3.0, "-.33333333333333"),
            (-1e-5 / 3.0, "-3.33333333333-6"),
            (1e10 / 3.0, "3333333333.33333"),
            (f64::MAX, "1.79769313+308"),
        ] {
            let (found, is_same) = real(x);
            assert!(found.len() <= WIDTH, "{found}");
            assert_eq!(is_same, parse_real(found.as_bytes()) == Some(x), "{found}");
            let error = (parse_real(found.as_bytes()).unwrap() - x).abs();
            assert!(error <= 1e-8 * x.abs(), "{found}");
            assert_eq!(found, field);
        }
    }
}
