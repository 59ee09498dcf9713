//! A PLY of any of the three encodings.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    triptych_fuzz::judge_mesh(triptych_fuzz::ply(bytes));
});
