//! One scene on every leg: set up, compared, and measured side by side.

use std::collections::btree_map::{BTreeMap, Entry};

use triptych_gpu::raster::{Path, Rasterizer};
use triptych_spec::raster::Samples;
use triptych_spec::vertex::SUBPIXEL_BITS;

use super::counts::Work;
use super::error::Error;
use super::gpu::{Leg, Refusal, Start, Vertices};
use super::reference::Grid;
use super::rivals::{self, Beside};
use super::rows::{Timing, rows};
use super::run::{Asked, Bound, Options};
use super::spec::Core;
use super::station::Station;
use super::tiles::ByTiles;
use super::warm::warm_up;
use super::{Ceilings, Method, Progress, Row};
use crate::plan::Plan;
use crate::scene::Loaded;

/// A kind of frame, measured.
pub(super) struct Measured {
    pub(super) method: Method,
    pub(super) layers: u32,
    /// Seconds of each part, round by round.
    pub(super) parts: Vec<(&'static str, Vec<f64>)>,
    pub(super) error: Error,
    pub(super) memory: u64,
    /// Bytes of a stored fragment.
    pub(super) of_fragment: Option<u64>,
    /// Bands of rows that it is made in.
    pub(super) bands: u32,
    pub(super) work: Work,
}

/// What came of a scene.
#[derive(Default)]
pub(super) struct Done {
    pub(super) rows: Vec<Row>,
    pub(super) skipped: Vec<String>,
    pub(super) wrong: Vec<String>,
}

impl Done {
    fn refused(&mut self, what: &str, refusal: Refusal) {
        match refusal {
            Refusal::Skipped(reason) => self.skipped.push(format!("{what}: {reason}")),
            Refusal::Wrong(words) => self.wrong.push(format!("{what}: {words}")),
        }
    }

    /// What worked; what did not is noted.
    fn keep<T>(&mut self, what: &str, result: Result<T, Refusal>) -> Option<T> {
        result.map_err(|refusal| self.refused(what, refusal)).ok()
    }

    /// The spec's rows, unless it does not hold the scene.
    fn of_core(&mut self, loaded: &Loaded, plan: &Plan, spec: &Grid, bound: &Bound<'_>) {
        let Some(run) = spec.whole() else {
            self.skipped.push(format!(
                "{}: spec: {} fragments are more than a replay holds; {} rows of pixels are \
                 compared",
                loaded.name,
                spec.fragments(),
                spec.rows_compared()
            ));
            return;
        };
        let core = Core::new(&loaded.scene, plan, spec, run);
        let timing = Timing {
            leg: "spec",
            vertices: Some(vec![core.vertices]),
        };
        let own = rows(loaded, spec, &timing, &core.measured(), bound);
        self.rows.extend(own);
    }

    /// The rows of a leg.
    fn of_leg(&mut self, loaded: &Loaded, leg: &Leg<'_>, bound: &Bound<'_>) {
        let measured = leg.measured();
        if measured.iter().any(|m| m.seconds().any(|s| s <= 0.0)) {
            let reason = Refusal::Skipped("its timestamps stand still".to_owned());
            self.refused(&format!("{}: {}", loaded.name, leg.label), reason);
            return;
        }
        let timing = Timing {
            leg: &leg.label,
            vertices: leg.vertices.as_ref().map(|v| v.seconds.clone()),
        };
        let own = rows(loaded, leg.grid, &timing, &measured, bound);
        self.rows.extend(own);
    }
}

/// The spec on each sub-pixel grid with each set of samples.
type Grids = BTreeMap<(u32, Samples), Grid>;

/// A leg's triangles on its device.
struct Prepared<'r> {
    label: String,
    rasterizer: Rasterizer<'r>,
    grid: &'r Grid,
    station: &'r Station<'r>,
}

