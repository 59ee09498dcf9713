//! The table of mutants: one file for each family, and one for the rivals of the A-buffer.

use serde::Deserialize;
use sha2::{Digest, Sha256};
use triptych_gpu::kernel::Fault;
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::{Sources, WgslError};

use super::Outcome;
use crate::cause::Cause;
use crate::corpus::{self, Entry};
use crate::replay::gpu::PathName;
use crate::text::hex;

const TABLES: [(&str, &str); 11] = [
    ("vertex.toml", include_str!("vertex.toml")),
    ("raster.toml", include_str!("raster.toml")),
    ("abuffer.toml", include_str!("abuffer.toml")),
    ("multisample.toml", include_str!("multisample.toml")),
    ("tiles.toml", include_str!("tiles.toml")),
    ("layouts.toml", include_str!("layouts.toml")),
    ("rivals.toml", include_str!("rivals.toml")),
    ("grid.toml", include_str!("grid.toml")),
    ("rsm.toml", include_str!("rsm.toml")),
    ("ldm.toml", include_str!("ldm.toml")),
    ("dispatch.toml", include_str!("dispatch.toml")),
];

/// A named defect, and where it must show.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Mutant {
    /// What it is called.
    pub name: String,
    /// What is wrong, in words.
    pub defect: String,
    /// The scene that shows it, by its folder in the corpus.
    #[serde(default)]
    pub scene: String,
    /// The one cause that every leg must report, and nothing else: a canary.
    pub cause: Option<Cause>,
    /// The stage that alone must diverge, where that is stated.
    pub stage: Option<String>,
    /// How every leg must kill it, where no cause says so, and drivers cannot differ.
    by: Option<Outcome>,
    /// Whether a driver may hide it; then one leg must kill it, otherwise all.
    #[serde(default)]
    pub racy: bool,
    /// Raster paths that have the defect.
    #[serde(default = "compute")]
    paths: Vec<PathName>,
    /// Defects of the WGSL.
    #[serde(default)]
    patch: Vec<Patch>,
    /// A defect of the host's part.
    fault: Option<FaultName>,
    /// The adapter can bind no more than so many bytes.
    pub bindings: Option<u64>,
    /// Why there is no such code to break; then nothing runs.
    pub absent: Option<String>,
}

/// `find`, which occurs once in `file`, is replaced.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Patch {
    file: String,
    find: String,
    replace: String,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum FaultName {
    HeadsNotCleared,
    CounterNotCleared,
    ColourWritten,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    mutant: Vec<Mutant>,
}

fn compute() -> Vec<PathName> {
    vec![PathName::Compute]
}

/// All of them, family by family.
///
/// # Panics
/// If a table of this repository is not sound.
pub fn mutants() -> Vec<Mutant> {
    let of = |(name, text): (&str, &str)| {
        let table: Table = toml::from_str(text).unwrap_or_else(|e| panic!("{name}: {e}"));
        table.mutant
    };
    TABLES.into_iter().flat_map(of).collect()
}

/// The mutants that one of these paths has, on no other, whose name, scene or cause
/// contains one of the patterns; without a pattern all of them.
///
/// # Errors
/// A pattern that selects nothing.
pub fn select(
    mut all: Vec<Mutant>,
    patterns: &[String],
    paths: &[Path],
) -> Result<Vec<Mutant>, String> {
    all.retain_mut(|mutant| {
        mutant.paths.retain(|path| paths.contains(&path.path()));
        !mutant.paths.is_empty()
    });
    let matches = |m: &Mutant, pattern: &String| {
        let cause = m.cause.map(Cause::name).unwrap_or_default();
        [&m.name, &m.scene, &cause]
            .iter()
            .any(|text| text.contains(pattern.as_str()))
    };
    if let Some(pattern) = patterns
        .iter()
        .find(|pattern| !all.iter().any(|m| matches(m, pattern)))
    {
        let of = match paths.len() < Path::ALL.len() {
            true => " of these paths",
            false => "",
        };
        return Err(format!(
            "{pattern}: no mutant{of} has a name, scene or cause like it"
        ));
    }
    let wanted = |m: &Mutant| patterns.is_empty() || patterns.iter().any(|p| matches(m, p));
    Ok(all.into_iter().filter(wanted).collect())
}

/// What a matrix depends on beside drivers: kernels and table.
pub(super) fn digest() -> String {
    let mut sha = Sha256::new();
    for native in [false, true] {
        for (name, text) in Sources::shipped(native).files() {
            sha.update(format!("{name} {}\n{text}", text.len()));
        }
    }
    for (name, text) in TABLES {
        sha.update(format!("{name} {}\n{text}", text.len()));
    }
    hex(&sha.finalize())
}

impl Mutant {
    /// The raster paths that have the defect.
    pub fn paths(&self) -> impl Iterator<Item = Path> {
        self.paths.iter().map(|path| path.path())
    }

    /// The defect of the host's part.
    pub fn fault(&self) -> Option<Fault> {
        self.fault.map(|fault| match fault {
            FaultName::HeadsNotCleared => Fault::HeadsNotCleared,
            FaultName::CounterNotCleared => Fault::CounterNotCleared,
            FaultName::ColourWritten => Fault::ColourWritten,
        })
    }

