//! `--kernel STAGE=FILE`: a user's kernels in place of ours.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use anyhow::Context;
use triptych_gpu::kernel::{Foreign, STAGES, Stage, skeleton};
use triptych_gpu::raster;

use crate::error::InputError;
use crate::output::complain;
use crate::replay::Options;

/// Bytes that a kernel's file may have; ours have a hundredth of it.
const FILE_MAX: u64 = 1 << 20;

/// What the option asks for.
pub enum Kernels {
    /// Kernels to run.
    Run(Vec<Foreign>),
    /// WGSL to start from, to be printed.
    Print(String),
}

/// Reads the values of the option, and every file that they name.
///
/// # Errors
/// One line for the last mistake; those before it are already printed.
pub fn kernels(values: &[String]) -> anyhow::Result<Kernels> {
    let mut foreign: Vec<Foreign> = Vec::new();
    for value in values {
        let (name, file) = value
            .split_once('=')
            .with_context(|| format!("--kernel {value}: not STAGE=FILE, nor STAGE=?"))?;
        let stage = Stage::named(name).with_context(|| {
            let all = STAGES.each_ref().map(|stage| stage.name).join(", ");
            format!("--kernel {value}: no stage is called {name}; there are {all}")
        })?;
        if file == "?" {
            return Ok(Kernels::Print(skeleton(stage)?));
        }
        anyhow::ensure!(
            foreign.iter().all(|other| other.stage != stage),
            "--kernel {value}: stage {name} has a kernel already"
        );
        foreign.push(read(stage, file)?);
    }
    Ok(Kernels::Run(foreign))
}

/// Whether a run with these options runs every kernel that it was given.
///
/// # Errors
/// One that it would not: its agreement would say nothing about it.
pub fn all_run(foreign: &[Foreign], options: &Options) -> anyhow::Result<()> {
    match foreign.iter().find(|f| !runs(f, options)) {
        None => Ok(()),
        Some(Foreign { stage, file, .. }) => {
            let name = stage.name;
            anyhow::bail!("--kernel {name}={file}: no leg that was asked for runs its kernels")
        }
    }
}

fn runs(foreign: &Foreign, options: &Options) -> bool {
    let mut paths = options.paths.iter();
    options.gpu && paths.any(|path| foreign.serves(*path == raster::Path::Fragment))
}

fn read(stage: &'static Stage, file: &str) -> anyhow::Result<Foreign> {
    let text = text(Path::new(file)).map_err(|message| InputError::new(file, message))?;
    Foreign::new(stage, file, &text).map_err(|mut errors| {
        let last = errors.pop();
        for error in errors {
            complain(error);
        }
        last.map_or_else(|| anyhow::anyhow!("{file}: no reason"), anyhow::Error::from)
    })
}

/// A file's text, if it is a regular file of a sensible size.
fn text(path: &Path) -> Result<String, String> {
    let told = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => "does not exist".to_owned(),
        _ => error.to_string(),
    };
    // A pipe would keep `open` waiting.
    if !path.metadata().map_err(told)?.is_file() {
        return Err("is no file".into());
    }
    let mut text = Vec::new();
    let file = File::open(path).map_err(told)?;
    file.take(FILE_MAX + 1)
        .read_to_end(&mut text)
        .map_err(told)?;
    if text.len() as u64 > FILE_MAX {
        return Err(format!("has more than {FILE_MAX} bytes"));
    }
    String::from_utf8(text).map_err(|error| format!("is not UTF-8: {error}"))
}
