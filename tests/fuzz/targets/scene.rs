//! A scene file, with two meshes and a library that it may name.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let names = ["scene.toml", "a.obj", "a.mtl", "a.ply"];
    triptych_fuzz::scene(&triptych_fuzz::files(&names, bytes));
});
