//! Names of sets as the file has them.

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
    fn names_are_quoted_where_necessary() {
        assert_eq!(written("wall-1", false), "wall-1");
        assert_eq!(written("wall", true), "\"wall\"");
        assert_eq!(written("2 \"x\"", false), "\"2 'x'\"");
    }
}
