//! One attempt at one band: buffers, passes, results.

use std::time::Duration;

use triptych_spec::abuffer::{EOL, Lists, NOTHING, Node};

use super::{Given, Options, Times};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::raster::{Rasterizer, per_pixel};

/// Steps along a list within one dispatch. Twin: `STEPS` in `abuffer.wgsl`.
pub const STEPS: u64 = 16_384;

/// Bytes of a pixel's progress. Twin: `Progress` in `abuffer.wgsl`.
pub const PROGRESS: u64 = 32;

/// Bytes before the pixels' progress. Twin: `Work` in `abuffer.wgsl`.
pub(super) const HEADER: u64 = 4;

/// Buffers of a band.
pub(super) struct Buffers {
    counter: wgpu::Buffer,
    pub(super) opaque_key: wgpu::Buffer,
    pub(super) opaque_prim: wgpu::Buffer,
    heads: wgpu::Buffer,
    nodes: wgpu::Buffer,
    colours: wgpu::Buffer,
    picture: wgpu::Buffer,
}

/// One attempt at one band.
pub(super) struct Run<'r, 'g> {
    pub(super) rasterizer: &'r Rasterizer<'g>,
    pub(super) options: Options<'r>,
    pub(super) band: Band,
    pub(super) capacity: u32,
    pub(super) times: Times,
}

impl Run<'_, '_> {
    fn gpu(&self) -> &Gpu {
        self.rasterizer.gpu
    }

    pub(super) fn buffers(&self) -> Result<Buffers, GpuError> {
        let gpu = self.gpu();
        let pixels = self.band.pixels(self.rasterizer.size);
        let picture = gpu.storage("picture", 16 * u64::from(pixels))?;
        if let Some(given) = self.options.given {
            return self.buffers_from(given, picture);
        }
        let capacity = if self.options.lists {
            u64::from(self.capacity)
        } else {
            0
        };
        Ok(Buffers {
            counter: gpu.filled("counter", 1, 0)?,
            opaque_key: gpu.filled("opaque_key", pixels, NOTHING)?,
            opaque_prim: gpu.filled("opaque_prim", pixels, NOTHING)?,
            heads: gpu.filled("heads", pixels, EOL)?,
            nodes: gpu.storage("nodes", 16 * capacity)?,
            colours: gpu.storage("colours", 16 * capacity)?,
            picture,
        })
    }

    fn buffers_from(&self, given: Given<'_>, picture: wgpu::Buffer) -> Result<Buffers, GpuError> {
        let gpu = self.gpu();
        let width = self.rasterizer.size.width;
        let first = (self.band.first * width) as usize;
        let pixels = first..first + self.band.pixels(self.rasterizer.size) as usize;
        let lists = given.lists;
        let nodes: Vec<[u32; 4]> = lists
            .nodes
            .iter()
            .map(|n| [n.key, n.next, n.prim, n.mask])
            .collect();
        Ok(Buffers {
            counter: gpu.filled("counter", 1, lists.attempts)?,
            opaque_key: gpu.upload("opaque_key", &given.opaque.key[pixels.clone()])?,
            opaque_prim: gpu.upload("opaque_prim", &given.opaque.prim[pixels.clone()])?,
            heads: gpu.upload("heads", &lists.heads[pixels])?,
            nodes: gpu.upload("nodes", &nodes)?,
            colours: gpu.upload("colours", &lists.colours)?,
            picture,
        })
    }

    fn frame(&self) -> Frame {
        let [r, g, b] = self.options.background;
        Frame {
            capacity: self.capacity,
            depth_test: u32::from(self.options.depth_test),
            background: [r, g, b, 1.0],
            ..self.rasterizer.frame(self.band)
        }
    }

    fn opaque(&mut self, b: &Buffers, is_opaque: &impl Fn(u32) -> bool) -> Result<(), GpuError> {
        let work = self.rasterizer.work(self.band, is_opaque)?;
        for stage in ["opaque_nearest", "opaque_first"] {
            let buffers = b.named();
            self.times.opaque +=
                self.rasterizer
                    .draw("abuffer", stage, self.frame(), &work, &buffers)?;
        }
        Ok(())
    }

