//! Passes with all that they bind, to be recorded once or many times.

use std::sync::Arc;

use triptych_spec::scene::Size;
use triptych_spec::vertex::{GUARD, guard_origin};

use super::{Path, Rasterizer, Work};
use crate::error::GpuError;
use crate::frame::{Frame, WORKGROUP};
use crate::kernel::{Kernel, Pipeline};
use crate::timer::Writes;
use crate::wgsl::Depth;

/// A pass that is ready.
pub(crate) struct Ready {
    pub(super) kernel: Arc<Kernel>,
    /// The stage whose kernel it runs.
    pub(super) stage: String,
    /// Whether several invocations may work on one pixel.
    pub(super) shared: bool,
    pub(super) group: wgpu::BindGroup,
    pub(super) frame: Frame,
    /// Invocations, if it is a compute pass.
    pub(super) invocations: u32,
}

impl Rasterizer<'_> {
    /// The passes of stage `stage` of `file` over a band: one for each batch.
    pub(crate) fn ready(
        &self,
        file: &str,
        stage: &str,
        frame: Frame,
        work: &Work,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Vec<Ready>, GpuError> {
        let kernel = match self.path {
            Path::Compute | Path::Native => self.kernels.compute(self.gpu, file, stage)?,
            Path::Fragment => {
                let place = match self.handed {
                    None => "place",
                    Some(_) => "place_handed",
                };
                let entry = format!("{stage}_fragment");
                let samples = self.samples.count();
                let file = match samples {
                    1 => file.to_owned(),
                    _ => format!("{file}_samples"),
                };
                self.kernels
                    .fragment(self.gpu, &file, [place, &entry], samples)?
            }
        };
        self.ready_kernel(&kernel, stage, frame, work, buffers)
    }

    /// The passes of a kernel over a band: one for each batch.
    pub(crate) fn ready_kernel(
        &self,
        kernel: &Arc<Kernel>,
        stage: &str,
        frame: Frame,
        work: &Work,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Vec<Ready>, GpuError> {
        let pass = |batch: &super::work::Batch| {
            let frame = Frame {
                work_first: batch.first,
                work_count: batch.count,
                items: batch.items,
                ..frame
            };
            let uniform = self.gpu.uniform("frame", &frame)?;
            let mut all = vec![
                ("frame", &uniform),
                ("corners", &self.corners),
                ("work", &work.buffer),
                ("faces", &self.faces),
            ];
            all.extend(self.handed.as_ref().map(|handed| ("handed", handed)));
            all.extend_from_slice(buffers);
            Ok(Ready {
                kernel: kernel.clone(),
                stage: stage.into(),
                shared: true,
                group: kernel.bind(self.gpu, &all),
                frame,
                invocations: frame.items,
            })
        };
        work.batches.iter().map(pass).collect()
    }

    /// A compute pass with one invocation per pixel of a band.
    pub(crate) fn ready_per_pixel(
        &self,
        file: &str,
        stage: &str,
        frame: Frame,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Ready, GpuError> {
        let kernel = self.kernels.compute(self.gpu, file, stage)?;
        let uniform = self.gpu.uniform("frame", &frame)?;
        let mut all = vec![
            ("frame", &uniform),
            ("corners", &self.corners),
            ("faces", &self.faces),
        ];
        all.extend_from_slice(buffers);
        Ok(Ready {
            group: kernel.bind(self.gpu, &all),
            kernel,
            stage: stage.into(),
            shared: false,
            frame,
            // A target of 2048 x 2048 pixels is 65,536 workgroups, one more than allowed
            // in a row; bands of the full size are split before that.
            invocations: frame.width * frame.rows,
        })
    }
}

impl Rasterizer<'_> {
    /// Records a pass whose colours are blended into other targets than this one's, and notes
    /// it.
    pub(crate) fn record_into(
        &self,
        ready: &Ready,
        targets: &[Option<wgpu::RenderPassColorAttachment<'_>>],
        encoder: &mut wgpu::CommandEncoder,
        writes: Option<Writes<'_>>,
    ) {
        let Pipeline::Render(pipeline) = &ready.kernel.pipeline else {
            unreachable!("colours are those of fragments");
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: targets,
            timestamp_writes: writes.map(Writes::render),
            ..Default::default()
        });
        ready.draw(pipeline, self.size, &mut pass);
        self.note(&ready.stage, ready.shared, &ready.kernel);
    }
}

impl Ready {
    /// Records the pass, which notes when it begins and ends if that is asked for.
    pub(crate) fn record(
        &self,
        rasterizer: &Rasterizer<'_>,
        encoder: &mut wgpu::CommandEncoder,
        writes: Option<Writes<'_>>,
    ) {
        match &self.kernel.pipeline {
            Pipeline::Compute(pipeline) => {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: None,
                    timestamp_writes: writes.map(Writes::compute),
                });
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, &self.group, &[]);
                pass.dispatch_workgroups(self.invocations.div_ceil(WORKGROUP), 1, 1);
            }
            Pipeline::Render(pipeline) => {
                let depth = rasterizer.depth.get().map(|view| (view, self.kernel.depth));
                let mut pass = begin_render(encoder, &rasterizer.target, depth, writes);
                self.draw(pipeline, rasterizer.size, &mut pass);
            }
        }
    }

    /// The triangles of its batch.
    fn draw(&self, pipeline: &wgpu::RenderPipeline, size: Size, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        let side = GUARD as f32;
        let origin = [guard_origin(size.width), guard_origin(size.height)];
        pass.set_viewport(origin[0] as f32, origin[1] as f32, side, side, 0.0, 1.0);
        pass.set_scissor_rect(0, self.frame.first_row, size.width, self.frame.rows);
        pass.draw(0..3 * self.frame.work_count, 0..1);
    }
}

fn begin_render<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
    depth: Option<(&wgpu::TextureView, Depth)>,
    writes: Option<Writes<'_>>,
) -> wgpu::RenderPass<'e> {
    let attached = |(view, depth)| {
        let load = match depth {
            Depth::Unused => return None,
            Depth::Written => wgpu::LoadOp::Clear(1.0),
            Depth::Tested => wgpu::LoadOp::Load,
        };
        Some(wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations {
                load,
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        })
    };
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
        depth_stencil_attachment: depth.and_then(attached),
        timestamp_writes: writes.map(Writes::render),
        ..Default::default()
    })
}
