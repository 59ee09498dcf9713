//! Raster stage on the device: triangles in, fragments out, on two paths.

use std::time::{Duration, Instant};

use triptych_spec::raster::Fragment;
use triptych_spec::scene::Size;
use triptych_spec::vertex::{GUARD, Primitives, guard_origin};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Band, Frame, WORKGROUP};
use crate::kernel::{Kernel, Kernels, Pipeline, TARGET_FORMAT};

/// Who decides coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Path {
    /// The hardware's rasteriser.
    Fragment,
    /// Integer arithmetic in a compute kernel, baseline WGSL.
    Compute,
    /// The same with the adapter's own 64-bit integers.
    Native,
}

impl Path {
    /// Name on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fragment => "fragment",
            Self::Compute => "compute",
            Self::Native => "native",
        }
    }
}

/// Past this many claims a counter no longer counts. Twin: `SATURATED` in
/// `counter.wgsl`.
pub const SATURATED: u32 = 0x8000_0000;

/// Most rows of triangles that one dispatch walks (WebGPU: 65,535 workgroups).
const ITEMS_MAX: u32 = 65_535 * WORKGROUP;

/// Triangles on the device.
pub struct Rasterizer<'g> {
    /// The device.
    pub gpu: &'g Gpu,
    /// Its kernels.
    pub kernels: &'g Kernels,
    /// Fragment or compute.
    pub path: Path,
    /// Size of the target.
    pub size: Size,
    bits: u32,
    corners: wgpu::Buffer,
    /// Colour of each triangle.
    pub faces: wgpu::Buffer,
    /// First and last row with a sample, of each triangle that has any.
    rows: Vec<Option<[i64; 2]>>,
    target: wgpu::TextureView,
}

/// A work list and its batches.
pub struct Work {
    buffer: wgpu::Buffer,
    batches: Vec<Batch>,
}

struct Batch {
    first: u32,
    count: u32,
    items: u32,
}

