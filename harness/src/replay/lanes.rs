//! Pieces of one scene's work side by side: a lane for Embree, and one for each adapter.
//!
//! A driver mostly waits, compiles, or has one core at work, and so do comparisons. Lanes share
//! nothing but the spec's results, so what comes out, and in which order, is the same as if all
//! pieces had run one after another; only times are those of a machine that has more to do.

mod specs;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, Weak};
use std::thread;

use triptych_gpu::raster::Path;
use triptych_spec::raster::Samples;

use super::dispatch::DispatchRun;
use super::gpu::Adapter;
use super::grid::GridRun;
use super::ldm::LdmRun;
use super::rows::Rows;
use super::rsm::RsmRun;
use super::run::Run;
use super::spec::SpecRun;
use super::stop::Stop;
use super::worst::Errors;
use crate::cache::Uses;
use crate::observe::{Observed, Spec};
use crate::row::Class;

/// A piece of a scene's work. Those of a lane follow each other.
pub(super) struct Task<'a> {
    lane: usize,
    work: Work<'a>,
}

type Work<'a> = Box<dyn FnOnce(&mut Run<'a>) -> Result<(), Stop> + Send + 'a>;

impl<'a> Task<'a> {
    /// A piece in the lane of what is asked of Embree and needs no adapter.
    pub(super) fn apart(work: impl FnOnce(&mut Run<'a>) -> Result<(), Stop> + Send + 'a) -> Self {
        Self {
            lane: 0,
            work: Box::new(work),
        }
    }
}

/// The spec's results, if a lane works with them.
type Held = Weak<Observed<Spec, SpecRun>>;

/// The spec's results, as long as a lane works with them: they are large.
#[derive(Default)]
pub(super) struct Shared {
    /// By sub-pixel bits and samples.
    specs: Mutex<BTreeMap<(u32, Samples), Held>>,
    /// Of a scene with a grid.
    grid: Mutex<Weak<Observed<Spec, GridRun>>>,
    /// Of a scene with indirect light.
    rsm: Mutex<Weak<Observed<Spec, RsmRun>>>,
    /// Of a scene with maps.
    ldm: Mutex<Weak<Observed<Spec, LdmRun>>>,
    /// Of a scene with rays in queues.
    dispatch: Mutex<Weak<Observed<Spec, DispatchRun>>>,
}

/// What came of a piece of work.
struct Part<'a> {
    /// Its place among all pieces.
    place: usize,
    run: Run<'a>,
    result: Result<(), Stop>,
}

impl<'a> Run<'a> {
    /// The legs of every adapter on every path; those of an adapter that share a sub-pixel grid
    /// follow each other.
    pub(super) fn on_adapters(
        &self,
        leg: fn(&mut Self, &Adapter, Path) -> Result<(), Stop>,
    ) -> Vec<Task<'a>> {
        let (adapters, options) = (self.adapters, self.options);
        let apart = Task::apart(move |run| {
            for broken in &options.broken {
                run.broken(broken);
            }
            if adapters.is_empty() && options.broken.is_empty() {
                let reason = "no adapter; `triptych doctor` says what is missing".to_owned();
                run.rows.skip("all", "spec", "gpu", Class::Exact, reason);
            }
            Ok(())
        });
        let mut legs: Vec<(usize, &'a Adapter, Path)> = Vec::new();
        for (at, adapter) in adapters.iter().enumerate() {
            legs.extend(options.paths.iter().map(|path| (1 + at, adapter, *path)));
        }
        legs.sort_by_key(|(_, adapter, path)| std::cmp::Reverse(adapter.bits(*path)));
        let task = |(lane, adapter, path): (usize, &'a Adapter, Path)| Task {
            lane,
            work: Box::new(move |run: &mut Self| run.on_adapter(adapter, path, leg)),
        };
        [apart]
            .into_iter()
            .chain(legs.into_iter().map(task))
            .collect()
    }

