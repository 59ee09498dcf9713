//! Results of legs whose inputs and code have not changed.
//!
//! Content-addressed: a leg's key is the SHA-256 of everything that it depends on:
//! this binary, the scene with its meshes and seed, the options, the adapter with
//! its driver's version and libraries, Embree's library. Only what agrees is kept,
//! so that a divergence is always seen afresh.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::report::Picture;
use crate::row::{Row, Verdict};

/// Entries that no run has used for so long are removed.
const KEPT: Duration = Duration::from_secs(30 * 24 * 3600);

/// What a leg of a scene came to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Unit {
    /// Its rows.
    pub rows: Vec<Row>,
    /// Its pictures; their PNGs are files of their own.
    pub pictures: Vec<Picture>,
    /// Milliseconds that skipping saved, where measured.
    pub saved_ms: Option<f64>,
}

/// A folder of units.
#[derive(Clone, Debug)]
pub struct Cache {
    dir: PathBuf,
    /// Hash of the code: this binary and the libraries that it has loaded.
    code: String,
}

impl Cache {
    /// A cache in a folder, which is made. Call it once all libraries are loaded.
    ///
    /// # Errors
    /// A folder that cannot be made or read, a library that cannot be read.
    pub fn open(dir: &Path) -> io::Result<Self> {
        fs::create_dir_all(dir)?;
        prune(dir)?;
        Ok(Self {
            dir: dir.to_owned(),
            code: code()?,
        })
    }

    /// The key of a unit with these inputs.
    pub fn key(&self, inputs: &[&str]) -> String {
        let mut digest = Sha256::new();
        for part in std::iter::once(&self.code.as_str()).chain(inputs) {
            digest.update(part.len().to_le_bytes());
            digest.update(part.as_bytes());
        }
        hex(&digest.finalize())
    }

    /// What is kept under a key, its rows marked as cached. Whatever is damaged is
    /// not there.
    pub fn get(&self, key: &str) -> Option<Unit> {
        let dir = self.dir.join(key);
        let text = fs::read(dir.join(UNIT)).ok()?;
        let mut unit: Unit = serde_json::from_slice(&text).ok()?;
        for (i, picture) in unit.pictures.iter_mut().enumerate() {
            picture.image.png = fs::read(dir.join(png(i))).ok()?;
        }
        for row in &mut unit.rows {
            row.cached = true;
        }
        // Used today; if that cannot be noted, the entry is removed the sooner.
        if let Ok(file) = fs::File::open(dir.join(UNIT)) {
            let _ = file.set_modified(SystemTime::now());
        }
        Some(unit)
    }

    /// Keeps a unit, if all of it agrees. Entries appear whole or not at all.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub fn put(&self, key: &str, unit: &Unit) -> io::Result<()> {
        if unit
            .rows
            .iter()
            .any(|row| row.verdict() == Verdict::Diverge)
        {
            return Ok(());
        }
        let new = self.dir.join(format!("{key}.{}", std::process::id()));
        fs::create_dir_all(&new)?;
        for (i, picture) in unit.pictures.iter().enumerate() {
            fs::write(new.join(png(i)), &picture.image.png)?;
        }
        fs::write(new.join(UNIT), serde_json::to_vec(unit)?)?;
        let entry = self.dir.join(key);
        if entry.exists() {
            fs::remove_dir_all(&entry)?;
        }
        fs::rename(&new, &entry)
    }
}

const UNIT: &str = "unit.json";

fn png(i: usize) -> String {
    format!("{i}.png")
}

fn prune(dir: &Path) -> io::Result<()> {
    let now = SystemTime::now();
    for entry in fs::read_dir(dir)? {
        let path = entry?.path();
        let used = fs::metadata(path.join(UNIT)).and_then(|m| m.modified());
        let age = used.ok().and_then(|used| now.duration_since(used).ok());
        if age.is_some_and(|age| age > KEPT) {
            fs::remove_dir_all(path)?;
        }
    }
    Ok(())
}

/// Hash of this binary and of the drivers and tracers that it has loaded.
fn code() -> io::Result<String> {
    let mut digest = Sha256::new();
    hash_file(&std::env::current_exe()?, &mut digest)?;
    for library in libraries() {
        hash_file(&library, &mut digest)?;
    }
    Ok(hex(&digest.finalize()))
}

/// Loaded libraries that compute results, in order. Linux tells; elsewhere the
/// drivers' versions in the key must do.
fn libraries() -> Vec<PathBuf> {
    const COMPUTES: [&str; 7] = [
        "embree", "tbb", "vulkan", "vk_", "LLVM", "nvidia", "gallium",
    ];
    let maps = fs::read_to_string("/proc/self/maps").unwrap_or_default();
    let mut paths: Vec<PathBuf> = maps
        .lines()
        .filter_map(|line| line.find('/').map(|at| PathBuf::from(&line[at..])))
        .filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.contains(".so") && COMPUTES.iter().any(|part| name.contains(part))
        })
        .collect();
    paths.sort();
    paths.dedup();
    paths
}

fn hash_file(path: &Path, digest: &mut Sha256) -> io::Result<()> {
    let bytes =
        fs::read(path).map_err(|e| io::Error::new(e.kind(), format!("{}: {e}", path.display())))?;
    digest.update(bytes);
    Ok(())
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::replay::rows::Rows;
    use crate::row::Class;

    fn cache(name: &str) -> Cache {
        let dir =
            std::env::temp_dir().join(format!("triptych-cache-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&dir);
        Cache::open(&dir).expect("a folder in the temporary folder")
    }

    fn unit(differ: u64) -> Unit {
        let mut rows = Rows::new("raster/x", "raster");
        rows.skip("cover", "spec", "gpu", Class::Exact, "nothing".into());
        rows.rows[0].differ = differ;
        Unit {
            rows: rows.rows,
            ..Unit::default()
        }
    }

    #[test]
    fn what_agrees_comes_back_marked() {
        let cache = cache("agrees");
        let key = cache.key(&["scene", "leg"]);
        assert_eq!(cache.get(&key), None, "nothing is kept yet");
        cache.put(&key, &unit(0)).expect("written");
        let back = cache.get(&key).expect("kept");
        assert!(back.rows[0].cached, "rows from the cache say so");
        assert_eq!(
            cache.get(&cache.key(&["scene", "other"])),
            None,
            "another leg is another key"
        );
    }

    #[test]
    fn what_diverges_is_not_kept() {
        let cache = cache("diverges");
        let key = cache.key(&["scene"]);
        cache.put(&key, &unit(1)).expect("no error");
        assert_eq!(cache.get(&key), None, "a divergence is seen afresh");
    }

    #[test]
    fn a_damaged_entry_is_not_there() {
        let cache = cache("damaged");
        let key = cache.key(&["scene"]);
        cache.put(&key, &unit(0)).expect("written");
        fs::write(cache.dir.join(&key).join(UNIT), b"{").expect("damaged");
        assert_eq!(cache.get(&key), None, "half an entry is none");
    }

    #[test]
    fn parts_of_a_key_do_not_run_together() {
        let cache = cache("parts");
        assert_ne!(
            cache.key(&["ab", "c"]),
            cache.key(&["a", "bc"]),
            "lengths are hashed"
        );
    }
}
