//! Where a run took place.

use serde::{Deserialize, Serialize};

use crate::replay::gpu::Adapter;

/// A machine, as far as times depend on it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// What it is called in the names of files: the first adapter that is a board, else
    /// the processor.
    pub slug: String,
    /// The processor's own words.
    pub cpu: String,
    /// Cores that this process may use.
    pub cores: usize,
    /// System and architecture.
    pub system: String,
    /// Version of Triptych, and whether it was built for release.
    pub version: String,
    /// Each adapter's name, and what it says of itself and its driver.
    pub adapters: Vec<(String, String)>,
}

impl Machine {
    /// This one.
    pub fn here(adapters: &[Adapter]) -> Self {
        let board = adapters.iter().find(|a| {
            let kind = a.gpu.info.device_type;
            kind != wgpu::DeviceType::Cpu
        });
        let cpu = processor();
        let build = match cfg!(debug_assertions) {
            true => "development build",
            false => "release build",
        };
        let facts = |a: &Adapter| {
            let info = &a.gpu.info;
            let words = [&info.name, &info.driver, &info.driver_info];
            let words = words.map(|w| w.trim().to_owned());
            (
                a.gpu.name.clone(),
                format!("{}, {:?}", words.join(", "), info.backend),
            )
        };
        Self {
            slug: slug(board.map_or(&cpu, |a| &a.gpu.name)),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            version: format!("triptych {}, {build}", env!("CARGO_PKG_VERSION")),
            adapters: adapters.iter().map(facts).collect(),
            cpu,
        }
    }
}

/// What Linux says of the first processor.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find(|l| l.starts_with("model name"));
    let name = line.and_then(|l| l.split_once(':'));
    name.map_or("unknown processor", |(_, name)| name.trim())
        .to_owned()
}

/// A name without anything that a file name should not have.
fn slug(name: &str) -> String {
    let lower = name.to_lowercase();
    let words = lower.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|w| !w.is_empty()).take(6).collect();
    words.join("-")
}

#[cfg(test)]
mod tests {
    use super::slug;

    #[test]
    fn names_become_file_names() {
        assert_eq!(
            slug("Intel(R) Xeon(R) CPU @ 2.80GHz"),
            "intel-r-xeon-r-cpu-2"
        );
        assert_eq!(slug("NVIDIA H200"), "nvidia-h200");
        assert_eq!(slug("../.."), "");
    }
}
