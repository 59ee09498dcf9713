//! Results of legs whose inputs and code have not changed.
//!
//! Content-addressed: a leg's key is the SHA-256 of everything that it depends on:
//! this binary, the scene with its meshes and seed, the options, the adapter with
//! its driver's version and libraries, Embree's library. Only what agrees is kept,
//! so that a divergence is always seen afresh. What depends on code whose bytes
//! cannot be read has no key, and is not kept either.

mod code;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::report::Picture;
use crate::row::{Row, Verdict};
use crate::sheet::Sheet;
use crate::text::hex;
use code::Code;
pub use code::Uses;

/// Entries that no run has used for so long are removed.
const KEPT: Duration = Duration::from_secs(30 * 24 * 3600);

/// What a leg of a scene came to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Unit {
    /// Its rows.
    pub rows: Vec<Row>,
    /// Its pictures; their PNGs are files of their own.
    pub pictures: Vec<Picture>,
    /// Its lists; their bytes are files of their own.
    pub sheets: Vec<Sheet>,
    /// Legs of which skipping was tested, and the milliseconds that it saved.
    pub saved: Vec<(String, f64)>,
}

/// A folder of units.
#[derive(Clone, Debug)]
pub struct Cache {
    dir: PathBuf,
    binary: Code,
    libraries: Vec<Code>,
}

impl Cache {
    /// A cache in a folder, which is made. Call it once all libraries are loaded.
    ///
    /// # Errors
    /// A folder that cannot be made or read.
    pub fn open(dir: &Path) -> io::Result<Self> {
        fs::create_dir_all(dir)?;
        prune(dir)?;
        Ok(Self {
            dir: dir.to_owned(),
            binary: Code::binary()?,
            libraries: Code::libraries(),
        })
    }

    /// What cannot be kept, and why: a line each.
    pub fn remarks(&self) -> impl Iterator<Item = String> {
        let all = std::iter::once(&self.binary).chain(&self.libraries);
        all.filter_map(Code::remark)
    }

    /// The key of a unit with these inputs; `None` if it depends on code that cannot be
    /// read.
    pub fn key(&self, uses: Uses<'_>, inputs: &[&str]) -> Option<String> {
        let mut digest = Sha256::new();
        let mut part = |part: &str| {
            digest.update(part.len().to_le_bytes());
            digest.update(part.as_bytes());
        };
        part(self.binary.hash()?);
        for library in self.libraries.iter().filter(|l| l.serves(uses)) {
            part(library.hash()?);
        }
        inputs.iter().for_each(|input| part(input));
        Some(hex(&digest.finalize()))
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
        for (i, sheet) in unit.sheets.iter_mut().enumerate() {
            sheet.data = fs::read(dir.join(lists(i))).ok()?;
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
        for (i, sheet) in unit.sheets.iter().enumerate() {
            fs::write(new.join(lists(i)), &sheet.data)?;
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

fn lists(i: usize) -> String {
    format!("{i}.lists")
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

    fn spec_key(cache: &Cache, inputs: &[&str]) -> String {
        let key = cache.key(Uses::Nothing, inputs);
        key.expect("this binary can be read")
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
        let key = spec_key(&cache, &["scene", "leg"]);
        assert_eq!(cache.get(&key), None, "nothing is kept yet");
        cache.put(&key, &unit(0)).expect("written");
        let back = cache.get(&key).expect("kept");
        assert!(back.rows[0].cached, "rows from the cache say so");
        assert_eq!(
            cache.get(&spec_key(&cache, &["scene", "other"])),
            None,
            "another leg is another key"
        );
    }

    #[test]
    fn what_diverges_is_not_kept() {
        let cache = cache("diverges");
        let key = spec_key(&cache, &["scene"]);
        cache.put(&key, &unit(1)).expect("no error");
        assert_eq!(cache.get(&key), None, "a divergence is seen afresh");
    }

    #[test]
    fn a_damaged_entry_is_not_there() {
        let cache = cache("damaged");
        let key = spec_key(&cache, &["scene"]);
        cache.put(&key, &unit(0)).expect("written");
        fs::write(cache.dir.join(&key).join(UNIT), b"{").expect("damaged");
        assert_eq!(cache.get(&key), None, "half an entry is none");
    }

    #[test]
    fn parts_of_a_key_do_not_run_together() {
        let cache = cache("parts");
        assert_ne!(
            spec_key(&cache, &["ab", "c"]),
            spec_key(&cache, &["a", "bc"]),
            "lengths are hashed"
        );
    }

    #[test]
    fn only_what_depends_on_an_unreadable_library_has_no_key() {
        const LLVMPIPE: Uses<'_> = Uses::Driver("llvmpipe (LLVM 15) llvmpipe Mesa 22");
        const SWIFT: Uses<'_> = Uses::Driver("SwiftShader Device SwiftShader driver");
        const OTHER: Uses<'_> = Uses::Driver("some board");
        let all = [Uses::Nothing, Uses::Embree, LLVMPIPE, SWIFT, OTHER];
        let keyed = |library: &str| {
            let mut cache = cache("unreadable");
            let maps = format!("0-1 r-xp 0 00:01 7 /no-such-folder/{library} (deleted)");
            cache.libraries = Code::mapped(&maps);
            assert_eq!(cache.remarks().count(), cache.libraries.len(), "{library}");
            all.map(|uses| cache.key(uses, &["scene"]).is_some())
        };
        let expected = [
            ("libc.so.6", [true, true, true, true, true]),
            ("libembree4.so.4", [true, false, true, true, true]),
            ("libtbb.so.12", [true, false, true, true, true]),
            ("libvulkan_lvp.so", [true, true, false, true, false]),
            ("libvk_swiftshader.so", [true, true, true, false, false]),
            ("libGLX_nvidia.so.0", [true, true, true, true, false]),
            ("libvulkan.so.1", [true, true, false, false, false]),
            ("libLLVM-15.so.1", [true, true, false, false, false]),
        ];
        for (library, has_key) in expected {
            assert_eq!(keyed(library), has_key, "spec, embree, drivers: {library}");
        }
    }

    #[test]
    fn a_key_knows_the_libraries_that_its_work_uses() {
        let mut cache = cache("libraries");
        let library = cache.dir.join("libembree4.so.4");
        let maps = format!("0-1 r-xp 0 00:01 7 {}", library.display());
        let mut keys = |bytes: &[u8]| {
            fs::write(&library, bytes).expect("written");
            cache.libraries = Code::mapped(&maps);
            [Uses::Embree, Uses::Nothing].map(|uses| cache.key(uses, &["scene"]))
        };
        let ([old, spec_old], [new, spec_new]) = (keys(b"old"), keys(b"new"));
        assert!(old.is_some() && new.is_some(), "both can be read");
        assert_ne!(old, new, "another Embree is another key");
        assert_eq!(spec_old, spec_new, "the spec does not use it");
    }
}
