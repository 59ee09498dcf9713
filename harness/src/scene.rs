//! Scenes: from scene.toml or a bare mesh to what every leg is given.

mod abuffer;
mod blending;
pub mod dispatch;
mod effect;
pub mod expect;
pub mod file;
mod fit;
mod flatten;
pub mod grid;
pub mod ldm;
mod mistake;
pub mod rsm;
mod shade;
pub mod sky;
mod source;
mod surface;
#[cfg(test)]
mod tests;
pub mod value;
pub mod world;

use std::path::Path;

use sha2::{Digest, Sha256};
use triptych_spec::scene::Scene;

use crate::corpus::{self, Entry};
use crate::error::InputError;
use crate::mesh::Intake;
use crate::text::{self, hex};
use file::SceneFile;
pub use mistake::{Lines, Mistake};
use mistake::{line_of, utf8};
use sky::Sky;
use world::World;

/// Largest scene.toml in bytes. Parsing takes up to a hundred times as much memory.
pub const FILE_MAX: u64 = 1 << 20;

/// Levels of nesting beyond which the parser of a scene.toml gives up.
const LEVELS_MAX: usize = 80;

/// Characters of a remark that are shown.
const REMARK_SHOWN: usize = 1000;

/// What a bare mesh is shown as.
const BARE: &str = r#"
purpose = "a mesh by itself, seen whole"
size = [512, 512]
mesh = []
"#;

/// A scene, ready for the legs.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// `family/case`.
    pub name: String,
    /// `raster`, `abuffer`, `grid`, `rsm`, `ldm` or `dispatch`.
    pub family: String,
    /// The scene as written.
    pub file: SceneFile,
    /// Where its keys stand.
    pub lines: Lines,
    /// Whether it is a bare mesh, with everything else by default.
    pub bare: bool,
    /// The scene as the legs see it.
    pub scene: Scene,
    /// The same before the camera.
    pub world: World,
    /// Light from all around, if `[ldm]` states one.
    pub sky: Option<Sky>,
    /// What was loaded.
    pub stats: Stats,
}

/// What loading saw.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Triangles over all meshes and instances.
    pub triangles: u64,
    /// Of these, without area in object space.
    pub degenerate: u64,
    /// The meshes in order.
    pub meshes: Vec<MeshStats>,
    /// SHA-256 of everything that was read: scene, meshes, material libraries,
    /// seed. Generators are code and not part of it.
    pub sha256: String,
}

impl Stats {
    /// One line for each mesh of which something was left out, by its name.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        for mesh in &self.meshes {
            let name = mesh.source.split_once(' ').map_or("", |(_, name)| name);
            let remark = mesh.notes.line().map(|line| format!("{name}: {line}"));
            let remark = remark.map(|line| text::cut(&line, REMARK_SHOWN).into_owned());
            // A scene may use a mesh more than once.
            remarks.extend(remark.filter(|line| !remarks.contains(line)));
        }
        remarks
    }
}

/// What loading saw of one mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MeshStats {
    /// `file shape.obj`, `package bunny.obj` or `generate stack`.
    pub source: String,
    /// SHA-256 of the mesh file as it lies on disk; `None` for a generator.
    pub sha256: Option<String>,
    /// Triangles of one instance.
    pub triangles: u64,
    /// Number of instances.
    pub instances: u64,
    /// Triangles of one instance without area.
    pub degenerate: u64,
    /// What the file holds beside triangles, and remarks.
    pub notes: crate::mesh::Notes,
}

/// Why a scene is not loaded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LoadError {
    /// Something is wrong with a file.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A package's mesh is not there: the scene is to be skipped and counted.
    #[error("mesh {mesh} is not there; `{command}` installs it")]
    Missing {
        /// Its name in corpus/meshes.lock.
        mesh: String,
        /// What installs it.
        command: &'static str,
    },
}

/// Loads a scene.toml or a bare mesh as a scene outside the corpus.
///
/// # Errors
/// See [`LoadError`].
pub fn load(path: &Path) -> Result<Loaded, LoadError> {
    load_entry(&Entry::outside(path), None)
}

/// Loads a scene; `seed` takes the place of the scene's own.
///
/// # Errors
/// See [`LoadError`].
pub fn load_entry(entry: &Entry, seed: Option<u64>) -> Result<Loaded, LoadError> {
    load_from(&mut Intake::from_disk(), entry, seed)
}

