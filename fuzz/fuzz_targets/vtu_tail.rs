#![no_main]
//! Reads any bytes as a large VTU file in both ways: whole, and array by array from the file. The results
//! must agree.

use std::cell::LazyCell;
use std::fs;

use libfuzzer_sys::fuzz_target;

mod common;

/// Files of at least this size with raw appended data are read array by array.
const LARGE: usize = 256 << 10;

thread_local! {
    static FOLDER: LazyCell<tempfile::TempDir> = LazyCell::new(|| tempfile::tempdir().expect("a folder in memory"));
}

fuzz_target!(|bytes: &[u8]| {
    let mut bytes = bytes.to_vec();
    bytes.resize(bytes.len().max(LARGE), 0);
    FOLDER.with(|folder| {
        let path = folder.path().join("in.vtu");
        fs::write(&path, &bytes).expect("it is written");
        let by_array = motet::io::read(&path).ok();
        let whole = common::read(".vtu", &bytes);
        assert_eq!(by_array.map(|m| (m.points.len(), m.cells)), whole.map(|m| (m.points.len(), m.cells)));
    });
});
