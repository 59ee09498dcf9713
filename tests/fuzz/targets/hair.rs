//! Hair: a layout, and the data that it describes.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    triptych_fuzz::judge_mesh(triptych_fuzz::hair(bytes));
});
