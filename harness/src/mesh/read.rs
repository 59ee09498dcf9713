//! Reading files with limits.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use flate2::bufread::GzDecoder;

use crate::error::InputError;

/// Most bytes of the files of a scene together; a .gz counts as what it unpacks to,
/// or as what it has, whichever is more. Loading takes up to five times as much memory.
pub const BYTES_MAX: u64 = 1 << 29;

/// Most members of a .gz: programs that pack in blocks make one of every 64 KiB or so.
const MEMBERS_MAX: u32 = 1 << 16;

/// Where files lie.
enum Files<'a> {
    Disk,
    Memory(&'a BTreeMap<PathBuf, Vec<u8>>),
}

/// What a scene takes in: reads its files, and counts their bytes.
pub struct Intake<'a> {
    files: Files<'a>,
    /// What may still be read.
    left: u64,
    taken: Vec<PathBuf>,
}

impl Intake<'static> {
    /// Files as they lie on disk.
    pub fn from_disk() -> Self {
        Self {
            files: Files::Disk,
            left: BYTES_MAX,
            taken: Vec::new(),
        }
    }
}

impl<'a> Intake<'a> {
    /// Files in memory, and no others.
    pub fn from_memory(files: &'a BTreeMap<PathBuf, Vec<u8>>) -> Self {
        Self {
            files: Files::Memory(files),
            left: BYTES_MAX,
            taken: Vec::new(),
        }
    }

    /// The files that were read, in order.
    pub fn taken(&self) -> &[PathBuf] {
        &self.taken
    }

    /// Whether there is something by that name.
    pub(crate) fn has(&self, path: &Path) -> bool {
        match self.files {
            Files::Disk => path.exists(),
            Files::Memory(files) => files.contains_key(path),
        }
    }

    /// A regular file as it lies there.
    ///
    /// # Errors
    /// A missing or unreadable file, a folder or device, more bytes than `limit`, more
    /// than the files before it leave of [`BYTES_MAX`].
    pub fn read(&mut self, path: &Path, limit: u64) -> Result<Vec<u8>, InputError> {
        let error = |message: String| InputError::new(path, message);
        let most = limit.min(self.left);
        let bytes = match self.files {
            Files::Disk => on_disk(path, most).map_err(error)?,
            Files::Memory(files) => match files.get(path) {
                Some(bytes) => read_limited(&bytes[..], most).expect("memory is readable"),
                None => return Err(error("does not exist".to_owned())),
            },
        };
        let bytes = bytes.ok_or_else(|| error(format!("has more than {}", limits(most, limit))))?;
        self.left -= bytes.len() as u64;
        self.taken.push(path.to_owned());
        Ok(bytes)
    }

    /// What a file that was just read holds: unpacked if its name ends in .gz.
    ///
    /// # Errors
    /// Damaged data, or more bytes than the files before it leave of [`BYTES_MAX`].
    pub fn unpack(&mut self, path: &Path, bytes: Vec<u8>) -> Result<Vec<u8>, InputError> {
        if !path.to_string_lossy().to_lowercase().ends_with(".gz") {
            return Ok(bytes);
        }
        let packed = bytes.len() as u64;
        let most = (self.left + packed).min(BYTES_MAX);
        let error = |message: String| InputError::new(path, message);
        let unpacked = unpacked(&bytes, most).map_err(error)?;
        let unpacked = unpacked
            .ok_or_else(|| error(format!("unpacks to more than {}", limits(most, BYTES_MAX))))?;
        self.left -= (unpacked.len() as u64).saturating_sub(packed);
        Ok(unpacked)
    }
}

/// `N bytes, the limit`, and where it comes from.
fn limits(most: u64, limit: u64) -> String {
    match most < limit {
        false => format!("{limit} bytes, the limit"),
        true => format!("{most} bytes, which is what the files before it leave of {BYTES_MAX}"),
    }
}

/// A regular file, or `None` if it has more than `limit` bytes.
fn on_disk(path: &Path, limit: u64) -> Result<Option<Vec<u8>>, String> {
    let fail = |e: io::Error| match e.kind() {
        io::ErrorKind::NotFound => "does not exist".to_owned(),
        _ => format!("cannot be read: {e}"),
    };
    // Asked before opening: opening a pipe would wait for its other end.
    let metadata = std::fs::metadata(path).map_err(fail)?;
    if !metadata.is_file() {
        return Err("is not a regular file".to_owned());
    }
    // Files of the kernel's have no length, and reading one may wait for an event.
    match metadata.len() {
        0 => Ok(Some(Vec::new())),
        length if length > limit => Ok(None),
        _ => read_limited(File::open(path).map_err(fail)?, limit).map_err(fail),
    }
}

/// What gzip data unpack to, or `None` if it has more than `limit` bytes.
fn unpacked(mut packed: &[u8], limit: u64) -> Result<Option<Vec<u8>>, String> {
    let mut unpacked = Vec::new();
    for _ in 0..MEMBERS_MAX {
        let mut member = GzDecoder::new(packed);
        let most = limit + 1 - unpacked.len() as u64;
        let read = member.by_ref().take(most).read_to_end(&mut unpacked);
        read.map_err(|e| format!("is not sound gzip: {e}"))?;
        packed = member.into_inner();
        if unpacked.len() as u64 > limit {
            return Ok(None);
        } else if packed.is_empty() {
            return Ok(Some(unpacked));
        }
    }
    Err(format!(
        "has more than {MEMBERS_MAX} gzip members, the limit"
    ))
}

/// All bytes, or `None` if there are more than `limit`.
fn read_limited(from: impl Read, limit: u64) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    from.take(limit + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= limit).then_some(bytes))
}
