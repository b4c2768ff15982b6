#![no_main]
//! Reads any bytes as a .cdb file; what can be read is written and read again.

mod common;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| common::there_and_back(".cdb", bytes));
