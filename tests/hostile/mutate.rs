//! Sound files with a few bytes changed: whatever comes of them, it is a sound
//! mesh or one line, never a panic.

use std::collections::BTreeMap;
use std::path::Path;

use triptych_harness::generate::Random;
use triptych_harness::mesh;

use super::{Loads, assert_sound, obj, ply};

/// Changes of each file.
const CHANGES: usize = 2000;

/// Bytes that mean something to a loader.
const BYTES: &[u8] = b"0123456789-+.eEnainf/\\# \t\r\nvflp\0\xff\x80{}";

fn change(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len().max(1));
        let byte = BYTES[random.below(BYTES.len())];
        match random.below(4) {
            0 if at < bytes.len() => bytes[at] = byte,
            1 => bytes.insert(at, byte),
            2 if at < bytes.len() => drop(bytes.remove(at)),
            _ => bytes.truncate(at),
        }
    }
}

#[test]
fn changed_files_load_or_fail_in_one_line() {
    let mut random = Random::new(2010);
    let nothing = BTreeMap::new();
    let sound = obj::CASES.iter().chain(ply::CASES);
    for (name, bytes, _) in sound.filter(|c| matches!(c.2, Loads(_))) {
        for _ in 0..CHANGES {
            let mut changed = bytes.to_vec();
            change(&mut changed, &mut random);
            let mut intake = mesh::Intake::from_memory(&nothing);
            match mesh::load(&mut intake, Path::new(name), changed) {
                Ok(mesh) => assert_sound(&mesh),
                Err(e) => assert_eq!(e.to_string().lines().count(), 1, "{e}"),
            }
        }
    }
}
