//! JSON lines, as `triptych report` reads them.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Err(error) = triptych_fuzz::json(bytes) {
        triptych_fuzz::one_line(error);
    }
});
