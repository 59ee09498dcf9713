//! A scene file, with two meshes and a library that it may name.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    triptych_fuzz::judge_scene(triptych_fuzz::scene(bytes));
});
