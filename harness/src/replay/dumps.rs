//! What a replay writes for `--dump`.

use triptych_spec::vertex::SUBPIXEL_BITS;

use super::facts;
use super::gpu::GpuSeen;
use super::grid::{GridRun, OwnGrid};
use super::run::Run;
use super::spec::SpecRun;
use crate::dump::{GridArrays, GridHit};
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

    /// The spec's lists and hits. Any that it names is the nearest, too.
    pub(super) fn dump_grid_spec(&self, spec: &Observed<Spec, GridRun>) -> std::io::Result<()> {
        let hits = spec.value.answers.iter().map(|answer| GridHit {
            any: answer.map(|first| first.prim),
            closest: answer.map(|first| (first.prim, first.time.value())),
        });
        let grid = &spec.value.grid;
        let lists = [&grid.offsets[..], &grid.prims];
        let hits: Vec<GridHit> = hits.collect();
        self.dump_lists(&spec.label, &spec.value, lists, &hits)
    }

    /// A device's own.
    pub(super) fn dump_grid(
        &self,
        spec: &GridRun,
        own: &Observed<Gpu, OwnGrid>,
    ) -> std::io::Result<()> {
        let lists = [&own.value.offsets[..], &own.value.prims];
        self.dump_lists(&own.label, spec, lists, &own.value.hits)
    }

    fn dump_lists(
        &self,
        label: &str,
        spec: &GridRun,
        [offsets, prims]: [&[u32]; 2],
        hits: &[GridHit],
    ) -> std::io::Result<()> {
        let Some(dump) = &self.options.dump else {
            return Ok(());
        };
        let leg = dump.leg(&self.loaded.name, label);
        leg.meta(&facts::meta(self.loaded, label, SUBPIXEL_BITS))?;
        leg.grid(&GridArrays {
            lattice: &spec.lattice,
            axes: &spec.grid.axes,
            blockers: &spec.blockers,
            offsets,
            prims,
            rays: &spec.rays,
            hits,
        })
    }
}
