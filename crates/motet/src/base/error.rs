//! The error type of the library: what went wrong, in which file, where, and what to do.

use std::borrow::Cow;
use std::fmt;
use std::path::{Path, PathBuf};

/// `Result` with this library's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// What kind of failure an [`Error`] is. The command line maps it to its exit status, the other interfaces to
/// their exceptions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The data cannot be read, or is not what the operation needs.
    Input,
    /// The operating system refused access to an input file, or to the place of an output file.
    Io,
    /// The operating system refused to write the output.
    Output,
    /// A combination of options that has no meaning.
    Options,
    /// The call was stopped through its [watch](crate::base::Watch).
    Stopped,
}

/// A failure, described in up to four parts: file, place, what went wrong, remedy.
///
/// ```
/// use motet::{Error, ErrorKind};
/// let error = Error::input("refers to vertex 17, but the mesh has 12 points")
///     .at("cell 4")
///     .remedy("write the file again with zero-based ids")
///     .in_file("vessel.vtu");
/// assert_eq!(error.kind(), ErrorKind::Input);
/// assert_eq!(
///     error.to_string(),
///     "vessel.vtu: cell 4: refers to vertex 17, but the mesh has 12 points; \
///      write the file again with zero-based ids"
/// );
/// ```
#[derive(Debug)]
pub struct Error(Box<Parts>);

#[derive(Debug)]
struct Parts {
    kind: ErrorKind,
    file: Option<PathBuf>,
    place: Option<String>,
    what: String,
    remedy: Option<String>,
    source: Option<std::io::Error>,
}

impl Error {
    /// An error of the given kind; `what` says what was expected and what was found.
    pub fn new(kind: ErrorKind, what: impl Into<String>) -> Self {
        Self(Box::new(Parts { kind, file: None, place: None, what: what.into(), remedy: None, source: None }))
    }

    /// An error of kind [`ErrorKind::Input`]: data that cannot be read, or that the operation cannot use.
    pub fn input(what: impl Into<String>) -> Self {
        Self::new(ErrorKind::Input, what)
    }

    /// An error of kind [`ErrorKind::Options`]: options that have no meaning together.
    pub fn options(what: impl Into<String>) -> Self {
        Self::new(ErrorKind::Options, what)
    }

    /// A file that the operating system refused to read or to create; `source` is its error.
    ///
    /// ```
    /// use std::error::Error;
    /// let error = motet::io::read("missing.vtu").unwrap_err();
    /// assert!(error.source().unwrap().is::<std::io::Error>());
    /// ```
    pub fn io(file: impl AsRef<Path>, source: std::io::Error) -> Self {
        Self::new(ErrorKind::Io, source.to_string()).in_file(file).because(source)
    }

    /// A file that the operating system refused to write; `source` is its error.
    pub fn output(file: impl AsRef<Path>, source: std::io::Error) -> Self {
        let error = Self::new(ErrorKind::Output, format!("cannot be written: {source}")).in_file(file);
        let error = match source.kind() {
            std::io::ErrorKind::StorageFull | std::io::ErrorKind::QuotaExceeded => {
                error.remedy("free some space, or write elsewhere")
            }
            std::io::ErrorKind::PermissionDenied | std::io::ErrorKind::ReadOnlyFilesystem => {
                error.remedy("change its permissions, or write elsewhere")
            }
            _ => error,
        };
        error.because(source)
    }

    fn because(mut self, source: std::io::Error) -> Self {
        self.0.source = Some(source);
        self
    }

    /// Adds the place within the file or the mesh: a line, an element, a cell. The innermost place is kept.
    #[must_use]
    pub fn at(mut self, place: impl Into<String>) -> Self {
        self.0.place.get_or_insert_with(|| place.into());
        self
    }

    /// Adds what the user can do about it. The innermost remedy is kept.
    #[must_use]
    pub fn remedy(mut self, remedy: impl Into<String>) -> Self {
        self.0.remedy.get_or_insert_with(|| remedy.into());
        self
    }

    /// Adds the file. The innermost file is kept.
    #[must_use]
    pub fn in_file(mut self, file: impl AsRef<Path>) -> Self {
        self.0.file.get_or_insert_with(|| file.as_ref().to_owned());
        self
    }

    /// What kind of failure this is.
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// The file that the error is about, if any.
    pub fn file(&self) -> Option<&Path> {
        self.0.file.as_deref()
    }

    /// The place within the file or mesh, if known.
    pub fn place(&self) -> Option<&str> {
        self.0.place.as_deref()
    }

    /// What was expected and what was found.
    pub fn what(&self) -> &str {
        &self.0.what
    }

    /// What the user can do about it.
    pub fn remedy_text(&self) -> Option<&str> {
        self.0.remedy.as_deref()
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.0.file {
            write!(f, "{}: ", printable(&file.to_string_lossy()))?;
        }
        if let Some(place) = &self.0.place {
            write!(f, "{place}: ")?;
        }
        f.write_str(&self.0.what)?;
        match &self.0.remedy {
            Some(remedy) => write!(f, "; {remedy}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.source.as_ref().map(|source| source as _)
    }
}

/// Text that is safe on a terminal: control characters, which could move its cursor or change its colours,
/// are written as escapes, such as `\u{1b}` for the one that begins such sequences.
///
/// ```
/// assert_eq!(motet::base::printable("a\u{1b}[2Jb"), r"a\u{1b}[2Jb");
/// ```
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(char::is_control) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if c.is_control() { shown.extend(c.escape_default()) } else { shown.push(c) }
    }
    Cow::Owned(shown)
}
