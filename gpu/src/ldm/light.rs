//! Stages that ask the lists: neighbours, occlusion, environment.

use std::ops::Range;
use std::time::Duration;

use triptych_spec::ldm::{FAR_MAX, Falloff, Hits, KEYS_PER_STEP, Receiver, Sky, WEIGHT_BITS};

use super::lists::Batch;
use super::stages::Stages;
use super::{Open, Told};
use crate::error::GpuError;

/// Maps that an invocation asks in a dispatch. Each costs one iteration and, with 2^28 keys in a
/// list, 2 x 29 more; llvmpipe leaves every loop after 65,535.
pub(super) const ASKED: u32 = 1024;

impl Stages<'_> {
    /// Stage `neighbours`: map by map, those of every receiver.
    pub fn neighbours(&mut self, receivers: &[Receiver]) -> Result<Vec<Hits>, GpuError> {
        let gpu = self.device.gpu;
        let own = self.upload(receivers)?;
        let items = count(receivers);
        let bytes = 12 * u64::from(items.max(1));
        gpu.check_binding("hits of receivers", bytes)?;
        let at_once = self.device.room.min(gpu.binding_limit()) / bytes;
        let at_once = u32::try_from(at_once.max(1)).unwrap_or(u32::MAX);
        let mut found = Vec::with_capacity(receivers.len() * self.device.all.maps.len());
        let mut time = Duration::ZERO;
        for batch in &self.batches {
            let maps = batch.span.maps.clone();
            for told in asking(batch, maps, self.device.told, items, at_once) {
                let hits = gpu.storage("hits of receivers", bytes * u64::from(told.maps))?;
                let named = [("receivers", &own), ("hits", &hits)];
                let named = [&named[..], &lists(batch)].concat();
                let groups = (told.maps * items).div_ceil(crate::frame::WORKGROUP);
                let pass = self.device.groups("neighbours", told, groups, &named)?;
                time += self.device.run(&[pass])?;
                let hits: Vec<super::Hits> = gpu.read(&hits, (told.maps * items) as usize)?;
                found.extend(hits.into_iter().map(Hits::from));
            }
        }
        self.time = time;
        Ok(found)
    }

    /// Stage `occlusion`, of all maps.
    ///
    /// # Panics
    /// If the falloff's distance is beyond its limits.
    pub fn occlusion(
        &mut self,
        receivers: &[Receiver],
        falloff: Falloff,
    ) -> Result<Vec<Open>, GpuError> {
        let nothing = vec![Open::default(); receivers.len()];
        self.occlusion_onto(&nothing, receivers, falloff)
    }

    /// The same, added to what was open `before` in the maps of other rotations.
    ///
    /// # Panics
    /// As [`Self::occlusion`].
    pub fn occlusion_onto(
        &mut self,
        before: &[Open],
        receivers: &[Receiver],
        falloff: Falloff,
    ) -> Result<Vec<Open>, GpuError> {
        let own = self.upload(receivers)?;
        let sums = self.device.gpu.upload("what is open", before)?;
        self.time = Duration::ZERO;
        let told = fading(self.device.told, falloff);
        self.ask(
            ("occlusion", |_| true),
            told,
            count(receivers),
            &[("receivers", &own), ("opened", &sums)],
        )?;
        self.device.gpu.read(&sums, receivers.len())
    }

    /// Stage `environment`, of all maps but those that are not lit; a sky for each, of radiance that
    /// an `f32` holds. The sum is divided by the number of `directions` of the set.
    pub fn environment(
        &mut self,
        receivers: &[Receiver],
        (skies, lit): (&[Sky], &[bool]),
        directions: u32,
    ) -> Result<Vec<[f32; 3]>, GpuError> {
        let nothing = vec![[0.0; 4]; receivers.len()];
        let sums = self.environment_onto(&nothing, receivers, (skies, lit))?;
        Ok(irradiance(&sums, directions))
    }

    /// The sum over these maps, added to that `before` of other rotations; the fourth number is not
    /// used. [`irradiance`] makes light of it.
    pub fn environment_onto(
        &mut self,
        before: &[[f32; 4]],
        receivers: &[Receiver],
        (skies, lit): (&[Sky], &[bool]),
    ) -> Result<Vec<[f32; 4]>, GpuError> {
        let gpu = self.device.gpu;
        let own = self.upload(receivers)?;
        let skies: Vec<[[f32; 4]; 2]> = skies.iter().map(padded).collect();
        let skies = gpu.upload("skies of maps", &skies)?;
        let light = gpu.upload("light", before)?;
        self.time = Duration::ZERO;
        let named = [("receivers", &own), ("skies", &skies), ("light", &light)];
        let is_lit = |map: u32| lit.get(map as usize).copied().unwrap_or(false);
        self.ask(
            ("environment", is_lit),
            self.device.told,
            count(receivers),
            &named,
        )?;
        gpu.read(&light, receivers.len())
    }

    pub(super) fn upload(&self, receivers: &[Receiver]) -> Result<wgpu::Buffer, GpuError> {
        let packed: Vec<_> = receivers.iter().map(super::Receiver::from).collect();
        self.device.gpu.upload("receivers", &packed)
    }

    /// One invocation for each receiver; of the maps that are asked, so many at a time.
    pub(super) fn ask(
        &mut self,
        (entry, asked): (&str, impl Fn(u32) -> bool),
        told: Told,
        items: u32,
        named: &[(&str, &wgpu::Buffer)],
    ) -> Result<(), GpuError> {
        for batch in &self.batches {
            let named = [named, &lists(batch)].concat();
            for maps in runs(batch.span.maps.clone(), &asked) {
                for told in asking(batch, maps, told, items, ASKED) {
                    let pass = self.device.each(entry, told, &named)?;
                    self.time += self.device.run(&[pass])?;
                }
            }
        }
        Ok(())
    }
}

