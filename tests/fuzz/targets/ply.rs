//! A PLY of any of the three encodings.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let files = [("a.ply".into(), bytes.to_vec())].into();
    triptych_fuzz::mesh("a.ply", &files);
});
