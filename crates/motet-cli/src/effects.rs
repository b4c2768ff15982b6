//! Help and parsers of arguments, from the library's tables of options.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use motet::base::{Choice, Words};

/// The effect of an option, as the library says it.
pub(crate) fn effect<T: Words>(word: &str) -> String {
    T::effect(word).trim_end_matches('.').to_owned()
}

/// The effect of an option that may be given several times.
pub(crate) fn repeatable<T: Words>(word: &str) -> String {
    format!("{} Repeatable", T::effect(word))
}

/// Parses a value of a word that has a fixed set of them; help shows the effect of each.
pub(crate) fn choice<T: Choice>() -> impl TypedValueParser<Value = T> {
    let value = |value: &T| PossibleValue::new(value.name()).help(value.effect().trim_end_matches('.'));
    PossibleValuesParser::new(T::ALL.iter().map(value)).try_map(|name| T::of_name(&name))
}
