#![no_main]
//! Reads any bytes as a PVD file.

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(frames) = motet::io::parse_series(bytes) {
        assert!(frames.iter().all(|(time, _)| time.is_finite()));
    }
});
