//! What the fuzz targets share: files in memory, and what must hold of whatever loads.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use triptych_harness::corpus::Entry;
use triptych_harness::error::InputError;
use triptych_harness::mesh::{self, Intake, Mesh};
use triptych_harness::scene::{self, Loaded};

#[path = "../hostile/sound.rs"]
mod sound;

/// The line between the parts of an input that stands for several files.
const BETWEEN: &[u8] = b"\n%%%%\n";

/// The parts of an input, as many as there are names; those that are missing are empty.
pub fn files(names: &[&str], bytes: &[u8]) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut rest = bytes;
    let mut files = BTreeMap::new();
    for name in names {
        let at = rest.windows(BETWEEN.len()).position(|w| w == BETWEEN);
        let (part, others) = match at {
            Some(at) => (&rest[..at], &rest[at + BETWEEN.len()..]),
            None => (rest, &[][..]),
        };
        files.insert(PathBuf::from(name), part.to_vec());
        rest = others;
    }
    files
}

/// Loads one of the files as a mesh: it is sound, or one line says what is wrong.
pub fn mesh(name: &str, files: &BTreeMap<PathBuf, Vec<u8>>) {
    let mut intake = Intake::from_memory(files);
    let path = Path::new(name);
    let bytes = files[path].clone();
    judge(mesh::load(&mut intake, path, bytes));
}

/// Holds what came of a mesh against what is promised.
pub fn judge(loaded: Result<Mesh, InputError>) {
    match loaded {
        Ok(mesh) => {
            sound::assert_sound(&mesh);
            if let Some(line) = mesh.notes.line() {
                one_line(line);
            }
        }
        Err(error) => one_line(error),
    }
}

/// Loads `scene.toml`, and whatever of the other files it names.
pub fn scene(files: &BTreeMap<PathBuf, Vec<u8>>) {
    let mut intake = Intake::from_memory(files);
    let entry = Entry {
        name: "fuzz".to_owned(),
        family: "abuffer".to_owned(),
        path: PathBuf::from("scene.toml"),
    };
    match scene::load_from(&mut intake, &entry, None) {
        Ok(loaded) => assert_finite(&loaded),
        Err(error) => one_line(error),
    }
}

/// No leg is ever handed a corner or a colour that is not a number.
fn assert_finite(loaded: &Loaded) {
    let scene = &loaded.scene;
    let colours = scene.triangles.iter().flat_map(|t| t.colour);
    let numbers = colours.chain(scene.vertices.iter().flat_map(|v| v.position));
    for number in numbers {
        assert!(number.is_finite(), "{number} is handed to the legs");
    }
    loaded.stats.remarks().iter().for_each(one_line);
}

/// What a user is told is one short line without anything that moves the cursor.
pub fn one_line(message: impl Display) {
    let message = message.to_string();
    assert!(!message.contains(char::is_control), "{message:?}");
    assert!(message.len() < 6000, "{} bytes", message.len());
}