    /// How every leg that kills it must do so.
    pub fn expected(&self) -> Option<Outcome> {
        self.cause.map(Outcome::of).or(self.by)
    }

    /// The patched kernels. `TWICE` in a replacement stands for a share of twice the
    /// bound, which `twice` works out.
    ///
    /// # Errors
    /// A text to replace that is not there, or not once.
    pub fn sources(&self, native: bool, twice: impl Fn() -> f64) -> Result<Sources, WgslError> {
        let mut sources = Sources::shipped(native);
        for Patch {
            file,
            find,
            replace,
        } in &self.patch
        {
            let replace = match replace.contains("TWICE") {
                true => replace.replace("TWICE", &format!("{:e}f", twice())),
                false => replace.clone(),
            };
            sources = sources.patched(file, find, &replace)?;
        }
        Ok(sources)
    }

    /// Its scene.
    pub fn entry(&self) -> Entry {
        Entry {
            name: self.scene.clone(),
            family: self.scene.split('/').next().unwrap_or_default().into(),
            path: corpus::root().join(&self.scene).join("scene.toml"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::*;

    #[test]
    fn every_mutant_says_how_it_dies() {
        let all = mutants();
        let names: BTreeSet<&str> = all.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names.len(), all.len(), "names are unique");
        for m in &all {
            let broken = !m.patch.is_empty() || m.fault.is_some();
            assert_ne!(
                broken,
                m.absent.is_some(),
                "{}: a defect, or why none",
                m.name
            );
            assert!(
                m.cause.is_none() || m.by.is_none(),
                "{}: said twice",
                m.name
            );
            let dies = [Some(Outcome::Result), Some(Outcome::Structure), None];
            assert!(dies.contains(&m.expected()), "{}: {:?}", m.name, m.by);
        }
    }

    /// Also those of paths that this machine's adapters do not have; in every program that they change.
    #[test]
    fn every_patch_compiles() {
        let shipped = [false, true].map(Sources::shipped);
        let is_root = |text: &str| text.contains("@compute") || text.contains("@fragment");
        let plain = |name: &str| name.trim_end_matches("_samples").to_owned();
        let stem = |name: &str| plain(name).trim_end_matches("_exact").to_owned();
        let texts: BTreeMap<&str, &str> = shipped[0].files().collect();
        let own = |name: &str| texts.get(name).is_some_and(|text| is_root(text));
        let roots: Vec<&str> = texts
            .keys()
            .copied()
            .filter(|name| own(&stem(name)) && !name.starts_with("network"))
            .collect();
        let variants = ["tiles_samples", "grid_exact"].map(|name| roots.contains(&name));
        assert_eq!(variants, [true; 2], "variants are roots too");
        // Networks are long, and change with few mutants: elsewhere nothing stands in their place.
        let without_networks = |sources: Sources| {
            let names = ["network", "network_samples"];
            names
                .into_iter()
                .fold(sources, |all, name| all.with(name.into(), String::new()))
        };
        let shipped = shipped.clone().map(without_networks);
        let text = |sources: &Sources, root| sources.link(root).expect("what ships links").text;
        let must = [0, 1].map(|native| {
            let texts = roots.iter().map(|root| text(&shipped[native], root));
            texts.collect::<Vec<_>>()
        });
        for m in mutants().iter().filter(|m| !m.patch.is_empty()) {
            let natives: BTreeSet<bool> = m.paths().map(|path| path == Path::Native).collect();
            let touches = |file: &str| m.patch.iter().any(|p| p.file.starts_with(file));
            // Sorting by links as it is patched names nodes, which are `packed_nodes` there.
            let names = |p: &Patch| p.file == "relink" && p.replace.contains("nodes[");
            let names_nodes = m.patch.iter().any(names);
            for native in natives {
                let sources = m.sources(native, || 1.0);
                let mut sources = sources.unwrap_or_else(|e| panic!("{}: {e}", m.name));
                if !touches("network") {
                    sources = without_networks(sources);
                }
                let mut changed = 0;
                for (root, must) in roots.iter().zip(&must[usize::from(native)]) {
                    let linked = sources.link(root);
                    let linked = linked.unwrap_or_else(|e| panic!("{}: {e}", m.name));
                    if linked.text == *must || (root.starts_with("packed") && names_nodes) {
                        continue;
                    }
                    changed += 1;
                    let program = linked.parse().map(drop);
                    program.unwrap_or_else(|e| panic!("{} in {root}: {e}", m.name));
                }
                assert!(changed > 0, "{} changes no program", m.name);
            }
        }
    }

    #[test]
    fn patterns_select_by_name_scene_and_cause() {
        let of = |pattern: &str| select(mutants(), &[pattern.to_owned()], &Path::ALL);
        let count = |pattern: &str| of(pattern).map(|m| m.len());
        assert_eq!(count("head-exchanged-in-two-steps"), Ok(1), "by name");
        assert!(count("abuffer/contention").is_ok_and(|n| n > 1), "by scene");
        assert!(count("tie-order").is_ok_and(|n| n > 1), "by cause");
        let none = count("no-such-thing").expect_err("nothing is like it");
        assert!(none.starts_with("no-such-thing: "), "{none}");
    }
}
