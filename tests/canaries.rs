//! The harness tests itself: broken kernels, which some leg must kill, and one canary
//! for each typed cause, which every leg must report as exactly that cause. Each runs on
//! a scene on which the shipped kernels agree.

mod adapters;
#[path = "canaries/leg.rs"]
mod leg;

use std::collections::{BTreeMap, BTreeSet};
use std::process::ExitCode;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use libtest_mimic::{Arguments, Failed, Trial};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_harness::cause::Cause;
use triptych_harness::corpus;
use triptych_harness::mutants::{Cell, Columns, Lab, Mutant, by_mutant, legs, mutants};
use triptych_harness::replay::{Options, replay};

fn main() -> ExitCode {
    let mut arguments = Arguments::from_args();
    // Most of them wait for a lab, whichever is free.
    arguments.test_threads.get_or_insert(WAITING);
    let cage = Arc::new(Cage {
        labs: Default::default(),
        order: mutants().into_iter().map(|m| m.name).zip(0..).collect(),
    });
    let mut trials = Vec::new();
    for mutant in by_turns(mutants()) {
        let cage = cage.clone();
        let cause = mutant.cause.map_or_else(|| "mutant".into(), Cause::name);
        let name = format!("{cause}/{}", mutant.name);
        trials.push(Trial::test(name, move || cage.kill(&mutant)));
    }
    for (name, test) in [
        ("lab/what-changes-nothing-survives", survives as Check),
        ("lab/what-does-not-compile-is-no-kill", no_kill),
        (
            "lab/where-the-shipped-kernels-fail-nothing-is-said",
            no_ground,
        ),
    ] {
        let cage = cage.clone();
        trials.push(Trial::test(name, move || test(&cage)));
    }
    trials.push(Trial::test("device-lost/destroyed", lose_device));
    trials.extend(leg::trials());
    trials.push(Trial::test("every-cause-has-a-canary", every_cause));
    let conclusion = libtest_mimic::run(&arguments, trials);
    cage.print();
    conclusion.exit_code()
}

/// Tests that wait or run at once: so many that seldom all of them wait for one lab.
const WAITING: usize = 8;

/// Mutants as they are listed, but those of one lab and of the other by turns.
fn by_turns(all: Vec<Mutant>) -> Vec<Mutant> {
    let (first, second): (Vec<_>, Vec<_>) = all.into_iter().partition(|m| lab_of(m) == 0);
    let [a, b] = [first.len(), second.len()];
    let place = |of: usize| move |(i, mutant)| ((2 * i + 1) * (a + b - of), mutant);
    let first = first.into_iter().enumerate().map(place(a));
    let mut all: Vec<_> = first
        .chain(second.into_iter().enumerate().map(place(b)))
        .collect();
    all.sort_by_key(|(place, _)| *place);
    all.into_iter().map(|(_, mutant)| mutant).collect()
}

/// Mutants on frames take about as long as those on grids, indirect light and maps together.
fn lab_of(mutant: &Mutant) -> usize {
    let frames = ["abuffer/", "raster/", "vertex/"];
    usize::from(!frames.iter().any(|family| mutant.scene.starts_with(family)))
}

/// Two labs: a driver compiles on one core, and runs most kernels there. Their scenes have few
/// kernels in common, so little is compiled twice.
struct Cage {
    labs: [Mutex<State>; 2],
    /// Where mutants stand in the table.
    order: BTreeMap<String, usize>,
}

/// The devices, opened when first asked for, and what came of the mutants so far.
#[derive(Default)]
struct State {
    lab: Option<Lab>,
    cells: Vec<Cell>,
    time: Duration,
}

impl Cage {
    fn state(&self, lab: usize) -> MutexGuard<'_, State> {
        self.labs[lab]
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    fn kill(&self, mutant: &Mutant) -> Result<(), Failed> {
        let mut state = self.state(lab_of(mutant));
        let start = Instant::now();
        let mut lab = match state.lab.take() {
            Some(lab) => lab,
            None => open()?,
        };
        let cells = lab.run(mutant);
        state.lab = Some(lab).filter(Lab::is_well);
        let cells = cells?;
        state.time += start.elapsed();
        let listed = |cell: &&Cell| self.order.contains_key(&cell.mutant);
        state.cells.extend(cells.iter().filter(listed).cloned());
        Ok(mutant.judge(&cells)?)
    }

