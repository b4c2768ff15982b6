#![no_main]
//! Reads any bytes as a solution of a mesh of one tetrahedron and one triangle.

use std::cell::LazyCell;
use std::fs;

use libfuzzer_sys::fuzz_target;

thread_local! {
    static FOLDER: LazyCell<tempfile::TempDir> = LazyCell::new(|| tempfile::tempdir().expect("a folder in memory"));
}

const MESH: &str = "MeshVersionFormatted 2 Dimension 3 Vertices 4 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0 \
    Triangles 1 1 2 3 1 Tetrahedra 1 1 2 3 4 1 End";

fuzz_target!(|bytes: &[u8]| {
    FOLDER.with(|folder| {
        let path = folder.path().join("in.sol");
        fs::write(path.with_extension("mesh"), MESH).expect("it is written");
        fs::write(&path, bytes).expect("it is written");
        if let Ok(mesh) = motet::io::read(&path) {
            mesh.validate().expect("a reader returns a mesh that holds together");
        }
    });
});
