//! JSON lines, as `triptych report` reads them.

#![no_main]

use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let read = triptych_harness::json::read_from(Path::new("a.json"), bytes);
    if let Err(error) = read {
        triptych_fuzz::one_line(error);
    }
});