    /// The kill matrix.
    fn print(&self) {
        let states = [self.state(0), self.state(1)];
        let cells: Vec<Cell> = states.iter().flat_map(|s| s.cells.clone()).collect();
        if cells.is_empty() {
            return;
        }
        let mut rows: Vec<_> = by_mutant(&cells);
        rows.sort_by_key(|(name, _)| self.order[*name]);
        let names = cells.iter().map(|c| (c.mutant.as_str(), c.scene.as_str()));
        let legs: Vec<String> = legs(&cells).into_iter().map(str::to_owned).collect();
        let columns = Columns::new(&legs, names);
        for line in columns.header() {
            println!("{line}");
        }
        for (_, cells) in &rows {
            println!("{}", columns.line(cells));
        }
        let times: Vec<String> = states
            .iter()
            .map(|s| format!("{:.1} s", s.time.as_secs_f64()))
            .collect();
        println!("{} mutants in {}\n", rows.len(), times.join(" and "));
    }
}

type Check = fn(&Cage) -> Result<(), Failed>;

/// A mutant of the sort that is not in the table.
fn other(replace: &str, more: &str) -> Result<Mutant, Failed> {
    Ok(toml::from_str(&format!(
        "name = \"other\"\ndefect = \"of a test\"\nscene = \"abuffer/quads\"\n{more}\n\
         [[patch]]\nfile = \"abuffer\"\nfind = \"return x.key < y.key\"\nreplace = \"{replace}\""
    ))?)
}

fn must_fail(said: Result<(), Failed>, words: &str) -> Result<(), Failed> {
    match said {
        Err(error) if error.message().is_some_and(|m| m.contains(words)) => Ok(()),
        said => Err(format!("said {said:?}, must say {words}").into()),
    }
}

fn survives(cage: &Cage) -> Result<(), Failed> {
    let same = other("return y.key > x.key", "racy = true")?;
    must_fail(cage.kill(&same), "other survives: of a test")
}

fn no_kill(cage: &Cage) -> Result<(), Failed> {
    must_fail(
        cage.kill(&other("return x.kex < y.key", "")?),
        "abuffer.wgsl:",
    )
}

/// Kernels that are broken before the mutant comes.
fn no_ground(_: &Cage) -> Result<(), Failed> {
    let broken = other("return x.key > y.key", "")?;
    let mut adapters = adapters::open()?;
    adapters.truncate(1);
    for adapter in &mut adapters {
        adapter.kernels = Kernels::new(broken.sources(false, || 0.0)?);
    }
    let said = Lab::new(adapters).run(&broken).map(drop);
    must_fail(
        said.map_err(Failed::from),
        "the shipped kernels do not agree",
    )
}

fn open() -> Result<Lab, Failed> {
    Ok(Lab::new(adapters::open()?))
}

/// A device that goes away: every leg on it fails, and says why.
fn lose_device() -> Result<(), Failed> {
    let adapters = adapters::open()?;
    for adapter in &adapters {
        adapter.gpu.device.destroy();
    }
    let entries = corpus::list(&corpus::root())?;
    let quads = entries.iter().find(|e| e.name == "abuffer/quads");
    let options = Options {
        embree: false,
        paths: vec![Path::Compute],
        ..Options::default()
    };
    let outcome = replay(quads.ok_or("no abuffer/quads")?, &adapters, &options)?;
    for adapter in &adapters {
        let label = format!("gpu@{}/", adapter.gpu.name);
        let rows = outcome.rows.iter().filter(|r| r.b.starts_with(&label));
        let rows: Vec<_> = rows.filter(|r| r.differ > 0).collect();
        let lost = rows
            .iter()
            .all(|r| r.causes.keys().eq([&Cause::DeviceLost]));
        if rows.is_empty() || !lost || rows.iter().any(|r| r.unexplained > 0) {
            return Err(format!("not exactly device-lost: {rows:#?}").into());
        }
    }
    Ok(())
}

/// Each cause that a comparer can give has a canary. `edge` is no difference: what
/// is in that class is counted, not judged.
fn every_cause() -> Result<(), Failed> {
    let mut sung: BTreeSet<Cause> = mutants().iter().filter_map(|m| m.cause).collect();
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
