#![no_main]
//! Reads any bytes as a .cas.h5 file; what has volume cells is written as .cas and read again.

mod common;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some(mesh) = common::read(".cas.h5", bytes) else { return };
    let Some((again, complete)) = common::try_write(".cas", &mesh) else { return };
    let again = common::read(".cas", &again).expect("what is written is read");
    assert!(!complete || again.points.len() == mesh.points.len());
});
