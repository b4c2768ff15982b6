//! What a file format is: a reader and a writer, what they are given, and what they give back.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use crate::base::Result;
use crate::mesh::Mesh;

/// What a reader gets: the whole file, and its path for formats that lie in several files.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// Where the file lies.
    pub path: &'a Path,
    /// Its content.
    pub bytes: &'a [u8],
    /// Where a reader says what it passed over.
    pub notes: &'a Notes,
}

/// What a reader passed over, each in a sentence for the user: sections that
/// motet does not know, texture coordinates, a second label on one cell.
#[derive(Debug, Default)]
pub struct Notes(Mutex<Vec<String>>);

impl Notes {
    /// Adds a sentence, unless it has been said.
    pub fn add(&self, note: impl Into<String>) {
        let mut notes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let note = note.into();
        if !notes.contains(&note) {
            notes.push(note);
        }
    }

    /// All sentences, in the order in which they came.
    pub fn into_vec(self) -> Vec<String> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

/// How numbers are laid down, where a format leaves the choice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Text; numbers with as many digits as bring them back bit for bit.
    Ascii,
    /// Base64 inside the elements (XML formats); binary elsewhere.
    Base64,
    /// Raw bytes: appended (XML formats), binary elsewhere.
    #[default]
    Binary,
}

/// How blocks are compressed, where a format can.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// Not at all.
    None,
    /// zlib, which every reader knows.
    #[default]
    Zlib,
    /// lz4: faster, larger.
    Lz4,
    /// lzma (xz): slower, smaller.
    Lzma,
}

/// What the user may choose when writing.
#[derive(Clone, Debug, Default)]
pub struct WriteOptions {
    /// How numbers are laid down.
    pub encoding: Encoding,
    /// How blocks are compressed.
    pub compression: Compression,
    /// The format's own version, such as `2.2` for MSH; the format's default when `None`.
    pub version: Option<String>,
}

/// What a writer made: one or more files, and what the format could not hold.
#[derive(Clone, Debug, Default)]
pub struct Written {
    /// File ending (with dot) and content; the ending replaces that of the path asked for.
    /// An empty ending means the path itself. For a format that is a folder: the path within it.
    pub files: Vec<(String, Vec<u8>)>,
    /// What the format cannot hold, each in a sentence for the user.
    pub lost: Vec<String>,
}

impl Written {
    /// A single file, nothing lost.
    pub fn one(bytes: Vec<u8>) -> Self {
        Self { files: vec![(String::new(), bytes)], lost: Vec::new() }
    }
}

/// A reader: the whole file in, a mesh out.
pub type Read = fn(&Input<'_>) -> Result<Mesh>;
/// A writer: a mesh in, the content of one or more files out.
pub type Write = fn(&Mesh, &WriteOptions) -> Result<Written>;

/// A file format.
#[derive(Clone, Copy)]
pub struct Format {
    /// Its name, for messages.
    pub name: &'static str,
    /// File endings, with the dot, in lower case; `/` for a format that is a folder.
    pub endings: &'static [&'static str],
    /// How it is read.
    pub read: Option<Read>,
    /// How it is written.
    pub write: Option<Write>,
}

impl Format {
    /// Whether a mesh in this format is a folder of files.
    pub fn is_folder(&self) -> bool {
        self.endings.iter().any(|ending| ending.ends_with('/'))
    }
}
