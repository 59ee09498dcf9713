//! What a replay of rays in queues writes for `--dump`.

use std::io;

use triptych_gpu::dispatch::Frame;
use triptych_spec::dispatch::{Met, Sums};
use triptych_spec::raster::Samples;

use super::spec::DispatchRun;
use crate::dump::{BounceArrays, LegDump};
use crate::observe::{Observed, Spec};
use crate::replay::facts;
use crate::replay::run::Run;

impl Run<'_> {
    /// Every ray of the spec's.
    pub(super) fn dump_traced_spec(&self, spec: &Observed<Spec, DispatchRun>) -> io::Result<()> {
        let run = &spec.value;
        let Some(leg) = self.traced_leg(&spec.label, run, &run.sums)? else {
            return Ok(());
        };
        for (number, bounce) in run.bounces.iter().enumerate() {
            let arrays = BounceArrays {
                rays: &bounce.rays,
                met: &bounce.met,
                surfaces: &bounce.surfaces,
                shadows: &bounce.shadows,
                lit: &bounce.lit,
            };
            leg.bounce(number, &arrays)?;
        }
        Ok(())
    }

    /// Every ray of a device's own frame.
    pub(super) fn dump_traced_gpu(
        &self,
        label: &str,
        spec: &Observed<Spec, DispatchRun>,
        made: &Frame,
    ) -> io::Result<()> {
        let Some(leg) = self.traced_leg(label, &spec.value, &made.sums)? else {
            return Ok(());
        };
        for (number, bounce) in made.bounces.iter().enumerate() {
            let lit: Vec<bool> = bounce.blocked.iter().map(|m| *m == Met::Nothing).collect();
            let arrays = BounceArrays {
                rays: &bounce.rays,
                met: &bounce.met,
                surfaces: &bounce.seen,
                shadows: &bounce.shadows.rays,
                lit: &lit,
            };
            leg.bounce(number, &arrays)?;
        }
        Ok(())
    }

    /// A leg's folder, with what does not depend on a bounce; `None` if nothing is written.
    fn traced_leg(
        &self,
        label: &str,
        run: &DispatchRun,
        sums: &Sums,
    ) -> io::Result<Option<LegDump>> {
        let Some(dump) = &self.options.dump else {
            return Ok(None);
        };
        let leg = dump.leg(&self.loaded.name, label);
        leg.meta(&facts::meta(self.loaded, label, 0, Samples::ONE))?;
        leg.traced(&run.setup.lattice, &run.setup.world.blockers, sums)?;
        Ok(Some(leg))
    }
}
