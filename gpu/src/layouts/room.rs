//! Buffers of a band in some layout, and the passes over them.

use std::time::{Duration, Instant};

use triptych_spec::abuffer::Lists;

use super::{Layout, Listing, Options};
use crate::abuffer::rivals::image;
use crate::error::GpuError;
use crate::frame::{Band, Frame, WORKGROUP};
use crate::named::Named;
use crate::raster::{self, Rasterizer, Work};
use crate::ready;
use crate::timer::Writes;

/// Pixels that a band may have: those of a dispatch of one row, and what can be bound of them.
pub(super) fn pixels_max(rasterizer: &Rasterizer<'_>) -> u64 {
    let samples = u64::from(rasterizer.samples.count());
    let largest = crate::abuffer::PROGRESS.max(16 * samples);
    let bindable = rasterizer.gpu.binding_limit().saturating_sub(4) / largest;
    bindable.min(65_535 * u64::from(WORKGROUP))
}

/// A pass.
pub(super) enum Step {
    /// Over triangles.
    Drawn(raster::Ready),
    /// Over anything else.
    Other(ready::Ready),
}

impl Step {
    pub(super) fn record(
        &self,
        rasterizer: &Rasterizer<'_>,
        encoder: &mut wgpu::CommandEncoder,
        writes: Option<Writes<'_>>,
    ) {
        match self {
            Self::Drawn(pass) => rasterizer.record_pass(pass, encoder, writes),
            Self::Other(pass) => pass.record(encoder, writes),
        }
    }
}

/// A band on the device.
pub(super) struct Room<'r, 'g> {
    pub(super) rasterizer: &'r Rasterizer<'g>,
    pub(super) layout: Layout,
    pub(super) frame: Frame,
    pub(super) band: Band,
    /// What kernels are told, unless a pass has something of its own to say.
    pub(super) listing: Listing,
    /// The transparent triangles.
    work: Work,
    /// All buffers by the names of variables.
    pub(super) buffers: Named,
}

impl<'r, 'g> Room<'r, 'g> {
    /// Surfaces and picture; what a layout needs beside is set afterwards.
    pub(super) fn new(
        rasterizer: &'r Rasterizer<'g>,
        layout: Layout,
        options: Options<'_>,
        (band, capacity): (Band, u32),
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<Self, GpuError> {
        let gpu = rasterizer.gpu;
        let [r, g, b] = options.background;
        let frame = Frame {
            capacity,
            depth_test: options.depth_test.into(),
            background: [r, g, b, 1.0],
            ..rasterizer.frame(band)
        };
        let each = rasterizer.samples.count() as usize;
        let first = (band.first * rasterizer.size.width) as usize * each;
        let places = first..first + band.pixels(rasterizer.size) as usize * each;
        let opaque = options.opaque;
        let buffers = vec![
            (
                "opaque_key",
                gpu.upload("opaque_key", &opaque.key[places.clone()])?,
            ),
            (
                "opaque_prim",
                gpu.upload("opaque_prim", &opaque.prim[places.clone()])?,
            ),
            ("picture", gpu.storage("picture", 16 * places.len() as u64)?),
        ];
        let [until_key, until_face] = triptych_spec::layouts::ALL.end;
        Ok(Self {
            rasterizer,
            layout,
            frame,
            band,
            listing: Listing {
                until_key,
                until_face,
                layers: u32::MAX,
                samples: rasterizer.samples.count(),
                ..Listing::default()
            },
            work: rasterizer.work(band, |prim| !is_opaque(prim))?,
            buffers: buffers.into(),
        })
    }

    pub(super) fn pixels(&self) -> u32 {
        self.band.pixels(self.rasterizer.size)
    }

    /// Makes a buffer of so many words of zeros.
    pub(super) fn zeros(&mut self, name: &'static str, words: u64) -> Result<(), GpuError> {
        let buffer = self.rasterizer.gpu.storage(name, 4 * words)?;
        self.buffers.set(name, buffer);
        Ok(())
    }

    /// A stage over the transparent triangles.
    pub(super) fn draw(&self, stage: &str) -> Result<Vec<Step>, GpuError> {
        let listing = self.rasterizer.gpu.uniform("listing", &self.listing)?;
        let mut named: Vec<_> = self.buffers.iter().collect();
        named.push(("listing", &listing));
        let file = self.layout.file();
        let passes = self
            .rasterizer
            .ready(file, stage, self.frame, &self.work, &named)?;
        Ok(passes.into_iter().map(Step::Drawn).collect())
    }

    /// So many workgroups of a kernel of the layout's file.
    pub(super) fn pass(
        &self,
        entry: &str,
        listing: Listing,
        groups: u32,
    ) -> Result<ready::Ready, GpuError> {
        self.pass_of(self.layout.file(), entry, listing, groups)
    }

    /// The same of another file's.
    pub(super) fn pass_of(
        &self,
        file: &str,
        entry: &str,
        listing: Listing,
        groups: u32,
    ) -> Result<ready::Ready, GpuError> {
        let Rasterizer { gpu, kernels, .. } = *self.rasterizer;
        let frame = gpu.uniform("frame", &self.frame)?;
        let listing = gpu.uniform("listing", &listing)?;
        let mut named: Vec<_> = self.buffers.iter().collect();
        named.extend([
            ("frame", &frame),
            ("listing", &listing),
            ("corners", self.rasterizer.corners()),
            ("faces", &self.rasterizer.faces),
        ]);
        ready::Ready::new(gpu, kernels, (file, entry), groups, &named)
    }

    /// One invocation a pixel.
    pub(super) fn per_pixel(
        &self,
        entry: &str,
        listing: Listing,
    ) -> Result<ready::Ready, GpuError> {
        self.pass(entry, listing, self.pixels().div_ceil(WORKGROUP))
    }

    /// Runs passes, and waits for the end.
    pub(super) fn submit(&self, steps: &[Step]) -> Result<Duration, GpuError> {
        let gpu = self.rasterizer.gpu;
        let mut encoder = gpu.encoder();
        for step in steps {
            step.record(self.rasterizer, &mut encoder, None);
        }
        let start = Instant::now();
        gpu.submit(encoder)?;
        Ok(start.elapsed())
    }

    /// Sets a buffer, or its beginning, to zero.
    pub(super) fn clear(&self, name: &str, bytes: Option<u64>) -> Result<(), GpuError> {
        let mut encoder = self.rasterizer.gpu.encoder();
        encoder.clear_buffer(self.buffers.get(name), 0, bytes);
        self.rasterizer.gpu.submit(encoder)
    }

    /// The picture: the mean of a pixel's samples is where its first one was.
    pub(super) fn picture(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        let (gpu, samples) = (self.rasterizer.gpu, self.frame.samples);
        let all = image(gpu, self.buffers.get("picture"), self.pixels() * samples)?;
        Ok(all.into_iter().step_by(samples as usize).collect())
    }
}

/// A word of an address.
pub(super) fn word(n: usize) -> u32 {
    u32::try_from(n).expect("addresses are words")
}

/// Lists without nodes, yet.
pub(super) fn no_lists(pixels: u32) -> Lists {
    Lists {
        heads: Vec::with_capacity(pixels as usize),
        nodes: Vec::new(),
        colours: Vec::new(),
        attempts: 0,
        capacity: 0,
    }
}
