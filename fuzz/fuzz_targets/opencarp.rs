#![no_main]
//! Splits any bytes at zero bytes into .pts, .elem and .lon files, and reads them.

use std::cell::LazyCell;
use std::fs;

use libfuzzer_sys::fuzz_target;

thread_local! {
    static FOLDER: LazyCell<tempfile::TempDir> = LazyCell::new(|| tempfile::tempdir().expect("a folder in memory"));
}

fuzz_target!(|bytes: &[u8]| {
    FOLDER.with(|folder| {
        let path = folder.path().join("in.pts");
        let mut parts = bytes.split(|&b| b == 0);
        for extension in ["pts", "elem", "lon"] {
            fs::write(path.with_extension(extension), parts.next().unwrap_or(b"0"))
                .expect("it is written");
        }
        if let Ok(mesh) = motet::io::read(&path) {
            mesh.validate().expect("a reader returns a mesh that holds together");
        }
    });
});
