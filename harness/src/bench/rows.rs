//! Rows of results from what was measured.

use super::reference::Grid;
use super::run::Bound;
use super::scene::Measured;
use super::{Method, Row, Spread};
use crate::scene::Loaded;

/// Parts of a frame that make lists, or bins of triangles.
pub(super) const BUILDS: [&str; 5] = ["clear", "bin", "place", "fill", "build"];

/// Parts that put layers in order.
pub(super) const ORDERS: [&str; 2] = ["nearest", "sort"];

/// Parts that make the picture.
pub(super) const BLENDS: [&str; 2] = ["blend", "local"];

impl Row {
    /// Median milliseconds of some parts together.
    pub(super) fn of_parts(&self, names: &[&str]) -> f64 {
        let own = self.parts.iter();
        let own = own.filter(|(name, _)| names.contains(&name.as_str()));
        own.fold(0.0, |sum, (_, ms)| sum + ms)
    }

    /// Median milliseconds of what makes lists, beside opaque surfaces.
    pub(super) fn build(&self) -> f64 {
        self.of_parts(&BUILDS)
    }

    /// Median milliseconds from lists to the picture.
    pub(super) fn resolve(&self) -> f64 {
        self.of_parts(&ORDERS) + self.of_parts(&BLENDS)
    }
}

/// What the rows of a leg have in common.
pub(super) struct Timing<'t> {
    pub(super) leg: &'t str,
    /// Seconds of the vertex stages, round by round.
    pub(super) vertices: Option<Vec<f64>>,
}

/// The rows of a leg.
pub(super) fn rows(
    loaded: &Loaded,
    grid: &Grid,
    timing: &Timing<'_>,
    measured: &[Measured],
    bound: &Bound<'_>,
) -> Vec<Row> {
    let longest = grid.counts.longest();
    let is_reference = |m: &&Measured| m.method == Method::Sort && m.layers == longest;
    let reference = measured.iter().find(is_reference);
    let fragments = grid.fragments();
    let row = |m: &Measured| {
        let time = Spread::of(m.seconds().map(|s| 1000.0 * s));
        let all = reference.into_iter().flat_map(Measured::seconds);
        let frame = timing.vertices.as_ref().map(|vertices| {
            let both = m.seconds().zip(vertices).map(|(own, before)| own + before);
            Spread::of(both.map(|s| 1000.0 * s))
        });
        let (what, seconds) = bound.of(timing.leg, m.work);
        let median = |seconds: &[f64]| 1000.0 * Spread::of(seconds.iter().copied()).median;
        let parts = m.parts.iter();
        Row {
            scene: loaded.name.clone(),
            size: [loaded.scene.size.width, loaded.scene.size.height],
            samples: grid.primitives.samples.count(),
            fragments,
            longest,
            leg: timing.leg.to_owned(),
            clock: bound.clock(timing.leg).to_owned(),
            method: m.method,
            layers: m.layers,
            all: m.layers >= longest && !m.method.approximates(),
            runs: u32::try_from(m.seconds().count()).unwrap_or(u32::MAX),
            time,
            frame,
            ratio: Spread::of(m.seconds().zip(all).map(|(own, all)| own / all)),
            parts: parts.map(|(n, s)| ((*n).to_owned(), median(s))).collect(),
            psnr: m.error.psnr,
            largest: m.error.largest,
            memory: m.memory,
            of_fragment: m.of_fragment,
            bands: m.bands,
            fragments_per_second: 1000.0 * fragments as f64 / time.median,
            bound: what.to_owned(),
            bound_ms: 1000.0 * seconds,
            fraction: 1000.0 * seconds / time.median,
        }
    };
    measured.iter().map(row).collect()
}
