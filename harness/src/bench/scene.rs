//! One scene on every leg: set up, compared, and measured side by side.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use triptych_gpu::abuffer;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::timer::Clock;
use triptych_spec::abuffer::Order;
use triptych_spec::vertex::SUBPIXEL_BITS;

use super::counts::Work;
use super::error::Error;
use super::gpu::{Leg, Refusal};
use super::reference::Grid;
use super::run::{Bound, Options};
use super::spec::Core;
use super::warm::warm_up;
use super::{Ceilings, Method, Progress, Row, Spread};
use crate::calibrate;
use crate::plan::Plan;
use crate::replay::gpu::Adapter;
use crate::scene::Loaded;

/// An adapter with the kernels that are timed.
pub(super) struct Station<'a> {
    pub(super) adapter: &'a Adapter,
    pub(super) kernels: Kernels,
    pub(super) native: Option<Kernels>,
    pub(super) clock: Clock,
}

/// A kind of frame, measured.
pub(super) struct Measured {
    pub(super) method: Method,
    pub(super) layers: u32,
    /// Seconds of each part, round by round.
    pub(super) parts: Vec<(&'static str, Vec<f64>)>,
    pub(super) error: Error,
    pub(super) memory: u64,
    pub(super) work: Work,
}

/// What came of a scene.
#[derive(Default)]
pub(super) struct Done {
    pub(super) rows: Vec<Row>,
    pub(super) skipped: Vec<String>,
    pub(super) wrong: Vec<String>,
}

impl Station<'_> {
    fn rasterizer(&self, path: Path, grid: &Grid) -> Result<Rasterizer<'_>, Refusal> {
        let kernels = match path {
            Path::Native => self.native.as_ref(),
            Path::Compute | Path::Fragment => Some(&self.kernels),
        };
        let reason = "no 64-bit integers: compute takes its place";
        let kernels = kernels.ok_or_else(|| Refusal::Skipped(reason.to_owned()))?;
        if path == Path::Fragment && self.adapter.grid == calibrate::Grid::Unknown {
            let reason = "the driver's sub-pixel grid is unknown".to_owned();
            return Err(Refusal::Skipped(reason));
        }
        for foreign in &self.adapter.foreign {
            if !foreign.serves(path == Path::Fragment) {
                let reason = format!("{} has no kernel for it", foreign.file);
                return Err(Refusal::Skipped(reason));
            }
        }
        let (primitives, faces) = (&grid.run.primitives, &grid.run.faces);
        let gpu = &self.adapter.gpu;
        Ok(Rasterizer::new(gpu, kernels, path, primitives, faces)?)
    }
}

impl Done {
    fn refused(&mut self, what: &str, refusal: Refusal) {
        match refusal {
            Refusal::Skipped(reason) => self.skipped.push(format!("{what}: {reason}")),
            Refusal::Wrong(words) => self.wrong.push(format!("{what}: {words}")),
        }
    }
}

/// A leg's triangles on its device.
struct Prepared<'r> {
    label: String,
    rasterizer: Rasterizer<'r>,
    grid: &'r Grid,
    clock: &'r Clock,
}

/// Measures a scene.
pub(super) fn scene(
    loaded: &Loaded,
    stations: &[Station<'_>],
    options: &Options,
    ceilings: &[Ceilings],
    progress: &Progress,
) -> Result<Done, String> {
    let plan = Plan::new(&loaded.scene, true);
    let mut done = Done::default();
    if loaded.scene.samples.count() > 1 {
        let words = format!(
            "{}: frames of one sample a pixel are timed alone",
            loaded.name
        );
        done.skipped.push(words);
        return Ok(done);
    }
    let grids = grids(loaded, &plan, stations, options)?;
    if grids.values().all(|grid| grid.counts.longest() == 0) {
        let words = format!("{}: nothing transparent is seen", loaded.name);
        done.skipped.push(words);
        return Ok(done);
    }
    let mut prepared = Vec::new();
    for (station, path) in pairs(stations, options) {
        let label = station.adapter.label(path);
        let grid = &grids[&station.adapter.bits(path)];
        match station.rasterizer(path, grid) {
            Ok(rasterizer) => prepared.push(Prepared {
                label,
                rasterizer,
                grid,
                clock: &station.clock,
            }),
            Err(refusal) => done.refused(&format!("{}: {label}", loaded.name), refusal),
        }
    }
    progress.begin(&format!("{}: comparing", loaded.name), options.runs);
    let mut legs = legs(loaded, &plan, &prepared, &mut done);
    let spec = &grids[&SUBPIXEL_BITS];
    let mut core = Core::new(&loaded.scene, &plan, spec);
    progress.begin(&format!("{}: warming up", loaded.name), options.runs);
    warm_up(&core, &mut legs, |result| {
        keep(result, &loaded.name, &mut done)
    });
    progress.begin(&format!("{}: measuring", loaded.name), options.runs);
    for round in 0..options.runs {
        core.round(round);
        legs.retain_mut(|leg| keep(leg.round(round), &loaded.name, &mut done));
        progress.step();
    }
    legs.retain(|leg| keep(leg.compare().map(drop), &loaded.name, &mut done));
    let bound = Bound(ceilings);
    let own = rows(loaded, spec, "spec", &core.measured(), &bound);
    done.rows.extend(own);
    for leg in &legs {
        let measured = leg.measured();
        if measured.iter().any(|m| m.seconds().any(|s| s <= 0.0)) {
            let reason = Refusal::Skipped("its timestamps stand still".to_owned());
            done.refused(&format!("{}: {}", loaded.name, leg.label), reason);
            continue;
        }
        let own = rows(loaded, leg.grid, &leg.label, &measured, &bound);
        done.rows.extend(own);
    }
    Ok(done)
}

/// Every adapter with each path.
fn pairs<'s, 'a>(
    stations: &'s [Station<'a>],
    options: &'s Options,
) -> impl Iterator<Item = (&'s Station<'a>, Path)> {
    let of = |station| options.paths.iter().map(move |path| (station, *path));
    stations.iter().flat_map(of)
}

