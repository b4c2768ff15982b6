//! Tables of options: the words, their defaults and their effects stand in one place, from which files are
//! read, help is printed and tables of documentation are made.

use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, MapAccess, Visitor};

/// One word of a table of options.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// The key in files, and the name of the argument in other languages.
    pub name: &'static str,
    /// The default as JSON; `null` where leaving the word out has an effect that no value has.
    pub default: String,
    /// The effect, in sentences, with the unit.
    pub effect: &'static str,
}

impl Word {
    /// The effect as one paragraph.
    pub fn effect_text(&self) -> String {
        paragraph(self.effect)
    }
}

/// A text of several lines as one paragraph.
#[doc(hidden)]
pub fn paragraph(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A table of options, made by the macro `words!`.
pub trait Words: Default {
    /// The names of all words.
    const NAMES: &'static [&'static str];

    /// All words.
    fn words() -> Vec<Word>;

    /// Reads the value of one word; returns whether the table has this word.
    ///
    /// # Errors
    /// When the value is not of the type of the word.
    fn take<'de, A: MapAccess<'de>>(&mut self, name: &str, map: &mut A) -> Result<bool, A::Error>;

    /// The effect of a word, as one paragraph; empty where there is no such word.
    fn effect(name: &str) -> String {
        let words = Self::words();
        words.iter().find(|word| word.name == name).map(Word::effect_text).unwrap_or_default()
    }
}

/// Reads a table of options in which the words of two kinds stand side by side.
///
/// # Errors
/// When a word is unknown, or a value is not of the type of its word.
#[doc(hidden)]
pub fn read_both<'de, A: Words, B: Words, D: Deserializer<'de>>(deserializer: D) -> Result<(A, B), D::Error> {
    struct Both<A, B>(A, B);
    impl<'de, A: Words, B: Words> Visitor<'de> for Both<A, B> {
        type Value = (A, B);

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a table")
        }

        fn visit_map<M: MapAccess<'de>>(mut self, mut map: M) -> Result<(A, B), M::Error> {
            while let Some(name) = map.next_key_seed(Name(&[A::NAMES, B::NAMES]))? {
                let _ = self.0.take(name, &mut map)? || self.1.take(name, &mut map)?;
            }
            Ok((self.0, self.1))
        }
    }
    deserializer.deserialize_map(Both(A::default(), B::default()))
}

/// A table without words, for [`read_both`].
#[doc(hidden)]
#[derive(Clone, Copy, Debug, Default)]
pub struct NoWords;

impl Words for NoWords {
    const NAMES: &'static [&'static str] = &[];

    fn words() -> Vec<Word> {
        Vec::new()
    }

    fn take<'de, A: MapAccess<'de>>(&mut self, _: &str, _: &mut A) -> Result<bool, A::Error> {
        Ok(false)
    }
}

/// Reads a name that must be one of these.
struct Name<'a>(&'a [&'static [&'static str]]);

impl<'de> DeserializeSeed<'de> for Name<'_> {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<&'static str, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Name<'_> {
    type Value = &'static str;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<&'static str, E> {
        let known = || self.0.iter().copied().flatten().copied();
        known().find(|known| *known == name).ok_or_else(|| E::custom(unknown(name, known())))
    }
}

/// What is wrong with an unknown name: the nearest known one, or all of them.
fn unknown(name: &str, known: impl Iterator<Item = &'static str> + Clone) -> String {
    match nearest(name, known.clone()) {
        Some(near) => format!("unknown key `{name}`; did you mean `{near}`?"),
        None => format!("unknown key `{name}`; expected one of {}", known.collect::<Vec<_>>().join(", ")),
    }
}

/// The one of `known` that takes the fewest changes of letters to be `name` (inserted, removed, replaced, or
/// two swapped), if at most half of its letters change.
pub fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let with_distance = known.map(|known| (strsim::osa_distance(name, known), known));
    let (distance, near) = with_distance.min_by_key(|(distance, _)| *distance)?;
    (2 * distance <= name.chars().count()).then_some(near)
}

