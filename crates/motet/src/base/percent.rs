//! A part of a whole in percent, as text.

/// `fraction` in percent with one decimal, and with more where one decimal would round a part to the whole.
pub fn percent(fraction: f64) -> String {
    let text = |decimals: usize| format!("{:.decimals$} %", 100.0 * fraction);
    let is_whole = |text: &String| text.starts_with("100.");
    match fraction < 1.0 {
        true => (1..16).map(text).find(|text| !is_whole(text)).unwrap_or_else(|| "just below 100 %".into()),
        false => text(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_never_printed_as_the_whole() {
        assert_eq!([0.0, 0.5, 0.9994, 1.0].map(percent), ["0.0 %", "50.0 %", "99.9 %", "100.0 %"]);
        assert_eq!(percent(0.999_999_999_766_258_3), "99.99999998 %");
        let mut below = 1.0 - f64::EPSILON / 2.0;
        for _ in 0..50 {
            assert!(!percent(below).starts_with("100"), "{below}");
            below = 1.0 - 2.0 * (1.0 - below);
        }
    }
}
