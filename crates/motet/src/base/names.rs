//! Values with names: each value, its name and its effect stand in one place, by which files are read, help
//! is printed, and an unknown name is refused.

use serde::Deserialize;
use serde::de::{Deserializer, Error as _};

use crate::base::{Error, Result, nearest};

/// Values that have names in files and on the command line, made by the macro `names!`.
pub trait Names: Copy + 'static {
    /// What the names denote, such as `method`.
    const WHAT: &'static str;
    /// All values, the default first.
    const ALL: &'static [Self];

    /// The name.
    fn as_str(self) -> &'static str;

    /// The effect as one paragraph.
    fn effect(self) -> String;

    /// The value with this name.
    ///
    /// # Errors
    /// When there is none; the error names the nearest, and all others.
    fn of(name: &str) -> Result<Self> {
        let known: Vec<_> = Self::ALL.iter().map(|value| (value.as_str(), *value)).collect();
        one_of(Self::WHAT, name, &known)
    }
}

/// The one of `known` that has this name; `what` is what the names denote, such as `method`.
///
/// # Errors
/// When none has it; the error names the nearest, and all others.
pub fn one_of<T: Copy>(what: &str, name: &str, known: &[(&str, T)]) -> Result<T> {
    known.iter().find(|(known, _)| *known == name).map(|(_, value)| *value).ok_or_else(|| {
        let remedy = suggestion(name, known.iter().map(|(known, _)| *known));
        Error::options(format!("unknown {what} `{name}`")).remedy(remedy)
    })
}

/// A remedy for a name that is not among the known ones: the nearest of these, and all others.
pub fn suggestion<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    let near = nearest(name, known.clone());
    let others = known.filter(|other| Some(*other) != near).collect::<Vec<_>>().join(", ");
    match near {
        Some(near) => format!("did you mean `{near}`? Others are {others}"),
        None => format!("give one of {others}"),
    }
}

/// Reads what a text or a number denotes.
///
/// # Errors
/// When there is neither, or it denotes nothing.
#[doc(hidden)]
pub fn read_text<'de, T, D: Deserializer<'de>>(
    deserializer: D,
    of: fn(&str) -> Result<T>,
) -> Result<T, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a text or a number")]
    enum Written {
        Number(f64),
        Text(String),
    }
    let text = match Written::deserialize(deserializer)? {
        Written::Number(number) => number.to_string(),
        Written::Text(text) => text,
    };
    of(&text).map_err(D::Error::custom)
}

/// Defines values with names, the default first; each has its effect as a doc comment, and its name. The text
/// after the type says what the names denote.
#[doc(hidden)]
#[macro_export]
macro_rules! names {
    (
        $(#[$meta:meta])*
        $visibility:vis enum $enum:ident: $what:literal {
            $($(#[doc = $effect:literal])+ $value:ident = $name:literal,)+
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        $visibility enum $enum {
            $(
                $(#[doc = $effect])+
                #[doc = concat!("\n\nName: `", $name, "`.")]
                $value,
            )+
        }

        impl $crate::base::Names for $enum {
            const WHAT: &'static str = $what;
            const ALL: &'static [Self] = &[$(Self::$value),+];

            fn as_str(self) -> &'static str {
                match self {
                    $(Self::$value => $name,)+
                }
            }

            fn effect(self) -> String {
                $crate::base::paragraph(match self {
                    $(Self::$value => concat!($($effect, "\n"),+),)+
                })
            }
        }

        impl Default for $enum {
            fn default() -> Self {
                <Self as $crate::base::Names>::ALL[0]
            }
        }

        impl ::std::fmt::Display for $enum {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                f.write_str($crate::base::Names::as_str(*self))
            }
        }

        impl ::serde::Serialize for $enum {
            fn serialize<S: ::serde::Serializer>(
                &self,
                serializer: S,
            ) -> ::std::result::Result<S::Ok, S::Error> {
                serializer.serialize_str($crate::base::Names::as_str(*self))
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $enum {
            fn deserialize<D: ::serde::Deserializer<'de>>(
                deserializer: D,
            ) -> ::std::result::Result<Self, D::Error> {
                $crate::base::read_text(deserializer, <Self as $crate::base::Names>::of)
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    names! {
        /// A colour.
        enum Colour: "colour" {
            /// As the sky
            /// at noon.
            Blue = "blue",
            /// As grass.
            Green = "green",
            /// As snow.
            White = "white",
        }
    }

    #[test]
    fn a_value_is_found_by_the_name_that_it_has() {
        for colour in Colour::ALL {
            assert_eq!(Colour::of(colour.as_str()).unwrap(), *colour);
            let written = serde_json::to_string(colour).unwrap();
            assert_eq!(
                (written.clone(), colour.to_string()),
                (format!("\"{colour}\""), colour.as_str().into())
            );
            assert_eq!(serde_json::from_str::<Colour>(&written).unwrap(), *colour);
        }
        assert_eq!(
            (Colour::default(), Colour::Blue.effect().as_str()),
            (Colour::Blue, "As the sky at noon.")
        );
    }

    #[test]
    fn an_unknown_name_is_refused_with_the_nearest_and_all_others() {
        let error = |name: &str| Colour::of(name).unwrap_err().to_string();
        assert_eq!(error("gren"), "unknown colour `gren`; did you mean `green`? Others are blue, white");
        assert_eq!(error("crimson"), "unknown colour `crimson`; give one of blue, green, white");
        let read = serde_json::from_str::<Colour>("\"gren\"").unwrap_err().to_string();
        assert!(read.contains("did you mean `green`?"), "{read}");
    }
}
