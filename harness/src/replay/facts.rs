//! What the spec found, in a form that belongs into a snapshot: counts and hashes
//! of integers, never floats.

use std::collections::BTreeMap;

use serde::Serialize;
use sha2::{Digest, Sha256};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::raster::{Samples, sample_nodes};

use super::grid::GridRun;
use super::spec::SpecRun;
use crate::dump::Meta;
use crate::plan::Pass;
use crate::rays::Kind;
use crate::scene::Loaded;

/// Canonical facts of a scene at 8 sub-pixel bits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Facts {
    /// What was counted, in the order in which people read it.
    pub counts: Vec<(&'static str, String)>,
    /// Passes that run.
    pub runs: Vec<String>,
    /// SHA-256 of each exact result, the first 16 digits.
    pub hashes: BTreeMap<&'static str, String>,
}

impl Facts {
    /// The facts of a run.
    pub fn new(loaded: &Loaded, spec: &SpecRun, passes: &[Pass]) -> Self {
        let SpecRun {
            primitives,
            opaque,
            sorted,
            ..
        } = spec;
        let lengths = sorted.lengths();
        let snapped = primitives
            .snapped
            .iter()
            .flatten()
            .map(|v| v.cast_unsigned());
        let corners = primitives.prims.iter().flatten().copied();
        let fragments = sorted
            .fragments
            .iter()
            .flat_map(|f| [f.pixel, f.prim, f.key, f.mask]);
        let shown = opaque.pixels(primitives.size.pixels());
        let visible = opaque.key.iter().chain(&opaque.prim).copied();
        let mut counts = vec![
            (
                "size",
                format!("{} x {}", primitives.size.width, primitives.size.height),
            ),
            ("triangles", loaded.stats.triangles.to_string()),
            ("degenerate", loaded.stats.degenerate.to_string()),
            ("prims", primitives.prims.len().to_string()),
            ("opaque_pixels", shown.to_string()),
            ("fragments", sorted.fragments.len().to_string()),
            ("longest_list", lengths.max().unwrap_or(0).to_string()),
        ];
        if primitives.samples.count() > 1 {
            // What nodes of a sample each would take, beside those with a mask.
            counts.push(("samples", primitives.samples.count().to_string()));
            let nodes = sample_nodes(sorted.fragments.iter());
            counts.push(("sample_nodes", nodes.to_string()));
        }
        Self {
            counts,
            runs: runs(passes),
            hashes: BTreeMap::from([
                ("vertex", hash(snapped.chain(corners))),
                ("opaque", hash(visible)),
                (
                    "sorted",
                    hash(sorted.offsets.iter().copied().chain(fragments)),
                ),
            ]),
        }
    }

    /// The facts of a scene with a grid.
    pub fn of_grid(loaded: &Loaded, spec: &GridRun, skip: bool) -> Self {
        let grid = &spec.grid;
        let cells = grid.axes.each_ref().map(|axis| axis.cells().to_string());
        let full = spec.counts.iter().filter(|count| **count > 0);
        let longest = spec.counts.iter().max().copied().unwrap_or(0);
        let mut counts = vec![
            ("cells", cells.join(" x ")),
            ("triangles", loaded.stats.triangles.to_string()),
            ("degenerate", loaded.stats.degenerate.to_string()),
            ("full_cells", full.count().to_string()),
            ("entries", grid.prims.len().to_string()),
            ("longest_list", longest.to_string()),
            ("lattice", format!("2^{}", spec.lattice.exponent)),
        ];
        let mut start = 0;
        for (kind, end) in Kind::ALL.into_iter().zip(spec.ends) {
            let met = spec.answers[start..end].iter().flatten().count();
            counts.push((
                kind.name(),
                format!("{met} of {} rays blocked", end - start),
            ));
            start = end;
        }
        let boundaries = grid
            .axes
            .iter()
            .flat_map(|axis| axis.boundaries().iter().copied());
        let corners = spec.blockers.vertices.iter().flatten().copied();
        let words = |i: i32| i.cast_unsigned();
        let lists = grid.offsets.iter().chain(&grid.prims).copied();
        let answers = spec.answers.iter().map(|a| a.map_or(NOTHING, |a| a.prim));
        Self {
            counts,
            runs: runs(&super::passes(loaded, skip)),
            hashes: BTreeMap::from([
                ("blockers", hash(corners.map(words))),
                ("boundaries", hash(boundaries.map(words))),
                ("lists", hash(lists)),
                ("closest", hash(answers)),
            ]),
        }
    }
}

/// Names of the passes that run.
pub(super) fn runs(passes: &[Pass]) -> Vec<String> {
    let run = passes.iter().filter(|pass| pass.runs);
    run.map(|pass| pass.name.to_owned()).collect()
}

/// First 16 digits of the SHA-256 of words, low byte first.
pub(super) fn hash(words: impl Iterator<Item = u32>) -> String {
    let mut digest = Sha256::new();
    for word in words {
        digest.update(word.to_le_bytes());
    }
    digest
        .finalize()
        .iter()
        .take(8)
        .map(|b| format!("{b:02x}"))
        .collect()
}

/// What a dump's arrays do not say themselves.
pub fn meta(loaded: &Loaded, leg: &str, bits: u32, samples: Samples) -> Meta {
    Meta {
        scene: loaded.name.clone(),
        leg: leg.into(),
        width: loaded.scene.size.width,
        height: loaded.scene.size.height,
        subpixel_bits: bits,
        sample_positions: samples.positions(),
        versions: BTreeMap::from([("triptych".into(), env!("CARGO_PKG_VERSION").into())]),
    }
}
