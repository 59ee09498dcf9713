//! A GPU leg of a scene with rays in queues: every stage from the spec's rays, bounce after bounce, then
//! a frame of the device's own.

use std::collections::BTreeSet;
use std::time::Duration;

use triptych_gpu::dispatch::{Appended, Bounce as Made, Frame, Room, Stages};
use triptych_gpu::error::GpuError;
use triptych_spec::dispatch::{Met, Ray};

use super::spec::{Bounce, DispatchRun};
use crate::compare::Judgement;
use crate::compare::dispatch as judge;
use crate::replay::judged::Judged;
use crate::replay::leg::Leg;
use crate::replay::rows::Rows;

/// One GPU leg of one scene.
pub type DispatchLeg<'a> = Leg<'a, DispatchRun>;

/// Why a stage has nothing to be compared.
const NONE: &str = "the spec has no such ray, and neither has the leg";

/// Fewest rays for which too little room is tried as well.
const OVERFLOWING: usize = 4;

impl DispatchLeg<'_> {
    /// Adds a row for each stage from the spec's input, and one for all of them from the device's
    /// own rays; gives what it made in the latter.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self, rows: &mut Rows) -> Result<Frame, GpuError> {
        self.each(rows)?;
        self.end_to_end(rows)
    }

    fn stages(&self) -> Result<Stages<'_>, GpuError> {
        let setup = &self.spec.value.setup;
        let kernels = self.adapter.kernels(self.path);
        Stages::new(&self.adapter.gpu, kernels, &setup.world, &setup.grid)
    }

    /// Adds a row for each stage from the spec's input.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn each(&self, rows: &mut Rows) -> Result<(), GpuError> {
        let mut judged = Judged::default();
        let mut stages = self.stages()?;
        let first = &self.spec.value.bounces[0];
        let seen = stages.primary()?;
        let judgement = self.beside(&first.rays, seen, |must, seen| judge::shot(must, seen));
        let times = self.spec.value.times;
        judged.add("primary", judgement, times.primary, stages.time);
        for (at, bounce) in self.spec.value.bounces.iter().enumerate() {
            let next = self.spec.value.bounces.get(at + 1);
            self.searched(bounce, &mut stages, &mut judged)?;
            self.appended(bounce, next, &mut stages, &mut judged)?;
            self.deposited(bounce, &mut stages, &mut judged)?;
        }
        judged.rows_or(Some(NONE), &self.spec.label, &self.label(), rows);
        self.left_out(rows);
        Ok(())
    }

    /// A share of the spec's time of a stage, which it has for all bounces.
    fn share(&self, time: Duration) -> Duration {
        time / u32::try_from(self.spec.value.bounces.len()).unwrap_or(u32::MAX)
    }

    /// Stages `intersect` and `locate`.
    fn searched(
        &self,
        bounce: &Bounce,
        stages: &mut Stages<'_>,
        judged: &mut Judged,
    ) -> Result<(), GpuError> {
        let times = self.spec.value.times;
        if self.runs("intersect") {
            let (rays, must) = bounce.asked();
            let seen = stages.intersect(&rays)?;
            let judgement = self.beside(must, seen, |must, seen| judge::met(&rays, must, seen));
            judged.add(
                "intersect",
                judgement,
                self.share(times.intersect),
                stages.time,
            );
        }
        if self.runs("locate") {
            let seen = stages.locate(&bounce.rays, &bounce.met)?;
            let judgement = self.beside(&bounce.surfaces, seen, |must, seen| {
                judge::located(&bounce.rays, must, seen)
            });
            judged.add("locate", judgement, self.share(times.locate), stages.time);
        }
        Ok(())
    }

    /// Stages `light` and `reflect`, each with half of the room that it needs at first.
    fn appended(
        &self,
        bounce: &Bounce,
        next: Option<&Bounce>,
        stages: &mut Stages<'_>,
        judged: &mut Judged,
    ) -> Result<(), GpuError> {
        let times = self.spec.value.times;
        if self.runs("light") {
            let room = half(&bounce.shadows);
            let seen = stages.light(&bounce.rays, &bounce.surfaces, room)?;
            let time = stages.time;
            let judgement = self.queue(&bounce.rays, &bounce.shadows, &seen, judged);
            judged.add("light", judgement, self.share(times.light), time);
            let lights = self.beside(&bounce.lights, &seen.rays, |lights, seen| {
                judge::lights(&bounce.shadows, lights, seen)
            });
            judged.part("light", lights);
        }
        if self.runs("reflect") {
            let must = next.map_or(&[][..], |next| &next.rays[..]);
            let seen = stages.reflect(&bounce.rays, &bounce.surfaces, half(must))?;
            let time = stages.time;
            let judgement = self.queue(&bounce.rays, must, &seen, judged);
            judged.add("reflect", judgement, self.share(times.reflect), time);
        }
        Ok(())
    }

    /// A queue's rays; attempts that had too little room have a row of their own.
    fn queue(&self, rays: &[Ray], must: &[Ray], seen: &Appended, judged: &mut Judged) -> Judgement {
        for tried in &seen.overflows {
            let room = [tried.capacity, tried.attempts];
            // Of a bounce that goes through in parts each has its own attempt; a pixel has one ray in it.
            let asked = asked_by(rays, &tried.asked);
            let own = must.iter().filter(|ray| asked.contains(&ray.pixel));
            let own: Vec<Ray> = own.copied().collect();
            let judgement = self.beside(own, &tried.rays, |must, seen| {
                judge::overflow(must, room, seen)
            });
            judged.part("overflow", judgement);
        }
        self.beside(must, &seen.rays, |must, seen| judge::shot(must, seen))
    }

    /// Stage `deposit`.
    fn deposited(
        &self,
        bounce: &Bounce,
        stages: &mut Stages<'_>,
        judged: &mut Judged,
    ) -> Result<(), GpuError> {
        if !self.runs("deposit") {
            return Ok(());
        }
        let run = &self.spec.value;
        let (rays, met) = bounce.asked();
        let seen = stages.deposit(&rays, &met)?;
        let must = bounce.sums(&run.setup.world);
        let judgement = self.beside(must, seen, judge::sums);
        judged.add(
            "deposit",
            judgement,
            self.share(run.times.deposit),
            stages.time,
        );
        Ok(())
    }

    /// Adds a row for all stages, each from what the device made in the ones before: the same rays in
    /// every bounce, which needs the same answers to those before, and a picture within its bounds.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn end_to_end(&self, rows: &mut Rows) -> Result<Frame, GpuError> {
        let run = &self.spec.value;
        let made = self.stages()?.frame(Room::default())?;
        let Frame { bounces, sums, .. } = &made;
        let mut judged = Judged::default();
        for at in 0..run.bounces.len().max(bounces.len()) {
            let (none, nothing) = (Bounce::default(), Made::default());
            let must = run.bounces.get(at).unwrap_or(&none);
            let seen = bounces.get(at).unwrap_or(&nothing);
            let all = |rays: &[Ray], shadows: &[Ray]| [rays, shadows].concat();
            let must = all(&must.rays, &must.shadows);
            let seen = all(&seen.rays, &seen.shadows.rays);
            let judgement = self.beside(must, seen, |must, seen| judge::shot(must, seen));
            judged.part("end to end", judgement);
        }
        let picture = self.beside(&run.sums, sums, |must, seen| {
            judge::picture(must, &run.bounds, seen)
        });
        judged.part("end to end", picture);
        judged.rows(&self.spec.label, &self.label(), rows);
        Ok(made)
    }
}

impl Bounce {
    /// Rays of both kinds, and what they meet.
    fn asked(&self) -> (Vec<Ray>, Vec<Met>) {
        let reached = |lit: &bool| if *lit { Met::Nothing } else { Met::Something };
        let rays = [&self.rays[..], &self.shadows].concat();
        let met = self.met.iter().copied().chain(self.lit.iter().map(reached));
        (rays, met.collect())
    }
}

/// The pixels of some rays.
fn asked_by(rays: &[Ray], rows: &std::ops::Range<usize>) -> BTreeSet<u32> {
    let rays = rays.get(rows.clone()).unwrap_or_default();
    rays.iter().map(|ray| ray.pixel).collect()
}

/// Half of the room that some rays need; as much as is chosen for few.
fn half(rays: &[Ray]) -> Option<u32> {
    let half = u32::try_from(rays.len() / 2).ok();
    half.filter(|_| rays.len() >= OVERFLOWING)
}
