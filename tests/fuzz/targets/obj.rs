//! An OBJ, and the material library beside it.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let files = triptych_fuzz::files(&["a.obj", "a.mtl"], bytes);
    triptych_fuzz::mesh("a.obj", &files);
});