impl<'g> Rasterizer<'g> {
    /// Uploads triangles and their colours, one for each row of
    /// [`Primitives::prims`].
    ///
    /// # Errors
    /// More triangles than the adapter can bind.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        path: Path,
        primitives: &Primitives,
        faces: &[[f32; 4]],
    ) -> Result<Self, GpuError> {
        let corners: Vec<[[i32; 3]; 3]> = primitives
            .prims
            .iter()
            .map(|p| p.map(|corner| primitives.snapped[corner as usize]))
            .collect();
        let bits = primitives.bits;
        Ok(Self {
            gpu,
            kernels,
            path,
            size: primitives.size,
            bits,
            rows: corners.iter().map(|c| sampled_rows(c, bits)).collect(),
            corners: gpu.upload("corners", &corners)?,
            faces: gpu.upload("faces", faces)?,
            target: target(gpu, primitives.size),
        })
    }

    /// The triangles that `select` picks, as far as they meet a band.
    ///
    /// # Errors
    /// More triangles than the adapter can bind.
    pub fn work(&self, band: Band, select: impl Fn(u32) -> bool) -> Result<Work, GpuError> {
        let mut list: Vec<[u32; 2]> = Vec::new();
        let mut batches = Vec::new();
        let mut batch = Batch {
            first: 0,
            count: 0,
            items: 0,
        };
        for (prim, rows) in (0..).zip(&self.rows) {
            let rows = rows.map_or(0, |rows| rows_within(rows, band));
            if rows == 0 || !select(prim) {
                continue;
            }
            if batch.items + rows > ITEMS_MAX {
                let first = batch.first + batch.count;
                batches.push(std::mem::replace(
                    &mut batch,
                    Batch {
                        first,
                        count: 0,
                        items: 0,
                    },
                ));
            }
            list.push([prim, batch.items]);
            batch.count += 1;
            batch.items += rows;
        }
        if batch.count > 0 {
            batches.push(batch);
        }
        Ok(Work {
            buffer: self.gpu.upload("work", &list)?,
            batches,
        })
    }

    /// Runs stage `stage` of `file` over a band, and waits for it.
    ///
    /// # Errors
    /// WGSL errors, and whatever the device reports.
    pub fn draw(
        &self,
        file: &str,
        stage: &str,
        frame: Frame,
        work: &Work,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Duration, GpuError> {
        let kernel = match self.path {
            Path::Compute | Path::Native => self.kernels.compute(self.gpu, file, stage)?,
            Path::Fragment => {
                self.kernels
                    .fragment(self.gpu, file, &format!("{stage}_fragment"))?
            }
        };
        let mut encoder = self.gpu.encoder();
        for batch in &work.batches {
            let frame = Frame {
                work_first: batch.first,
                work_count: batch.count,
                items: batch.items,
                ..frame
            };
            let uniform = uniform(self.gpu, &frame);
            let mut all = vec![
                ("frame", &uniform),
                ("corners", &self.corners),
                ("work", &work.buffer),
                ("faces", &self.faces),
            ];
            all.extend_from_slice(buffers);
            let group = kernel.bind(self.gpu, &all);
            self.record(&mut encoder, &kernel, &group, &frame);
        }
        let start = Instant::now();
        self.gpu.submit(encoder)?;
        Ok(start.elapsed())
    }

    /// A frame for a band of this target.
    pub fn frame(&self, band: Band) -> Frame {
        Frame::new(self.size, self.bits, band)
    }

    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        kernel: &Kernel,
        group: &wgpu::BindGroup,
        frame: &Frame,
    ) {
        match &kernel.pipeline {
            Pipeline::Compute(pipeline) => {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                pass.dispatch_workgroups(frame.items.div_ceil(WORKGROUP), 1, 1);
            }
            Pipeline::Render(pipeline) => {
                let mut pass = begin_render(encoder, &self.target);
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                let side = GUARD as f32;
                let origin = [
                    guard_origin(self.size.width),
                    guard_origin(self.size.height),
                ];
                pass.set_viewport(origin[0] as f32, origin[1] as f32, side, side, 0.0, 1.0);
                pass.set_scissor_rect(0, frame.first_row, self.size.width, frame.rows);
                pass.draw(0..3 * frame.work_count, 0..1);
            }
        }
    }
}

/// Runs a compute kernel with one invocation per pixel of a band.
///
/// # Errors
/// WGSL errors, and whatever the device reports.
pub fn per_pixel(
    rasterizer: &Rasterizer<'_>,
    file: &str,
    stage: &str,
    frame: Frame,
    buffers: &[(&str, &wgpu::Buffer)],
) -> Result<Duration, GpuError> {
    let gpu = rasterizer.gpu;
    let kernel = rasterizer.kernels.compute(gpu, file, stage)?;
    let uniform = uniform(gpu, &frame);
    let mut all = vec![("frame", &uniform), ("faces", &rasterizer.faces)];
    all.extend_from_slice(buffers);
    let group = kernel.bind(gpu, &all);
    let mut encoder = gpu.encoder();
    if let Pipeline::Compute(pipeline) = &kernel.pipeline {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        // A target of 2048 x 2048 pixels is 65,536 workgroups, one more than allowed
        // in a row; bands of the full size are split before that.
        pass.dispatch_workgroups((frame.width * frame.rows).div_ceil(WORKGROUP), 1, 1);
    }
    let start = Instant::now();
    gpu.submit(encoder)?;
    Ok(start.elapsed())
}

/// What stage `cover` gave.
pub struct Covered {
    /// Fragments in no particular order.
    pub fragments: Vec<Fragment>,
    /// Time on the device, without transfers.
    pub time: Duration,
}

