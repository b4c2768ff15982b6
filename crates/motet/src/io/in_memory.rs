//! Reading and writing of formats without files, for their tests.

use std::path::Path;

use crate::base::{Result, Threads};
use crate::io::format::{Format, Input, Notes, WriteOptions};
use crate::io::read_as;
use crate::mesh::Mesh;

/// Reads bytes as the file `name`; also returns the notes.
pub(super) fn parsed(format: &Format, name: impl AsRef<Path>, bytes: &[u8]) -> (Result<Mesh>, Vec<String>) {
    let notes = Notes::default();
    let input = Input { path: name.as_ref(), bytes, threads: &Threads::single(), notes: &notes };
    (read_as(format, &input), notes.into_vec())
}

/// Writes a mesh; returns the first file, and what is lost.
pub(super) fn printed(format: &Format, mesh: &Mesh, options: &WriteOptions) -> (Vec<u8>, Vec<String>) {
    let mut written = format.to_files(mesh, options, &Threads::single()).unwrap();
    (written.files.remove(0).1, written.lost)
}

/// Writes a mesh in a format of text; returns the first file, and what is lost.
pub(super) fn printed_text(format: &Format, mesh: &Mesh) -> (String, Vec<String>) {
    let (bytes, lost) = printed(format, mesh, &WriteOptions::default());
    (String::from_utf8(bytes).unwrap(), lost)
}

/// Checks that each text in which a part is replaced by another is refused with a message that names the file
/// and contains the third text.
pub(super) fn refuses(format: &Format, name: &str, text: &str, damages: &[(&str, &str, &str)]) {
    for (from, to, expected) in damages {
        assert!(text.contains(from), "{from}");
        let error = parsed(format, name, text.replacen(from, to, 1).as_bytes()).0.unwrap_err().to_string();
        assert!(error.starts_with(&format!("{name}: ")) && error.contains(expected), "{to}: {error}");
    }
}

/// Checks that a file in which any byte is replaced by any of `others` is read as a valid mesh or refused.
pub(super) fn survives_changed_bytes(format: &Format, name: &str, file: &[u8], others: &[u8]) {
    let mut bytes = file.to_vec();
    for place in 0..bytes.len() {
        for &other in others {
            let own = std::mem::replace(&mut bytes[place], other);
            if let Ok(mesh) = parsed(format, name, &bytes).0 {
                mesh.validate().unwrap();
            }
            bytes[place] = own;
        }
    }
}
