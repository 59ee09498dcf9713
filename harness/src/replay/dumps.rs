//! What a replay writes for `--dump`.

use triptych_spec::raster::Samples;
use triptych_spec::rsm::{Frame, Model};
use triptych_spec::vertex::SUBPIXEL_BITS;

use super::facts;
use super::gpu::GpuSeen;
use super::grid::{GridRun, OwnGrid};
use super::ldm::{LdmRun, Made};
use super::rsm::{RsmRun, Setup, rounded};
use super::run::Run;
use super::spec::SpecRun;
use crate::dump::{FrameArrays, FrameShape, GridArrays, GridHit, MapArrays, TurnArrays};
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
        leg.meta(&facts::meta(
            self.loaded,
            &spec.label,
            primitives.bits,
            primitives.samples,
        ))?;
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
        leg.meta(&facts::meta(
            self.loaded,
            &seen.label,
            spec.primitives.bits,
            spec.primitives.samples,
        ))?;
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
        leg.meta(&facts::meta(
            self.loaded,
            label,
            SUBPIXEL_BITS,
            Samples::ONE,
        ))?;
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

    /// The spec's frames, each number rounded once.
    pub(super) fn dump_rsm_spec(&self, spec: &Observed<Spec, RsmRun>) -> std::io::Result<()> {
        if self.options.dump.is_none() {
            return Ok(());
        }
        let frames = spec.value.frames.iter();
        let arrays: Vec<FrameArrays> = frames.map(|frame| arrays_of(&frame.frame)).collect();
        let models = spec.value.frames.iter().map(|frame| &frame.parts.model);
        self.dump_frames(&spec.label, &spec.value, models.zip(&arrays))
    }

    /// The spec's maps, and what is open and lit through them; each number rounded once.
    pub(super) fn dump_ldm_spec(&self, spec: &Observed<Spec, LdmRun>) -> std::io::Result<()> {
        let Some(dump) = &self.options.dump else {
            return Ok(());
        };
        let LdmRun {
            setup,
            turns,
            openness,
            ..
        } = &spec.value;
        let leg = dump.leg(&self.loaded.name, &spec.label);
        leg.meta(&facts::meta(
            self.loaded,
            &spec.label,
            spec.value.bits(),
            Samples::ONE,
        ))?;
        #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
        let openness: Vec<f32> = openness.iter().map(|o| o.value as f32).collect();
        let picture = spec.value.lit.then(|| rounded(&spec.value.picture()));
        let pixels: Vec<u32> = setup.receivers.iter().map(|r| r.pixel).collect();
        let receivers: Vec<_> = setup.receivers.iter().map(|r| r.receiver).collect();
        leg.maps(&MapArrays {
            lattice: &setup.lattice,
            size: setup.eye.size,
            blockers: &setup.blockers,
            pixels: &pixels,
            receivers: &receivers,
            openness: &openness,
            picture: picture.as_deref(),
        })?;
        let mut whole = vec![0; receivers.len()];
        for (number, turn) in (1..).zip(turns) {
            for (sum, open) in whole.iter_mut().zip(&turn.open) {
                *sum += open.whole;
            }
            leg.turn(
                number,
                &TurnArrays {
                    maps: &turn.maps,
                    offsets: &turn.layers.offsets,
                    keys: &turn.layers.keys,
                    whole: &whole,
                    hits: Some(&|receiver| {
                        turn.hits(&receivers[receiver]).map(|(_, h)| h).collect()
                    }),
                },
            )?;
        }
        Ok(())
    }

    /// What a device made of a scene of maps, from its own lists.
    pub(super) fn dump_ldm_gpu(
        &self,
        label: &str,
        spec: &Observed<Spec, LdmRun>,
        made: &[Made],
    ) -> std::io::Result<()> {
        let Some(dump) = &self.options.dump else {
            return Ok(());
        };
        let leg = dump.leg(&self.loaded.name, label);
        let run = &spec.value;
        leg.meta(&facts::meta(self.loaded, label, run.bits(), Samples::ONE))?;
        for (number, (turn, made)) in (1..).zip(run.turns.iter().zip(made)) {
            let whole: Vec<u32> = made.open.iter().map(|open| open.whole).collect();
            leg.turn(
                number,
                &TurnArrays {
                    maps: &turn.maps,
                    offsets: &made.layers.offsets,
                    keys: &made.layers.keys,
                    whole: &whole,
                    hits: None,
                },
            )?;
        }
        Ok(())
    }

    /// A leg's frames.
    pub(super) fn dump_frames<'a>(
        &self,
        label: &str,
        spec: &RsmRun,
        frames: impl Iterator<Item = (&'a Model, &'a FrameArrays)>,
    ) -> std::io::Result<()> {
        let Some(dump) = &self.options.dump else {
            return Ok(());
        };
        let leg = dump.leg(&self.loaded.name, label);
        leg.meta(&facts::meta(
            self.loaded,
            label,
            SUBPIXEL_BITS,
            Samples::ONE,
        ))?;
        let Setup {
            lattice,
            eye,
            lamp,
            parameters,
            ..
        } = &spec.setup;
        let shape = FrameShape {
            lattice,
            eye: eye.size,
            map: lamp.view.size,
            coarse: parameters.coarse(eye.size),
            words: parameters.words(),
        };
        leg.frames(&shape, frames)
    }
}

fn arrays_of(frame: &Frame) -> FrameArrays {
    FrameArrays {
        seen: frame.seen.surfaces.clone(),
        lights: frame.rsm.lights(),
        places: frame.places.clone(),
        lit: frame.direct.lit.clone(),
        direct: rounded(&frame.direct.light),
        all: rounded(&frame.all),
        bits: frame.blocked.bits.clone(),
        blocked: rounded(&frame.blocked.light),
        blurred: rounded(&frame.blurred),
        picture: rounded(&frame.picture),
    }
}
