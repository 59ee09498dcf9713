//! The spec on one core beside the hardware path of adapters.

use triptych_gpu::abuffer::{Stage, Stages};
use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::timer::{Clock, Timer};
use triptych_spec::abuffer::{Opaque, build};
use triptych_spec::raster::{self, Fragment};
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{Primitives, SUBPIXEL_BITS, primitives};

use super::super::{Progress, WARM_UP};
use super::{Row, Taken, order};
use crate::calibrate::Grid;
use crate::replay::gpu::Adapter;
use crate::replay::spec::{FRAGMENTS_MAX, faces, timed};
use crate::scene::Loaded;

/// The stages, in the order of all results here.
const NAMES: [&str; 2] = ["cover", "build"];

/// The adapter that the spec shall be no slower than.
const RIVAL: &str = "llvmpipe";

/// An adapter with the kernels that are timed, and the clock that can be believed.
pub(in crate::bench) struct Station<'a> {
    pub(in crate::bench) adapter: &'a Adapter,
    pub(in crate::bench) kernels: Kernels,
    pub(in crate::bench) clock: Clock,
}

impl Station<'_> {
    /// Whose clock, as rows name it.
    pub(in crate::bench) fn clock_name(&self) -> &'static str {
        match self.clock {
            Clock::Device => "device",
            Clock::Host(_) => "host",
        }
    }
}

/// The triangles on one sub-pixel grid, and how many fragments each stage must have.
struct Work {
    primitives: Primitives,
    faces: Vec<[f32; 4]>,
    /// Fragments of each row of pixels.
    rows: Vec<u32>,
    counts: [u64; 2],
}

impl Work {
    fn new(scene: &Scene, bits: u32) -> Self {
        let primitives = primitives(scene, bits);
        let faces = faces(scene, &primitives);
        let mut rows = vec![0; primitives.size.height as usize];
        let mut counts = [0; 2];
        raster::cover(&primitives, |f| {
            rows[(f.pixel / primitives.size.width) as usize] += 1;
            counts[0] += 1;
            counts[1] += u64::from(faces[f.prim as usize][3] < 1.0);
        });
        Self {
            primitives,
            faces,
            rows,
            counts,
        }
    }

    fn is_opaque(&self, prim: u32) -> bool {
        self.faces[prim as usize][3] >= 1.0
    }
}

/// A leg with what its stages took.
struct Leg<'r> {
    taken: [Taken; 2],
    device: Option<(Stages<'r, 'r>, Timer)>,
    /// Whether its device failed.
    lost: bool,
}

/// Measures a scene, and says what could not be.
pub(super) fn measure(
    loaded: &Loaded,
    stations: &[Station<'_>],
    runs: u32,
    progress: &Progress,
) -> (Vec<Row>, Vec<String>) {
    let (scene, name) = (&loaded.scene, &loaded.name);
    let mut remarks = Vec::new();
    let mut refuse = |leg: &str, why: String| remarks.push(format!("{name}: {leg}: {why}"));
    let own = Work::new(scene, SUBPIXEL_BITS);
    if own.counts[1] == 0 || own.counts[0] > FRAGMENTS_MAX {
        let count = own.counts[1];
        refuse("spec", format!("{count} fragments for lists"));
        return (Vec::new(), remarks);
    }
    let ready = prepared(scene, stations, &mut refuse);
    let mut legs = vec![Leg::of_core(&own)];
    for (label, rasterizer, work, clock) in &ready {
        match Leg::of_adapter(label, rasterizer, work, clock) {
            Ok(leg) => legs.push(leg),
            Err(why) => refuse(label, why),
        }
    }
    progress.begin(&format!("{name}: stages"), WARM_UP + runs);
    let mut stream = Vec::new();
    for round in 0..WARM_UP + runs {
        for at in order(round, legs.len()) {
            let leg = &mut legs[at];
            match leg.time(scene, &own.primitives, &mut stream) {
                Ok(seconds) if round >= WARM_UP => leg.note(seconds),
                Ok(_) => {}
                Err(error) => {
                    refuse(&leg.taken[0].leg, error.to_string());
                    leg.lost = true;
                }
            }
        }
        legs.retain(|leg| !leg.lost);
        progress.step();
    }
    (rows(name, &legs), remarks)
}

/// An adapter's label, its triangles, what they are, and its clock.
type Prepared<'s> = (String, Rasterizer<'s>, Work, &'s Clock);

/// The adapters with the triangles on their grids.
fn prepared<'s>(
    scene: &Scene,
    stations: &'s [Station<'_>],
    refuse: &mut impl FnMut(&str, String),
) -> Vec<Prepared<'s>> {
    let mut ready = Vec::new();
    let path = Path::Fragment;
    for station in stations {
        let adapter = station.adapter;
        let label = adapter.label(path);
        if adapter.grid == Grid::Unknown {
            refuse(&label, "the driver's sub-pixel grid is unknown".to_owned());
            continue;
        }
        if scene.samples.count() > 1 {
            refuse(
                &label,
                "frames of one sample a pixel are timed alone".to_owned(),
            );
            continue;
        }
        let work = Work::new(scene, adapter.bits(path));
        let (gpu, kernels) = (&adapter.gpu, &station.kernels);
        match Rasterizer::new(gpu, kernels, path, &work.primitives, &work.faces) {
            Ok(rasterizer) => ready.push((label, rasterizer, work, &station.clock)),
            Err(error) => refuse(&label, error.to_string()),
        }
    }
    ready
}

