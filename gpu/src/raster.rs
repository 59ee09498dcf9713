//! Raster stage on the device: triangles in, fragments out, on two paths.

mod attempts;
mod cover;
mod early;
mod ready;
mod work;

use std::cell::{OnceCell, RefCell};
use std::time::{Duration, Instant};

use triptych_spec::raster::Samples;
use triptych_spec::scene::Size;
use triptych_spec::vertex::{Position, Primitives, SUBPIXEL_BITS};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::kernel::{Kernel, Kernels, TARGET_FORMAT};
use crate::pass::Pass;
use crate::timer::Writes;
pub use attempts::{Attempts, MEMORY, Need, SATURATED};
pub use cover::{Covered, cover};
pub(crate) use ready::Ready;
pub(crate) use work::{Reach, heights};
pub use work::{WALKED, Work};

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
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Fragment, Self::Compute, Self::Native];

    /// Name on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fragment => "fragment",
            Self::Compute => "compute",
            Self::Native => "native",
        }
    }
}

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
    /// Where the samples of every pixel lie.
    pub samples: Samples,
    corners: wgpu::Buffer,
    /// Clip space, where the driver is to divide, clip and snap.
    handed: Option<wgpu::Buffer>,
    /// Colour of each triangle.
    pub faces: wgpu::Buffer,
    pub(crate) colours: Vec<[f32; 4]>,
    /// Of each triangle that has a sample.
    reaches: Vec<Option<Reach>>,
    /// The smallest and the largest depth key of a corner.
    depths: [u32; 2],
    target: wgpu::TextureView,
    /// Whether fragments that build lists may be tested by depth before they run.
    early: bool,
    /// Its depth, once kernels are tested by it before they run.
    depth: OnceCell<wgpu::TextureView>,
    passes: RefCell<Vec<Pass>>,
}

impl<'g> Rasterizer<'g> {
    /// Uploads triangles and their colours, one for each row of
    /// [`Primitives::prims`].
    ///
    /// # Errors
    /// More triangles than the adapter can bind, or has memory for.
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
        let (bits, samples) = (primitives.bits, primitives.samples);
        // Only the fragment path draws to it.
        let drawn = match path {
            Path::Fragment => samples.count(),
            Path::Compute | Path::Native => 1,
        };
        let height = heights(samples, bits);
        Ok(Self {
            gpu,
            kernels,
            path,
            size: primitives.size,
            bits,
            samples,
            reaches: corners
                .iter()
                .map(|c| Reach::of(c, (primitives.size, bits), height))
                .collect(),
            depths: depths(&corners),
            corners: gpu.upload("corners", &corners)?,
            handed: None,
            faces: gpu.upload("faces", faces)?,
            colours: faces.to_vec(),
            target: texture(gpu, ("target", TARGET_FORMAT, 1), primitives.size, drawn)?,
            early: path == Path::Fragment && gpu.tests_depth_early(drawn),
            depth: OnceCell::new(),
            passes: RefCell::default(),
        })
    }

    /// Hands the driver triangles in the clip space of the guard rectangle: it divides,
    /// clips and snaps itself. Only coverage means anything then; keys are 0. The path is
    /// [`Path::Fragment`].
    ///
    /// # Errors
    /// More triangles than the adapter can bind, or has memory for.
    pub fn handed(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        size: Size,
        triangles: &[[Position<f32>; 3]],
    ) -> Result<Self, GpuError> {
        let nothing = Primitives {
            size,
            bits: SUBPIXEL_BITS,
            samples: Samples::ONE,
            snapped: vec![[0; 3]],
            prims: vec![[0; 3]; triangles.len()],
            source: Vec::new(),
        };
        let faces = vec![[0.0; 4]; triangles.len()];
        // Only the driver knows where they lie.
        let everywhere = Reach::whole(size);
        let all = Self::new(gpu, kernels, Path::Fragment, &nothing, &faces)?;
        Ok(Self {
            reaches: vec![Some(everywhere); triangles.len()],
            handed: Some(gpu.upload("handed", triangles)?),
            early: false,
            ..all
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
        self.run(&self.ready(file, stage, frame, work, buffers)?)
    }

    /// Runs passes, and waits for them.
    pub(crate) fn run(&self, passes: &[Ready]) -> Result<Duration, GpuError> {
        let mut encoder = self.gpu.encoder();
        self.record(passes, &mut encoder);
        let start = Instant::now();
        self.gpu.submit(encoder)?;
        Ok(start.elapsed())
    }

    /// Triangles.
    pub(crate) fn prims(&self) -> u32 {
        u32::try_from(self.reaches.len()).expect("rows of triangles are words")
    }

    /// Depth keys of fragments lie between these.
    pub(crate) fn depths(&self) -> [u32; 2] {
        self.depths
    }

    /// Nine numbers for each of them.
    pub(crate) fn corners(&self) -> &wgpu::Buffer {
        &self.corners
    }

    /// The passes since the last call, in the order in which they were recorded.
    pub fn take_passes(&self) -> Vec<Pass> {
        self.passes.take()
    }

    /// Records passes, and notes them.
    pub(crate) fn record(&self, passes: &[Ready], encoder: &mut wgpu::CommandEncoder) {
        for pass in passes {
            self.record_pass(pass, encoder, None);
        }
    }

    /// Records a pass, and notes it.
    pub(crate) fn record_pass(
        &self,
        pass: &Ready,
        encoder: &mut wgpu::CommandEncoder,
        writes: Option<Writes<'_>>,
    ) {
        pass.record(self, encoder, writes);
        self.note(&pass.stage, pass.shared, &pass.kernel);
    }

    fn note(&self, stage: &str, shared: bool, kernel: &Kernel) {
        self.passes.borrow_mut().push(Pass {
            stage: stage.into(),
            shared,
            uses: kernel.uses.clone(),
        });
    }

    /// A frame for a band of this target.
    pub fn frame(&self, band: Band) -> Frame {
        Frame::with_samples(self.size, self.bits, self.samples, band)
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
    let pass = rasterizer.ready_per_pixel(file, stage, frame, buffers)?;
    let mut encoder = gpu.encoder();
    pass.record(rasterizer, &mut encoder, None);
    rasterizer.note(&pass.stage, pass.shared, &pass.kernel);
    let start = Instant::now();
    gpu.submit(encoder)?;
    Ok(start.elapsed())
}

/// The smallest and the largest depth key of a corner.
fn depths(corners: &[[[i32; 3]; 3]]) -> [u32; 2] {
    let keys = || corners.iter().flatten().map(|c| c[2].unsigned_abs());
    [keys().min().unwrap_or(0), keys().max().unwrap_or(0)]
}

/// A texture to draw to, of a format of so many bytes.
fn texture(
    gpu: &Gpu,
    (what, format, bytes): (&'static str, wgpu::TextureFormat, u64),
    size: Size,
    samples: u32,
) -> Result<wgpu::TextureView, GpuError> {
    let descriptor = wgpu::TextureDescriptor {
        label: Some(what),
        size: wgpu::Extent3d {
            width: size.width,
            height: size.height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    };
    let bytes = bytes * u64::from(size.width) * u64::from(size.height) * u64::from(samples);
    let texture = gpu.make(what, bytes, |device| device.create_texture(&descriptor))?;
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}
