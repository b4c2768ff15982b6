//! Conversion between the numbers of labels and the names of sets.

use std::collections::BTreeSet;

pub(super) const REGION: &str = "REGION_";
pub(super) const PATCH: &str = "PATCH_";

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

/// A name as written to a file: quoted where it is not a plain word, or where quotes distinguish it from
/// another.
pub(super) fn written(name: &str, needs_quotes: bool) -> String {
    let is_plain = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if is_plain && !needs_quotes {
        return name.to_owned();
    }
    format!("\"{}\"", one_line(name))
}

/// The name with line breaks and double quotes replaced.
pub(super) fn one_line(name: &str) -> String {
    name.replace('"', "'").replace(['\n', '\r'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_numbers_are_kept_and_other_names_get_free_ones() {
        assert_eq!(numbers(&["a", "REGION_1", "b", "region_-7", "REGION_1"], REGION), [2, 1, 3, -7, 4]);
        for name in ["REGION_0", "REGION_01", "REGION_", "PATCH_1", "REGION_1x", "é"] {
            assert_eq!(bare_number(name, REGION), None, "{name}");
        }
    }

    #[test]
    fn names_are_quoted_where_necessary() {
        assert_eq!(written("wall-1", false), "wall-1");
        assert_eq!(written("wall", true), "\"wall\"");
        assert_eq!(written("2 \"x\"", false), "\"2 'x'\"");
    }
}
