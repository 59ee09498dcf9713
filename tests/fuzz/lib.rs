//! What the fuzz targets share: files in memory, and what must hold of whatever loads.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use triptych_harness::corpus::Entry;
use triptych_harness::error::InputError;
use triptych_harness::json::{self, Merged};
use triptych_harness::mesh::{self, Intake, Mesh};
use triptych_harness::scene::{self, LoadError, Loaded};

#[path = "../hostile/sound.rs"]
mod sound;

/// The line between the parts of an input that stands for several files.
const BETWEEN: &[u8] = b"\n%%%%\n";

/// The parts of an input, as many as there are names; those that are missing are empty.
fn files(names: &[&str], bytes: &[u8]) -> BTreeMap<PathBuf, Vec<u8>> {
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

/// An OBJ, and the material library beside it.
pub fn obj(bytes: &[u8]) -> Result<Mesh, InputError> {
    mesh("a.obj", &files(&["a.obj", "a.mtl"], bytes))
}

/// A PLY of any of the three encodings.
pub fn ply(bytes: &[u8]) -> Result<Mesh, InputError> {
    mesh("a.ply", &files(&["a.ply"], bytes))
}

/// Hair: a layout, and the data that it describes. They are not packed, so that the
/// fuzzer sees what gzip would hide from it.
pub fn hair(bytes: &[u8]) -> Result<Mesh, InputError> {
    let path = Path::new("a.bin");
    let layout = mesh::layout_of(path).display().to_string();
    let files = files(&[&layout, "a.bin"], bytes);
    let mut intake = Intake::from_memory(&files);
    mesh::load_hair(&mut intake, path, files[path].clone(), NonZeroU32::MIN)
}

fn mesh(name: &str, files: &BTreeMap<PathBuf, Vec<u8>>) -> Result<Mesh, InputError> {
    let path = Path::new(name);
    mesh::load(&mut Intake::from_memory(files), path, files[path].clone())
}

/// A scene file, with two meshes and a library that it may name.
pub fn scene(bytes: &[u8]) -> Result<Loaded, LoadError> {
    let files = files(&["scene.toml", "a.obj", "a.mtl", "a.ply"], bytes);
    let entry = Entry {
        name: "fuzz".to_owned(),
        family: "abuffer".to_owned(),
        path: PathBuf::from("scene.toml"),
    };
    scene::load_from(&mut Intake::from_memory(&files), &entry, None)
}

/// JSON lines, as `triptych report` reads them.
pub fn json(bytes: &[u8]) -> Result<Merged, InputError> {
    json::read_from(Path::new("a.json"), bytes)
}

/// Holds a mesh, or why there is none, against what is promised of every one.
pub fn judge_mesh(loaded: Result<Mesh, InputError>) {
    match loaded {
        Ok(mesh) => {
            sound::assert_sound(&mesh);
            mesh.notes.line().iter().for_each(one_line);
        }
        Err(error) => one_line(error),
    }
}

/// The same of a scene.
pub fn judge_scene(loaded: Result<Loaded, LoadError>) {
    match loaded {
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
