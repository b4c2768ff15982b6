//! Words with a fixed set of values: the names of the values and their effects stand in one place, by which
//! texts are looked up and help is printed.

use serde::de::{self, Deserialize, Deserializer};

use super::error::{Error, Result};
use super::words::nearest;

/// The values of a word that has a fixed set of them, made by the macro `choices!`.
pub trait Choice: Copy + PartialEq + Send + Sync + 'static {
    /// The word, for messages.
    const WORD: &'static str;

    /// All values.
    const ALL: &'static [Self];

    /// The name of the value in files and other languages.
    fn name(self) -> &'static str;

    /// The effect of the value, in sentences.
    fn effect(self) -> &'static str;

    /// The value of this name.
    ///
    /// # Errors
    /// When there is none; the error names the nearest, or all.
    fn of_name(name: &str) -> Result<Self> {
        Self::ALL.iter().copied().find(|value| value.name() == name).ok_or_else(|| {
            Error::options(format!("`{name}` is not a value of `{}`", Self::WORD))
                .remedy(one_of(name, Self::ALL.iter().map(|value| value.name())))
        })
    }
}

/// A remedy for a name that does not exist: the nearest that does, or all.
pub fn one_of<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    match nearest(name, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("give one of {}", known.collect::<Vec<_>>().join(", ")),
    }
}

/// Reads a text and looks it up; an error has the remedy behind it.
///
/// # Errors
/// When there is no text, or the lookup fails.
#[doc(hidden)]
pub fn read_named<'de, T, D: Deserializer<'de>>(
    deserializer: D,
    of: fn(&str) -> Result<T>,
) -> std::result::Result<T, D::Error> {
    let text = String::deserialize(deserializer)?;
    of(&text).map_err(|e| match e.remedy_text() {
        Some(remedy) => de::Error::custom(format_args!("{}: {remedy}", e.what())),
        None => de::Error::custom(e.what()),
    })
}

/// Defines the values of a word: an enum with the word and the default behind its name; each value has its
/// effect as a doc comment, and its name in files.
#[doc(hidden)]
#[macro_export]
macro_rules! choices {
    (
        $(#[$meta:meta])*
        $visibility:vis enum $choice:ident as $word:literal = $usual:ident {
            $($(#[doc = $effect:literal])+ $value:ident = $name:literal,)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $visibility enum $choice {
            $($(#[doc = $effect])+ $value,)*
        }

        impl Default for $choice {
            fn default() -> Self {
                Self::$usual
            }
        }

        impl $crate::base::Choice for $choice {
            const WORD: &'static str = $word;
            const ALL: &'static [Self] = &[$(Self::$value),*];

            fn name(self) -> &'static str {
                match self {
                    $(Self::$value => $name,)*
                }
            }

            fn effect(self) -> &'static str {
                match self {
                    $(Self::$value => concat!($($effect),+).trim_ascii(),)*
                }
            }
        }

        impl ::serde::Serialize for $choice {
            fn serialize<S: ::serde::Serializer>(
                &self,
                serializer: S,
            ) -> ::std::result::Result<S::Ok, S::Error> {
                serializer.serialize_str($crate::base::Choice::name(*self))
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $choice {
            fn deserialize<D: ::serde::Deserializer<'de>>(
                deserializer: D,
            ) -> ::std::result::Result<Self, D::Error> {
                $crate::base::read_named(deserializer, <Self as $crate::base::Choice>::of_name)
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    choices! {
        /// The colour of something.
        enum Colour as "colour" = Blue {
            /// Like a tomato,
            /// when it is ripe.
            Red = "red",
            /// Like the sky.
            Blue = "blue",
        }
    }

    #[test]
    fn each_value_is_found_by_its_name_and_read() {
        for colour in [Colour::Red, Colour::Blue] {
            assert_eq!(Colour::of_name(colour.name()).unwrap(), colour);
            let text = serde_json::to_string(&colour).unwrap();
            assert_eq!(serde_json::from_str::<Colour>(&text).unwrap(), colour);
        }
        assert_eq!(Colour::default(), Colour::Blue);
        assert_eq!(Colour::Red.effect(), "Like a tomato, when it is ripe.");
    }

    #[test]
    fn an_unknown_value_names_the_nearest_or_all() {
        let error = |name: &str| Colour::of_name(name).unwrap_err().to_string();
        assert_eq!(error("bleu"), "`bleu` is not a value of `colour`; did you mean `blue`?");
        assert_eq!(error("green"), "`green` is not a value of `colour`; give one of red, blue");
        let read = serde_json::from_str::<Colour>("\"bleu\"").unwrap_err().to_string();
        assert!(read.contains("did you mean `blue`?"), "{read}");
    }
}
