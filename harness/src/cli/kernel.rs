//! `--kernel STAGE=FILE`: a user's kernels in place of ours.

use std::path::Path;

use anyhow::Context;
use triptych_gpu::kernel::{Foreign, STAGES, Stage, skeleton};
use triptych_gpu::raster;

use crate::error::InputError;
use crate::mesh::Intake;
use crate::output::complain;
use crate::replay::Options;
use crate::row::Row;

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
            anyhow::ensure!(
                values.len() == 1,
                "--kernel {value}: prints a skeleton; leave the other --kernel out"
            );
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

/// Whether a run with these options runs every kernel that it was given, if a scene
/// needs its stage.
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

/// Whether every kernel's stage was compared somewhere, on whichever adapter.
///
/// # Errors
/// One whose stage no scene of the run needs, or that `--gpu-from` left out.
pub fn all_judged(foreign: &[Foreign], rows: &[Row]) -> anyhow::Result<()> {
    let judged = |kernel: &&Foreign| {
        let name = kernel.stage.name;
        let of_stage = |row: &&Row| row.stage == name && row.b.starts_with("gpu@");
        rows.iter()
            .filter(of_stage)
            .any(|row| row.skipped.is_none())
    };
    match foreign.iter().find(|kernel| !judged(kernel)) {
        None => Ok(()),
        Some(Foreign { stage, file, .. }) => {
            let name = stage.name;
            anyhow::bail!(
                "--kernel {name}={file}: stage {name} was skipped everywhere, for the reasons \
                 above, so that nothing was said of it; other scenes or --no-skip may run it"
            )
        }
    }
}

fn runs(foreign: &Foreign, options: &Options) -> bool {
    let mut paths = options.paths.iter();
    options.gpu && paths.any(|path| foreign.serves(*path == raster::Path::Fragment))
}

fn read(stage: &'static Stage, file: &str) -> anyhow::Result<Foreign> {
    let bytes = Intake::from_disk().read(Path::new(file), FILE_MAX)?;
    let text = String::from_utf8(bytes)
        .map_err(|error| InputError::new(file, format!("is not UTF-8: {error}")))?;
    Foreign::new(stage, file, &text).map_err(|mut errors| {
        let last = errors.pop();
        for error in errors {
            complain(error);
        }
        last.map_or_else(|| anyhow::anyhow!("{file}: no reason"), anyhow::Error::from)
    })
}
