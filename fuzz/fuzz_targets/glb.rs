#![no_main]
//! Reads any bytes as a .glb file; what can be read is written as .off and read again.

mod common;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some(mesh) = common::read(".glb", bytes) else { return };
    let Some((again, complete)) = common::try_write(".off", &mesh) else { return };
    let again = common::read(".off", &again).expect("what is written is read");
    assert!(!complete || again.points.len() == mesh.points.len());
});