/// What the spec says on each sub-pixel grid that a leg has, and on its own.
fn grids(
    loaded: &Loaded,
    plan: &Plan,
    stations: &[Station<'_>],
    options: &Options,
) -> Result<BTreeMap<u32, Grid>, String> {
    let mut grids = BTreeMap::new();
    let bits = pairs(stations, options).map(|(station, path)| station.adapter.bits(path));
    for bits in bits.chain([SUBPIXEL_BITS]) {
        if let Entry::Vacant(vacant) = grids.entry(bits) {
            let mut grid = Grid::new(&loaded.scene, plan, bits)?;
            grid.draw(&loaded.scene, options.layers.as_deref());
            vacant.insert(grid);
        }
    }
    Ok(grids)
}

/// The legs whose pictures are right.
fn legs<'r>(
    loaded: &Loaded,
    plan: &Plan,
    prepared: &'r [Prepared<'r>],
    done: &mut Done,
) -> Vec<Leg<'r>> {
    let options = abuffer::Options {
        given: None,
        capacity: None,
        opaque: plan.opaque,
        lists: plan.lists,
        depth_test: plan.depth_test,
        order: Order::Centroid,
        once: false,
        background: loaded.scene.background,
    };
    let mut legs = Vec::new();
    for Prepared {
        label,
        rasterizer,
        grid,
        clock,
    } in prepared
    {
        match Leg::new(label.clone(), rasterizer, grid, options, clock) {
            Ok(leg) => legs.push(leg),
            Err(refusal) => done.refused(&loaded.name, refusal),
        }
    }
    legs
}

/// Whether a leg goes on.
fn keep(result: Result<(), Refusal>, name: &str, done: &mut Done) -> bool {
    result
        .map_err(|refusal| done.refused(name, refusal))
        .is_ok()
}

impl Measured {
    /// Seconds of a frame, round by round.
    fn seconds(&self) -> impl Iterator<Item = f64> {
        let rounds = self.parts.first().map_or(0, |(_, seconds)| seconds.len());
        (0..rounds).map(|round| self.parts.iter().map(|(_, seconds)| seconds[round]).sum())
    }
}

/// The rows of a leg.
fn rows(
    loaded: &Loaded,
    grid: &Grid,
    leg: &str,
    measured: &[Measured],
    bound: &Bound<'_>,
) -> Vec<Row> {
    let longest = grid.counts.longest();
    let is_reference = |m: &&Measured| m.method == Method::Sort && m.layers == longest;
    let reference = measured.iter().find(is_reference);
    let row = |m: &Measured| {
        let time = Spread::of(m.seconds().map(|s| 1000.0 * s));
        let pairs = m
            .seconds()
            .zip(reference.into_iter().flat_map(Measured::seconds));
        let (what, seconds) = bound.of(leg, m.work);
        let clock = bound.clock(leg);
        let median = |seconds: &[f64]| 1000.0 * Spread::of(seconds.iter().copied()).median;
        Row {
            scene: loaded.name.clone(),
            size: [loaded.scene.size.width, loaded.scene.size.height],
            fragments: grid.counts.fragments,
            longest,
            leg: leg.to_owned(),
            clock: clock.to_owned(),
            method: m.method,
            layers: m.layers,
            all: m.layers >= longest,
            time,
            ratio: Spread::of(pairs.map(|(own, all)| own / all)),
            parts: m
                .parts
                .iter()
                .map(|(n, s)| ((*n).to_owned(), median(s)))
                .collect(),
            psnr: m.error.psnr,
            largest: m.error.largest,
            memory: m.memory,
            fragments_per_second: 1000.0 * grid.counts.fragments as f64 / time.median,
            bound: what.to_owned(),
            bound_ms: 1000.0 * seconds,
            fraction: 1000.0 * seconds / time.median,
        }
    };
    measured.iter().map(row).collect()
}
