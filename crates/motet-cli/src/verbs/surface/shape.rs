//! Shapes by parameters: `NAME=X,NAME=X`.

use motet::base::Words;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// The help of an option that takes a shape: what it is, and its parameters with their defaults.
pub(super) fn help<W: Words>(what: &str) -> String {
    let words = W::words();
    let of =
        words.iter().map(|word| format!("{}={} ({})", word.name, word.default, brief(&word.effect_text())));
    format!("{what}: {}", of.collect::<Vec<_>>().join(", "))
}

/// An effect as part of a list: without its first capital and its last stop.
fn brief(effect: &str) -> String {
    let mut letters = effect.trim_end_matches('.').chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// Parses parameters of a shape.
pub(super) fn words<W: DeserializeOwned>(text: &str) -> Result<W, String> {
    let mut map = Map::new();
    for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let (name, value) = part.split_once('=').ok_or_else(|| format!("`{part}` is not NAME=X"))?;
        let number: Value = serde_json::from_str(value.trim())
            .ok()
            .filter(Value::is_number)
            .ok_or_else(|| format!("`{value}` is not a number"))?;
        if map.insert(name.trim().to_owned(), number).is_some() {
            return Err(format!("`{}` is given twice", name.trim()));
        }
    }
    serde_json::from_value(Value::Object(map)).map_err(|e| e.to_string())
}
