//! A GPU leg that is measured: first its pictures are compared, then it is timed.

use std::time::Instant;

use triptych_gpu::abuffer::{Options, Part, Timed};
use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::timer::{Clock, Timer};
use triptych_spec::abuffer::Lists;

use super::error::Error;
use super::reference::Grid;
use super::scene::Measured;
use super::tiles::ByTiles;
use super::{AWAKE, Method};
use crate::compare::compare;
use crate::compare::lists::certify;
use crate::compare::order;
use crate::observe::{Gpu, Observed, Spec};

/// Why a leg has no figures.
pub(super) enum Refusal {
    /// It cannot be measured.
    Skipped(String),
    /// It is wrong.
    Wrong(String),
}

impl From<GpuError> for Refusal {
    fn from(error: GpuError) -> Self {
        Self::Skipped(error.to_string())
    }
}

/// A leg that is set up, and whose pictures are right.
pub(super) struct Leg<'r> {
    pub(super) label: String,
    /// Name of its adapter.
    pub(super) adapter: &'r str,
    /// Whether it has clocks of its own.
    board: bool,
    pub(super) grid: &'r Grid,
    timed: Timed<'r, 'r>,
    /// The same frame by tiles, where the leg draws without the hardware's rasteriser.
    tiles: Option<ByTiles<'r>>,
    timer: Timer,
    parts: Vec<Part>,
    errors: Vec<(Part, Error)>,
    /// Seconds of each part, round by round.
    rounds: Vec<Vec<f64>>,
}

impl<'r> Leg<'r> {
    /// Sets up a leg on triangles that are on its device, and compares every picture.
    pub(super) fn new(
        label: String,
        rasterizer: &'r Rasterizer<'r>,
        grid: &'r Grid,
        options: Options<'_>,
        clock: &Clock,
    ) -> Result<Self, Refusal> {
        let expected = grid.run.lists.attempts;
        let options = Options {
            capacity: Some(expected),
            ..options
        };
        let mut timed = Timed::new(rasterizer, options, |prim| grid.run.is_opaque(prim))?;
        let lists = timed.build()?;
        if lists.attempts != expected {
            let attempts = lists.attempts;
            let words = format!("{label}: build counts {attempts} fragments, must be {expected}");
            return Err(Refusal::Wrong(words));
        }
        let certificate = certify(&lists);
        let longest = certificate.longest().filter(|_| certificate.is_sound());
        let Some(longest) = longest else {
            return Err(Refusal::Wrong(format!(
                "{label}: build leaves damaged lists"
            )));
        };
        timed.follow(longest, &grid.layers)?;
        sorted(&label, &timed.sorted()?, grid)?;
        let tiles = match rasterizer.path {
            Path::Fragment => None,
            _ => Some(ByTiles::new(&label, rasterizer, grid, options, clock)?),
        };
        let parts: Vec<Part> = timed.parts().collect();
        let spans = u32::try_from(parts.len()).expect("a few parts");
        let mut leg = Self {
            timer: Timer::new(rasterizer.gpu, clock, spans)?,
            label,
            adapter: &rasterizer.gpu.name,
            board: rasterizer.gpu.info.device_type != wgpu::DeviceType::Cpu,
            grid,
            timed,
            tiles,
            parts,
            errors: Vec::new(),
            rounds: Vec::new(),
        };
        leg.errors = leg.compare()?;
        Ok(leg)
    }

    /// Compares every picture with the spec's of the same layers.
    pub(super) fn compare(&self) -> Result<Vec<(Part, Error)>, Refusal> {
        let mut errors = Vec::new();
        let mut wrong = None;
        self.timed.pictures(|part, picture| {
            let seen = picture.iter().map(|pixel| pixel.map(f64::from));
            errors.push((part, self.grid.error(seen)));
            let (method, layers) = self.variant(part);
            wrong = wrong
                .take()
                .or_else(|| self.grid.wrong(&self.label, layers, method, picture));
        })?;
        if let Some(tiles) = &self.tiles {
            tiles.compare(&self.label)?;
        }
        match wrong {
            Some(words) => Err(Refusal::Wrong(words)),
            None => Ok(errors),
        }
    }

