//! What the host does for each stage.

use std::time::Duration;

use triptych_spec::grid::Membership;
use triptych_spec::grid::trace::Query;
use triptych_spec::rsm::{self as spec, Setting};

use super::Parameters;
use super::device::Device;
use super::records::{Light, Place};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::grid;
use crate::kernel::Kernels;

/// What pixels see, if anything.
pub type Surfaces = Vec<Option<spec::Surface>>;

/// Linear.
pub type Colours = Vec<[f32; 3]>;

/// Most pairs of a pixel and a texel of one dispatch: a ray and a hit each, 48 bytes.
const PAIRS: u64 = 1 << 21;

/// Buffer B, as a device made it.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocked {
    /// [`spec::Parameters::words`] a pixel: a bit for each texel that is blocked.
    pub bits: Vec<u32>,
    /// How many rays were asked for.
    pub rays: u64,
    /// Linear irradiance.
    pub light: Colours,
}

/// Stages of a frame; colours are linear, and 0 where nothing is seen, but for the picture's
/// background. What is read back is what the device says: triangles may be none of the model.
pub struct Stages<'g> {
    device: Device<'g>,
    /// The blockers' cells; `None` without blockers.
    grid: Option<grid::Stages<'g>>,
    /// Time on the device of what ran last, without transfers.
    pub time: Duration,
}