    fn build(&mut self, b: &Buffers, is_opaque: &impl Fn(u32) -> bool) -> Result<(), GpuError> {
        let work = self.rasterizer.work(self.band, |prim| !is_opaque(prim))?;
        let buffers = b.named();
        self.times.build =
            self.rasterizer
                .draw("abuffer", "build", self.frame(), &work, &buffers)?;
        Ok(())
    }

    /// Runs the passes that fill the buffers, unless they hold another leg's results.
    pub(super) fn fill(
        &mut self,
        b: &Buffers,
        is_opaque: &impl Fn(u32) -> bool,
    ) -> Result<(), GpuError> {
        if self.options.given.is_some() {
            return Ok(());
        }
        if self.options.opaque {
            self.opaque(b, is_opaque)?;
        }
        if self.options.lists {
            self.build(b, is_opaque)?;
        }
        Ok(())
    }

    /// Sorts and resolves lists of at most `longest` nodes; gives the sorted lists and
    /// appends to the picture.
    pub(super) fn finish(
        &mut self,
        b: &Buffers,
        longest: u32,
        image: &mut Vec<[f32; 3]>,
    ) -> Result<Lists, GpuError> {
        if self.options.lists && !self.options.given.is_some_and(|g| g.sorted) {
            self.times.sort = self.until_done("sort", longest, b)?;
        }
        self.times.resolve = self.until_done("resolve", longest, b)?;
        let pixels = self.band.pixels(self.rasterizer.size) as usize;
        let picture = self.gpu().read::<[f32; 4]>(&b.picture, pixels)?;
        image.extend(picture.into_iter().map(|[r, g, b, _]| [r, g, b]));
        self.lists(b)
    }

    /// Dispatches a stage until no pixel asks for more. Merging a list of n nodes
    /// takes at most 4 n steps in each of at most log2(n) + 1 passes; what needs
    /// more follows a list that does not end.
    fn until_done(
        &self,
        stage: &'static str,
        longest: u32,
        b: &Buffers,
    ) -> Result<Duration, GpuError> {
        let gpu = self.gpu();
        let pixels = u64::from(self.band.pixels(self.rasterizer.size));
        let progress = gpu.storage("progress", HEADER + PROGRESS * pixels)?;
        let mut buffers = b.named().to_vec();
        buffers.push(("progress", &progress));
        let mut time = Duration::ZERO;
        let passes = u64::from(longest.max(1).ilog2()) + 1;
        for _ in 0..=4 * u64::from(longest) * passes / STEPS {
            gpu.queue.write_buffer(&progress, 0, &[0; 4]);
            time += per_pixel(self.rasterizer, "abuffer", stage, self.frame(), &buffers)?;
            if gpu.read::<u32>(&progress, 1)?[0] == 0 {
                return Ok(time);
            }
        }
        Err(GpuError::Endless {
            adapter: gpu.name.clone(),
            stage,
        })
    }

    pub(super) fn lists(&self, b: &Buffers) -> Result<Lists, GpuError> {
        let gpu = self.gpu();
        let attempts = gpu.read::<u32>(&b.counter, 1)?[0];
        let stored = attempts.min(self.capacity) as usize;
        let node = |[key, next, prim, mask]: [u32; 4]| Node {
            key,
            next,
            prim,
            mask,
        };
        Ok(Lists {
            heads: self.read(&b.heads)?,
            nodes: gpu
                .read::<[u32; 4]>(&b.nodes, stored)?
                .into_iter()
                .map(node)
                .collect(),
            colours: gpu.read(&b.colours, stored)?,
            attempts,
            capacity: self.capacity,
        })
    }

    /// One word per pixel of the band.
    pub(super) fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u32>, GpuError> {
        self.gpu()
            .read(buffer, self.band.pixels(self.rasterizer.size) as usize)
    }
}

impl Buffers {
    fn named(&self) -> [(&'static str, &wgpu::Buffer); 7] {
        [
            ("counter", &self.counter),
            ("opaque_key", &self.opaque_key),
            ("opaque_prim", &self.opaque_prim),
            ("heads", &self.heads),
            ("nodes", &self.nodes),
            ("colours", &self.colours),
            ("picture", &self.picture),
        ]
    }
}
