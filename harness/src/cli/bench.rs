//! `triptych bench`.

pub(super) mod abuffer;
mod dispatch;
mod extremes;
mod files;
mod grid;
mod ldm;
mod legs;
mod rsm;
mod share;
mod stress;

use std::path::PathBuf;

use super::adapters::OnAdapters;
use super::scenes::Scenes;
use super::{Verdict, reports};
use crate::corpus::{self, Entry};
use crate::replay::gpu::Adapter;

/// What is measured.
#[derive(clap::Subcommand)]
pub enum Bench {
    /// Time against error: the nearest 1, 2, 4, … layers of each pixel
    Abuffer(abuffer::Args),
    /// Work queues: frames of a ray tracer against threads, queue by queue
    Dispatch(dispatch::Args),
    /// Grids: builds and rays against resolution, beside Embree and a BVH
    Grid(grid::Args),
    /// Layered depth maps: time of making and asking them against their error
    Ldm(ldm::Args),
    /// Leg against leg: the spec beside adapters, the Embree leg beside bare calls
    Legs(legs::Args),
    /// Indirect light: time of a frame against its error
    Rsm(rsm::Args),
    /// The spec's share of a replay, with one thread and with more
    Share(share::Args),
    /// What holds at the extremes, and by how much
    #[command(long_flag = "stress")]
    Stress(stress::Args),
}

pub fn run(bench: &Bench) -> anyhow::Result<Verdict> {
    match bench {
        Bench::Abuffer(args) => abuffer::run(args),
        Bench::Dispatch(args) => dispatch::run(args),
        Bench::Grid(args) => grid::run(args),
        Bench::Ldm(args) => ldm::run(args),
        Bench::Legs(args) => legs::run(args),
        Bench::Rsm(args) => rsm::run(args),
        Bench::Share(args) => share::run(args),
        Bench::Stress(args) => stress::run(args),
    }
}

/// What a measurement starts from.
struct Start {
    corpus: Vec<Entry>,
    /// `None`: those of our own choice.
    scenes: Option<Vec<Entry>>,
    adapters: Vec<Adapter>,
    /// Where files go, whose names begin with the stem and end with the machine's.
    folder: PathBuf,
}

/// Looks for scenes and adapters, and whether files can be written, before anything is measured.
fn start(
    scenes: &Scenes,
    on: &OnAdapters,
    out: Option<&PathBuf>,
    stem: &str,
) -> anyhow::Result<Start> {
    let corpus = corpus::list(&corpus::root())?;
    let scenes = scenes.if_any(&corpus)?;
    let folder = out.cloned().unwrap_or_else(reports::bench);
    reports::can_write([&folder.join(stem)])?;
    Ok(Start {
        scenes,
        adapters: on.usable()?.open,
        folder,
        corpus,
    })
}
