//! What all stages share, and dispatches.

use std::time::Duration;

use triptych_spec::grid::Blockers;
use triptych_spec::ldm::Maps;

use super::batch::Span;
use super::{LARGE_AT_ONCE, MAPS_AT_ONCE, Packed, Told};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::WORKGROUP;
use crate::kernel::Kernels;
use crate::lists::TILE;
use crate::ready::{GROUPS_MAX, Ready};

pub(super) type Buffers<'b> = [(&'b str, &'b wgpu::Buffer)];

/// Maps and triangles on the device.
pub(super) struct Device<'g> {
    pub(super) gpu: &'g Gpu,
    kernels: &'g Kernels,
    pub(super) all: &'g Maps,
    /// What kernels are told, but for what a dispatch adds.
    pub(super) told: Told,
    maps: wgpu::Buffer,
    corners: wgpu::Buffer,
    pub(super) unfinished: wgpu::Buffer,
    larges: wgpu::Buffer,
    /// Bytes of a buffer of lists, at most.
    pub(super) room: u64,
}

impl<'g> Device<'g> {
    /// Uploads maps and triangles. No buffer of lists takes more than `budget` bytes.
    pub(super) fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        all: &'g Maps,
        blockers: &Blockers,
        budget: u64,
    ) -> Result<Self, GpuError> {
        let count = blockers.triangles.len();
        let triangles = u32::try_from(count).map_err(|_| GpuError::Limit {
            adapter: gpu.name.clone(),
            what: "triangles",
            needed: count as u64,
            limit: u32::MAX.into(),
        })?;
        let corners = (0..triangles).flat_map(|prim| blockers.corners(prim));
        let corners: Vec<[i32; 4]> = corners.map(|[x, y, z]| [x, y, z, 0]).collect();
        let drawn = blockers.triangles.iter().flatten();
        let drawn = drawn.map(|row| blockers.vertices[*row as usize]);
        let low = drawn.reduce(|a, b| [0, 1, 2].map(|i| a[i].min(b[i])));
        let low = low.unwrap_or_default();
        let packed = |map| Packed::new(map, all.shifts[0], low);
        let maps: Vec<Packed> = all.maps.iter().map(packed).collect();
        let mut device = Self {
            told: Told {
                bits: all.bits,
                shift: all.shifts[0],
                half: all.half,
                half_shift: all.half_shift,
                triangles,
                low_x: low[0],
                low_y: low[1],
                low_z: low[2],
                small: small(all.pixel),
                ..Told::default()
            },
            maps: gpu.upload("maps", &maps)?,
            corners: gpu.upload("corners of triangles", &corners)?,
            unfinished: gpu.storage("unfinished", 4)?,
            room: gpu.binding_limit().min(budget),
            gpu,
            kernels,
            all,
            larges: gpu.storage("large triangles", 4 * u64::from(triangles))?,
        };
        device.sizes()?.run(gpu)?;
        device.told.larges = gpu.take(&device.unfinished)?;
        Ok(device)
    }

    /// The pass that tells large triangles from small ones.
    pub(super) fn sizes(&self) -> Result<Ready, GpuError> {
        let told = Told {
            items: self.told.triangles,
            ..self.told
        };
        let pass = self.each("layers_larges", told, &[])?;
        Ok(pass.after_clearing(self.unfinished.clone()))
    }

    /// Bytes of maps and triangles.
    pub(super) fn bytes(&self) -> u64 {
        self.maps.size() + self.corners.size() + self.larges.size()
    }

    /// So many workgroups, to be recorded.
    pub(super) fn groups(
        &self,
        entry: &str,
        told: Told,
        groups: u32,
        buffers: &Buffers<'_>,
    ) -> Result<Ready, GpuError> {
        let uniform = self.gpu.uniform("told", &told)?;
        let mut all = vec![
            ("told", &uniform),
            ("maps", &self.maps),
            ("corners", &self.corners),
            ("unfinished", &self.unfinished),
            ("larges", &self.larges),
        ];
        all.extend_from_slice(buffers);
        Ready::new(self.gpu, self.kernels, ("ldm", entry), groups, &all)
    }

    /// One invocation for each item, to be recorded.
    pub(super) fn each(
        &self,
        entry: &str,
        told: Told,
        buffers: &Buffers<'_>,
    ) -> Result<Ready, GpuError> {
        self.groups(entry, told, told.items.div_ceil(WORKGROUP), buffers)
    }

    /// Passes that draw all triangles into all maps of a batch: the kernel for small ones, and the
    /// one for large ones.
    ///
    /// # Errors
    /// More workgroups than a dispatch has, and what the device refuses.
    pub(super) fn draw(
        &self,
        [small, large]: [&str; 2],
        (span, capacity): (&Span, u32),
        buffers: &Buffers<'_>,
    ) -> Result<Vec<Ready>, GpuError> {
        let told = Told {
            capacity,
            ..self.told
        };
        let (all, parts) = span.drawn(told);
        let jobs = [
            (
                told.triangles.div_ceil(WORKGROUP),
                span.count().div_ceil(MAPS_AT_ONCE),
            ),
            (told.larges.div_ceil(LARGE_AT_ONCE), span.count()),
        ];
        let [of_small, of_large] = jobs.map(|(chunks, maps)| self.product(chunks, maps));
        let mut passes = vec![self.groups(small, all, of_small?, buffers)?];
        let of_large = of_large?;
        if of_large > 0 {
            let large = parts.map(|told| self.groups(large, told, of_large, buffers));
            passes.extend(large.collect::<Result<Vec<_>, _>>()?);
        }
        Ok(passes)
    }

    fn product(&self, chunks: u32, maps: u32) -> Result<u32, GpuError> {
        let groups = u64::from(chunks) * u64::from(maps);
        let fitting = u32::try_from(groups)
            .ok()
            .filter(|groups| *groups <= GROUPS_MAX);
        fitting.ok_or_else(|| GpuError::Limit {
            adapter: self.gpu.name.clone(),
            what: "workgroups that draw triangles into maps",
            needed: groups,
            limit: GROUPS_MAX.into(),
        })
    }

    /// Passes that put the end of each run in place of its count.
    pub(super) fn scan(&self, span: &Span, buffers: &Buffers<'_>) -> Result<Vec<Ready>, GpuError> {
        let (told, tiles) = (span.told(self.told), span.len().div_ceil(TILE));
        let passes = [
            ("layers_tiles", tiles),
            ("layers_sums", 1),
            ("layers_ends", tiles),
        ];
        let pass = |(entry, groups)| self.groups(entry, told, groups, buffers);
        passes.into_iter().map(pass).collect()
    }

    /// Runs passes one after another, and waits for the end of each.
    pub(super) fn run(&self, passes: &[Ready]) -> Result<Duration, GpuError> {
        passes.iter().map(|pass| pass.run(self.gpu)).sum()
    }
}

/// Triangles with a box up to so many steps long are drawn by one invocation.
fn small(pixel: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "below 2^26")]
    let steps = (SMALL * pixel) as i32;
    steps
}

/// Pixels of a small triangle's box along an axis of the lattice, at most; in a map it is at most
/// sqrt(3) times as long, and one more.
const SMALL: f64 = 12.0;
