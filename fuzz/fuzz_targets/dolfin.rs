#![no_main]
//! Reads any bytes as a DOLFIN XML file.

mod common;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    common::read(".xml", bytes);
});
