//! What a device makes of a grid by itself, from its own lists.

use triptych_gpu::error::GpuError;
use triptych_gpu::grid::{Hit, Stages};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::Membership;
use triptych_spec::grid::trace::Query;
use triptych_spec::scene::Scene;

use super::gpu::GridLeg;
use super::pictures;
use super::spec::GridRun;
use super::view::View;
use crate::compare::grid::{self as judge, Runs};
use crate::compare::{Judgement, compare};
use crate::dump::GridHit;
use crate::observe::{Gpu, Observed};
use crate::replay::rows::Rows;
use crate::report::Picture;

impl GridLeg<'_> {
    /// The device's own lists, and rays through them. Lists that no search may follow are told
    /// by their own row.
    pub(super) fn end_to_end(&self, rows: &mut Rows) -> Result<(), GpuError> {
        let mut stages = self.stages()?;
        let spec = self.spec.map(|_| ());
        let [offsets, prims] = self.built(&mut stages)?;
        let sound = self.is_sound(&offsets, &prims);
        let lists = Observed::<Gpu, _>::new(self.label(), (offsets, prims));
        let judgement = compare(self.spec, &lists, |spec, (offsets, prims)| {
            lists_of(spec, Runs { offsets, prims })
        });
        rows.add("end to end", &spec, &lists, judgement);
        if !sound {
            return Ok(());
        }
        let judgement = Judgement {
            note: "closest hits from its own lists".to_owned(),
            ..self.traced(&mut stages, Query::Closest)?
        };
        let seen = Observed::<Gpu, _>::new(self.label(), ());
        rows.add("end to end", &spec, &seen, judgement);
        Ok(())
    }

    /// The device's own offsets, and its entries unless the offsets lead nowhere.
    fn built(&self, stages: &mut Stages<'_>) -> Result<[Vec<u32>; 2], GpuError> {
        stages.count()?;
        let offsets = stages.scan()?;
        let prims = match self.entries_of(&offsets) {
            Some(entries) => stages.fill(entries, entries)?,
            None => Vec::new(),
        };
        Ok([offsets, prims])
    }

    /// Whether a search may follow lists.
    fn is_sound(&self, offsets: &[u32], prims: &[u32]) -> bool {
        let triangles = self.spec.value.blockers.triangles.len();
        let known = prims.iter().all(|prim| (*prim as usize) < triangles);
        known && self.entries_of(offsets).is_some()
    }

    /// The device's own offsets and entries; `None` if no search may follow them.
    fn own_lists(&self, stages: &mut Stages<'_>) -> Result<Option<[Vec<u32>; 2]>, GpuError> {
        let [offsets, prims] = self.built(stages)?;
        let sound = self.is_sound(&offsets, &prims);
        Ok(sound.then_some([offsets, prims]))
    }

    /// What the device sees through its own lists, for the report; `None` if they are damaged, or
    /// nobody looks.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn look(&self, scene: &Scene) -> Result<Option<Picture>, GpuError> {
        let mut stages = self.stages()?;
        if self.own_lists(&mut stages)?.is_none() {
            return Ok(None);
        }
        let Some(view) = View::new(&self.spec.value.grid) else {
            return Ok(None);
        };
        let seen = view.seen(scene, |rays, query| {
            let hits = stages.trace(rays, query)?;
            let met = |hit: &Hit| Some((met(hit)?, f64::from(hit.time)));
            Ok::<_, GpuError>(hits.iter().map(met).collect())
        })?;
        Ok(Some(pictures::leg(&view, &self.label(), &seen)))
    }

    /// Everything by the device alone, for a dump; `None` if its lists are damaged.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn own(&self) -> Result<Option<Observed<Gpu, OwnGrid>>, GpuError> {
        let mut stages = self.stages()?;
        let Some([offsets, prims]) = self.own_lists(&mut stages)? else {
            return Ok(None);
        };
        let rays = &self.spec.value.rays;
        let any = stages.trace(rays, Query::Any)?;
        let closest = stages.trace(rays, Query::Closest)?;
        let hits = any.iter().zip(&closest).map(|(any, closest)| GridHit {
            any: met(any),
            closest: met(closest).map(|prim| (prim, f64::from(closest.time))),
        });
        let own = OwnGrid {
            offsets,
            prims,
            hits: hits.collect(),
        };
        Ok(Some(Observed::new(self.label(), own)))
    }
}

/// What a device makes of a scene's grid by itself.
pub struct OwnGrid {
    /// Where each cell's list starts.
    pub offsets: Vec<u32>,
    /// Rows of triangles.
    pub prims: Vec<u32>,
    /// What its rays meet.
    pub hits: Vec<GridHit>,
}

/// A device's own lists: the spec's, or between them and those of boxes where a kernel may prove
/// less than the spec.
fn lists_of(spec: &GridRun, seen: Runs<'_>) -> Judgement {
    let least = spec.runs();
    if spec.membership == Membership::Overlap {
        return judge::within(least, seen, spec.box_runs());
    }
    let offsets = judge::offsets(least.offsets, seen.offsets);
    match offsets.differ() {
        0 => judge::entries(least, seen.prims),
        _ => offsets,
    }
}

/// The triangle that a hit names.
fn met(hit: &Hit) -> Option<u32> {
    (hit.prim != NOTHING).then_some(hit.prim)
}
