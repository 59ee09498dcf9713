//! What the hardware blends into, and the buffers that kernels read it from.

use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::Rasterizer;
use crate::timer::Writes;

/// Bytes that a row of a texture is a multiple of in a buffer (WebGPU).
const ROW: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

/// How the hardware blends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blend {
    /// Colours over what is there; alpha is what goes through.
    Over { half: bool },
    /// Weighted colours and weights added; what goes through multiplied.
    Sums,
}

impl Blend {
    /// Variable, bytes a pixel, and what it is cleared to.
    fn kinds(self) -> &'static [(&'static str, u32, wgpu::Color)] {
        const THROUGH: wgpu::Color = wgpu::Color::BLACK;
        match self {
            Self::Over { half: false } => &[("blended", 16, THROUGH)],
            Self::Over { half: true } => &[("blended_half", 8, THROUGH)],
            Self::Sums => &[
                ("blended", 16, wgpu::Color::TRANSPARENT),
                ("revealed", 4, wgpu::Color::WHITE),
            ],
        }
    }

    pub(super) fn states(self) -> Vec<wgpu::ColorTargetState> {
        use wgpu::BlendFactor::{One, OneMinusSrc, OneMinusSrcAlpha, SrcAlpha, Zero};
        let state = |format, color, alpha| {
            let component =
                |[src_factor, dst_factor]: [wgpu::BlendFactor; 2]| wgpu::BlendComponent {
                    src_factor,
                    dst_factor,
                    operation: wgpu::BlendOperation::Add,
                };
            wgpu::ColorTargetState {
                format,
                blend: Some(wgpu::BlendState {
                    color: component(color),
                    alpha: component(alpha),
                }),
                write_mask: wgpu::ColorWrites::ALL,
            }
        };
        let over = |format| {
            state(
                format,
                [SrcAlpha, OneMinusSrcAlpha],
                [Zero, OneMinusSrcAlpha],
            )
        };
        match self {
            Self::Over { half: false } => vec![over(wgpu::TextureFormat::Rgba32Float)],
            Self::Over { half: true } => vec![over(wgpu::TextureFormat::Rgba16Float)],
            Self::Sums => {
                let through = [Zero, OneMinusSrc];
                vec![
                    state(wgpu::TextureFormat::Rgba32Float, [One, One], [One, One]),
                    state(wgpu::TextureFormat::R32Float, through, through),
                ]
            }
        }
    }
}

/// Targets of a band.
pub(super) struct Targets {
    blend: Blend,
    band: Band,
    width: u32,
    textures: Vec<wgpu::Texture>,
    views: Vec<wgpu::TextureView>,
    buffers: Vec<wgpu::Buffer>,
}

impl Targets {
    pub(super) fn new(
        rasterizer: &Rasterizer<'_>,
        blend: Blend,
        band: Band,
    ) -> Result<Self, GpuError> {
        let (gpu, size) = (rasterizer.gpu, rasterizer.size);
        let mut all = Self {
            blend,
            band,
            width: size.width,
            textures: Vec::new(),
            views: Vec::new(),
            buffers: Vec::new(),
        };
        for (state, (name, bytes, _)) in blend.states().iter().zip(blend.kinds()) {
            let descriptor = wgpu::TextureDescriptor {
                label: Some(name),
                size: wgpu::Extent3d {
                    width: size.width,
                    height: size.height,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: state.format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            };
            let taken = u64::from(*bytes) * size.pixels() as u64;
            let texture = gpu.make(name, taken, |device| device.create_texture(&descriptor))?;
            all.views
                .push(texture.create_view(&wgpu::TextureViewDescriptor::default()));
            all.textures.push(texture);
            let rows = u64::from(row(size.width, *bytes)) * u64::from(band.rows);
            all.buffers.push(gpu.storage(name, rows)?);
        }
        Ok(all)
    }

    pub(super) fn named(&self) -> impl Iterator<Item = (&'static str, &wgpu::Buffer)> {
        let names = self.blend.kinds().iter().map(|(name, ..)| *name);
        names.zip(&self.buffers)
    }

    pub(super) fn bytes(&self) -> u64 {
        let kinds = self.blend.kinds().iter().zip(&self.textures);
        let textures = kinds.map(|((_, bytes, _), texture)| {
            u64::from(*bytes) * u64::from(texture.width()) * u64::from(texture.height())
        });
        let buffers = self.buffers.iter().map(wgpu::Buffer::size);
        textures.sum::<u64>() + buffers.sum::<u64>()
    }

    /// To be drawn into, over what is there.
    pub(super) fn attachments(&self) -> Vec<Option<wgpu::RenderPassColorAttachment<'_>>> {
        let views = self.views.iter();
        views
            .map(|view| attachment(view, wgpu::LoadOp::Load))
            .collect()
    }

    /// A pass of its own, as the first batch may not be there.
    pub(super) fn clear(&self, encoder: &mut wgpu::CommandEncoder, writes: Option<Writes<'_>>) {
        let views = self.views.iter().zip(self.blend.kinds());
        let cleared = |(view, (_, _, colour)): (_, &(_, _, wgpu::Color))| {
            attachment(view, wgpu::LoadOp::Clear(*colour))
        };
        let attachments: Vec<_> = views.map(cleared).collect();
        drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &attachments,
            timestamp_writes: writes.map(Writes::render),
            ..Default::default()
        }));
    }

    /// The band's rows, where kernels read them.
    pub(super) fn copy(&self, encoder: &mut wgpu::CommandEncoder) {
        let kinds = self.blend.kinds().iter();
        let pairs = self.textures.iter().zip(&self.buffers);
        for ((_, bytes, _), (texture, buffer)) in kinds.zip(pairs) {
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo {
                    origin: wgpu::Origin3d {
                        x: 0,
                        y: self.band.first,
                        z: 0,
                    },
                    ..texture.as_image_copy()
                },
                wgpu::TexelCopyBufferInfo {
                    buffer,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(row(self.width, *bytes)),
                        rows_per_image: None,
                    },
                },
                wgpu::Extent3d {
                    width: self.width,
                    height: self.band.rows,
                    depth_or_array_layers: 1,
                },
            );
        }
    }
}

fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        },
    })
}

/// Bytes of a row in a buffer.
fn row(width: u32, bytes: u32) -> u32 {
    (width * bytes).next_multiple_of(ROW)
}
