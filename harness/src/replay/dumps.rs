//! What a replay writes for `--dump`.

use super::facts;
use super::gpu::GpuSeen;
use super::run::Run;
use super::spec::SpecRun;
use crate::observe::{Gpu, Observed, Spec};

impl Run<'_> {
    pub(super) fn dump_spec(&self, spec: &Observed<Spec, SpecRun>) -> std::io::Result<()> {
        let Some(dump) = &self.options.dump else {
            return Ok(());
        };
        let leg = dump.leg(&self.loaded.name, &spec.label);
        let SpecRun {
            primitives, sorted, ..
        } = &spec.value;
        leg.meta(&facts::meta(self.loaded, &spec.label, primitives.bits))?;
        leg.primitives(primitives, &self.loaded.scene)?;
        leg.sorted(&self.loaded.scene, primitives, sorted)?;
        leg.image("resolve", "image", primitives.size, &spec.value.picture())
    }

    pub(super) fn dump_gpu(
        &self,
        spec: &SpecRun,
        seen: &Observed<Gpu, GpuSeen>,
    ) -> std::io::Result<()> {
        let Some(dump) = &self.options.dump else {
            return Ok(());
        };
        let leg = dump.leg(&self.loaded.name, &seen.label);
        leg.meta(&facts::meta(self.loaded, &seen.label, spec.primitives.bits))?;
        leg.primitives(&spec.primitives, &self.loaded.scene)?;
        if let Some(sorted) = &seen.value.sorted {
            leg.sorted(&self.loaded.scene, &spec.primitives, sorted)?;
            let size = spec.primitives.size;
            leg.image("resolve", "image", size, &seen.value.abuffer.image)?;
        }
        Ok(())
    }
}
