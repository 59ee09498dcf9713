//! Broken kernels: patches of the shipped WGSL, from `kernels.toml`.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use triptych_gpu::wgsl::{Sources, WgslError};
use triptych_harness::cause::Cause;
use triptych_harness::corpus::Entry;
use triptych_harness::plan::Plan;
use triptych_harness::replay::spec::SpecRun;
use triptych_harness::scene::load_entry;
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

/// A defect of a shipped kernel.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Canary {
    /// What it must be reported as.
    pub cause: Cause,
    /// The stage that alone must report it, where that is stated.
    pub stage: Option<String>,
    /// What is broken.
    pub name: String,
    /// A scene of the corpus that shows it, or the path of one in the repository.
    pub scene: String,
    file: String,
    find: String,
    replace: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    canary: Vec<Canary>,
}

/// All of them.
pub fn canaries() -> Vec<Canary> {
    let table: Table = toml::from_str(include_str!("kernels.toml")).expect("kernels.toml is sound");
    table.canary
}

impl Canary {
    /// The patched kernels.
    ///
    /// # Errors
    /// A text to replace that is not there, or not once.
    pub fn sources(&self) -> Result<Sources, WgslError> {
        let replace = match self.replace.contains("TWICE") {
            true => self
                .replace
                .replace("TWICE", &twice_the_bound(&self.entry())),
            false => self.replace.clone(),
        };
        Sources::shipped(false).patched(&self.file, &self.find, &replace)
    }

    /// Its scene.
    pub fn entry(&self) -> Entry {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("");
        let path: PathBuf = match self.scene.ends_with(".toml") {
            true => root.join(&self.scene),
            false => triptych_harness::corpus::root()
                .join(&self.scene)
                .join("scene.toml"),
        };
        Entry {
            name: self.scene.clone(),
            family: "abuffer".into(),
            path,
        }
    }
}

/// The least share of a colour by which every colour of a scene with layers differs
/// by twice its own bound, as WGSL.
fn twice_the_bound(entry: &Entry) -> String {
    let loaded = load_entry(entry, None).expect("the scene loads");
    let scene = &loaded.scene;
    let run = SpecRun::new(
        scene,
        primitives(scene, SUBPIXEL_BITS),
        &Plan::new(scene, true),
    )
    .expect("the scene is small");
    let lists = run.sorted.offsets.windows(2);
    let layered = run
        .image
        .iter()
        .zip(lists)
        .filter(|(_, list)| list[0] < list[1]);
    let shares = layered.flat_map(|(pixel, _)| pixel.map(|c| c.bound / c.value));
    format!("{:e}f", 2.0 * shares.fold(0.0, f64::max))
}
