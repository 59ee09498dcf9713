//! The vertex stages without the host, set up once and timed: from vertices to what coverage reads.
//!
//! A replay has the host make fans of clipped triangles, and share walks over triangles out. Here the
//! device does, so that a frame can be timed from its vertices on; what comes of it is the same. Only
//! how many triangles there are after clipping is known beforehand, from a run of the stages.

use triptych_spec::raster::Samples;
use triptych_spec::scene::Scene;

use super::stages::{self, VERTICES};
use super::{CORNERS, Given, run};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Band, Frame, WORKGROUP};
use crate::kernel::Kernels;
use crate::lists::TILE;
use crate::ready::Ready;
use crate::timer::Timer;

/// The vertex stages of a scene, ready to run.
pub struct Timed<'g> {
    gpu: &'g Gpu,
    passes: Vec<Ready>,
    fanned: wgpu::Buffer,
    starts: wgpu::Buffer,
    prims: u32,
    bytes: u64,
}

/// Makes passes over some buffers.
struct Passes<'p> {
    gpu: &'p Gpu,
    kernels: &'p Kernels,
    frame: Frame,
    all: Vec<Ready>,
}

impl Passes<'_> {
    fn add(
        &mut self,
        at: (&str, &str),
        [first, items, groups]: [u32; 3],
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<(), GpuError> {
        let frame = Frame {
            work_first: first,
            items,
            ..self.frame
        };
        let uniform = self.gpu.uniform("frame", &frame)?;
        let mut named = vec![("frame", &uniform)];
        named.extend_from_slice(buffers);
        let ready = Ready::new(self.gpu, self.kernels, at, groups, &named)?;
        self.all.push(ready);
        Ok(())
    }

    /// Sums of so many counts before each.
    fn scan(
        &mut self,
        items: u32,
        [counts, before, sums]: [&wgpu::Buffer; 3],
    ) -> Result<(), GpuError> {
        let named = [("counts", counts), ("before", before), ("sums", sums)];
        let parts = items.div_ceil(TILE);
        for (entry, groups) in [
            ("fan_parts", parts),
            ("fan_sums", 1),
            ("fan_offsets", parts),
        ] {
            self.add(("fan_scan", entry), [0, items, groups], &named)?;
        }
        Ok(())
    }
}

impl<'g> Timed<'g> {
    /// Sets them up for a target with these samples, on a sub-pixel grid. With `walked`, walks
    /// over triangles are shared out as well, as kernels take them that rasterise by themselves.
    ///
    /// # Errors
    /// More triangles than fit at once, by name; WGSL errors; what the device refuses.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &Kernels,
        scene: &Scene,
        (bits, samples): (u32, Samples),
        walked: bool,
    ) -> Result<Self, GpuError> {
        let clipped = run(gpu, kernels, scene, bits, Given::Nothing, false)?.primitives;
        let most = u64::from(VERTICES);
        let all = [scene.triangles.len(), 2 * clipped.prims.len()];
        for needed in all.map(|count| count as u64) {
            if needed > most {
                return Err(GpuError::Limit {
                    adapter: gpu.name.clone(),
                    what: CORNERS,
                    needed,
                    limit: most,
                });
            }
        }
        let [triangles, slots] = all.map(|count| u32::try_from(count).expect("within the limit"));
        let prims = slots / 2;
        let buffers = buffers(gpu, scene, [triangles, slots])?;
        let named: Vec<(&str, &wgpu::Buffer)> = buffers.iter().map(|(n, b)| (*n, b)).collect();
        let of = |name: &str| {
            let found = named.iter().find(|(other, _)| *other == name);
            found.expect("it was made above").1
        };
        let band = Band::whole(scene.size);
        let mut passes = Passes {
            gpu,
            kernels,
            frame: Frame {
                work_count: prims,
                ..Frame::with_samples(scene.size, bits, samples, band)
            },
            all: Vec::new(),
        };
        let vertices = u32::try_from(scene.vertices.len()).expect("their numbers are words");
        for first in (0..vertices).step_by(VERTICES as usize) {
            let count = VERTICES.min(vertices - first);
            let groups = count.div_ceil(WORKGROUP);
            passes.add(("vertex", "transform"), [first, count, groups], &named)?;
        }
        let each = [0, triangles, triangles.div_ceil(WORKGROUP)];
        passes.add(("vertex", "clip"), each, &named)?;
        passes.add(("fans", "fan_count"), each, &named)?;
        passes.scan(triangles, [of("fans"), of("offsets"), of("sums")])?;
        passes.add(("fans", "fan_snap"), each, &named)?;
        if walked {
            passes.scan(slots, [of("walks"), of("starts"), of("sums")])?;
        }
        Ok(Self {
            gpu,
            passes: passes.all,
            fanned: of("fanned").clone(),
            starts: of("starts").clone(),
            prims,
            bytes: buffers.iter().map(|(_, buffer)| buffer.size()).sum(),
        })
    }

    /// Bytes of its buffers.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Seconds of a run, of the only span of a timer.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<f64, GpuError> {
        let count = self.passes.len();
        let spans = timer.time(self.gpu, 0..1, |span, encoder, queries| {
            for (at, pass) in self.passes.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(span, at, count));
                pass.record(encoder, writes);
            }
        })?;
        Ok(spans[0])
    }

    /// Corners of each triangle after clipping, and where its walks begin among those of all: first
    /// the transparent ones', then, counted on, the opaque ones'.
    ///
    /// # Errors
    /// Whatever the device reports.
    #[expect(
        clippy::type_complexity,
        reason = "three corners of three numbers each"
    )]
    pub fn made(&self) -> Result<(Vec<[[i32; 3]; 3]>, Vec<u32>), GpuError> {
        for pass in &self.passes {
            pass.run(self.gpu)?;
        }
        let prims = self.prims as usize;
        let fanned = self.gpu.read(&self.fanned, prims)?;
        Ok((fanned, self.gpu.read(&self.starts, 2 * prims)?))
    }
}

/// Buffers by the names of variables, for so many triangles, and twice as many as come of them.
fn buffers(
    gpu: &Gpu,
    scene: &Scene,
    [triangles, slots]: [u32; 2],
) -> Result<Vec<(&'static str, wgpu::Buffer)>, GpuError> {
    let words = |what, count: u32| gpu.storage(what, 4 * u64::from(count));
    let corners: Vec<[u32; 3]> = scene.triangles.iter().map(|t| t.vertices).collect();
    let colours: Vec<[f32; 4]> = scene.triangles.iter().map(|t| t.colour).collect();
    let [matrices, vertices] = stages::inputs(gpu, scene)?;
    Ok(vec![
        ("matrices", matrices),
        ("vertices", vertices),
        (
            "positions",
            gpu.storage("positions", 16 * scene.vertices.len() as u64)?,
        ),
        ("triangles", gpu.upload("triangles", &corners)?),
        ("colours", gpu.upload("colours", &colours)?),
        ("counts", words("counts", triangles)?),
        (
            "polygons",
            gpu.storage("polygons", stages::SLOTS * u64::from(triangles))?,
        ),
        ("fans", words("fans", triangles)?),
        ("offsets", words("offsets", triangles)?),
        ("fanned", gpu.storage("fanned", 36 * u64::from(slots / 2))?),
        (
            "painted",
            gpu.storage("painted", 16 * u64::from(slots / 2))?,
        ),
        ("walks", words("walks", slots)?),
        ("starts", words("starts", slots)?),
        ("sums", words("sums", triangles.max(slots).div_ceil(TILE))?),
    ])
}
