//! An OBJ, and the material library beside it.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    triptych_fuzz::judge_mesh(triptych_fuzz::obj(bytes));
});
