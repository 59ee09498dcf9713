//! The harness tests itself: one deliberately broken kernel (or leg) per typed cause,
//! which must be reported as exactly that cause, on every adapter, on a scene on
//! which the shipped kernels agree.

mod devices;
#[path = "canaries/leg.rs"]
mod leg;
#[path = "canaries/table.rs"]
mod table;

use std::collections::{BTreeMap, BTreeSet};
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};

use devices::Devices;
use libtest_mimic::{Arguments, Failed, Trial};
use table::Canary;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_harness::cause::Cause;
use triptych_harness::corpus::{self, Entry};
use triptych_harness::replay::gpu::Adapter;
use triptych_harness::replay::{Options, Outcome, replay};
use triptych_harness::row::{Row, Verdict};

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let cage = Arc::new(Cage::default());
    let mut trials = Vec::new();
    for canary in table::canaries() {
        let cage = cage.clone();
        let name = format!("{}/{}", canary.cause.name(), canary.name);
        trials.push(Trial::test(name, move || cage.sing(&canary)));
    }
    let lost = cage.clone();
    trials.push(Trial::test("device-lost/destroyed", move || {
        lost.lose_device()
    }));
    trials.extend(leg::trials());
    trials.push(Trial::test("every-cause-has-a-canary", every_cause));
    libtest_mimic::run(&arguments, trials).exit_code()
}

/// Devices, and the scenes on which the shipped kernels are known to agree.
#[derive(Default)]
struct Cage {
    devices: Devices,
    sound: Mutex<BTreeSet<String>>,
}

impl Cage {
    fn sing(&self, canary: &Canary) -> Result<(), Failed> {
        let mut adapters = self.devices.take()?;
        // One check a scene; a canary that waits for it would check it as well.
        let mut sound = self.sound.lock().unwrap_or_else(PoisonError::into_inner);
        let entry = canary.entry();
        if !sound.contains(&entry.name) {
            shipped_kernels_agree(&entry, &adapters)?;
            sound.insert(entry.name.clone());
        }
        drop(sound);
        let patched = canary.sources()?;
        let shipped = swap(&mut adapters, || Kernels::new(patched.clone()));
        let outcome = run(&entry, &adapters);
        for (adapter, kernels) in adapters.iter_mut().zip(shipped) {
            adapter.kernels = kernels;
        }
        let outcome = outcome?;
        let wrong: Vec<String> = adapters
            .iter()
            .filter_map(|a| {
                let rows = rows_of(&outcome, a);
                let cause = exactly(canary.cause, &rows);
                cause.and_then(|()| in_stage(canary, &rows)).err()
            })
            .collect();
        if wrong.is_empty() {
            return Ok(());
        }
        adapters.spoil();
        Err(format!("{}\n{}", wrong.join("\n"), outcome.described.join("\n")).into())
    }

    /// A device that goes away: every leg on it fails, and says why.
    fn lose_device(&self) -> Result<(), Failed> {
        let mut adapters = self.devices.take()?;
        adapters.spoil();
        for adapter in adapters.iter() {
            adapter.gpu.device.destroy();
        }
        let quads = corpus::list(&corpus::root())?;
        let quads = quads
            .iter()
            .find(|e| e.name == "abuffer/quads")
            .ok_or("no abuffer/quads")?;
        let outcome = run(quads, &adapters)?;
        for adapter in adapters.iter() {
            exactly(Cause::DeviceLost, &rows_of(&outcome, adapter))?;
        }
        Ok(())
    }
}

/// Gives every adapter other kernels; returns those that it had.
fn swap(adapters: &mut [Adapter], new: impl Fn() -> Kernels) -> Vec<Kernels> {
    let kernels = adapters.iter_mut().map(|a| &mut a.kernels);
    kernels.map(|old| std::mem::replace(old, new())).collect()
}

/// Replays a scene on the compute path of every adapter.
fn run(entry: &Entry, adapters: &[Adapter]) -> Result<Outcome, Failed> {
    let options = Options {
        embree: false,
        paths: vec![Path::Compute],
        ..Options::default()
    };
    Ok(replay(entry, adapters, &options)?)
}

/// Without this, a canary could die of something else.
fn shipped_kernels_agree(entry: &Entry, adapters: &[Adapter]) -> Result<(), Failed> {
    let outcome = run(entry, adapters)?;
    for adapter in adapters.iter() {
        let rows = rows_of(&outcome, adapter);
        let agree = rows.iter().any(|r| r.verdict() == Verdict::Agree);
        let diverge = rows.iter().any(|r| r.verdict() == Verdict::Diverge);
        if diverge || !agree {
            return Err(format!(
                "{}: the shipped kernels do not agree on {}",
                adapter.gpu.name, entry.name
            )
            .into());
        }
    }
    Ok(())
}

fn rows_of<'o>(outcome: &'o Outcome, adapter: &Adapter) -> Vec<&'o Row> {
    let label = format!("gpu@{}/", adapter.gpu.name);
    outcome
        .rows
        .iter()
        .filter(|r| r.b.starts_with(&label))
        .collect()
}

/// Whether rows diverge for one cause and nothing else.
fn exactly(cause: Cause, rows: &[&Row]) -> Result<(), String> {
    let mut causes: BTreeMap<Cause, u64> = BTreeMap::new();
    let mut unexplained = 0;
    for row in rows.iter().filter(|r| r.verdict() == Verdict::Diverge) {
        unexplained += row.unexplained;
        for (cause, count) in &row.causes {
            *causes.entry(*cause).or_default() += count;
        }
    }
    if unexplained == 0 && causes.keys().eq([&cause]) {
        return Ok(());
    }
    let table: Vec<String> = rows
        .iter()
        .map(|r| {
            format!(
                "  {} of {}: {:?}, {:?}, {} unexplained, {}",
                r.stage,
                r.b,
                r.verdict(),
                r.causes,
                r.unexplained,
                r.note
            )
        })
        .collect();
    let name = cause.name();
    Err(format!(
        "not exactly {name}: {causes:?}, {unexplained} unexplained\n{}",
        table.join("\n")
    ))
}

/// Whether only the row of a canary's stage diverges, where it has one.
fn in_stage(canary: &Canary, rows: &[&Row]) -> Result<(), String> {
    let diverging = rows.iter().filter(|r| r.verdict() == Verdict::Diverge);
    let stages: BTreeSet<&str> = diverging.map(|r| r.stage.as_str()).collect();
    match &canary.stage {
        Some(stage) if !stages.iter().eq([stage]) => {
            Err(format!("not in {stage} alone: {stages:?}"))
        }
        _ => Ok(()),
    }
}

/// Each cause that a comparer can give has a canary. `edge` is no difference: what
/// is in that class is counted, not judged.
fn every_cause() -> Result<(), Failed> {
    let mut sung: BTreeSet<Cause> = table::canaries().iter().map(|c| c.cause).collect();
    sung.extend(leg::CAUSES);
    sung.extend([Cause::DeviceLost, Cause::Edge]);
    let silent: Vec<String> = Cause::ALL
        .iter()
        .filter(|c| !sung.contains(c))
        .map(|c| c.name())
        .collect();
    match silent.is_empty() {
        true => Ok(()),
        false => Err(format!("no canary for {}", silent.join(", ")).into()),
    }
}
