//! The spec on one core, measured.

use std::time::Duration;

use triptych_gpu::abuffer::Part;
use triptych_spec::abuffer::{build, nearest_layers, opaque, resolve, sort};
use triptych_spec::scene::Scene;

use super::Method;
use super::counts::Work;
use super::error::Error;
use super::reference::Grid;
use super::scene::Measured;
use crate::plan::Plan;
use crate::replay::spec::timed;

/// The spec, round by round.
pub(super) struct Core<'g> {
    scene: &'g Scene,
    plan: &'g Plan,
    grid: &'g Grid,
    /// Seconds of stages opaque and build; of the nearest layers, each with their
    /// picture; of sort and resolve.
    rounds: Vec<[Vec<f64>; 4]>,
}

impl<'g> Core<'g> {
    pub(super) fn new(scene: &'g Scene, plan: &'g Plan, grid: &'g Grid) -> Self {
        Self {
            scene,
            plan,
            grid,
            rounds: Vec::new(),
        }
    }

    /// Runs everything once, and keeps no times.
    pub(super) fn warm_up(&self, round: u32) {
        self.run(round);
    }

    /// Runs everything once, and keeps the times.
    pub(super) fn round(&mut self, round: u32) {
        let times = self.run(round);
        self.rounds.push(times);
    }

    fn run(&self, round: u32) -> [Vec<f64>; 4] {
        let (scene, run) = (self.scene, &self.grid.run);
        let primitives = &run.primitives;
        let mut before = Vec::new();
        if self.plan.opaque {
            before.push(timed(|| opaque(scene, primitives)).1);
        }
        let depth_test = self.plan.depth_test;
        let (lists, time) = timed(|| build(scene, primitives, &run.opaque, depth_test, u32::MAX));
        before.push(time);
        let layers = &self.grid.layers;
        let mut order = vec![Duration::ZERO; layers.len()];
        let mut blend = order.clone();
        for at in 0..layers.len() {
            // None is always first.
            let at = (at + round as usize) % layers.len();
            let (kept, time) = timed(|| nearest_layers(&lists, layers[at]));
            order[at] = time;
            blend[at] = timed(|| resolve(scene, primitives, &run.opaque, &kept)).1;
        }
        let (sorted, time) = timed(|| sort(&lists));
        let all = timed(|| resolve(scene, primitives, &run.opaque, &sorted)).1;
        let times = [before, order, blend, vec![time, all]];
        times.map(|times| times.iter().map(Duration::as_secs_f64).collect())
    }

    /// The frames that were measured.
    pub(super) fn measured(&self) -> Vec<Measured> {
        let kept = (0..).zip(&self.grid.layers);
        let mut all: Vec<Measured> = kept.map(|(at, n)| self.frame(at, *n)).collect();
        let longest = self.grid.counts.longest();
        let seconds = |at: usize| self.rounds.iter().map(|r| r[3][at]).collect();
        let mut parts = self.before();
        parts.push(("sort", seconds(0)));
        parts.push(("blend", seconds(1)));
        all.push(Measured {
            method: Method::Sort,
            layers: longest,
            parts,
            error: self.error(longest),
            memory: self.grid.counts.spec_memory(longest),
            work: self.work(&[Part::Sort, Part::Resolve]),
        });
        all
    }

    fn frame(&self, at: usize, layers: u32) -> Measured {
        let seconds = |which: usize| self.rounds.iter().map(|r| r[which][at]).collect();
        let mut parts = self.before();
        parts.push(("nearest", seconds(1)));
        parts.push(("blend", seconds(2)));
        Measured {
            method: Method::Insertion,
            layers,
            parts,
            error: self.error(layers),
            memory: self.grid.counts.spec_memory(layers),
            work: self.work(&[Part::Nearest(layers)]),
        }
    }

    fn before(&self) -> Vec<(&'static str, Vec<f64>)> {
        let names: &[&str] = match self.plan.opaque {
            true => &["opaque", "build"],
            false => &["build"],
        };
        let seconds = |at: usize| self.rounds.iter().map(|r| r[0][at]).collect();
        (0..)
            .zip(names)
            .map(|(at, name)| (*name, seconds(at)))
            .collect()
    }

    fn work(&self, last: &[Part]) -> Work {
        let opaque = self.plan.opaque.then_some(Part::Opaque);
        let parts = [Part::Clear, Part::Build].into_iter().chain(opaque);
        let all = parts.chain(last.iter().copied());
        all.fold(Work::default(), |sum, part| {
            sum.and(self.grid.counts.work(part))
        })
    }

    fn error(&self, layers: u32) -> Error {
        let picture = &self.grid.picture(layers).value;
        self.grid
            .error(picture.iter().map(|pixel| pixel.map(|c| c.value)))
    }
}
