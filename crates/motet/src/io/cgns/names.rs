//! Names that CGNS can hold: at most 32 bytes, no slash, unique among siblings.

use crate::mesh::unused_name;

/// Maximum length of a name in bytes.
pub(super) const MAX_NAME_LENGTH: usize = 32;

/// The default name of a label without a name.
pub(super) fn default_name(dim: usize, number: i32) -> String {
    format!("{}_{number}", if dim == 3 { "Region" } else { "Patch" })
}

/// The name, or a similar one that CGNS can hold, distinct from all of `taken`.
pub(super) fn valid(name: &str, taken: &[String]) -> String {
    let clean: String = name.chars().map(|c| if matches!(c, '/' | '\0') { '_' } else { c }).collect();
    let clean = clean.trim();
    let clean = if clean.is_empty() || clean == "." || clean == ".." { "unnamed" } else { clean };
    let mut longest = MAX_NAME_LENGTH;
    loop {
        // Leave space for the number that makes the name unique.
        let name = unused_name(truncated(clean, longest), |name| taken.iter().any(|t| t == name));
        if name.len() <= MAX_NAME_LENGTH {
            return name;
        }
        longest -= 1;
    }
}

/// The name, truncated to at most `most` bytes.
pub(super) fn truncated(name: &str, most: usize) -> &str {
    let end = (0..=most.min(name.len())).rev().find(|&end| name.is_char_boundary(end)).unwrap_or(0);
    &name[..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_truncated_between_characters_and_stay_distinct() {
        assert_eq!(valid("wall", &[]), "wall");
        assert_eq!(valid("a/b", &["a_b".into()]), "a_b_2");
        assert_eq!(valid(" ", &[]), "unnamed");
        let long = "é".repeat(20);
        let first = valid(&long, &[]);
        assert_eq!(first, "é".repeat(16));
        let second = valid(&long, std::slice::from_ref(&first));
        assert!(second.len() <= MAX_NAME_LENGTH && second != first, "{second}");
    }
}
