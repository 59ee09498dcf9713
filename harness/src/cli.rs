//! The command line. Exit code 0: all agree. 1: something diverges. 2: could not
//! run.

mod adapters;
mod add;
mod bench;
mod bundle;
mod doctor;
mod kernel;
mod list;
mod mutants;
mod paths;
mod plan;
mod replay;
mod report;
mod reports;
mod results;
mod run_info;
mod scenes;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::output::complain;

/// What a command came to.
pub enum Verdict {
    /// Everything that was compared agrees.
    Agree,
    /// Something diverges.
    Diverge,
}

#[derive(Parser)]
#[command(
    name = "triptych",
    version,
    about = "Replays scenes through a scalar spec, WGSL on every adapter, and Embree, and \
             accounts for every difference",
    after_help = "Examples:\n  \
        triptych replay                     the whole corpus, all legs, all adapters\n  \
        triptych replay raster/ --leg gpu   the raster family on GPUs alone\n  \
        triptych replay shape.obj           a mesh of your own\n  \
        triptych plan abuffer/sponza        what a scene needs, and what it skips\n\n\
        Exit code 0: all agree. 1: something diverges. 2: could not run."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Measure: time against error, leg against leg, and what holds at the extremes
    #[command(subcommand)]
    Bench(bench::Bench),
    /// Put a scene into the corpus, replay it, and leave its snapshot for review
    Add(add::Args),
    /// Pack what a machine without a toolchain needs
    Bundle(bundle::Args),
    /// What is installed, which adapters there are, and what is missing
    #[command(
        after_help = "It also runs what drivers were found to do wrong, corpus/findings, on every \
                      adapter: each must still be seen where it was found.\n\n\
                      Exit code 1: something is missing, an adapter cannot be used, or a finding is \
                      not as it was found."
    )]
    Doctor,
    /// The scenes of the corpus
    List(list::Args),
    /// Run kernels with a defect each, which the scenes must bring to light
    Mutants(mutants::Args),
    /// What a scene needs, and what it skips
    Plan(plan::Args),
    /// Replay scenes through all legs and compare them
    Replay(Box<replay::Args>),
    /// Merge the JSON lines of several runs into one report
    Report(report::Args),
}

/// Runs the command line that the process was given.
pub fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Bench(args) => bench::run(&args),
        Command::Add(args) => add::run(&args),
        Command::Bundle(args) => bundle::run(&args),
        Command::Doctor => doctor::run(),
        Command::List(args) => list::run(&args),
        Command::Mutants(args) => mutants::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Report(args) => report::run(&args),
    };
    match result {
        Ok(Verdict::Agree) => ExitCode::SUCCESS,
        Ok(Verdict::Diverge) => ExitCode::from(1),
        Err(error) => {
            // One line: the user's mistake needs no backtrace.
            complain(format_args!("{error:#}"));
            ExitCode::from(2)
        }
    }
}
