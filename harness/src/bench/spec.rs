//! The spec on one core, measured: once, as it takes seconds where an adapter takes thousandths.

use std::time::Duration;

use triptych_gpu::abuffer::Part;
use triptych_spec::abuffer::{build, nearest_layers, opaque, resolve, sort};
use triptych_spec::scene::Scene;
use triptych_spec::vertex::primitives;

use super::Method;
use super::counts::Work;
use super::reference::Grid;
use super::scene::Measured;
use crate::plan::Plan;
use crate::replay::spec::{SpecRun, timed};

/// The spec, which ran once.
pub(super) struct Core<'g> {
    plan: &'g Plan,
    grid: &'g Grid,
    /// Seconds of the vertex stages.
    pub(super) vertices: f64,
    /// Seconds of stages opaque and build; of the nearest layers, each with their
    /// picture; of sort and resolve.
    taken: [Vec<f64>; 4],
}

impl<'g> Core<'g> {
    /// Runs everything once.
    pub(super) fn new(scene: &Scene, plan: &'g Plan, grid: &'g Grid, run: &SpecRun) -> Self {
        let prims = &run.primitives;
        let vertices = timed(|| primitives(scene, prims.bits)).1;
        let mut before = Vec::new();
        if plan.opaque {
            before.push(timed(|| opaque(scene, prims)).1);
        }
        let (lists, time) = timed(|| build(scene, prims, &run.opaque, plan.depth_test, u32::MAX));
        before.push(time);
        let layers = &grid.layers;
        let mut order = vec![Duration::ZERO; layers.len()];
        let mut blend = order.clone();
        // With several samples a pixel there are only all layers, in order.
        let several = prims.samples.count() > 1;
        for at in (0..layers.len()).filter(|_| !several) {
            let (kept, time) = timed(|| nearest_layers(&lists, layers[at]));
            order[at] = time;
            blend[at] = timed(|| resolve(scene, prims, &run.opaque, &kept)).1;
        }
        let (sorted, time) = timed(|| sort(&lists));
        let all = timed(|| resolve(scene, prims, &run.opaque, &sorted)).1;
        let times = [before, order, blend, vec![time, all]];
        let seconds = |times: Vec<Duration>| times.iter().map(Duration::as_secs_f64).collect();
        Self {
            plan,
            grid,
            vertices: vertices.as_secs_f64(),
            taken: times.map(seconds),
        }
    }

    /// The frames that were measured.
    pub(super) fn measured(&self) -> Vec<Measured> {
        let longest = self.grid.counts.longest();
        let one = self.grid.primitives.samples.count() == 1;
        let kept = (0..).zip(&self.grid.layers).filter(|_| one);
        let mut all: Vec<Measured> = kept.map(|(at, n)| self.frame(at, *n)).collect();
        let [sort, blend] = [0, 1].map(|at| vec![self.taken[3][at]]);
        all.push(self.all(Method::Sort, longest, [("sort", sort), ("blend", blend)]));
        all
    }

    fn frame(&self, at: usize, layers: u32) -> Measured {
        let [order, blend] = [1, 2].map(|which| vec![self.taken[which][at]]);
        let parts = [("nearest", order), ("blend", blend)];
        self.all(Method::Insertion, layers, parts)
    }

    fn all(&self, method: Method, layers: u32, last: [(&'static str, Vec<f64>); 2]) -> Measured {
        let names: &[&str] = match self.plan.opaque {
            true => &["opaque", "build"],
            false => &["build"],
        };
        let before = names.iter().zip(&self.taken[0]);
        let mut parts: Vec<(&'static str, Vec<f64>)> = before
            .map(|(name, seconds)| (*name, vec![*seconds]))
            .collect();
        parts.extend(last);
        let work: &[Part] = match method {
            Method::Sort => &[Part::Sort, Part::Resolve],
            _ => &[Part::Nearest(layers)],
        };
        Measured {
            method,
            layers,
            parts,
            error: self.grid.error_of_spec(layers),
            memory: self.grid.counts.spec_memory(layers),
            of_fragment: Some(triptych_gpu::abuffer::NODE),
            bands: 1,
            work: self.work(work),
        }
    }

    fn work(&self, last: &[Part]) -> Work {
        let opaque = self.plan.opaque.then_some(Part::Opaque);
        let parts = [Part::Clear, Part::Build].into_iter().chain(opaque);
        let all = parts.chain(last.iter().copied());
        all.fold(Work::default(), |sum, part| {
            sum.and(self.grid.counts.work(part))
        })
    }
}