/// Defines a table of options: a struct of words, each with its effect as a doc comment, its type and its
/// default. A word whose key is no identifier of Rust has its key behind it: `matching as "match"`.
#[doc(hidden)]
#[macro_export]
macro_rules! words {
    (
        $(#[$meta:meta])*
        $visibility:vis struct $table:ident {
            $($(#[doc = $effect:literal])+ $word:ident $(as $key:literal)?: $type:ty = $default:expr,)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, ::serde::Serialize)]
        $visibility struct $table {
            $(
                $(#[doc = $effect])+
                #[doc = concat!("\n\nDefault: `", stringify!($default), "`.")]
                $(#[serde(rename = $key)])?
                pub $word: $type,
            )*
        }

        impl Default for $table {
            fn default() -> Self {
                Self { $($word: $default,)* }
            }
        }

        impl $crate::base::Words for $table {
            const NAMES: &'static [&'static str] = &[$($crate::words!(@name $word $($key)?)),*];

            fn words() -> Vec<$crate::base::Word> {
                let usual = Self::default();
                vec![$($crate::base::Word {
                    name: $crate::words!(@name $word $($key)?),
                    default: ::serde_json::to_string(&usual.$word).unwrap_or_default(),
                    effect: concat!($($effect, "\n"),+),
                }),*]
            }

            fn take<'de, A: ::serde::de::MapAccess<'de>>(
                &mut self,
                name: &str,
                map: &mut A,
            ) -> ::std::result::Result<bool, A::Error> {
                $(if name == $crate::words!(@name $word $($key)?) {
                    self.$word = map.next_value()?;
                    return Ok(true);
                })*
                Ok(false)
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $table {
            fn deserialize<D: ::serde::Deserializer<'de>>(
                deserializer: D,
            ) -> ::std::result::Result<Self, D::Error> {
                $crate::base::read_both::<Self, $crate::base::NoWords, D>(deserializer).map(|(table, _)| table)
            }
        }
    };
    (@name $word:ident) => { stringify!($word) };
    (@name $word:ident $key:literal) => { $key };
}

#[cfg(test)]
mod tests {
    use super::*;

    words! {
        /// A table.
        struct Table {
            /// How many
            /// there are.
            count: usize = 3,
            /// Where.
            place as "where": Option<String> = None,
        }
    }

    words! {
        /// Another table.
        struct Other {
            /// How long, in seconds.
            length: f64 = 0.5,
        }
    }

    #[test]
    fn words_have_their_defaults_keys_and_effects() {
        let [count, place] = &Table::words()[..] else { panic!("two words") };
        assert_eq!((count.name, count.default.as_str()), ("count", "3"));
        assert_eq!(count.effect_text(), "How many there are.");
        assert_eq!((place.name, place.default.as_str()), ("where", "null"));
        assert_eq!(Table::effect("where"), "Where.");
    }

    #[test]
    fn a_table_is_read_and_what_is_left_out_has_its_default() {
        let table: Table = serde_json::from_str(r#"{"where": "here"}"#).unwrap();
        assert_eq!((table.count, table.place.as_deref()), (3, Some("here")));
        assert_eq!(serde_json::to_string(&table).unwrap(), r#"{"count":3,"where":"here"}"#);
    }

    #[test]
    fn two_tables_are_read_side_by_side() {
        let mut text = serde_json::Deserializer::from_str(r#"{"length": 2, "count": 1}"#);
        let (table, other): (Table, Other) = read_both(&mut text).unwrap();
        assert_eq!((table.count, other.length), (1, 2.0));
    }

    #[test]
    fn an_unknown_word_names_the_nearest() {
        let error = |text: &str| serde_json::from_str::<Table>(text).unwrap_err().to_string();
        assert!(error(r#"{"cuont": 1}"#).contains("unknown key `cuont`; did you mean `count`?"));
        assert!(error(r#"{"colour": 1}"#).contains("unknown key `colour`; expected one of count, where"));
        assert!(error(r#"{"count": "many"}"#).contains("invalid type"));
    }
}