impl<'r> Leg<'r> {
    fn of_core(work: &Work) -> Self {
        Self {
            taken: work.counts.map(|count| Taken::new("spec", "host", count)),
            device: None,
            lost: false,
        }
    }

    /// An adapter's, if it counts what it must.
    fn of_adapter(
        label: &str,
        rasterizer: &'r Rasterizer<'r>,
        work: &Work,
        clock: &Clock,
    ) -> Result<Self, String> {
        let stages = Stages::new(rasterizer, &work.rows, |prim| work.is_opaque(prim));
        let stages = stages.map_err(|error| error.to_string())?;
        let counted = stages.count().map_err(|error| error.to_string())?;
        for stage in [Stage::Cover, Stage::Build] {
            let (has, must) = (counted[stage as usize], work.counts[stage as usize]);
            if has != must {
                let name = NAMES[stage as usize];
                return Err(format!("{name} counts {has} fragments, must be {must}"));
            }
        }
        let timer = Timer::new(rasterizer.gpu, clock, stages.spans());
        let timer = timer.map_err(|error| error.to_string())?;
        let clock = match clock {
            Clock::Device => "device",
            Clock::Host(_) => "host",
        };
        Ok(Self {
            taken: work.counts.map(|count| Taken::new(label, clock, count)),
            device: Some((stages, timer)),
            lost: false,
        })
    }

    /// Runs both stages once.
    fn time(
        &self,
        scene: &Scene,
        primitives: &Primitives,
        stream: &mut Vec<Fragment>,
    ) -> Result<[f64; 2], GpuError> {
        if let Some((stages, timer)) = &self.device {
            return stages.time(timer);
        }
        stream.clear();
        let ((), cover) = timed(|| raster::cover(primitives, |f| stream.push(f)));
        let nothing = Opaque::default();
        let (lists, build) = timed(|| build(scene, primitives, &nothing, false, u32::MAX));
        drop(lists);
        Ok([cover, build].map(|time| time.as_secs_f64()))
    }

    fn note(&mut self, seconds: [f64; 2]) {
        for (taken, seconds) in self.taken.iter_mut().zip(seconds) {
            taken.seconds.push(seconds);
        }
    }
}

/// The spec's rows, one for each adapter, and those of the adapters.
fn rows(scene: &str, legs: &[Leg<'_>]) -> Vec<Row> {
    let Some((own, others)) = legs.split_first() else {
        return Vec::new();
    };
    let mut rows = Vec::new();
    for (stage, what) in NAMES.into_iter().enumerate() {
        for other in others.iter().map(|leg| &leg.taken[stage]) {
            // A clock that stands still measures nothing.
            if other.seconds.iter().all(|seconds| *seconds > 0.0) {
                let most = other.leg.contains(RIVAL).then_some(1.0);
                rows.push(other.row(scene, what, None));
                rows.push(own.taken[stage].row(scene, what, Some((other, most))));
            }
        }
    }
    rows
}