/// Measures a scene.
pub(super) fn scene(
    loaded: &Loaded,
    asked: &Asked,
    stations: &[Station<'_>],
    options: &Options,
    ceilings: &[Ceilings],
    progress: &Progress,
) -> Result<Done, String> {
    let name = &loaded.name;
    let plan = Plan::of(loaded, asked.skip);
    let mut done = Done::default();
    let (grids, legs) = grids(loaded, asked, &plan, (stations, options), &mut done)?;
    let own = (SUBPIXEL_BITS, loaded.scene.samples);
    let Some(spec) = grids.get(&own) else {
        return Ok(done);
    };
    if grids.values().all(|grid| grid.counts.longest() == 0) {
        let words = format!("{name}: nothing transparent is seen");
        done.skipped.push(words);
        return Ok(done);
    }
    let mut prepared = Vec::new();
    for (station, path, key) in legs {
        let label = station.adapter.label(path);
        let grid = &grids[&key];
        if let Some(rasterizer) =
            done.keep(&format!("{name}: {label}"), station.rasterizer(path, grid))
        {
            prepared.push(Prepared {
                label,
                rasterizer,
                grid,
                station,
            });
        }
    }
    let steps = u32::try_from(prepared.len()).unwrap_or(u32::MAX);
    progress.begin(&format!("{name}: comparing"), steps);
    let mut legs = Vec::new();
    for one in &prepared {
        legs.extend(leg(one, (loaded, asked), &plan, options, &mut done));
        progress.step();
    }
    let bound = Bound(ceilings);
    progress.begin(&format!("{name}: the spec"), 1);
    done.of_core(loaded, &plan, spec, &bound);
    progress.step();
    measure(name, &mut legs, &mut done, progress);
    for leg in &legs {
        done.of_leg(loaded, leg, &bound);
    }
    Ok(done)
}

/// Warms the legs up, runs all rounds, and compares once more.
fn measure(name: &str, legs: &mut Vec<Leg<'_>>, done: &mut Done, progress: &Progress) {
    progress.begin(&format!("{name}: warming up"), 1);
    warm_up(legs, |result| done.keep(name, result).is_some());
    progress.step();
    let all = legs.iter().map(|leg| leg.runs);
    progress.begin(&format!("{name}: measuring"), all.clone().sum());
    for round in 0..all.max().unwrap_or(0) {
        legs.retain_mut(|leg| {
            if round >= leg.runs {
                return true;
            }
            let result = leg.round(round);
            progress.step();
            done.keep(name, result).is_some()
        });
    }
    legs.retain(|leg| done.keep(name, leg.compare()).is_some());
}

/// A leg of a scene: its station, its path, and the grid that it works on.
type OfScene<'s> = (&'s Station<'s>, Path, (u32, Samples));

/// What the spec says on each sub-pixel grid that a leg has, and on its own.
fn grids<'s>(
    loaded: &Loaded,
    asked: &Asked,
    plan: &Plan,
    (stations, options): (&'s [Station<'s>], &Options),
    done: &mut Done,
) -> Result<(Grids, Vec<OfScene<'s>>), String> {
    let samples = loaded.scene.samples;
    let mut legs = Vec::new();
    for station in stations {
        for path in &options.paths {
            let what = format!("{}: {}", loaded.name, station.adapter.label(*path));
            if asked.boards && station.is_software() {
                let words = "of so many fragments only on a board".to_owned();
                done.refused(&what, Refusal::Skipped(words));
                continue;
            }
            if let Some(samples) = done.keep(&what, station.samples(*path, samples)) {
                legs.push((station, *path, (station.adapter.bits(*path), samples)));
            }
        }
    }
    let mut grids = Grids::new();
    if legs.is_empty() && asked.boards {
        return Ok((grids, legs));
    }
    for key in legs
        .iter()
        .map(|leg| leg.2)
        .chain([(SUBPIXEL_BITS, samples)])
    {
        if let Entry::Vacant(vacant) = grids.entry(key) {
            let mut grid = Grid::new(&loaded.scene, plan, key)?;
            grid.draw(&loaded.scene, asked.layers.as_deref());
            vacant.insert(grid);
        }
    }
    Ok((grids, legs))
}

/// A leg whose pictures are right, with all techniques that it has.
fn leg<'r>(
    prepared: &'r Prepared<'r>,
    (loaded, asked): (&'r Loaded, &Asked),
    plan: &'r Plan,
    options: &Options,
    done: &mut Done,
) -> Option<Leg<'r>> {
    let Prepared {
        label,
        rasterizer,
        grid,
        station,
    } = prepared;
    let (scene, what) = (&loaded.scene, format!("{}: {label}", loaded.name));
    let start = Start {
        label: label.clone(),
        rasterizer,
        grid,
        scene,
        options: plan.abuffer(scene),
        clock: &station.clock,
        budget: options.budget(station.is_software()),
        runs: options.runs(station.is_software()),
    };
    let mut leg = done.keep(&loaded.name, Leg::new(&start))?;
    let vertices = Vertices::new(&start).map_err(Refusal::from);
    leg.vertices = done.keep(&format!("{what}: vertex stages"), vertices);
    let one = grid.primitives.samples.count() == 1;
    if plan.skipped("jagged").is_none() && rasterizer.path != Path::Fragment {
        for method in Method::BY_TILES {
            let name = format!("{what}: {}", method.name());
            leg.tiles
                .extend(done.keep(&name, ByTiles::new(method, &start)));
        }
    }
    if let Some(run) = grid.whole().filter(|_| one && asked.rivals) {
        let given = rivals::Given {
            label,
            rasterizer,
            grid,
            scene,
            run,
            plan,
            all: options.rivals,
        };
        for kind in rivals::ALL {
            let beside = Beside::new(kind, &given, start.clock);
            let name = kind.method.name();
            leg.beside
                .extend(done.keep(&format!("{what}: {name}"), beside));
        }
    }
    Some(leg)
}

impl Measured {
    /// Seconds of a frame, round by round.
    pub(super) fn seconds(&self) -> impl Iterator<Item = f64> {
        let rounds = self.parts.first().map_or(0, |(_, seconds)| seconds.len());
        (0..rounds).map(|round| self.parts.iter().map(|(_, seconds)| seconds[round]).sum())
    }
}
