//! Commands on lines: a name and arguments between commas.

use std::collections::HashMap;

use super::kinds::{Family, family};
use crate::io::latin::decode_utf8_or_latin1;
use crate::io::text::parse_int;

/// The element type that options of `MESH200` belong to.
const MESH: i64 = 200;

/// A line that is a command.
pub(super) struct Command {
    /// The first four letters, which tell commands apart, in capitals.
    pub(super) name: String,
    arguments: Vec<String>,
}

impl Command {
    /// The command on a line; `None` for data, comments and empty lines.
    pub(super) fn parse(line: &[u8]) -> Option<Self> {
        let line = line.split(|&byte| byte == b'!').next()?.trim_ascii();
        if !line.first().is_some_and(|byte| byte.is_ascii_alphabetic() || matches!(byte, b'*' | b'/')) {
            return None;
        }
        let mut words = line.split(|&byte| byte == b',').map(|word| decode_utf8_or_latin1(word.trim_ascii()));
        let name = words.next()?.chars().take(4).collect::<String>().to_ascii_uppercase();
        Some(Self { name, arguments: words.collect() })
    }

    /// An argument, counted from 1; empty if it is missing.
    pub(super) fn argument(&self, number: usize) -> &str {
        self.arguments.get(number - 1).map_or("", String::as_str)
    }
}

/// Parameters and element types.
#[derive(Default)]
pub(super) struct Types {
    parameters: HashMap<String, i64>,
    /// The number of each type in the library of elements, and its first option.
    types: HashMap<i64, (i64, i64)>,
}

impl Types {
    /// Takes a command that defines a parameter or a type; `false` if it is another one.
    pub(super) fn command(&mut self, command: &Command) -> bool {
        let value = |number| self.value(command.argument(number));
        match command.name.as_str() {
            "*SET" => {
                if let Some(value) = value(2) {
                    self.parameters.insert(command.argument(1).to_ascii_uppercase(), value);
                }
            }
            "ET" => {
                if let (Some(of), Some(number)) = (value(1), self.library_number(command.argument(2))) {
                    self.define(of, number, value(3).unwrap_or(0));
                }
            }
            "KEYO" => {
                if let (Some(of), Some(1), Some(option)) = (value(1), value(2), value(3))
                    && let Some(known) = self.types.get_mut(&of)
                {
                    known.1 = option;
                }
            }
            _ => return false,
        }
        true
    }

    /// Defines a type by its number in the library of elements and its first option.
    pub(super) fn define(&mut self, of: i64, number: i64, option: i64) {
        self.types.insert(of, (number, option));
    }

    /// The family of the elements of a type; `Err` names what they are.
    pub(super) fn family(&self, of: i64) -> Result<Family, String> {
        let &(number, option) = self.types.get(&of).ok_or_else(|| format!("an undefined type ({of})"))?;
        family(number, option).ok_or_else(|| match number {
            MESH => format!("type MESH200 of shape {option}"),
            number => format!("type {number}"),
        })
    }

    fn value(&self, word: &str) -> Option<i64> {
        parse_int(word.as_bytes()).or_else(|| self.parameters.get(&word.to_ascii_uppercase()).copied())
    }

    /// The number at the end of a name such as `SOLID185`.
    fn library_number(&self, word: &str) -> Option<i64> {
        self.value(word)
            .or_else(|| parse_int(word.trim_start_matches(|c: char| c.is_ascii_alphabetic()).as_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_have_numbers_names_and_parameters() {
        let mut types = Types::default();
        for line in
            ["et, 1 ,SOLID187 ! tets", "*set,tid,3", "ET,tid,154", "ET,4,200,6", "et,5,200", "KEYOPT,5,1,8"]
        {
            assert!(types.command(&Command::parse(line.as_bytes()).unwrap()), "{line}");
        }
        let expected = [(1, Family::Tet), (3, Family::Quad), (4, Family::Quad), (5, Family::Tet)];
        assert!(expected.iter().all(|(of, family)| types.family(*of) == Ok(*family)));
        assert_eq!(types.family(9), Err("an undefined type (9)".into()));
        for line in ["! ET,1,187", "  12 13", "", "-1", "(3i9)"] {
            assert!(Command::parse(line.as_bytes()).is_none(), "{line}");
        }
    }
}
