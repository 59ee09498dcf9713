//! What the spec found, in a form that belongs into a snapshot: counts and hashes
//! of integers, never floats.

use std::collections::BTreeMap;

use serde::Serialize;
use sha2::{Digest, Sha256};
use triptych_spec::abuffer::NOTHING;

use super::spec::SpecRun;
use crate::dump::Meta;
use crate::plan::Plan;
use crate::scene::Loaded;

/// Canonical facts of a scene at 8 sub-pixel bits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Facts {
    /// Pixels, width by height.
    pub size: String,
    /// Source triangles.
    pub triangles: u64,
    /// Of these, without area in object space.
    pub degenerate: u64,
    /// Triangles after clipping.
    pub prims: u64,
    /// Pixels that show an opaque surface.
    pub opaque_pixels: u64,
    /// Fragments in lists.
    pub fragments: u64,
    /// Most fragments in one list.
    pub longest_list: u32,
    /// Passes that run.
    pub runs: Vec<String>,
    /// SHA-256 of each exact result, the first 16 digits.
    pub hashes: BTreeMap<&'static str, String>,
}

impl Facts {
    /// The facts of a run.
    pub fn new(loaded: &Loaded, spec: &SpecRun, plan: &Plan) -> Self {
        let SpecRun {
            primitives,
            opaque,
            sorted,
            ..
        } = spec;
        let lengths = sorted.offsets.windows(2).map(|w| w[1] - w[0]);
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
        let visible = opaque.key.iter().chain(&opaque.prim).copied();
        Self {
            size: format!("{} x {}", primitives.size.width, primitives.size.height),
            triangles: loaded.stats.triangles,
            degenerate: loaded.stats.degenerate,
            prims: primitives.prims.len() as u64,
            opaque_pixels: opaque.prim.iter().filter(|p| **p != NOTHING).count() as u64,
            fragments: sorted.fragments.len() as u64,
            longest_list: lengths.max().unwrap_or(0),
            runs: plan
                .passes
                .iter()
                .filter(|p| p.runs)
                .map(|p| p.name.to_owned())
                .collect(),
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
}

/// First 16 digits of the SHA-256 of words, low byte first.
fn hash(words: impl Iterator<Item = u32>) -> String {
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
pub fn meta(loaded: &Loaded, leg: &str, bits: u32) -> Meta {
    Meta {
        scene: loaded.name.clone(),
        leg: leg.into(),
        width: loaded.scene.size.width,
        height: loaded.scene.size.height,
        subpixel_bits: bits,
        sample_positions: vec![[0.5, 0.5]],
        versions: BTreeMap::from([("triptych".into(), env!("CARGO_PKG_VERSION").into())]),
    }
}
