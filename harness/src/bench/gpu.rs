//! A GPU leg that is measured: first its pictures are compared, then it is timed.

mod frames;

use std::time::Instant;

use triptych_gpu::abuffer::{Options, Part, Timed};
use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::timer::{Clock, Timer};
use triptych_gpu::vertex;
use triptych_spec::scene::Scene;

use super::error::Error;
use super::reference::Grid;
use super::rivals::Beside;
use super::tiles::ByTiles;
use super::{AWAKE, Method};
use crate::compare::lists::certify;

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

/// What a leg is set up from.
pub(super) struct Start<'r> {
    pub(super) label: String,
    pub(super) rasterizer: &'r Rasterizer<'r>,
    pub(super) grid: &'r Grid,
    pub(super) scene: &'r Scene,
    pub(super) options: Options<'r>,
    pub(super) clock: &'r Clock,
    /// Bytes that the buffers of a technique may take.
    pub(super) budget: u64,
    /// Rounds that count.
    pub(super) runs: u32,
}

/// A leg that is set up, and whose pictures are right.
pub(super) struct Leg<'r> {
    pub(super) label: String,
    /// Name of its adapter.
    pub(super) adapter: &'r str,
    /// Whether it has clocks of its own.
    board: bool,
    pub(super) runs: u32,
    pub(super) grid: &'r Grid,
    /// From vertices to triangles, if the device can do it by itself.
    pub(super) vertices: Option<Vertices<'r>>,
    timed: Timed<'r, 'r>,
    /// The same frame by tiles, in several ways, where the leg draws without the hardware's rasteriser.
    pub(super) tiles: Vec<ByTiles<'r>>,
    /// Other techniques.
    pub(super) beside: Vec<Beside<'r>>,
    timer: Timer,
    parts: Vec<Part>,
    errors: Vec<(Part, Error)>,
    /// Seconds of each part, round by round.
    rounds: Vec<Vec<f64>>,
}

/// The vertex stages of a leg.
pub(super) struct Vertices<'r> {
    timed: vertex::Timed<'r>,
    timer: Timer,
    /// Seconds of each round.
    pub(super) seconds: Vec<f64>,
}

impl<'r> Vertices<'r> {
    pub(super) fn new(start: &Start<'r>) -> Result<Self, GpuError> {
        let Rasterizer {
            gpu, kernels, path, ..
        } = *start.rasterizer;
        let prims = &start.grid.primitives;
        let grid = (prims.bits, prims.samples);
        let walked = path != Path::Fragment;
        Ok(Self {
            timed: vertex::Timed::new(gpu, kernels, start.scene, grid, walked)?,
            timer: Timer::new(gpu, start.clock, 1)?,
            seconds: Vec::new(),
        })
    }
}

impl<'r> Leg<'r> {
    /// Sets up a leg on triangles that are on its device, and compares every picture of its lists.
    pub(super) fn new(start: &Start<'r>) -> Result<Self, Refusal> {
        let Start {
            label,
            rasterizer,
            grid,
            ..
        } = start;
        let (rasterizer, grid) = (*rasterizer, *grid);
        let opaque = |prim| grid.is_opaque(prim);
        let mut timed =
            Timed::in_bands(rasterizer, start.options, &grid.rows, start.budget, opaque)?;
        timed.follow(longest(label, &timed, grid)?, &grid.shown())?;
        let mut wrong = Ok(());
        timed.sorted(|band, lists| {
            if wrong.is_ok() {
                wrong = grid.sorted(label, band, lists);
            }
        })?;
        wrong?;
        let parts: Vec<Part> = timed.parts().collect();
        let mut leg = Self {
            timer: Timer::new(rasterizer.gpu, start.clock, timed.spans())?,
            label: label.clone(),
            adapter: &rasterizer.gpu.name,
            board: rasterizer.gpu.info.device_type != wgpu::DeviceType::Cpu,
            runs: start.runs,
            grid,
            vertices: None,
            timed,
            tiles: Vec::new(),
            beside: Vec::new(),
            parts,
            errors: Vec::new(),
            rounds: Vec::new(),
        };
        leg.errors = leg.compare_lists()?;
        Ok(leg)
    }

    /// Compares every picture with the spec's.
    pub(super) fn compare(&self) -> Result<(), Refusal> {
        self.compare_lists()?;
        for tiles in &self.tiles {
            tiles.compare(&self.label)?;
        }
        for beside in &self.beside {
            beside.compare(&self.label)?;
        }
        Ok(())
    }

    /// Compares every picture of lists with the spec's of the same layers.
    fn compare_lists(&self) -> Result<Vec<(Part, Error)>, Refusal> {
        let mut errors = Vec::new();
        let mut wrong = None;
        self.timed.pictures(|part, picture| {
            errors.push((part, self.grid.error(&picture)));
            let (method, layers) = self.variant(part);
            wrong = wrong.take().or_else(|| {
                let label = &self.label;
                self.grid.wrong(label, layers, method.name(), &picture)
            });
        })?;
        match wrong {
            Some(words) => Err(Refusal::Wrong(words)),
            None => Ok(errors),
        }
    }

    /// Runs everything once, and keeps no times; gives how many seconds it took the device.
    pub(super) fn warm_up(&self, round: u32) -> Result<f64, Refusal> {
        let mut seconds: f64 = self.timed.time(&self.timer, round)?.iter().sum();
        if let Some(Vertices { timed, timer, .. }) = &self.vertices {
            seconds += timed.time(timer)?;
        }
        for tiles in &self.tiles {
            seconds += tiles.time()?.iter().sum::<f64>();
        }
        for beside in &self.beside {
            seconds += beside.time()?.iter().sum::<f64>();
        }
        Ok(seconds)
    }

    /// Runs everything once, and keeps the times; before it as often as wakes a board,
    /// whose clocks fell while others had their turn.
    pub(super) fn round(&mut self, round: u32) -> Result<(), Refusal> {
        let start = Instant::now();
        while self.board && start.elapsed() < AWAKE {
            self.warm_up(round)?;
        }
        if let Some(Vertices {
            timed,
            timer,
            seconds,
        }) = &mut self.vertices
        {
            seconds.push(timed.time(timer)?);
        }
        let seconds = self.timed.time(&self.timer, round)?;
        self.rounds.push(seconds);
        for beside in &mut self.beside {
            beside.round()?;
        }
        self.tiles.iter_mut().try_for_each(ByTiles::round)
    }

    /// What a part that makes a picture stands for.
    fn variant(&self, part: Part) -> (Method, u32) {
        match part {
            Part::Nearest(n) => (Method::Insertion, n),
            Part::NearestSorted(n) => (Method::Sort, n),
            _ => (Method::Sort, self.grid.counts.longest()),
        }
    }
}

/// Nodes of the longest list, if all lists are sound and together have what they must.
fn longest(label: &str, timed: &Timed<'_, '_>, grid: &Grid) -> Result<u32, Refusal> {
    let (mut attempts, mut longest) = (0, Some(0));
    timed.build(|_, lists| {
        attempts += u64::from(lists.attempts);
        let certificate = certify(&lists);
        let own = certificate.longest().filter(|_| certificate.is_sound());
        longest = longest.zip(own).map(|(all, own)| u32::max(all, own));
    })?;
    let must = grid.fragments();
    if attempts != must {
        let words = format!("{label}: build counts {attempts} fragments, must be {must}");
        return Err(Refusal::Wrong(words));
    }
    longest.ok_or_else(|| Refusal::Wrong(format!("{label}: build leaves damaged lists")))
}
