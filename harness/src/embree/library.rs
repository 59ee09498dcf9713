//! Which Embree is loaded, for `doctor` and for the cache key.

use std::fmt;
use std::path::PathBuf;

use embree4_sys::{RTCDeviceProperty, rtcGetDeviceProperty, rtcNewDevice, rtcReleaseDevice};

use super::EmbreeError;
use super::collect::CONFIG;

/// The loaded library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Library {
    /// Major, minor and patch version.
    pub version: [u32; 3],
    /// The file, where the system tells (Linux does).
    pub path: Option<PathBuf>,
}

impl fmt::Display for Library {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [major, minor, patch] = self.version;
        write!(f, "{major}.{minor}.{patch}")?;
        match &self.path {
            Some(path) => write!(f, " ({})", path.display()),
            None => Ok(()),
        }
    }
}

impl Library {
    /// Version and file without its folder, for what is shared with others.
    pub fn named(&self) -> Self {
        let file = self.path.as_ref().and_then(|path| path.file_name());
        Self {
            version: self.version,
            path: file.map(PathBuf::from),
        }
    }
}

/// Asks the loaded library for its version.
///
/// # Errors
/// If no device can be made on this machine.
pub fn library() -> Result<Library, EmbreeError> {
    // RTC_DEVICE_PROPERTY_VERSION is 10000 major + 100 minor + patch.
    let number = u32::try_from(property(RTCDeviceProperty::VERSION)?)
        .map_err(|e| EmbreeError::new("version", e))?;
    Ok(Library {
        version: [number / 10_000, number / 100 % 100, number % 100],
        path: loaded_from(),
    })
}

/// A property of a device that is configured like ours.
#[expect(unsafe_code, reason = "the wrapper does not offer device properties")]
fn property(property: RTCDeviceProperty) -> Result<isize, EmbreeError> {
    // SAFETY: the configuration ends in NUL. The handle is checked, used by this
    // thread alone, and released exactly once.
    unsafe {
        let device = rtcNewDevice(CONFIG.as_ptr().cast());
        if device.is_null() {
            return Err(EmbreeError::new("new device", "refused on this machine"));
        }
        let value = rtcGetDeviceProperty(device, property);
        rtcReleaseDevice(device);
        Ok(value)
    }
}

/// The file that this process has mapped as Embree. A line of the table of
/// mappings ends in the path, after five columns.
fn loaded_from() -> Option<PathBuf> {
    let maps = std::fs::read_to_string("/proc/self/maps").ok()?;
    let path = maps.lines().find_map(|line| {
        let path = &line[line.find('/')?..];
        let name = path.rsplit('/').next()?;
        name.starts_with("libembree4").then_some(path)
    });
    path.map(PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::{RTCDeviceProperty, library, property};

    #[test]
    fn the_loaded_library_is_found() {
        let library = library().expect("Embree is linked");
        assert_eq!(library.version[0], 4, "the headers are those of Embree 4");
        if cfg!(target_os = "linux") {
            let path = library.path.expect("mapped from a file");
            assert!(path.is_file(), "{} is a file", path.display());
        }
    }

    #[test]
    fn the_instruction_set_is_the_same_everywhere() {
        let wide = |p| property(p).expect("a device");
        let four = wide(RTCDeviceProperty::NATIVE_RAY4_SUPPORTED);
        let eight = wide(RTCDeviceProperty::NATIVE_RAY8_SUPPORTED);
        assert_eq!((four, eight), (1, 0), "SSE2 has four lanes");
    }
}
