//! What all frames of a scene together may take.

use triptych_spec::grid::ENTRIES_MAX;
use triptych_spec::rsm::{Frame, Light, Setting};

use super::kernel::{of_coarse, pairs};
use super::setup::{Parts, Setup};
use crate::dispatch::share;
use crate::replay::pieces;
use crate::replay::spec::FRAGMENTS_MAX;
use crate::replay::work::{self, Meter, WORK_MAX, Work};
use crate::scene::Mistake;

/// Pixels of a piece of work.
const PIXELS: usize = 64;

/// How many entries of lists Embree makes up for in the time in which the spec tests one. Measured
/// on rays of stage `block`: 9 for the bunny, where it mostly passes boxes, 16 for slivers, and 145
/// where thousands of cells list the same needles.
const EMBREE: u64 = 8;

/// What frames have added up to. Their entries of cells are held at once, and so have the limit
/// of a single grid; fragments are those of eye and lamp.
pub(super) struct Limits {
    entries: u64,
    fragments: u64,
    /// If no ray of any frame could meet more, what all would meet together.
    most: u64,
    /// Of the picture without noise, for each ray of stage `block`.
    rays: u64,
    meter: Meter,
}

impl Limits {
    /// Before the first frame.
    pub(super) fn new(setup: &Setup) -> Self {
        Self {
            entries: 0,
            fragments: 0,
            most: 0,
            rays: {
                let [fine, coarse] = [setup.eye.size, setup.parameters.coarse(setup.eye.size)];
                (fine.pixels() as u64).div_ceil(coarse.pixels() as u64)
            },
            meter: Meter::new(WORK_MAX),
        }
    }

    /// Adds a frame that is not yet drawn.
    ///
    /// # Errors
    /// More entries in the cells of all frames, or more fragments, than there may be.
    pub(super) fn add(&mut self, setup: &Setup, parts: &Parts) -> Result<(), Mistake> {
        self.entries += parts.grid.prims.len() as u64;
        if self.entries > ENTRIES_MAX {
            let message = format!(
                "the blockers have {} entries in the cells of the frames so far, and {ENTRIES_MAX} in \
                 all frames are the limit; use fewer frames or simpler blockers",
                self.entries
            );
            return Err(Mistake::of("rsm.frames", message));
        }
        for view in [&setup.eye, &setup.lamp.view] {
            self.fragments += pieces::fragments_of(&parts.model, view);
        }
        if self.fragments > FRAGMENTS_MAX {
            let message = format!(
                "the triangles cover {} fragments of eye and lamp in the frames so far, and \
                 {FRAGMENTS_MAX} in all frames are the limit; use a smaller size or fewer triangles",
                self.fragments
            );
            return Err(Mistake::of("rsm", message));
        }
        let side = u64::from(setup.parameters.side());
        let texels = (side * side).min(setup.lamp.view.size.pixels() as u64);
        let rays = setup.parameters.coarse(setup.eye.size).pixels() as u64 * texels;
        let most = rays.saturating_mul(self.of(work::most(&parts.grid)));
        self.most = self.most.saturating_add(most);
        Ok(())
    }

    /// What a ray of stage `block` stands for: its own way for spec, kernels and vote, and what it
    /// is held against once more for each ray of the picture without noise that starts in its
    /// square of pixels. Embree skips what is empty. A triangle whose box a ray meets is listed in a
    /// cell that it passes, so boxes around triangles lead to no more of them than cells do.
    fn of(&self, work: Work) -> u64 {
        work.total() + work.entries.saturating_mul(self.rays) / EMBREE
    }

    /// Adds the rays of a frame's stage `block`, once all frames are known.
    ///
    /// # Errors
    /// Those of all frames so far would take too long.
    pub(super) fn rays(
        &self,
        setting: &Setting<'_>,
        frame: &Frame,
        lights: &[Option<Light>],
    ) -> Result<(), Mistake> {
        // Where no rays could, those of this scene need not be counted.
        if self.most <= WORK_MAX {
            return Ok(());
        }
        let pixel = |pixel: usize| {
            let at = of_coarse(setting, frame, pixel);
            let mut asked = pairs(setting, frame, lights, at);
            asked.all(|pair| self.meter.takes(self.of(work::of(setting.grid, pair.ray))))
        };
        let pixels = frame.coarse.size.pixels();
        match share::all(pixels, PIXELS, pixel) {
            true => Ok(()),
            false => Err(Mistake::of(
                "rsm",
                format!(
                    "the rays of all frames pass more than {WORK_MAX} cells and triangles in their \
                     lists, the limit; use a smaller kernel, a smaller picture or simpler blockers"
                ),
            )),
        }
    }
}

#[cfg(test)]
mod tests;
