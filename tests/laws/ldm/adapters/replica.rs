//! The author's way to build lists, sorted while entries are inserted: a replica that is unsound,
//! and what tells so.

use std::sync::Arc;

use triptych_gpu::kernel::{Foreign, Kernels, Stage};
use triptych_gpu::pass::{Pass, Uses};
use triptych_gpu::wgsl::Sources;

use super::extremes::maps_around;
use super::*;

const TEXT: &str = include_str!("replica.wgsl");

fn replica() -> Foreign {
    let stage = Stage::named("chain").expect("a stage");
    Foreign::new(stage, "replica.wgsl", TEXT).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// What an entry point may read while another invocation of the same pass writes it.
fn races(file: &str, sources: &Sources, entry: &str) -> Vec<String> {
    let program = sources
        .link(file)
        .and_then(triptych_gpu::wgsl::Linked::parse);
    let program = program.unwrap_or_else(|e| panic!("{e}"));
    let pass = Pass {
        stage: entry.to_owned(),
        shared: true,
        uses: Arc::new(Uses::of(&program, &[entry])),
    };
    pass.races().map(str::to_owned).collect()
}

/// An entry's key is read in the pass that writes it; nothing is in any pass of ours.
#[test]
fn an_entry_is_read_while_it_is_written() {
    let ours = Sources::shipped(false);
    let theirs = ours.clone().with("replica".to_owned(), TEXT.to_owned());
    for entry in ["chain", "chain_large"] {
        assert_eq!(races("replica", &theirs, entry), ["nodes"], "{entry}");
        assert_eq!(races("ldm", &ours, entry), [""; 0], "{entry}");
    }
    for entry in [
        "layers_count",
        "layers_count_large",
        "layers_fill",
        "layers_fill_large",
    ] {
        assert_eq!(races("ldm", &ours, entry), [""; 0], "{entry}");
    }
}

/// Drivers seldom show it: entries are counted right, since the counter is atomic, and what became
/// of lists is told, not judged.
#[test]
fn what_drivers_make_of_it() {
    let mesh = sphere([3e6; 3], 24, 16);
    let sets = [[0.0, 0.6, 0.8], [1.0, 0.0, 0.0]];
    let maps = maps_around(&mesh, &sets, 40);
    let made = layers(&maps, &mesh).unwrap();
    let total = u32::try_from(made.keys.len()).unwrap();
    let foreign = [replica()];
    for (gpu, _) in devices() {
        let kernels = Kernels::with_foreign(Sources::shipped(false), &foreign);
        let mut stages = Stages::new(gpu, &kernels, &maps, &mesh, AMPLE).expect("room");
        let chains = stages.chain(total, |_, _| true).expect("room");
        assert_eq!(chains.attempts, u64::from(total), "{}", gpu.name);
        let right = |pixel: &u32| linked(&chains, *pixel as usize) == made.list(*pixel);
        let count = (0..maps.pixels).filter(right).count();
        eprintln!("{}: {count} of {} lists are right", gpu.name, maps.pixels);
    }
}