/// Irradiance over pi, of sums over maps in so many directions, of all rotations. Kernels sum up;
/// what is common to all terms comes last, in `f32` like the rest.
pub fn irradiance(sums: &[[f32; 4]], directions: u32) -> Vec<[f32; 3]> {
    let scale = 2.0 / directions as f32 / (1_u32 << WEIGHT_BITS) as f32;
    let scaled = |[r, g, b, _]: &[f32; 4]| [r * scale, g * scale, b * scale];
    sums.iter().map(scaled).collect()
}

/// The longest runs of numbers for all of which something holds.
pub(super) fn runs(numbers: Range<u32>, holds: impl Fn(u32) -> bool) -> Vec<Range<u32>> {
    let mut runs: Vec<Range<u32>> = Vec::new();
    for number in numbers.filter(|number| holds(*number)) {
        match runs.last_mut() {
            Some(last) if last.end == number => last.end += 1,
            _ => runs.push(number..number + 1),
        }
    }
    runs
}

/// A batch's lists by the names that kernels have for them.
pub(super) fn lists(batch: &Batch) -> [(&'static str, &wgpu::Buffer); 2] {
    [("offsets", &batch.offsets), ("listed", &batch.keys)]
}

/// Dispatches over maps of a batch, so many at a time.
pub(super) fn asking(
    batch: &Batch,
    maps: Range<u32>,
    told: Told,
    items: u32,
    at_once: u32,
) -> impl Iterator<Item = Told> {
    let told = batch.span.told(told);
    let firsts = maps.clone().step_by(at_once as usize);
    firsts.map(move |first_map| Told {
        first_map,
        maps: at_once.min(maps.end - first_map),
        items,
        ..told
    })
}

/// What a distance does, in keys.
///
/// # Panics
/// If it is 0 or beyond [`FAR_MAX`].
pub(super) fn fading(told: Told, falloff: Falloff) -> Told {
    let (most, power) = match falloff {
        Falloff::None => (0, 0),
        Falloff::Distance { most, power } => {
            assert!((1..=FAR_MAX).contains(&most), "{most} steps of a falloff");
            (most * KEYS_PER_STEP.unsigned_abs(), power)
        }
    };
    Told {
        most,
        power,
        ..told
    }
}

pub(super) fn count(receivers: &[Receiver]) -> u32 {
    u32::try_from(receivers.len()).expect("fewer than 2^32")
}

pub(super) fn padded(sky: &Sky) -> [[f32; 4]; 2] {
    sky.map(|[r, g, b]| [r, g, b, 0.0])
}
