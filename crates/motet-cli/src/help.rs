//! Help of arguments in the words of the library, and arguments that are one of its names.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use motet::base::{Names, Words};

/// The effect of a word.
pub(crate) fn effect<W: Words>(word: &str) -> String {
    without_full_stop(W::effect(word))
}

/// The effect of a word that may be given several times.
pub(crate) fn repeatable<W: Words>(word: &str) -> String {
    format!("{} Repeatable", W::effect(word))
}

/// A parser of names, of which the help says the effects.
pub(crate) fn name_of<N: Names + Send + Sync>() -> impl TypedValueParser<Value = N> {
    PossibleValuesParser::new(values_of::<N>()).try_map(|name| N::of(&name))
}

/// The values that have names, with their effects.
pub(crate) fn values_of<N: Names>() -> impl Iterator<Item = PossibleValue> {
    N::ALL.iter().map(|name| PossibleValue::new(name.as_str()).help(without_full_stop(name.effect())))
}

fn without_full_stop(text: String) -> String {
    text.strip_suffix('.').map_or_else(|| text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use motet::meshing::MeshingWords;
    use motet::remesh::RemeshWords;

    #[test]
    fn help_ends_without_a_full_stop() {
        assert_eq!(effect::<RemeshWords>("min_eas"), "Tets below this EAS are bad");
        assert!(repeatable::<MeshingWords>("holes").ends_with(". Repeatable"));
    }
}
