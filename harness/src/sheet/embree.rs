//! What Embree reports along the rays.

use std::collections::BTreeSet;

use triptych_spec::scene::Scene;
use triptych_spec::vertex::SUBPIXEL_BITS;

use super::spec::{lattice, list, rounded};
use super::{EMBREE_BYTES, Entry, Kind, Pixel, Sheet, pack, source, stride};
use crate::compare::embree::{Pair, pair};
use crate::embree::{EmbreeScene, Hit, RayHits, ScreenHits};
use crate::replay::embree::EmbreeSeen;
use crate::replay::spec::SpecRun;

/// Entries that are packed at most: they take more bytes than the spec's, as no two keys
/// are alike.
const ENTRIES: u64 = 50_000;

/// Rays of a scene, for a sheet.
pub struct Rays<'a> {
    scene: &'a Scene,
    spec: &'a SpecRun,
    embree: &'a EmbreeScene,
}

impl<'a> Rays<'a> {
    /// The rays through the samples of a scene.
    pub fn new(scene: &'a Scene, spec: &'a SpecRun, embree: &'a EmbreeScene) -> Self {
        debug_assert_eq!(
            spec.primitives.bits, SUBPIXEL_BITS,
            "the grid that Embree is asked on"
        );
        Self {
            scene,
            spec,
            embree,
        }
    }

    /// All hits along the rays, and what of the spec's they lack. `seen` says how many
    /// there are.
    pub fn sheet(&self, seen: &EmbreeSeen) -> Sheet {
        let size = self.spec.primitives.size;
        let mut stride = stride(seen.hits, ENTRIES);
        loop {
            let sheet = self.of(lattice(size, stride));
            // One ray's hits that are too many end this with that ray.
            if sheet.data.len() <= EMBREE_BYTES || stride > size.width.max(size.height) {
                // A pixel may be held for what Embree lacks alone.
                let left_out = seen.pixels.saturating_sub(sheet.held);
                return Sheet {
                    stride,
                    left_out,
                    ..sheet
                };
            }
            stride *= 2;
        }
    }

    /// The same of single pixels, which differ: they are few.
    pub fn sheet_of(&self, pixels: &BTreeSet<u32>) -> Sheet {
        self.of(pixels.iter().copied())
    }

    fn of(&self, numbers: impl Iterator<Item = u32>) -> Sheet {
        let lists = numbers.map(|n| (n, vec![self.list(n)]));
        let pixels: Vec<Pixel> = lists.filter(|(_, lists)| !lists[0].is_empty()).collect();
        Sheet {
            leg: "embree".into(),
            bits: self.spec.primitives.bits,
            held: pixels.len() as u64,
            data: pack(&pixels, 1),
            ..Sheet::default()
        }
    }

    /// A ray's hits, nearest first, and what Embree does not report, where the spec has it.
    fn list(&self, pixel: u32) -> Vec<Entry> {
        let primitives = &self.spec.primitives;
        let (x, y) = (pixel % primitives.size.width, pixel / primitives.size.width);
        let mut hits = Vec::new();
        if self.embree.hits(x, y, &mut hits).is_err() {
            return Vec::new();
        }
        hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.prim.cmp(&b.prim)));
        hits.dedup_by_key(|hit| hit.prim);
        let mut all: Vec<Entry> = hits.iter().map(|hit| self.hit([x, y], hit)).collect();
        for must in list(self.scene, self.spec, pixel, rounded) {
            if !hits.iter().any(|hit| hit.prim == must.prim) {
                let pair = pair(primitives, &self.embree.depth(), must.prim, [x, y], None);
                let kind = match pair {
                    Pair::Missed => Kind::Missed,
                    _ => Kind::MissedUnjudged,
                };
                all.push(Entry {
                    kind,
                    mask: 0,
                    ..must
                });
            }
        }
        all
    }

    fn hit(&self, pixel: [u32; 2], hit: &Hit) -> Entry {
        let primitives = &self.spec.primitives;
        let depth = self.embree.depth();
        let kind = match pair(primitives, &depth, hit.prim, pixel, Some(hit.t)) {
            Pair::Edge { .. } => Kind::Edge,
            Pair::Unresolved { .. } => Kind::Unresolved,
            Pair::Depth(depth) if depth.is_outside() => Kind::Depth,
            Pair::Depth(_) => Kind::Listed,
            Pair::Missed | Pair::Invented | Pair::Neither => Kind::Invented,
        };
        let key = depth.key(hit.t).round().clamp(0.0, f64::from(u32::MAX));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped; for showing"
        )]
        let key = key as u32;
        Entry {
            prim: hit.prim,
            source: source(self.scene, primitives, hit.prim),
            key,
            mask: 0,
            colour: rounded(self.spec.faces[hit.prim as usize]),
            kind,
        }
    }
}
