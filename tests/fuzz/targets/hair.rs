//! Hair: a layout, and the data that it describes. They are packed here, so that the
//! fuzzer sees what gzip would hide from it.

#![no_main]

use std::num::NonZeroU32;
use std::path::Path;

use triptych_harness::mesh::{Intake, load_hair};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let files = triptych_fuzz::files(&["a.xml", "a.bin"], bytes);
    let data = files[Path::new("a.bin")].clone();
    let mut intake = Intake::from_memory(&files);
    let hair = load_hair(&mut intake, Path::new("a.bin"), data, NonZeroU32::MIN);
    triptych_fuzz::judge(hair);
});
