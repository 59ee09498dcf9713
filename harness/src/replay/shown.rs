//! What of a replay is kept for the report: pictures and lists of the legs.

use std::collections::BTreeSet;

use triptych_spec::vertex::SUBPIXEL_BITS;

use super::gpu::{From, GpuLeg, GpuSeen};
use super::pictures;
use super::run::Run;
use super::spec::SpecRun;
use super::stop::Stop;
use super::worst::Worst;
use crate::embree::EmbreeScene;
use crate::observe::{Gpu, Observed};
use crate::sheet::{self, Rays, Sheet};

impl Run<'_> {
    /// Keeps a leg's picture and lists for the report. Spots from `first` on are its own.
    pub(super) fn keep(&mut self, leg: &GpuLeg<'_>, seen: &Observed<Gpu, GpuSeen>, first: usize) {
        let (spec, image) = (&leg.spec.value, &seen.value.abuffer.image);
        if !image.is_empty() {
            self.shown(&seen.label, spec, image);
        }
        let pixels: BTreeSet<u32> = self.rows.spots[first..].iter().map(|s| s.pixel).collect();
        self.errors.note(&pixels, &spec.image, image);
        if leg.by_band() {
            return;
        }
        // The spec's own sheet is that of its own vertices, on the finest grid.
        let own = self.options.from >= From::Cover;
        let against = match own {
            true => "spec".to_owned(),
            false => format!("spec on the vertices of {}", seen.label),
        };
        if !own || spec.primitives.bits != SUBPIXEL_BITS {
            let new = |s: &&Sheet| (&s.leg, s.bits) == (&against, spec.primitives.bits);
            let known = self.sheets.iter().find(new).cloned();
            let pack = || sheet::spec(leg.scene, spec, &against);
            self.sheets.push(known.unwrap_or_else(pack));
        }
        let own = sheet::gpu(leg.scene, spec, &against, &seen.label, &seen.value);
        self.sheets.push(own);
    }

    /// Asks Embree for the pixels that people will look at first. Which these are is known
    /// in the end, when its scene has made room; where all agree there are none.
    pub(super) fn look_again(&mut self, worst: &Worst) -> Result<(), Stop> {
        let width = self.loaded.scene.size.width;
        let mut pixels = std::mem::take(&mut self.unlike);
        pixels.extend(worst.pixels.iter().map(|p| p.at[1] * width + p.at[0]));
        if pixels.is_empty() {
            return Ok(());
        }
        let spec = self.spec(SUBPIXEL_BITS)?;
        // What Embree refuses now it refused before, which has a row.
        if let Ok(embree) = EmbreeScene::new(&spec.value.primitives) {
            let rays = Rays::new(&self.loaded.scene, &spec.value, &embree);
            self.sheets.push(rays.sheet_of(&pixels));
        }
        Ok(())
    }

    /// Keeps a leg's picture, and how far it is from the spec's.
    pub(super) fn shown(&mut self, label: &str, spec: &SpecRun, picture: &[[f32; 3]]) {
        let size = self.loaded.scene.size;
        self.pictures.push(pictures::leg(label, size, picture));
        let difference = pictures::difference(label, size, &spec.picture(), picture);
        self.pictures.extend(difference);
    }
}

/// Each leg's own work brings the spec's lists that it was held against, as it may come
/// from the cache alone.
pub(super) fn once(sheets: Vec<Sheet>) -> Vec<Sheet> {
    let mut kept: Vec<Sheet> = Vec::new();
    for sheet in sheets {
        if !kept.iter().any(|k| k.is_like(&sheet)) {
            kept.push(sheet);
        }
    }
    kept
}
