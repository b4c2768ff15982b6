//! Names of properties, in comments of the programs that write them.

use std::collections::BTreeMap;

use crate::io::latin::decode_utf8_or_latin1;

/// The number of a property and its name, if a comment has them: `$ANSA_NAME_COMMENT;7;PSHELL;wall;`,
/// `$HMNAME PROP 7"wall" 4`, `$ Femap Property 7 : wall` or `$ Femap with NX Nastran Property 7 : wall`.
pub(super) fn name_in(comment: &[u8]) -> Option<(i32, String)> {
    let text = decode_utf8_or_latin1(comment.strip_prefix(b"$")?);
    let text = text.trim();
    let (number, name) = if let Some(rest) = text.strip_prefix("ANSA_NAME_COMMENT;") {
        let mut parts = rest.split(';');
        let (number, card) = (parts.next()?, parts.next()?);
        (number, parts.next().filter(|_| card.starts_with('P'))?)
    } else if let Some(rest) = text.strip_prefix("HMNAME PROP") {
        let (number, rest) = rest.split_once('"')?;
        (number, rest.rsplit_once('"')?.0)
    } else if text.starts_with("Femap") {
        text.split_once("Property ")?.1.split_once(':')?
    } else {
        return None;
    };
    let name = name.trim();
    Some((number.trim().parse().ok()?, name.to_owned())).filter(|_| !name.is_empty())
}

/// A comment with the name of a property, which must be one line and have no quotes; and what changed in it.
pub(super) fn comment(number: i32, name: &str, lost: &mut Vec<String>) -> String {
    let plain = name.trim().replace(['\n', '\r'], " ").replace('"', "'");
    if plain != name {
        lost.push(format!("the name {name:?} is written as {plain:?}"));
    }
    format!("$HMNAME PROP    {number:8}\"{plain}\"\n")
}

/// The names of numbers.
pub(super) type Names = BTreeMap<i32, String>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_in_comments_of_several_programs() {
        for comment in [
            "$ANSA_NAME_COMMENT;7;PSHELL;the wall;;NO;",
            "$HMNAME PROP                   7\"the wall\" 4",
            "$ Femap Property 7 : the wall",
            "$ Femap with NX Nastran Property 7 : the wall",
        ] {
            assert_eq!(name_in(comment.as_bytes()), Some((7, "the wall".into())), "{comment}");
        }
        for comment in [
            "$ANSA_NAME_COMMENT;7;MAT1;steel;",
            "$HMNAME COMP 7\"a\"",
            "$ Property 7 : a",
            "$HMNAME PROP x\"a\"",
            "$",
        ] {
            assert_eq!(name_in(comment.as_bytes()), None, "{comment}");
        }
        let mut lost = Vec::new();
        assert_eq!(
            name_in(comment(-3, "a\n\"b\"", &mut lost).trim_end().as_bytes()),
            Some((-3, "a 'b'".into()))
        );
        assert_eq!(lost.len(), 1);
    }
}