    fn on_adapter(
        &mut self,
        adapter: &Adapter,
        path: Path,
        leg: fn(&mut Self, &Adapter, Path) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        let wgpu::AdapterInfo {
            name,
            driver,
            driver_info,
            ..
        } = &adapter.gpu.info;
        let bits = adapter.bits(path).to_string();
        let grid = format!("{:?}", adapter.grid);
        let skipping = self.tests_skipping(adapter, path).to_string();
        let inputs = [
            name,
            driver,
            driver_info,
            path.name(),
            &bits,
            &grid,
            &skipping,
        ];
        let words = format!("{name} {driver}");
        self.unit(Uses::Driver(&words), &inputs, |run| leg(run, adapter, path))
    }

    /// Does all pieces, lanes beside each other, and takes up what came of them in the order in
    /// which they are given.
    ///
    /// # Errors
    /// That of the first piece that has one.
    pub(super) fn side_by_side(&mut self, tasks: Vec<Task<'a>>) -> Result<(), Stop> {
        let mut lanes = BTreeMap::<usize, Vec<(usize, Task<'a>)>>::new();
        for (place, task) in tasks.into_iter().enumerate() {
            lanes.entry(task.lane).or_default().push((place, task));
        }
        // Each lane lets go of the spec's results when it goes on to another grid.
        let first: Vec<Self> = lanes.iter().map(|_| self.apart()).collect();
        (self.spec, self.grid) = (None, None);
        (self.rsm, self.ldm, self.dispatch) = (None, None, None);
        let mut parts: Vec<Part<'a>> = thread::scope(|scope| {
            let lanes = lanes.into_values().zip(first);
            let lanes = lanes.map(|(lane, run)| scope.spawn(|| run.lane(lane)));
            let lanes: Vec<_> = lanes.collect();
            let done = lanes.into_iter().map(|lane| {
                lane.join()
                    .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            });
            done.flatten().collect()
        });
        parts.sort_by_key(|part| part.place);
        for part in parts {
            part.result?;
            self.take_up(part.run);
        }
        Ok(())
    }

    /// One lane's pieces, up to the first that stops.
    fn lane(mut self, tasks: Vec<(usize, Task<'a>)>) -> Vec<Part<'a>> {
        let mut parts: Vec<Part<'a>> = Vec::new();
        let count = tasks.len();
        for (nth, (place, task)) in tasks.into_iter().enumerate() {
            let result = (task.work)(&mut self);
            let stops = result.is_err();
            let mut next = self.apart();
            std::mem::swap(&mut next, &mut self);
            if nth + 1 < count {
                (next.spec, next.grid, next.rsm) = (None, None, None);
            }
            parts.push(Part {
                place,
                run: next,
                result,
            });
            if stops {
                break;
            }
        }
        parts
    }

    /// For a piece of this scene's work: with the spec's results, and nothing found yet.
    fn apart(&self) -> Self {
        Self {
            plan: self.plan.clone(),
            spec: self.spec.clone(),
            grid: self.grid.clone(),
            rsm: self.rsm.clone(),
            ldm: self.ldm.clone(),
            dispatch: self.dispatch.clone(),
            shared: self.shared.clone(),
            rows: Rows::new(&self.loaded.name, &self.loaded.family),
            pictures: Vec::new(),
            sheets: Vec::new(),
            errors: Errors::default(),
            unlike: BTreeSet::new(),
            saved: Vec::new(),
            facts: None,
            remarks: Vec::new(),
            ..*self
        }
    }

    /// Adds what a piece of work found.
    fn take_up(&mut self, part: Self) {
        self.spec = part.spec.or_else(|| self.spec.take());
        self.grid = part.grid.or_else(|| self.grid.take());
        self.rsm = part.rsm.or_else(|| self.rsm.take());
        self.ldm = part.ldm.or_else(|| self.ldm.take());
        self.dispatch = part.dispatch.or_else(|| self.dispatch.take());
        self.rows.append(part.rows);
        self.pictures.extend(part.pictures);
        self.sheets.extend(part.sheets);
        self.errors.add(part.errors);
        self.unlike.extend(part.unlike);
        self.saved.extend(part.saved);
        self.remarks.extend(part.remarks);
    }
}
