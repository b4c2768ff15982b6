//! Parsers that several verbs share: numbers, lists of them, `NAME=rest`, and names of files.

use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

/// Parses a finite number.
pub(crate) fn number(word: &str) -> Result<f64, String> {
    let number = word.trim().parse().ok().filter(|x: &f64| x.is_finite());
    number.ok_or_else(|| format!("`{word}` is not a finite number"))
}

/// Parses a number above 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match number(text) {
        Ok(x) if x > 0.0 => Ok(x),
        _ => Err("a positive number is expected".into()),
    }
}

/// Parses a number from 0 to below 1.
pub(crate) fn part(text: &str) -> Result<f64, String> {
    match number(text) {
        Ok(x) if (0.0..1.0).contains(&x) => Ok(x),
        _ => Err("a number in [0, 1) is expected".into()),
    }
}

/// Parses a number of at least 0.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match number(text) {
        Ok(x) if x >= 0.0 => Ok(x),
        _ => Err("a number of 0 or more is expected".into()),
    }
}

/// Parses numbers separated by commas, semicolons or white space.
pub(crate) fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let words = text.split([',', ';', ' ', '\n', '\t']).filter(|word| !word.is_empty());
    words.map(number).collect()
}

/// Parses `NAME=rest`, split at the last `=`, since numbers contain none and names might; `example` describes
/// the expected text.
pub(crate) fn named<'a>(text: &'a str, example: &str) -> Result<(&'a str, &'a str), String> {
    let parts = text.rsplit_once('=').filter(|(name, _)| !name.is_empty());
    parts.ok_or_else(|| format!("{example} is expected"))
}

/// The file's name without its extension.
pub(crate) fn stem(file: &Path) -> Option<String> {
    file.file_stem().map(|stem| stem.to_string_lossy().into_owned())
}

/// A path as text, for JSON: what is not Unicode in it becomes U+FFFD.
pub(crate) fn shown(path: impl AsRef<Path>) -> String {
    path.as_ref().to_string_lossy().into_owned()
}

/// Serializes one path, several, or an optional one, as [`shown`]: serde itself refuses a path that is not
/// Unicode.
pub(crate) fn paths<S: Serializer>(paths: &impl Paths, serializer: S) -> Result<S::Ok, S::Error> {
    paths.texts().serialize(serializer)
}

/// The arguments that [`paths`] takes.
pub(crate) trait Paths {
    /// The paths as text, each as [`shown`] writes it.
    fn texts(&self) -> impl Serialize;
}

impl Paths for PathBuf {
    fn texts(&self) -> impl Serialize {
        shown(self)
    }
}

impl Paths for &Path {
    fn texts(&self) -> impl Serialize {
        shown(self)
    }
}

impl Paths for Option<PathBuf> {
    fn texts(&self) -> impl Serialize {
        self.as_ref().map(shown)
    }
}

impl Paths for Vec<PathBuf> {
    fn texts(&self) -> impl Serialize {
        self.iter().map(shown).collect::<Vec<_>>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_and_names_kept_whole() {
        assert_eq!(numbers("1, -2.5;3e-2\n4"), Ok(vec![1.0, -2.5, 0.03, 4.0]));
        assert_eq!(named("a=b=0.5", "NAME=X"), Ok(("a=b", "0.5")));
        assert_eq!(positive("0.5"), Ok(0.5));
        assert_eq!((not_negative("0"), not_negative("-1").is_err()), (Ok(0.0), true));
        assert_eq!(stem(Path::new("a.b/c.d.stl")), Some("c.d".to_owned()));
    }

    #[test]
    fn what_is_off_is_reported() {
        assert!(numbers("1,x").is_err_and(|why| why.contains("`x` is not a finite number")));
        for text in ["0", "-1", "nan", "inf", "x", ""] {
            assert_eq!(positive(text), Err("a positive number is expected".into()));
        }
        for text in ["=3", "wall", ""] {
            assert_eq!(named(text, "PATCH=D"), Err("PATCH=D is expected".into()));
        }
    }
}
