//! Numbers of labels for formats that know labels by name only.
//!
//! A name that is just a prefix and a number stands for the unnamed label with this number.

use std::collections::BTreeSet;

/// The number in a name that is just the prefix and a number; `None` for other names.
pub(super) fn bare_number(name: &str, prefix: &str) -> Option<i32> {
    let (head, tail) = name.split_at_checked(prefix.len())?;
    let number: i32 = tail.parse().ok()?;
    (head.eq_ignore_ascii_case(prefix) && number != 0 && tail == number.to_string()).then_some(number)
}

/// A number for each name: the one in the name if it is a bare number, otherwise the next free one from 1.
pub(super) fn numbers(names: &[&str], prefix: &str) -> Vec<i32> {
    let mut taken = BTreeSet::from([0]);
    let own: Vec<Option<i32>> =
        names.iter().map(|name| bare_number(name, prefix).filter(|&number| taken.insert(number))).collect();
    let mut free = (1..).filter(|number| !taken.contains(number));
    own.into_iter().map(|number| number.or_else(|| free.next()).unwrap_or_default()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const REGION: &str = "REGION_";

    #[test]
    fn bare_numbers_are_kept_and_other_names_get_free_ones() {
        assert_eq!(numbers(&["a", "REGION_1", "b", "region_-7", "REGION_1"], REGION), [2, 1, 3, -7, 4]);
        for name in ["REGION_0", "REGION_01", "REGION_", "PATCH_1", "REGION_1x", "é"] {
            assert_eq!(bare_number(name, REGION), None, "{name}");
        }
    }
}
