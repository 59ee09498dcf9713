//! The spec's results, computed when a lane first asks for them, and shared.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use triptych_spec::raster::Samples;
use triptych_spec::vertex::Primitives;

use crate::observe::{Observed, Spec};
use crate::replay::dispatch::DispatchRun;
use crate::replay::grid::GridRun;
use crate::replay::ldm::LdmRun;
use crate::replay::pieces;
use crate::replay::rsm::RsmRun;
use crate::replay::run::Run;
use crate::replay::spec::{SpecRun, Times};
use crate::replay::stop::Stop;
use crate::scene::Mistake;

impl Run<'_> {
    /// The spec's results on a grid with the scene's samples, computed when first asked for. Only
    /// the last grid's are held: they are large.
    pub(in crate::replay) fn spec(
        &mut self,
        bits: u32,
    ) -> Result<Arc<Observed<Spec, SpecRun>>, Stop> {
        self.spec_with(bits, self.loaded.scene.samples)
    }

    /// The same with samples in these places.
    pub(in crate::replay) fn spec_with(
        &mut self,
        bits: u32,
        samples: Samples,
    ) -> Result<Arc<Observed<Spec, SpecRun>>, Stop> {
        let held = self.spec.as_ref();
        let is = |p: &Primitives| (p.bits, p.samples) == (bits, samples);
        if let Some(spec) = held.filter(|s| is(&s.value.primitives)) {
            return Ok(spec.clone());
        }
        self.spec = None;
        let shared = self.shared.clone();
        // A lane that asks for what another is at waits for it.
        let mut specs = locked(&shared.specs);
        let known = specs.get(&(bits, samples)).and_then(Weak::upgrade);
        let spec = match known {
            Some(spec) => spec,
            None => Arc::new(self.new_spec(bits, samples)?),
        };
        specs.insert((bits, samples), Arc::downgrade(&spec));
        self.spec = Some(spec.clone());
        Ok(spec)
    }

    fn new_spec(&self, bits: u32, samples: Samples) -> Result<Observed<Spec, SpecRun>, Stop> {
        let scene = &self.loaded.scene;
        let (primitives, [transform, clip, snap]) = pieces::primitives(scene, bits);
        let primitives = Primitives {
            samples,
            ..primitives
        };
        let mut run = SpecRun::new(scene, primitives, &self.plan)
            .map_err(|words| Stop::Input(words.into()))?;
        run.times = Times {
            transform,
            clip,
            snap,
            ..run.times
        };
        Ok(Observed::new("spec", run))
    }

    /// The same of a scene with a grid.
    pub(in crate::replay) fn grid_spec(&mut self) -> Result<Arc<Observed<Spec, GridRun>>, Stop> {
        let held = self.grid.clone();
        let spec = shared(held, &self.shared.grid, || GridRun::new(self.loaded))?;
        self.grid = Some(spec.clone());
        Ok(spec)
    }

    /// The same of a scene with indirect light.
    pub(in crate::replay) fn rsm_spec(&mut self) -> Result<Arc<Observed<Spec, RsmRun>>, Stop> {
        let (held, skip) = (self.rsm.clone(), self.options.skip);
        let spec = shared(held, &self.shared.rsm, || RsmRun::new(self.loaded, skip))?;
        self.rsm = Some(spec.clone());
        Ok(spec)
    }

    /// The same of a scene with maps.
    pub(in crate::replay) fn ldm_spec(&mut self) -> Result<Arc<Observed<Spec, LdmRun>>, Stop> {
        let (held, skip) = (self.ldm.clone(), self.options.skip);
        let spec = shared(held, &self.shared.ldm, || LdmRun::new(self.loaded, skip))?;
        self.ldm = Some(spec.clone());
        Ok(spec)
    }

    /// The same of a scene with rays in queues.
    pub(in crate::replay) fn dispatch_spec(
        &mut self,
    ) -> Result<Arc<Observed<Spec, DispatchRun>>, Stop> {
        let held = self.dispatch.clone();
        let spec = shared(held, &self.shared.dispatch, || {
            DispatchRun::new(self.loaded)
        })?;
        self.dispatch = Some(spec.clone());
        Ok(spec)
    }
}

/// What is held, what another lane holds, or what is computed now: who asks for what another is
/// at waits for it.
fn shared<T>(
    held: Option<Arc<Observed<Spec, T>>>,
    lanes: &Mutex<Weak<Observed<Spec, T>>>,
    run: impl FnOnce() -> Result<T, Mistake>,
) -> Result<Arc<Observed<Spec, T>>, Stop> {
    if let Some(spec) = held {
        return Ok(spec);
    }
    let mut known = locked(lanes);
    let spec = match known.upgrade() {
        Some(spec) => spec,
        None => Arc::new(Observed::new("spec", run().map_err(Stop::Input)?)),
    };
    *known = Arc::downgrade(&spec);
    Ok(spec)
}

fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