impl<'g> Stages<'g> {
    /// Uploads model, views and the blockers' cells.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports; so for all stages.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        setting: &Setting<'_>,
    ) -> Result<Self, GpuError> {
        Ok(Self {
            device: Device::new(gpu, kernels, setting)?,
            grid: cells(gpu, kernels, setting)?,
            time: Duration::ZERO,
        })
    }

    /// The blockers' cells, built by the device: where each list starts, and what the lists hold
    /// if the host finds the former `sound`. Stage `block` goes on from them. Empty without
    /// blockers.
    pub fn cells(&mut self, sound: impl FnOnce(&[u32]) -> bool) -> Result<[Vec<u32>; 2], GpuError> {
        let Some(grid) = &mut self.grid else {
            return Ok([Vec::new(), Vec::new()]);
        };
        grid.count()?;
        let offsets = grid.scan()?;
        let entries = offsets.last().copied().unwrap_or(0);
        let prims = match sound(&offsets) {
            true => grid.fill(entries, entries)?,
            false => Vec::new(),
        };
        Ok([offsets, prims])
    }

    /// Stage `gbuffer`: what each pixel sees of a triangle of the model, or of
    /// [`triptych_spec::abuffer::NOTHING`].
    pub fn gbuffer(&mut self, triangles: &[u32]) -> Result<Surfaces, GpuError> {
        let device = &self.device;
        let told = device.of(device.eye_size());
        let seen;
        (seen, self.time) = device.faces.seen(told, &device.eye, triangles)?;
        Ok(seen)
    }

    /// Stage `rsm`: what each texel of the light's map sees of a triangle, and its intensity.
    pub fn rsm(&mut self, triangles: &[u32]) -> Result<(Surfaces, Colours), GpuError> {
        let device = &self.device;
        let size = device.map_size();
        let lights = device.room::<Light>("lights", size)?;
        let intensities = device.room::<[f32; 4]>("intensities", size)?;
        let buffers = [
            ("nearest", &device.gpu.upload("triangles", triangles)?),
            ("sources", &device.faces.sources()?),
            ("weights", &device.weights),
            ("lights", &lights),
            ("intensities", &intensities),
        ];
        self.time = device.each("rsm", size, &device.lamp, &buffers)?;
        let lights: Vec<Light> = device.gpu.read(&lights, size.pixels())?;
        let lights = lights.into_iter().map(Light::unpacked).collect();
        Ok((lights, device.colours(&intensities, size)?))
    }

    /// Stage `place`: where each point lies in the light's map.
    pub fn place(
        &mut self,
        seen: &[Option<spec::Surface>],
    ) -> Result<Vec<Option<spec::Place>>, GpuError> {
        let device = &self.device;
        let size = device.eye_size();
        let places = device.room::<Place>("places", size)?;
        let buffers = [("seen", &device.upload_seen(seen)?), ("places", &places)];
        self.time = device.each("place", size, &device.lamp, &buffers)?;
        let places: Vec<Place> = device.gpu.read(&places, size.pixels())?;
        Ok(places.into_iter().map(Place::unpacked).collect())
    }

    /// Stage `direct`: which pixels the light reaches, and their irradiance; `keys` are the
    /// map's depths.
    pub fn direct(
        &mut self,
        seen: &[Option<spec::Surface>],
        places: &[Option<spec::Place>],
        keys: &[u32],
    ) -> Result<(Vec<bool>, Colours), GpuError> {
        let device = &self.device;
        let size = device.eye_size();
        let lit = device.room::<[f32; 4]>("direct light", size)?;
        let buffers = [
            ("seen", &device.upload_seen(seen)?),
            ("places", &device.upload_places(places)?),
            ("keys", &device.gpu.upload("keys", keys)?),
            ("lit", &lit),
        ];
        self.time = device.each("direct", size, &device.lamp, &buffers)?;
        let lit: Vec<[f32; 4]> = device.gpu.read(&lit, size.pixels())?;
        let split = |[r, g, b, reached]: [f32; 4]| (reached != 0.0, [r, g, b]);
        Ok(lit.into_iter().map(split).unzip())
    }

    /// Stage `gather`: buffer A.
    pub fn gather(
        &mut self,
        seen: &[Option<spec::Surface>],
        places: &[Option<spec::Place>],
        lights: &[Option<spec::Light>],
    ) -> Result<Colours, GpuError> {
        let device = &self.device;
        let size = device.eye_size();
        let all = device.room::<[f32; 4]>("buffer A", size)?;
        let [lights, intensities] = device.upload_lights(lights)?;
        let buffers = [
            ("seen", &device.upload_seen(seen)?),
            ("places", &device.upload_places(places)?),
            ("lights", &lights),
            ("intensities", &intensities),
            ("all_light", &all),
        ];
        self.time = device.rows("gather", size, &device.eye, &buffers)?;
        device.colours(&all, size)
    }

    /// Stage `block`: buffer B. Without blockers nothing is asked.
    pub fn block(
        &mut self,
        seen: &[Option<spec::Surface>],
        places: &[Option<spec::Place>],
        lights: &[Option<spec::Light>],
    ) -> Result<Blocked, GpuError> {
        let Self { device, grid, time } = self;
        let gpu = device.gpu;
        let size = device.coarse_size();
        let words = size.pixels() * device.given.words();
        *time = Duration::ZERO;
        let Some(grid) = grid else {
            return Ok(Blocked {
                bits: vec![0; words],
                rays: 0,
                light: vec![[0.0; 3]; size.pixels()],
            });
        };
        let kernel = u64::from(device.given.side()).pow(2);
        let pairs = size.pixels() as u64 * kernel;
        let batch = pairs.min(PAIRS);
        let [lights, intensities] = device.upload_lights(lights)?;
        let bits = gpu.storage("bits of buffer B", 4 * words as u64)?;
        let blocked = device.room::<[f32; 4]>("buffer B", size)?;
        let asked = gpu.storage("number of rays", 4)?;
        let rays = gpu.storage("rays", 32 * batch)?;
        let hits = gpu.storage("hits", size_of::<grid::Hit>() as u64 * batch)?;
        let buffers = [
            ("seen", &device.upload_seen(seen)?),
            ("places", &device.upload_places(places)?),
            ("lights", &lights),
            ("intensities", &intensities),
            ("bits", &bits),
            ("blocked", &blocked),
            ("asked", &asked),
            ("rays", &rays),
            ("hits", &hits),
        ];
        *time += grid.mark_bricks()?;
        let mut total = 0;
        for first in (0..pairs).step_by(usize::try_from(batch).unwrap_or(1)) {
            let told = Parameters {
                items: word(batch.min(pairs - first)),
                first: word(first),
                ..device.told
            };
            *time += device.run("block_rays", told, &device.eye, &buffers)?;
            let items = gpu.take(&asked)?;
            *time += grid.search(&rays, &hits, items, Query::Any)?;
            let told = Parameters { items, ..told };
            *time += device.run("block_bits", told, &device.eye, &buffers)?;
            total += u64::from(items);
        }
        *time += device.rows("block_sum", size, &device.eye, &buffers)?;
        Ok(Blocked {
            bits: gpu.read(&bits, words)?,
            rays: total,
            light: device.colours(&blocked, size)?,
        })
    }

    /// Stage `blur`: buffer B, averaged; `seen` is what the eye sees.
    pub fn blur(
        &mut self,
        seen: &[Option<spec::Surface>],
        light: &[[f32; 3]],
    ) -> Result<Colours, GpuError> {
        let device = &self.device;
        let size = device.coarse_size();
        let blurred = device.room::<[f32; 4]>("buffer B, averaged", size)?;
        let buffers = [
            ("seen", &device.upload_seen(seen)?),
            ("blocked", &device.upload_colours(light)?),
            ("blurred", &blurred),
        ];
        self.time = device.each("blur", size, &device.eye, &buffers)?;
        device.colours(&blurred, size)
    }

    /// Stage `compose`: the picture.
    pub fn compose(
        &mut self,
        seen: &[Option<spec::Surface>],
        [direct, all]: [&[[f32; 3]]; 2],
        blurred: &[[f32; 3]],
    ) -> Result<Colours, GpuError> {
        let device = &self.device;
        let size = device.eye_size();
        let picture = device.room::<[f32; 4]>("picture", size)?;
        let buffers = [
            ("seen", &device.upload_seen(seen)?),
            ("lit", &device.upload_colours(direct)?),
            ("all_light", &device.upload_colours(all)?),
            ("blurred", &device.upload_colours(blurred)?),
            ("picture", &picture),
        ];
        self.time = device.each("compose", size, &device.eye, &buffers)?;
        device.colours(&picture, size)
    }
}

/// At most [`spec::BITS_MAX`] pairs are allowed.
fn word(pairs: u64) -> u32 {
    u32::try_from(pairs).expect("fewer than 2^32")
}

/// The blockers' cells on the device.
fn cells<'g>(
    gpu: &'g Gpu,
    kernels: &'g Kernels,
    setting: &Setting<'_>,
) -> Result<Option<grid::Stages<'g>>, GpuError> {
    let Setting { blockers, grid, .. } = setting;
    if blockers.triangles.is_empty() {
        return Ok(None);
    }
    let device = grid::Device::new(gpu, kernels, blockers, &grid.axes, Membership::Box)?;
    let mut stages = grid::Stages::new(device)?;
    stages.give_offsets(&grid.offsets)?;
    stages.give_prims(&grid.prims)?;
    Ok(Some(stages))
}
