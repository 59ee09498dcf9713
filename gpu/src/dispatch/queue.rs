//! Queues of rays on the device.

use triptych_spec::dispatch::{Met, Ray};

use super::Overflow;
use super::records::{Carried, hit, packed, unpacked};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::grid::{Counted, Hit, Packed, TRACED, fresh};
use crate::raster::SATURATED;

/// Bytes of a ray in a queue's buffers together: where it goes, what it carries, what it met.
pub(super) const BYTES: u64 = 64;

/// Rays, in any order, and how many there are.
pub(super) struct Queue {
    pub(super) capacity: u32,
    rays: wgpu::Buffer,
    carried: wgpu::Buffer,
    hits: wgpu::Buffer,
    /// Attempts to store one.
    pub(super) counter: wgpu::Buffer,
    /// Workgroups of a dispatch of all, and how many they are.
    pub(super) arguments: wgpu::Buffer,
}

impl Queue {
    /// Room for so many rays, none of which is there.
    pub(super) fn new(gpu: &Gpu, capacity: u32) -> Result<Self, GpuError> {
        // No binding may be shorter than a ray.
        let room = |what, bytes: u64| gpu.storage(what, bytes * u64::from(capacity.max(1)));
        Ok(Self {
            capacity,
            rays: room("rays", size_of::<Packed>() as u64)?,
            carried: room("what rays carry", size_of::<Carried>() as u64)?,
            hits: room("hits", size_of::<Hit>() as u64)?,
            counter: gpu.storage("number of rays", 4)?,
            arguments: gpu.arguments("workgroups of rays")?,
        })
    }

    /// Room for so many rays, all of which a pass will put there.
    pub(super) fn first(gpu: &Gpu, count: u32) -> Result<Self, GpuError> {
        Ok(Self {
            counter: gpu.upload("number of rays", &[count])?,
            ..Self::new(gpu, count)?
        })
    }

    /// These rays, of which a search has seen nothing yet, or found all there is.
    pub(super) fn of(gpu: &Gpu, rays: &[Ray], met: Option<&[Met]>) -> Result<Self, GpuError> {
        let (ways, carried): (Vec<Packed>, Vec<Carried>) = rays.iter().map(packed).unzip();
        let hits: Vec<Hit> = match met {
            Some(met) => met.iter().copied().map(hit).collect(),
            None => vec![fresh(); rays.len()],
        };
        let capacity = u32::try_from(rays.len()).expect("a batch");
        Ok(Self {
            capacity,
            rays: gpu.upload("rays", &ways)?,
            carried: gpu.upload("what rays carry", &carried)?,
            hits: gpu.upload("hits", &hits)?,
            counter: gpu.upload("number of rays", &[capacity])?,
            arguments: gpu.arguments("workgroups of rays")?,
        })
    }

    /// As kernels go through it.
    pub(super) fn current(&self) -> [(&str, &wgpu::Buffer); 3] {
        [
            ("rays", &self.rays),
            ("carried", &self.carried),
            ("hits", &self.hits),
        ]
    }

    /// As kernels fill it.
    pub(super) fn next(&self) -> [(&str, &wgpu::Buffer); 4] {
        [
            ("next_rays", &self.rays),
            ("next_carried", &self.carried),
            ("next_hits", &self.hits),
            ("counter", &self.counter),
        ]
    }

    /// As a search goes through it.
    pub(super) fn counted(&self) -> Counted<'_> {
        Counted {
            rays: &self.rays,
            hits: &self.hits,
            arguments: &self.arguments,
        }
    }

    /// Rays that passes go through, as `intersect_queue` has it.
    pub(super) fn items(&self, gpu: &Gpu) -> Result<u32, GpuError> {
        gpu.word(&self.arguments, 3)
    }

    /// The first `count` rays.
    pub(super) fn read(&self, gpu: &Gpu, count: u32) -> Result<Vec<Ray>, GpuError> {
        let ways: Vec<Packed> = gpu.read(&self.rays, count as usize)?;
        let carried: Vec<Carried> = gpu.read(&self.carried, count as usize)?;
        let both = ways.iter().zip(&carried);
        Ok(both.map(|(way, carried)| unpacked(way, carried)).collect())
    }

    /// What the first `count` rays met, all of which have been searched.
    pub(super) fn prims(&self, gpu: &Gpu, count: u32) -> Result<Vec<u32>, GpuError> {
        let hits: Vec<Hit> = gpu.read(&self.hits, count as usize)?;
        match hits.iter().all(|hit| hit.state == TRACED) {
            true => Ok(hits.iter().map(|hit| hit.prim).collect()),
            false => Err(GpuError::Endless {
                adapter: gpu.name.clone(),
                stage: "intersect",
            }),
        }
    }

    /// What there was too little room for, if there was.
    ///
    /// # Errors
    /// More attempts than a counter counts.
    pub(super) fn overflow(&self, gpu: &Gpu) -> Result<Option<Overflow>, GpuError> {
        let attempts = gpu.word(&self.counter, 0)?;
        if attempts <= self.capacity {
            return Ok(None);
        }
        if attempts >= SATURATED {
            return Err(GpuError::Limit {
                adapter: gpu.name.clone(),
                what: "rays",
                needed: attempts.into(),
                limit: SATURATED.into(),
            });
        }
        Ok(Some(Overflow {
            capacity: self.capacity,
            attempts,
            rays: self.read(gpu, self.capacity)?,
            asked: 0..0,
        }))
    }
}