/// Loads a scene from wherever its files lie.
///
/// # Errors
/// See [`LoadError`].
pub fn load_from(
    intake: &mut Intake,
    entry: &Entry,
    seed: Option<u64>,
) -> Result<Loaded, LoadError> {
    let path = &entry.path;
    if corpus::is_mesh(path) {
        let mut parsed = parse(path, BARE)?;
        parsed.file.mesh = vec![source::bare(path)];
        return of_parsed(intake, entry, seed, parsed, Sha256::new());
    }
    let bytes = intake.read(path, FILE_MAX)?;
    load_text(intake, entry, seed, utf8(path, &bytes)?)
}

/// Loads a scene whose scene.toml, at the entry's path, is to say this.
///
/// # Errors
/// See [`LoadError`].
pub fn load_text(
    intake: &mut Intake,
    entry: &Entry,
    seed: Option<u64>,
    text: &str,
) -> Result<Loaded, LoadError> {
    let parsed = parse(&entry.path, text)?;
    of_parsed(intake, entry, seed, parsed, Sha256::new_with_prefix(text))
}

/// Loads what a scene file names. The digest has seen the file.
fn of_parsed(
    intake: &mut Intake,
    entry: &Entry,
    seed: Option<u64>,
    mut parsed: Parsed<'_>,
    mut digest: Sha256,
) -> Result<Loaded, LoadError> {
    if let Some(seed) = seed {
        parsed.file.seed = seed;
    }
    let places = parsed.file.expect.check_places(parsed.file.size.0);
    places.map_err(|(span, message)| parsed.error(span, message))?;
    digest.update(parsed.file.seed.to_le_bytes());
    abuffer::check(&parsed)?;
    grid::check(&parsed)?;
    [rsm::check, ldm::check, dispatch::check]
        .iter()
        .try_for_each(|check| check(&parsed))?;
    ldm::settle(&mut parsed.file);
    let sky = sky::load(intake, &parsed, &mut digest)?;
    let mut meshes = source::load_all(intake, &parsed, &mut digest)?;
    rsm::check_meshes(&parsed, &meshes)?;
    let (scene, world) = flatten::flatten(&parsed, &mut meshes)?;
    let mut stats = source::stats(&meshes);
    stats.sha256 = hex(&digest.finalize());
    Ok(Loaded {
        name: entry.name.clone(),
        bare: corpus::is_mesh(&entry.path),
        family: entry.family.clone(),
        lines: parsed.keys,
        file: parsed.file,
        scene,
        world,
        sky,
        stats,
    })
}

/// A scene file with what is needed to point at its lines.
struct Parsed<'a> {
    path: &'a Path,
    /// Byte offset of the start of every line.
    lines: Vec<usize>,
    keys: Lines,
    file: SceneFile,
}

impl Parsed<'_> {
    /// An error at a place of the scene file. A bare mesh has no such places.
    fn error(&self, span: std::ops::Range<usize>, message: impl Into<String>) -> InputError {
        if corpus::is_mesh(self.path) {
            return InputError::new(self.path, message);
        }
        InputError::at(self.path, line_of(&self.lines, span.start), message)
    }
}

/// What a scene is for, without loading its meshes.
///
/// # Errors
/// A file that cannot be read or parsed.
pub fn purpose(path: &Path) -> Result<String, InputError> {
    if corpus::is_mesh(path) {
        return Ok(parse(path, BARE)?.file.purpose.0);
    }
    let bytes = Intake::from_disk().read(path, FILE_MAX)?;
    Ok(parse(path, utf8(path, &bytes)?)?.file.purpose.0)
}

fn parse<'a>(path: &'a Path, text: &str) -> Result<Parsed<'a>, InputError> {
    let starts = text.match_indices('\n').map(|(at, _)| at + 1);
    let lines: Vec<usize> = std::iter::once(0).chain(starts).collect();
    let file: SceneFile = toml::from_str(text).map_err(|e| {
        let line = e.span().map(|span| line_of(&lines, span.start));
        InputError {
            file: path.to_owned(),
            line,
            message: match e.message() {
                // The parser's words where a dotted key nests too deep.
                "recursion limit" => {
                    format!("a key has more than {LEVELS_MAX} dotted parts, the limit")
                }
                message => message.to_owned(),
            },
        }
    })?;
    let others = file.grid.is_some() || file.is_lit_later();
    let keys = match others || abuffer::is_judged_later(&file) {
        true => Lines::new(text, |at| line_of(&lines, at)),
        false => Lines::default(),
    };
    Ok(Parsed {
        path,
        lines,
        keys,
        file,
    })
}
