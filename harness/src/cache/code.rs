//! The code that results depend on: this binary, and the libraries that it has loaded.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::text::hex;

/// What a piece of work runs on beside this binary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Uses<'a> {
    /// Nothing else: the spec.
    Nothing,
    /// Embree and what it is built on.
    Embree,
    /// A driver; the adapter's and the driver's own words.
    Driver(&'a str),
}

/// A file of code that is loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Code {
    path: String,
    /// SHA-256 of its bytes, or why they cannot be read. A library that was replaced
    /// while this process runs is such a one: its path now leads to other bytes.
    hash: Result<String, String>,
}

/// Adapters by a word of theirs, and the name of the library that serves no other.
const DRIVERS: [(&str, &str); 3] = [
    ("llvmpipe", "vulkan_lvp"),
    ("swiftshader", "swiftshader"),
    ("nvidia", "nvidia"),
];

/// Parts of the names of the libraries that Embree brings.
const TRACER: [&str; 2] = ["embree", "tbb"];

/// Parts of the names of drivers, their loader and their compilers.
const DRIVER: [&str; 5] = ["vulkan", "vk_", "LLVM", "nvidia", "gallium"];

impl Code {
    fn read(path: &Path, shown: String) -> Self {
        let bytes = fs::read(path).map_err(|e| e.to_string());
        Self {
            path: shown,
            hash: bytes.map(|b| hex(&Sha256::digest(b))),
        }
    }

    /// This binary, also if the file has been replaced or removed since.
    pub(super) fn binary() -> io::Result<Self> {
        let running = Path::new("/proc/self/exe");
        let shown = std::env::current_exe()?;
        let path = if running.exists() { running } else { &shown };
        Ok(Self::read(path, shown.display().to_string()))
    }

    /// Loaded libraries that compute results, in order of path. Linux tells; elsewhere
    /// the drivers' versions in the key must do.
    pub(super) fn libraries() -> Vec<Self> {
        let maps = fs::read_to_string("/proc/self/maps").unwrap_or_default();
        Self::mapped(&maps)
    }

    /// Those of a process's memory map. Behind the path of a file that is no longer
    /// there, Linux writes " (deleted)".
    pub(super) fn mapped(maps: &str) -> Vec<Self> {
        let path = |line: &str| line.find('/').map(|at| PathBuf::from(&line[at..]));
        let mut paths: Vec<PathBuf> = maps.lines().filter_map(path).collect();
        paths.sort();
        paths.dedup();
        let computes = |path: &PathBuf| {
            let name = name(&path.to_string_lossy()).to_owned();
            let known = |part: &&str| name.contains(*part);
            name.contains(".so") && TRACER.iter().chain(&DRIVER).any(known)
        };
        let all = paths.into_iter().filter(computes);
        all.map(|path| Self::read(&path, path.display().to_string()))
            .collect()
    }

    /// Whether a piece of work runs on this library. Which adapter a library belongs to
    /// is known of a few; where in doubt, it does.
    pub(super) fn serves(&self, uses: Uses<'_>) -> bool {
        let name = name(&self.path);
        let traces = TRACER.iter().any(|part| name.contains(part));
        match uses {
            Uses::Nothing => false,
            Uses::Embree => traces,
            Uses::Driver(words) => {
                let words = words.to_lowercase();
                let library = DRIVERS.iter().position(|(_, part)| name.contains(part));
                let adapter = DRIVERS.iter().position(|(word, _)| words.contains(word));
                !traces && (library.is_none() || adapter.is_none() || library == adapter)
            }
        }
    }

    /// SHA-256 of its bytes, if they can be read.
    pub(super) fn hash(&self) -> Option<&str> {
        self.hash.as_deref().ok()
    }

    /// A line for people, if its bytes cannot be read.
    pub(super) fn remark(&self) -> Option<String> {
        let reason = self.hash.as_ref().err()?;
        let path = &self.path;
        Some(format!(
            "cache: {path}: {reason}; results that depend on it are not kept"
        ))
    }
}

fn name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_replaced_library_has_no_hash_and_a_remark() {
        let dir = std::env::temp_dir().join(format!("triptych-code-{}", std::process::id()));
        fs::create_dir_all(&dir).expect("a folder in the temporary folder");
        let library = dir.join("libvk_swiftshader.so");
        fs::write(&library, b"new bytes").expect("written");
        let path = library.display();
        // The path exists, but it leads to other bytes than those that are loaded.
        let maps = format!(
            "7f0000000000-7f0000001000 r-xp 00000000 00:01 7 {path}\n\
             7f0000001000-7f0000002000 rw-p 00001000 00:01 7 {path}\n\
             7f0000002000-7f0000003000 r-xp 00000000 00:01 8 {path} (deleted)\n\
             7f0000003000-7f0000004000 r-xp 00000000 00:01 9 /usr/lib/libc.so.6\n\
             7f0000004000-7f0000005000 rw-p 00000000 00:00 0 [heap]\n"
        );
        let code = Code::mapped(&maps);
        let hashes: Vec<bool> = code.iter().map(|c| c.hash().is_some()).collect();
        assert_eq!(hashes, [true, false], "the file, and what it replaced");
        let remarks: Vec<String> = code.iter().filter_map(Code::remark).collect();
        assert_eq!(remarks.len(), 1, "{remarks:?}");
        assert!(remarks[0].contains("(deleted)"), "{remarks:?}");
        assert!(!remarks[0].contains('\n'), "{remarks:?}");
        fs::remove_dir_all(&dir).expect("it is ours");
    }

    #[test]
    fn this_binary_and_its_libraries_can_be_read() {
        let binary = Code::binary().expect("a process has a binary");
        assert!(binary.hash().is_some(), "{binary:?}");
    }
}
