//! Reading files with limits.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::error::InputError;

/// Most bytes of a mesh file, and of what a .gz unpacks to. Loading holds up to
/// four times as much.
pub const BYTES_MAX: u64 = 1 << 29;

/// A regular file as it lies on disk.
///
/// # Errors
/// A missing or unreadable file, a folder or device, more bytes than `limit`.
pub fn read(path: &Path, limit: u64) -> Result<Vec<u8>, InputError> {
    let fail = |e: io::Error| {
        let message = match e.kind() {
            io::ErrorKind::NotFound => "does not exist".to_owned(),
            _ => format!("cannot be read: {e}"),
        };
        InputError::new(path, message)
    };
    // Asked before opening: opening a pipe would wait for its other end.
    if !std::fs::metadata(path).map_err(fail)?.is_file() {
        return Err(InputError::new(path, "is not a regular file"));
    }
    let file = File::open(path).map_err(fail)?;
    let bytes = read_limited(file, limit).map_err(fail)?;
    bytes.ok_or_else(|| {
        let message = format!("has more than {limit} bytes, the limit");
        InputError::new(path, message)
    })
}

/// What a file holds: unpacked if its name ends in .gz.
pub(super) fn unpacked<'a>(
    path: &Path,
    bytes: &'a [u8],
) -> Result<std::borrow::Cow<'a, [u8]>, InputError> {
    if !path.to_string_lossy().to_lowercase().ends_with(".gz") {
        return Ok(bytes.into());
    }
    let unpacked = read_limited(MultiGzDecoder::new(bytes), BYTES_MAX)
        .map_err(|e| InputError::new(path, format!("is not sound gzip: {e}")))?;
    let Some(unpacked) = unpacked else {
        let message = format!("unpacks to more than {BYTES_MAX} bytes, the limit");
        return Err(InputError::new(path, message));
    };
    Ok(unpacked.into())
}

/// All bytes, or `None` if there are more than `limit`.
fn read_limited(from: impl Read, limit: u64) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    from.take(limit + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= limit).then_some(bytes))
}
