//! The same frame by tiles: first its pictures are compared, then it is timed.

use triptych_gpu::tiles::{self, Banded, Span, Way};
use triptych_gpu::timer::Timer;

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
    spans: Vec<Span>,
    errors: Vec<(u32, Error)>,
    /// Seconds of each part, round by round.
    rounds: Vec<Vec<f64>>,
}

impl<'r> ByTiles<'r> {
    /// Sets it up, and compares every picture.
    pub(super) fn new(method: Method, start: &Start<'r>) -> Result<Self, Refusal> {
        let (label, rasterizer, grid) = (&start.label, start.rasterizer, start.grid);
        let Some(opaque) = grid.opaque() else {
            let words = "more fragments than a replay holds".to_owned();
            return Err(Refusal::Skipped(words));
        };
        let options = tiles::Options {
            opaque,
            depth_test: start.options.depth_test,
            background: start.options.background,
            capacity: None,
            drawn: tiles::DRAWN,
        };
        // What is blended at once leaves no lists: its pictures are compared alone.
        let bands = match method {
            Method::Linked => tiles::run_linked(rasterizer, options, longest)?.bands,
            Method::Local => Vec::new(),
            _ => tiles::run(rasterizer, options)?.bands,
        };
        for band in bands {
            if let Some(lists) = band.sorted {
                grid.sorted(label, band.band, lists)?;
            }
        }
        let way = match method {
            Method::Linked => Way::Linked,
            Method::Local => Way::Local,
            _ => Way::Runs,
        };
        let shown = grid.shown();
        let pictures = (way, &shown[..]);
        let timed = Banded::new(rasterizer, &options, pictures, &grid.rows, start.budget)?;
        let (seen, must) = (timed.fragments(), grid.fragments());
        if seen != must && method != Method::Local {
            let words = format!("{label}: tiles count {seen} fragments, must be {must}");
            return Err(Refusal::Wrong(words));
        }
        let spans = timed.parts().to_vec();
        let mut tiles = Self {
            method,
            grid,
            timer: Timer::new(rasterizer.gpu, start.clock, timed.spans())?,
            timed,
            spans,
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
        // Lists that are too long for registers are merged from one array into another.
        let merged = self.method == Method::Tiles && self.spans.contains(&Span::Sort);
        let frame = |(layers, error): &(u32, Error)| {
            let belongs = |span: &Span| match span {
                Span::Shade(n) | Span::Local(n) => n == layers,
                _ => true,
            };
            let spans = self.spans.iter().enumerate();
            let spans = spans.filter(|(_, span)| belongs(span));
            let seconds = |at: usize| self.rounds.iter().map(|r| r[at]).collect();
            let mut parts = surfaces.parts.clone();
            parts.extend(spans.map(|(at, span)| (name(*span), seconds(at))));
            let work = counts.by_tiles(self.timed.binned(), *layers, self.method);
            Measured {
                method: self.method,
                layers: *layers,
                parts,
                error: *error,
                memory: counts.triangles() + self.timed.bytes(),
                of_fragment: match self.method {
                    Method::Local => None,
                    method => Some(method.entry() * (1 + u64::from(merged))),
                },
                work: work.and(surfaces.work),
            }
        };
        self.errors.iter().map(frame).collect()
    }
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
