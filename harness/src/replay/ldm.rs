//! A scene of layered depth maps: the family `ldm`.

mod facts;
pub mod limits;
mod setup;
mod spec;
mod tally;

use triptych_gpu::raster::Path;

use super::gpu::Adapter;
use super::lanes::Task;
use super::run::Run;
use super::stop::Stop;
use crate::cache::Uses;
use crate::registry::{Chain, Twin, stages_of};
use crate::row::Class;
pub use setup::{Asker, Setup, Turn};
pub use spec::{LdmRun, LdmTurn, Times};
pub use tally::Tally;

impl Run<'_> {
    /// The spec by itself, Embree, then every adapter.
    pub(super) fn ldm(&mut self) -> Result<(), Stop> {
        self.unit(Uses::Nothing, &["ldm", "spec"], |run| {
            let spec = run.ldm_spec()?;
            run.facts = Some(facts::of(run.loaded, &spec.value, run.options.skip));
            Ok(())
        })?;
        let mut tasks: Vec<Task<'_>> = Vec::new();
        if self.options.gpu {
            tasks.extend(self.on_adapters(Self::ldm_leg));
        }
        self.side_by_side(tasks)
    }

    /// No stage has a kernel yet, and rows say so.
    fn ldm_leg(&mut self, adapter: &Adapter, path: Path) -> Result<(), Stop> {
        let label = format!("gpu@{}/{}", adapter.gpu.name, path.name());
        for stage in stages_of(Chain::Maps) {
            if let Twin::None(why) = stage.compute {
                let rows = &mut self.rows;
                rows.skip(stage.name, "spec", &label, Class::Exact, why.to_owned());
            }
        }
        Ok(())
    }
}
