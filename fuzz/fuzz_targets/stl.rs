#![no_main]
//! Reads any bytes as an STL file; its triangles are written and read again.

mod common;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    // The format keeps neither points that no triangle uses, nor the numbering of points.
    if let Some(mesh) = common::read(".stl", bytes) {
        let again = common::read(".stl", &common::write(".stl", &mesh).0).expect("what is written is read");
        assert_eq!(again.cells.len(), mesh.cells.len());
    }
});
