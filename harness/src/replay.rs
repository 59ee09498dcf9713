//! Replays one scene through all legs and accounts for every difference.

mod adapter;
mod broken;
pub mod dispatch;
mod dumps;
pub mod embree;
pub mod end_to_end;
mod exposure;
pub mod facts;
pub mod gpu;
pub mod grid;
mod hardware;
mod judged;
mod lanes;
pub mod layouts;
pub mod ldm;
mod leg;
mod legs;
mod own_vertices;
pub mod pictures;
pub mod pieces;
mod placed;
pub mod rivals;
pub mod rows;
pub mod rsm;
mod run;
mod sampled;
mod shown;
pub mod skips;
pub mod spec;
mod stop;
pub mod tiles;
pub mod vertex;
mod visible;
pub mod work;
pub mod worst;

use triptych_gpu::raster::Path;
use triptych_spec::scene::Size;
use triptych_spec::vertex::SUBPIXEL_BITS;

use crate::cache::Cache;
use crate::corpus::Entry;
use crate::dump::Dump;
use crate::error::InputError;
use crate::plan::Pass;
pub use crate::plan::passes;
use crate::registry::{Chain, stages_of};
use crate::report::Picture;
use crate::row::{Class, Row};
use crate::scene::{LoadError, Loaded, load_entry};
use crate::sheet::Sheet;
use facts::Facts;
use gpu::{Adapter, Broken, From, Vertices};
use grid::GridRun;
use rows::Rows;
use run::Run;
use worst::Worst;

/// Of which scenes Embree is asked in world space, or rivals of the lists are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Extent {
    /// Those of at most [`embree::WORLD_MAX`] items, or [`rivals::WORK_MAX`] of work, so that it
    /// costs a default run little
    #[default]
    Small,
    /// All of them
    All,
}

/// What to replay, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Replay on GPUs.
    pub gpu: bool,
    /// Adapters on which that is not possible; every scene has a row for each.
    pub broken: Vec<Broken>,
    /// Replay through Embree.
    pub embree: bool,
    /// Of which scenes Embree is asked in world space as well.
    pub world: Extent,
    /// Of which scenes the rivals of the lists are compared.
    pub rivals: Extent,
    /// Raster paths.
    pub paths: Vec<Path>,
    /// From which stage on GPU legs use their own results.
    pub from: From,
    /// Whose vertices GPU legs start from; goes with `from` ([`Vertices::from`]).
    pub vertex: Vertices,
    /// Leave out what a scene does not need.
    pub skip: bool,
    /// In place of the scenes' own seeds.
    pub seed: Option<u64>,
    /// Write every leg's results here.
    pub dump: Option<Dump>,
    /// Keep the legs' pictures and lists for a report.
    pub pictures: bool,
    /// Where results of legs are kept that need not run again.
    pub cache: Option<Cache>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            gpu: true,
            broken: Vec::new(),
            embree: true,
            world: Extent::default(),
            rivals: Extent::default(),
            paths: Path::ALL.to_vec(),
            from: From::default(),
            vertex: Vertices::default(),
            skip: true,
            seed: None,
            dump: None,
            pictures: false,
            cache: None,
        }
    }
}

/// What came of one scene.
pub struct Outcome {
    /// `family/case`.
    pub name: String,
    /// What the scene is for.
    pub purpose: String,
    /// Size of the target; `None` if the scene was not loaded.
    pub size: Option<Size>,
    /// The comparisons.
    pub rows: Vec<Row>,
    /// First differences, in words.
    pub described: Vec<String>,
    /// Pixels that differ, the worst first.
    pub worst: Worst,
    /// What ran.
    pub passes: Vec<Pass>,
    /// GPU legs of which skipping was tested, and the milliseconds that it saved.
    pub saved: Vec<(String, f64)>,
    /// What the spec found, for a snapshot.
    pub facts: Option<Facts>,
    /// Pictures of the legs, then maps.
    pub pictures: Vec<Picture>,
    /// Lists of the legs.
    pub sheets: Vec<Sheet>,
    /// What is beside the point but should be known: what loading left out of a mesh,
    /// a cache that cannot be written.
    pub remarks: Vec<String>,
}

/// Works out what the spec says of a scene, and nothing else.
///
/// # Errors
/// One line for a scene beyond a limit.
pub fn spec_alone(loaded: &Loaded) -> Result<(), String> {
    let options = Options::default();
    let mut run = Run::new(loaded, &[], &options);
    let done = match loaded.chain() {
        Chain::Frame => run.spec(SUBPIXEL_BITS).map(drop),
        Chain::Rays => run.grid_spec().map(drop),
        Chain::Indirect => run.rsm_spec().map(drop),
        Chain::Maps => run.ldm_spec().map(drop),
        Chain::Traced => run.dispatch_spec().map(drop),
    };
    done.map_err(|stop| stop.mistake().to_string())
}

/// Replays a scene.
///
/// # Errors
/// Bad input, in one line. A missing mesh is not one: the scene is skipped.
pub fn replay(
    entry: &Entry,
    adapters: &[Adapter],
    options: &Options,
) -> Result<Outcome, InputError> {
    match load_entry(entry, options.seed) {
        Ok(loaded) => Run::new(&loaded, adapters, options).all().map_err(|stop| {
            let mistake = stop.mistake();
            InputError {
                file: entry.path.clone(),
                line: mistake.key.and_then(|key| loaded.lines.of(key)),
                message: mistake.to_string(),
            }
        }),
        Err(LoadError::Input(error)) => Err(error),
        Err(missing @ LoadError::Missing { .. }) => {
            let mut rows = Rows::new(&entry.name, &entry.family);
            rows.skip("all", "spec", "all legs", Class::Exact, missing.to_string());
            Ok(Outcome::empty(entry, rows))
        }
    }
}

/// Replays a scene with a grid of which the spec's side is known, through all other legs.
///
/// # Errors
/// Bad input, in one line.
pub fn replay_grid(
    loaded: &Loaded,
    spec: GridRun,
    adapters: &[Adapter],
    options: &Options,
) -> Result<Vec<Row>, String> {
    let run = Run::new(loaded, adapters, options).on_grid(spec);
    let outcome = run.all().map_err(|stop| stop.mistake().to_string())?;
    Ok(outcome.rows)
}

impl Outcome {
    /// Whether the scene is not rasterised by drivers: it has a `[grid]`, an `[rsm]` or an
    /// `[ldm]`.
    pub fn runs_kernels_alone(&self) -> bool {
        let frame: Vec<&str> = stages_of(Chain::Frame).map(|stage| stage.name).collect();
        let is_of_frame = |pass: &Pass| frame.contains(&pass.name);
        !self.passes.is_empty() && !self.passes.iter().any(is_of_frame)
    }

    fn empty(entry: &Entry, rows: Rows) -> Self {
        Self {
            name: entry.name.clone(),
            purpose: String::new(),
            size: None,
            rows: rows.rows,
            described: rows.described,
            worst: Worst::default(),
            passes: Vec::new(),
            saved: Vec::new(),
            facts: None,
            pictures: Vec::new(),
            sheets: Vec::new(),
            remarks: Vec::new(),
        }
    }
}

/// Whether a program, or its variant for several samples, is among these.
fn names(files: &[&str], file: &str) -> bool {
    files.iter().any(|f| f.trim_end_matches("_samples") == file)
}