/// Stage `cover`: every covered pixel of every triangle.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn cover(rasterizer: &Rasterizer<'_>) -> Result<Covered, GpuError> {
    let mut covered = Covered {
        fragments: Vec::new(),
        time: Duration::ZERO,
    };
    let size = rasterizer.size;
    let mut capacity = first_capacity(size).min(nodes_max(rasterizer.gpu));
    let mut bands = vec![Band::whole(size)];
    while let Some(band) = bands.pop() {
        let gpu = rasterizer.gpu;
        let counter = gpu.filled("counter", 1, 0)?;
        let stream = gpu.storage("stream", 16 * u64::from(capacity))?;
        let work = rasterizer.work(band, |_| true)?;
        let frame = Frame {
            capacity,
            ..rasterizer.frame(band)
        };
        let buffers = [("counter", &counter), ("stream", &stream)];
        let time = rasterizer.draw("raster", "cover", frame, &work, &buffers)?;
        let attempts = gpu.read::<u32>(&counter, 1)?[0];
        match after(gpu, "cover", band, attempts, capacity)? {
            Next::Done => {
                covered.time += time;
                let first = band.first * size.width;
                let stored = gpu.read::<[u32; 4]>(&stream, attempts as usize)?;
                let fragments = stored.into_iter().map(|[pixel, prim, key, mask]| Fragment {
                    pixel: pixel + first,
                    prim,
                    key,
                    mask,
                });
                covered.fragments.extend(fragments);
            }
            Next::Resize(exact) => {
                capacity = exact;
                bands.push(band);
            }
            Next::Split([upper, lower]) => bands.extend([lower, upper]),
        }
    }
    Ok(covered)
}

/// Room for two fragments a pixel: enough for most scenes at the first attempt.
pub fn first_capacity(size: Size) -> u32 {
    2 * size.width * size.height
}

/// The most nodes of 16 bytes that the adapter can bind.
pub fn nodes_max(gpu: &Gpu) -> u32 {
    u32::try_from(gpu.binding_limit() / 16).unwrap_or(u32::MAX)
}

/// What to do after an attempt with some capacity.
pub enum Next {
    /// Everything fitted.
    Done,
    /// Again, with exactly this much room.
    Resize(u32),
    /// The adapter has no such buffer: again in two parts.
    Split([Band; 2]),
}

/// Overflow is detected by the counter and cured by size, or by halves where the
/// adapter cannot bind so much (section 3.3: "detect when overflow happens and
/// resize the node buffer as needed").
///
/// # Errors
/// [`GpuError::Limit`] if even a single row does not fit.
pub fn after(
    gpu: &Gpu,
    what: &'static str,
    band: Band,
    attempts: u32,
    capacity: u32,
) -> Result<Next, GpuError> {
    let most = nodes_max(gpu);
    if attempts <= capacity {
        return Ok(Next::Done);
    }
    if attempts < SATURATED && attempts <= most {
        return Ok(Next::Resize(attempts));
    }
    band.halves().map(Next::Split).ok_or(GpuError::Limit {
        adapter: gpu.name.clone(),
        what,
        needed: u64::from(attempts),
        limit: u64::from(most),
    })
}

/// First and last row whose samples lie within a triangle's height; `None` if it
/// has none. This only shares out work: which of the samples are covered is decided
/// on the device.
fn sampled_rows(corners: &[[i32; 3]; 3], bits: u32) -> Option<[i64; 2]> {
    let y = corners.map(|c| i64::from(c[1]));
    let half = 1_i64 << (bits - 1);
    let top = -((half - y[0].min(y[1]).min(y[2])) >> bits);
    let bottom = (y[0].max(y[1]).max(y[2]) - half) >> bits;
    (top <= bottom).then_some([top, bottom])
}

fn rows_within([top, bottom]: [i64; 2], band: Band) -> u32 {
    let top = top.max(i64::from(band.first));
    let bottom = bottom.min(i64::from(band.first + band.rows) - 1);
    u32::try_from(bottom - top + 1).unwrap_or(0)
}

pub(crate) fn uniform(gpu: &Gpu, frame: &Frame) -> wgpu::Buffer {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("frame"),
        size: size_of::<Frame>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue
        .write_buffer(&buffer, 0, bytemuck::bytes_of(frame));
    buffer
}

fn target(gpu: &Gpu, size: Size) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("target"),
        size: wgpu::Extent3d {
            width: size.width,
            height: size.height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TARGET_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn begin_render<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Discard,
            },
        })],
        ..Default::default()
    })
}
