//! Lines of an input file: keywords with their parameters, data fields, labels.

use crate::base::{Error, Result};
use crate::io::text::{parse_float, parse_int, quoted};

/// A keyword line: the keyword in capitals without blanks, and its parameters.
#[derive(Debug)]
pub(super) struct Keyword {
    pub(super) name: String,
    parameters: Vec<(String, String)>,
}

impl Keyword {
    /// Parses a keyword line without its leading star.
    pub(super) fn parse(line: &str) -> Self {
        let mut words = split(line).into_iter();
        let name = normalized(words.next().unwrap_or_default());
        let parameter = |word: &str| match word.split_once('=') {
            Some((key, value)) => (normalized(key), value.trim().to_owned()),
            None => (normalized(word), String::new()),
        };
        Self { name, parameters: words.map(parameter).filter(|p| !p.0.is_empty()).collect() }
    }

    /// The value of a parameter, empty if it was given without one; `None` if the parameter is absent.
    pub(super) fn get(&self, key: &str) -> Option<&str> {
        self.parameters.iter().find(|p| p.0 == key).map(|p| p.1.as_str())
    }

    /// The value of a required parameter; an error if it is missing or empty.
    pub(super) fn expect(&self, key: &str) -> Result<&str> {
        self.get(key).filter(|value| !value.is_empty()).ok_or_else(|| {
            Error::input(format!("*{} has no parameter {key}=...", self.name))
                .remedy("the file is damaged: write it again")
        })
    }

    /// The value of a parameter as a label; `None` if it is missing or empty.
    pub(super) fn label(&self, key: &str) -> Option<Label> {
        self.get(key).filter(|value| !value.is_empty()).map(Label::new)
    }
}

/// The name of a set, a part or an instance.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Label {
    /// The key for comparisons: in capitals, unless quoted.
    pub(super) key: String,
    /// The name as spelled in the file.
    pub(super) shown: String,
}

impl Label {
    pub(super) fn new(text: &str) -> Self {
        let text = text.trim();
        match text.strip_prefix('"').and_then(|t| t.strip_suffix('"')) {
            Some(inner) => Self { key: inner.to_owned(), shown: inner.to_owned() },
            None => Self {
                key: normalized(text),
                shown: text.chars().filter(|c| !c.is_ascii_whitespace()).collect(),
            },
        }
    }
}

/// A reference to a node, element or set by number or label, and the instance that it belongs to.
#[derive(Clone, Debug)]
pub(super) struct Reference {
    pub(super) instance: Option<String>,
    pub(super) to: Target,
}

#[derive(Clone, Debug)]
pub(super) enum Target {
    Number(u64),
    Label(Label),
}

impl Reference {
    /// Parses a number or a label, with an optional instance and dot before it.
    pub(super) fn parse(field: &str) -> Result<Self> {
        if let Some(id) = parse_int(field.as_bytes()) {
            return Ok(Self { instance: None, to: Target::Number(number(id)?) });
        }
        let (instance, rest) = match instance_and_rest(field) {
            Some((instance, rest)) => (Some(Label::new(instance).key), rest),
            None => (None, field),
        };
        let to = match parse_int(rest.as_bytes()) {
            Some(id) => Target::Number(number(id)?),
            None if rest.trim().is_empty() => {
                return Err(Error::input(format!(
                    "expected a number or a name, found {}",
                    quoted(field.as_bytes())
                )));
            }
            None => Target::Label(Label::new(rest)),
        };
        Ok(Self { instance, to })
    }
}

/// Splits at the first dot outside quotes.
fn instance_and_rest(field: &str) -> Option<(&str, &str)> {
    let mut is_quoted = false;
    let dot = field.char_indices().find_map(|(at, c)| {
        is_quoted ^= c == '"';
        (c == '.' && !is_quoted).then_some(at)
    })?;
    Some((&field[..dot], &field[dot + 1..]))
}

/// The fields of a line, without the empty one after a trailing comma.
pub(super) fn fields(line: &str) -> Vec<&str> {
    let mut fields = split(line);
    if fields.last().is_some_and(|f| f.is_empty()) {
        fields.pop();
    }
    fields
}

/// Splits at commas outside quotes and trims each field.
fn split(line: &str) -> Vec<&str> {
    let mut is_quoted = false;
    line.split(|c| {
        is_quoted ^= c == '"';
        c == ',' && !is_quoted
    })
    .map(str::trim)
    .collect()
}

/// The text in capitals and without blanks, which carry no meaning.
fn normalized(text: &str) -> String {
    text.chars().filter(|c| !c.is_ascii_whitespace()).map(|c| c.to_ascii_uppercase()).collect()
}

/// Parses the number of a node or element.
pub(super) fn id(field: &str, what: &str) -> Result<u64> {
    parse_int(field.as_bytes()).ok_or_else(|| unexpected(field, what, "a whole number")).and_then(number)
}

fn number(id: i64) -> Result<u64> {
    match u64::try_from(id) {
        Ok(id) if id > 0 => Ok(id),
        _ => Err(Error::input(format!("{id} is not a valid node or element number: numbering starts at 1"))),
    }
}

/// Parses a floating-point number; an empty field is 0.
pub(super) fn float(field: &str, what: &str) -> Result<f64> {
    if field.is_empty() {
        return Ok(0.0);
    }
    parse_float(field.as_bytes()).ok_or_else(|| unexpected(field, what, "a number"))
}

fn unexpected(field: &str, what: &str, expected: &str) -> Error {
    Error::input(format!("{what}: expected {expected}, found {}", quoted(field.as_bytes())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_are_read_in_any_spelling() {
        let keyword = Keyword::parse("Solid Section , elset = Set-1 , Material=\"soft, red\",internal");
        assert_eq!(keyword.name, "SOLIDSECTION");
        assert_eq!(keyword.label("ELSET").unwrap(), Label { key: "SET-1".into(), shown: "Set-1".into() });
        assert_eq!(keyword.label("MATERIAL").unwrap().key, "soft, red");
        assert_eq!(keyword.get("INTERNAL"), Some(""));
        assert!(keyword.expect("NSET").unwrap_err().to_string().contains("no parameter NSET"));
    }

    #[test]
    fn references_name_instances_before_a_dot() {
        let parts = |text: &str| {
            let reference = Reference::parse(text).unwrap();
            let to = match reference.to {
                Target::Number(id) => id.to_string(),
                Target::Label(label) => label.shown,
            };
            (reference.instance, to)
        };
        assert_eq!(parts("12"), (None, "12".into()));
        assert_eq!(parts("Part-1-1.7"), (Some("PART-1-1".into()), "7".into()));
        assert_eq!(parts("I.set"), (Some("I".into()), "set".into()));
        assert_eq!(parts("\"a.b\""), (None, "a.b".into()));
        assert!(
            Reference::parse("0").is_err()
                && Reference::parse("-4").is_err()
                && Reference::parse("I.").is_err()
        );
    }
}
