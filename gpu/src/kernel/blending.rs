//! Fragment kernels whose colours are blended. They have no side effects, which llvmpipe would
//! lose where a later colour covers them.

use std::sync::Arc;

use super::{Kernel, Kernels, Pipeline};
use crate::context::Gpu;
use crate::error::GpuError;

impl Kernels {
    /// The fragment kernel `entry` of `file`, fed by the vertex entry point `place`, into these
    /// targets.
    ///
    /// # Errors
    /// WGSL errors at their place; what the device refuses.
    pub(crate) fn blending(
        &self,
        gpu: &Gpu,
        file: &str,
        [place, entry]: [&str; 2],
        targets: &[wgpu::ColorTargetState],
    ) -> Result<Arc<Kernel>, GpuError> {
        let into = format!("{targets:?}");
        let targets: Vec<_> = targets.iter().cloned().map(Some).collect();
        self.get(gpu, file, ([place, entry, &into], 1), |ours, module| {
            let descriptor = wgpu::RenderPipelineDescriptor {
                label: Some(entry),
                layout: None,
                vertex: wgpu::VertexState {
                    module: &ours.shader,
                    entry_point: Some(place),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module.shader,
                    entry_point: Some(entry),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            };
            Pipeline::Render(gpu.device.create_render_pipeline(&descriptor))
        })
    }
}
