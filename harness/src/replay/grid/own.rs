//! What a device makes of a grid by itself, from its own lists.

use triptych_gpu::error::GpuError;
use triptych_gpu::grid::{Hit, Stages};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::trace::Query;

use super::gpu::{DAMAGED, GridLeg};
use crate::compare::Judgement;
use crate::dump::GridHit;
use crate::observe::{Gpu, Observed};
use crate::replay::rows::Rows;
use crate::row::Class;

impl GridLeg<'_> {
    /// Rays through the device's own lists.
    pub(super) fn end_to_end(&self, rows: &mut Rows) -> Result<(), GpuError> {
        let mut stages = self.stages()?;
        let spec = self.spec.map(|_| ());
        if self.own_lists(&mut stages)?.is_none() {
            let (label, reason) = (self.label(), DAMAGED.to_owned());
            rows.skip("end to end", &spec.label, &label, Class::Decision, reason);
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

    /// The device's own offsets and entries; `None` if no search may follow them.
    fn own_lists(&self, stages: &mut Stages<'_>) -> Result<Option<[Vec<u32>; 2]>, GpuError> {
        stages.count()?;
        let offsets = stages.scan()?;
        let Some(entries) = self.entries_of(&offsets) else {
            return Ok(None);
        };
        let prims = stages.fill(entries, entries)?;
        let triangles = self.spec.value.blockers.triangles.len();
        let known = prims.iter().all(|prim| (*prim as usize) < triangles);
        Ok(known.then_some([offsets, prims]))
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
        let met = |hit: &Hit| (hit.prim != NOTHING).then_some(hit.prim);
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
