//! Options as JSON, by which a saved state makes sure that it continues with the options it was saved with.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::base::{Error, Result};
use crate::moving::options::Options;

/// The largest number of differences that are named.
const MAX_NAMED: usize = 4;

impl Options {
    /// All options that steps depend on, as JSON. The number of remembered changes is left out.
    ///
    /// # Errors
    /// If they cannot be written as JSON.
    pub(super) fn to_json(&self) -> Result<String> {
        serde_json::to_string(&Self { remembered: 0, ..self.clone() })
            .map_err(|e| Error::options(format!("the options cannot be written as JSON: {e}")))
    }
}

/// The differences between two [`Options::to_json`], each with its name, its old and its new value; empty
/// if there are none.
pub(super) fn differences(was: &str, is: &str) -> Vec<String> {
    let (was, is) = (values(was), values(is));
    let names = was.keys().chain(is.keys().filter(|name| !was.contains_key(*name)));
    let differ = names.filter(|name| was.get(*name) != is.get(*name));
    let value = |of: &BTreeMap<String, Value>, name: &str| {
        of.get(name).map_or("nothing".to_owned(), Value::to_string)
    };
    let mut named: Vec<String> =
        differ.map(|name| format!("{name} was {} and is {}", value(&was, name), value(&is, name))).collect();
    let n = named.len();
    if n > MAX_NAMED {
        named.truncate(MAX_NAMED);
        named.push(format!("{} more", n - MAX_NAMED));
    }
    named
}

/// Values by their names; the names in nested objects are joined by dots.
fn values(text: &str) -> BTreeMap<String, Value> {
    let mut values = BTreeMap::new();
    // Text that is not JSON differs from any state: it has one value without a name.
    let mut open = vec![(String::new(), serde_json::from_str(text).unwrap_or_else(|_| Value::from(text)))];
    while let Some((name, value)) = open.pop() {
        match value {
            Value::Object(of) if !of.is_empty() => open
                .extend(of.into_iter().map(|(key, value)| {
                    (if name.is_empty() { key } else { format!("{name}.{key}") }, value)
                })),
            value => {
                values.insert(name, value);
            }
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn to_json(options: &Options) -> String {
        options.to_json().unwrap()
    }

    #[test]
    fn what_differs_is_named_and_what_is_remembered_does_not_count() {
        let options = Options::default();
        let same = Options { remembered: 3, ..options.clone() };
        assert!(differences(&to_json(&options), &to_json(&same)).is_empty());
        let mut other = Options { floor: 0.1, contents: vec!["dye".into()], ..options.clone() };
        other.motion.smooth = 7;
        let message = differences(&to_json(&options), &to_json(&other)).join("; ");
        assert!(message.contains("motion.smooth was 0 and is 7"), "{message}");
        assert!(message.contains("floor was 0.05 and is 0.1"), "{message}");
        assert!(message.contains("contents") && message.contains("dye"), "{message}");
        let none = Options { repair: None, ..options.clone() };
        let message = differences(&to_json(&options), &to_json(&none)).join("; ");
        assert!(message.contains("repair"), "{message}");
    }
}
