//! File formats: a reader and a writer, their inputs and their results.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use crate::base::{Error, Result, Threads};
use crate::io::output::Output;
use crate::mesh::Mesh;

/// Input of a reader: the whole file, and its path for formats that consist of several files.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// Path of the file.
    pub path: &'a Path,
    /// Content of the file.
    pub bytes: &'a [u8],
    /// The threads that the reader may use. The mesh does not depend on them.
    pub threads: &'a Threads,
    /// Receives what the reader skips.
    pub notes: &'a Notes,
}

/// Messages for the user about what a reader skipped: unknown sections, texture coordinates, a second label
/// on one cell.
#[derive(Debug, Default)]
pub struct Notes(Mutex<Vec<String>>);

impl Notes {
    /// Adds a message, unless it is already present.
    pub fn add(&self, note: impl Into<String>) {
        let mut notes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let note = note.into();
        if !notes.contains(&note) {
            notes.push(note);
        }
    }

    /// All messages, in the order in which they were added.
    pub fn into_vec(self) -> Vec<String> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

/// How numbers are stored, if the format offers a choice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Text; numbers with enough digits to be recovered bit for bit.
    Ascii,
    /// Base64 inside the elements (XML formats); binary elsewhere.
    Base64,
    /// Raw bytes: appended (XML formats), binary elsewhere.
    #[default]
    Binary,
}

/// How blocks are compressed, if the format supports it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// No compression.
    None,
    /// zlib, which every reader supports.
    #[default]
    Zlib,
    /// lz4: faster, larger.
    Lz4,
    /// lzma (xz): slower, smaller.
    Lzma,
}

/// Options for writing.
#[derive(Clone, Debug, Default)]
pub struct WriteOptions {
    /// How numbers are stored.
    pub encoding: Encoding,
    /// How blocks are compressed.
    pub compression: Compression,
    /// The format's own version, such as `2.2` for MSH; the format's default when `None`.
    pub version: Option<String>,
}

/// Files in memory, and what their format could not hold.
#[derive(Clone, Debug, Default)]
pub struct Written {
    /// Extension (with dot) and content of each file; the extension replaces that of the requested path, and
    /// an empty one stands for the path itself. For a format that is a folder: the path within the folder.
    pub files: Vec<(String, Vec<u8>)>,
    /// What the format cannot hold, one message for the user each.
    pub lost: Vec<String>,
}

/// A reader: takes the whole file, returns a mesh.
pub type Read = fn(&Input<'_>) -> Result<Mesh>;

/// A writer of a mesh.
#[derive(Clone, Copy, Debug)]
pub enum Write {
    /// Writes one file, part by part; returns what the format could not hold, one message for the user each.
    File(fn(&Mesh, &WriteOptions, &mut Output<'_>) -> Result<Vec<String>>),
    /// Makes several files, or those of a folder. The last argument is their name without extension, for
    /// files that refer to each other; it is empty if they have no name.
    Files(fn(&Mesh, &WriteOptions, &Threads, &str) -> Result<Written>),
}

/// A file format.
#[derive(Clone, Copy)]
pub struct Format {
    /// Name of the format, for messages.
    pub name: &'static str,
    /// File extensions, with the dot, in lower case; `/` for a format that is a folder.
    pub extensions: &'static [&'static str],
    /// The reader; `None` if the format cannot be read.
    pub read: Option<Read>,
    /// The writer; `None` if the format cannot be written.
    pub write: Option<Write>,
}

impl Format {
    /// Whether a mesh in this format is a folder of files.
    pub fn is_folder(&self) -> bool {
        self.extensions.iter().any(|extension| extension.ends_with('/'))
    }

    /// The files that hold a mesh in this format, in memory. Their bytes do not depend on the threads.
    ///
    /// # Errors
    /// If the format cannot be written, or cannot hold the mesh.
    pub fn to_files(&self, mesh: &Mesh, options: &WriteOptions, threads: &Threads) -> Result<Written> {
        match self.write.ok_or_else(|| self.only_read())? {
            Write::File(write) => {
                let mut bytes = Vec::new();
                let lost = write(mesh, options, &mut Output::to_memory(&mut bytes, threads))?;
                Ok(Written { files: vec![(String::new(), bytes)], lost })
            }
            Write::Files(write) => write(mesh, options, threads, ""),
        }
    }

    /// The error for a format that cannot be written.
    pub(super) fn only_read(&self) -> Error {
        Error::input(format!("{} files can only be read", self.name))
    }
}