    /// Runs everything once, and keeps no times.
    pub(super) fn warm_up(&self, round: u32) -> Result<(), Refusal> {
        self.timed.time(&self.timer, round)?;
        if let Some(tiles) = &self.tiles {
            tiles.time()?;
        }
        Ok(())
    }

    /// Runs everything once, and keeps the times; before it as often as wakes a board,
    /// whose clocks fell while others had their turn.
    pub(super) fn round(&mut self, round: u32) -> Result<(), Refusal> {
        let start = Instant::now();
        while self.board && start.elapsed() < AWAKE {
            self.warm_up(round)?;
        }
        let seconds = self.timed.time(&self.timer, round)?;
        self.rounds.push(seconds);
        self.tiles.as_mut().map_or(Ok(()), ByTiles::round)
    }

    /// What a part that makes a picture stands for.
    fn variant(&self, part: Part) -> (Method, u32) {
        match part {
            Part::Nearest(n) => (Method::Insertion, n),
            Part::NearestSorted(n) => (Method::Sort, n),
            _ => (Method::Sort, self.grid.counts.longest()),
        }
    }

    /// The frames that were measured.
    pub(super) fn measured(&self) -> Vec<Measured> {
        let before = [Part::Clear, Part::Opaque, Part::Build];
        let frame = |(part, error): &(Part, Error)| {
            let (method, layers) = self.variant(*part);
            let belongs = |other: &Part| {
                let sorts = *other == Part::Sort && method == Method::Sort;
                before.contains(other) || sorts || other == part
            };
            let parts = self.parts.iter().enumerate().filter(|(_, p)| belongs(p));
            let seconds = |at: usize| self.rounds.iter().map(|r| r[at]).collect();
            let counts = &self.grid.counts;
            let mut work = super::counts::Work::default();
            for (_, part) in parts.clone() {
                work = work.and(counts.work(*part));
            }
            Measured {
                method,
                layers,
                parts: parts.map(|(at, p)| (name(*p), seconds(at))).collect(),
                error: *error,
                memory: counts.memory(method),
                work,
            }
        };
        let mut frames: Vec<Measured> = self.errors.iter().map(frame).collect();
        if let Some(tiles) = &self.tiles {
            frames.extend(tiles.measured(self.opaque().as_ref()));
        }
        frames
    }

    /// Stage opaque alone, where it runs.
    fn opaque(&self) -> Option<Measured> {
        let at = self.parts.iter().position(|part| *part == Part::Opaque)?;
        Some(Measured {
            method: Method::Sort,
            layers: 0,
            parts: vec![(
                name(Part::Opaque),
                self.rounds.iter().map(|r| r[at]).collect(),
            )],
            error: self.errors.first()?.1,
            memory: 0,
            work: self.grid.counts.work(Part::Opaque),
        })
    }
}

/// Compares the sorted lists with the spec's: pictures hide an order that changes no
/// colour.
pub(super) fn sorted(label: &str, lists: &Lists, grid: &Grid) -> Result<(), Refusal> {
    let must = Observed::<Spec, _>::new("spec", &grid.run.sorted);
    let seen = Observed::<Gpu, _>::new(label, lists);
    let width = grid.run.primitives.size.width;
    let judgement = compare(&must, &seen, |a, b| order::compare(a, b, width));
    if judgement.differ() == 0 && judgement.compared > 0 {
        return Ok(());
    }
    let (differ, unit) = (judgement.differ(), judgement.unit);
    let first = judgement.described.first().cloned().unwrap_or_default();
    Err(Refusal::Wrong(format!(
        "{label}, sorted lists: {differ} {unit} differ; {first}"
    )))
}

/// A part's name in results.
fn name(part: Part) -> &'static str {
    match part {
        Part::Clear => "clear",
        Part::Opaque => "opaque",
        Part::Build => "build",
        Part::Sort => "sort",
        Part::Nearest(_) | Part::NearestSorted(_) | Part::Resolve => "blend",
    }
}
