//! What the fuzz targets share: files in memory, and what must hold of whatever loads.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use triptych_harness::corpus::Entry;
use triptych_harness::error::InputError;
use triptych_harness::json::{self, Merged};
use triptych_harness::mesh::{self, Intake, Mesh};
use triptych_harness::rays::Kind;
use triptych_harness::registry::Chain;
use triptych_harness::replay::dispatch::DispatchRun;
use triptych_harness::replay::grid::{GridRun, blockers};
use triptych_harness::replay::ldm::LdmRun;
use triptych_harness::replay::rsm::{RsmRun, Setup};
use triptych_harness::scene::{self, LoadError, Loaded, Mistake};

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

/// A scene file, with two meshes, a library and two skies that it may name.
pub fn scene(bytes: &[u8]) -> Result<Loaded, LoadError> {
    let names = ["scene.toml", "a.obj", "a.mtl", "a.ply", "a.hdr", "a.exr"];
    let files = files(&names, bytes);
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
        Ok(loaded) => {
            assert_finite(&loaded);
            let replayed = match loaded.chain() {
                Chain::Frame => Ok(()),
                Chain::Rays => rays(&loaded),
                Chain::Indirect => indirect(&loaded),
                Chain::Maps => maps(&loaded),
                Chain::Traced => traced(&loaded),
            };
            replayed.err().iter().for_each(one_line);
        }
        Err(error) => one_line(error),
    }
}

/// What the spec makes of a grid: a lattice, and where it takes no time, lists and hits.
fn rays(loaded: &Loaded) -> Result<(), Mistake> {
    blockers(loaded)?;
    let grid = loaded.file.grid.unwrap_or_default();
    let cells = grid.resolution.map_or([1; 3], |cells| cells.0);
    let rays: u64 = Kind::ALL
        .iter()
        .map(|kind| u64::from(kind.count(&grid.rays)))
        .sum();
    let cells: u64 = cells.into_iter().map(u64::from).product();
    if loaded.scene.triangles.len() > 64 || rays > 2048 || cells > 4096 {
        return Ok(());
    }
    let run = GridRun::new(loaded)?;
    assert_eq!(run.rays.len(), run.answers.len(), "an answer to each ray");
    Ok(())
}

/// The same of indirect light: a lattice with cameras and lengths on it, and frames.
fn indirect(loaded: &Loaded) -> Result<(), Mistake> {
    let setup = Setup::new(loaded)?;
    let side = u64::from(setup.parameters.side());
    let pixels = setup.eye.size.pixels() as u64;
    let texels = setup.lamp.view.size.pixels() as u64;
    let pairs = u64::from(setup.frames) * pixels * side * side;
    if loaded.scene.triangles.len() > 64 || pairs > 1 << 16 || texels > 1 << 14 {
        return Ok(());
    }
    let run = RsmRun::new(loaded, true)?;
    for frame in &run.frames {
        let numbers = frame.frame.picture.iter().flatten();
        assert!(numbers.into_iter().all(|c| !c.value.is_nan()), "a colour");
    }
    Ok(())
}

/// The same of layered depth maps: a lattice with who asks on it, and what is open.
fn maps(loaded: &Loaded) -> Result<(), Mistake> {
    let ldm = loaded.file.ldm.as_ref().map(|ldm| ldm.get_ref());
    let maps = ldm.map_or(0, |ldm| u64::from(ldm.maps()));
    let side = ldm.map_or(0, |ldm| u64::from(ldm.resolution.0));
    let pixels = loaded.scene.size.pixels() as u64;
    if loaded.scene.triangles.len() > 64 || maps * (pixels + side * side) > 1 << 18 {
        return Ok(());
    }
    let run = LdmRun::new(loaded, true)?;
    for (open, light) in run.openness.iter().zip(&run.light) {
        assert!((0.0..2.0).contains(&open.value), "a part of the hemisphere");
        assert!(light.iter().all(|c| c.value >= 0.0), "light");
    }
    Ok(())
}

/// The same of rays in queues: a lattice with lamps and eye on it, and a picture.
fn traced(loaded: &Loaded) -> Result<(), Mistake> {
    let dispatch = loaded.file.dispatch.as_ref().map(|d| d.get_ref());
    let rays = dispatch.map_or(0, |d| d.rays(loaded.scene.size.pixels() as u64, true));
    if loaded.scene.triangles.len() > 64 || rays > 1 << 18 {
        return Ok(());
    }
    let run = DispatchRun::new(loaded)?;
    assert!(run.rays() <= rays, "no more rays than there may be");
    Ok(())
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
