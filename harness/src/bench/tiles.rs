//! The same frame by tiles: first its lists and pictures are compared, then it is timed.

use triptych_gpu::frame::Band;
use triptych_gpu::raster::Rasterizer;
use triptych_gpu::tiles::{self, Banded, Options, Span, Way};
use triptych_gpu::timer::Timer;
use triptych_spec::abuffer::Opaque;

use super::Method;
use super::error::Error;
use super::gpu::{Refusal, Start};
use super::reference::Grid;
use super::scene::Measured;
use crate::replay::tiles::longest;

/// A leg's frame by tiles.
pub(super) struct ByTiles<'r> {
    method: Method,
    grid: &'r Grid,
    timed: Banded<'r, 'r>,
    timer: Timer,
    errors: Vec<(u32, Error)>,
    /// Seconds of each part, round by round.
    rounds: Vec<Vec<f64>>,
}

impl<'r> ByTiles<'r> {
    /// Sets it up, and compares every picture.
    pub(super) fn new(method: Method, start: &Start<'r>) -> Result<Self, Refusal> {
        let (label, rasterizer, grid) = (&start.label, start.rasterizer, start.grid);
        let way = match method {
            Method::Linked => Way::Linked,
            Method::Local => Way::Local,
            _ => Way::Runs,
        };
        compare_lists(way, start)?;
        let (options, layers) = (options(start, grid.opaque()), grid.shown());
        let timed = (way, &layers[..]);
        let timed = Banded::new(rasterizer, &options, timed, &grid.rows, start.budget)?;
        let (seen, must) = (timed.fragments(), grid.fragments());
        if seen != must && method != Method::Local {
            let words = format!("{label}: tiles count {seen} fragments, must be {must}");
            return Err(Refusal::Wrong(words));
        }
        let mut tiles = Self {
            method,
            grid,
            timer: Timer::new(rasterizer.gpu, start.clock, timed.spans())?,
            timed,
            errors: Vec::new(),
            rounds: Vec::new(),
        };
        tiles.errors = tiles.compare(label)?;
        Ok(tiles)
    }

    /// Compares every picture with the spec's of the same layers.
    pub(super) fn compare(&self, label: &str) -> Result<Vec<(u32, Error)>, Refusal> {
        let mut errors = Vec::new();
        let mut wrong = None;
        self.timed.pictures(|layers, picture| {
            errors.push((layers, self.grid.error(&picture)));
            let method = self.method.name();
            wrong = wrong
                .take()
                .or_else(|| self.grid.wrong(label, layers, method, &picture));
        })?;
        match wrong {
            Some(words) => Err(Refusal::Wrong(words)),
            None => Ok(errors),
        }
    }

    /// Runs everything once.
    pub(super) fn time(&self) -> Result<Vec<f64>, Refusal> {
        Ok(self.timed.time(&self.timer)?)
    }

    /// Runs everything once, and keeps the times.
    pub(super) fn round(&mut self) -> Result<(), Refusal> {
        let seconds = self.time()?;
        self.rounds.push(seconds);
        Ok(())
    }

    /// The frames that were measured; `surfaces` is what comes before them.
    pub(super) fn measured(&self, surfaces: &Measured) -> Vec<Measured> {
        let counts = &self.grid.counts;
        let parts = self.timed.parts();
        let frame = |(layers, error): &(u32, Error)| {
            let belongs = |span: &Span| match span {
                Span::Shade(n) | Span::Local(n) => n == layers,
                _ => true,
            };
            let spans = parts.iter().enumerate();
            let spans = spans.filter(|(_, span)| belongs(span));
            let seconds = |at: usize| self.rounds.iter().map(|r| r[at]).collect();
            let mut own = surfaces.parts.clone();
            own.extend(spans.map(|(at, span)| (name(*span), seconds(at))));
            let work = counts.by_tiles(self.timed.binned(), *layers, self.method);
            Measured {
                method: self.method,
                layers: *layers,
                parts: own,
                error: *error,
                memory: counts.triangles() + self.timed.bytes(),
                of_fragment: match self.method {
                    Method::Local => None,
                    method => Some(method.entry() * (1 + u64::from(self.timed.merges()))),
                },
                bands: u32::try_from(self.timed.bands()).unwrap_or(u32::MAX),
                work: work.and(surfaces.work),
            }
        };
        self.errors.iter().map(frame).collect()
    }
}

fn options<'o>(start: &Start<'_>, opaque: &'o Opaque) -> Options<'o> {
    Options {
        opaque,
        depth_test: start.options.depth_test,
        background: start.options.background,
        capacity: None,
        drawn: tiles::DRAWN,
    }
}

/// Compares sorted lists with the spec's: of the whole target, or of those rows that are looked at, each
/// as a target of its own. What is blended at once leaves no lists: its pictures are compared alone.
fn compare_lists(way: Way, start: &Start<'_>) -> Result<(), Refusal> {
    let (grid, whole) = (start.grid, start.rasterizer);
    if way == Way::Local {
        return Ok(());
    }
    for (rows, run) in grid.alone() {
        let own = match rows == Band::whole(whole.size) {
            true => None,
            false => {
                let (gpu, kernels, faces) = (whole.gpu, whole.kernels, &grid.faces);
                let prims = &run.primitives;
                Some(Rasterizer::new(gpu, kernels, whole.path, prims, faces)?)
            }
        };
        let rasterizer = own.as_ref().unwrap_or(whole);
        let options = options(start, &run.opaque);
        let bands = match way {
            Way::Linked => tiles::run_linked(rasterizer, options, longest)?.bands,
            _ => tiles::run(rasterizer, options)?.bands,
        };
        for band in bands {
            let at = Band {
                first: rows.first + band.band.first,
                ..band.band
            };
            let lists = band.sorted.ok_or_else(|| {
                let label = &start.label;
                Refusal::Wrong(format!("{label}, by tiles: damaged lists"))
            })?;
            grid.sorted(&start.label, at, lists)?;
        }
    }
    Ok(())
}

/// A part's name in results.
fn name(span: Span) -> &'static str {
    match span {
        Span::Bin => "bin",
        Span::Place => "place",
        Span::Fill => "fill",
        Span::Sort => "sort",
        Span::Shade(_) => "blend",
        Span::Local(_) => "local",
    }
}

#[cfg(test)]
mod tests;
