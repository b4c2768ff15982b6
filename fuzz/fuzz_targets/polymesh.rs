#![no_main]
//! Splits any bytes at 0xff into the files of a polyMesh, and reads them.

use std::cell::LazyCell;
use std::fs;

use libfuzzer_sys::fuzz_target;

thread_local! {
    static FOLDER: LazyCell<tempfile::TempDir> = LazyCell::new(|| tempfile::tempdir().expect("a folder in memory"));
}

fuzz_target!(|bytes: &[u8]| {
    FOLDER.with(|folder| {
        let mut parts = bytes.split(|&b| b == 0xff);
        for name in ["points", "faces", "owner", "neighbour", "boundary", "cellZones"] {
            fs::write(folder.path().join(name), parts.next().unwrap_or(b"")).expect("it is written");
        }
        if let Ok(mesh) = motet::io::read(folder.path()) {
            mesh.validate().expect("a reader returns a mesh that holds together");
        }
    });
});
